// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What else a finding could be: candidates whose columns can show its trace as well.
#pragma once

#include "criticism/tested_candidate.hpp"
#include "trussmap/diagnose.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace trussmap::criticism {

/// Of tested[at] among the others; the most alike first, at most twelve. `others` are missing, too:
/// what they explain tells nothing apart. `dof` of the fit.
[[nodiscard]] std::vector<LookAlike> look_alikes_of(std::size_t at,
                                                    const std::vector<Tested>& tested,
                                                    const std::vector<std::size_t>& others,
                                                    const ScoreTest& tests, int dof);

/// chi^2 by which each rival explains less than the effect (LookAlike::behind).
[[nodiscard]] std::vector<double> chi2_behind(const Effect& effect,
                                              const std::vector<Effect>& rivals,
                                              const ScoreTest& tests, int dof);

/// The model with an effect in the place of the one that others look like; nothing where that
/// cannot be fitted.
using FitWith = std::function<std::optional<ModelFit>(const Effect& effect)>;

/// `behind` of those that are nearest to first order by fits: columns that are nearly parallel, or
/// a change beyond first order, leave it to these. Both without coefficients of their own begin
/// with those that the tests have.
void weigh_by_fits(std::vector<LookAlike>& alike, const Effect& effect, const ScoreTest& tests,
                   const FitWith& with);

/// One that fits clearly better, an extra coefficient counted; nullptr where there is none.
[[nodiscard]] const LookAlike* better_fitting(const std::vector<LookAlike>& alike,
                                              const Effect& effect);

/// nullptr where it is none of them.
[[nodiscard]] const LookAlike* find_among(const Effect& effect,
                                          const std::vector<LookAlike>& rivals);

/// Of an effect that is a look-alike of some that are missing: absent where fits tell it from all
/// of them, else it cannot be told; nothing where it is none's.
[[nodiscard]] std::optional<Status> status_beside(
    const Effect& effect, const std::vector<std::vector<LookAlike>>& rivals);

}  // namespace trussmap::criticism
