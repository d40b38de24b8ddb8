// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What else a finding could be: candidates whose columns can show its trace as well.
#pragma once

#include "criticism/tested_candidate.hpp"
#include "trussmap/diagnose.hpp"

#include <cstddef>
#include <vector>

namespace trussmap {

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

[[nodiscard]] bool is_among(const Effect& effect, const std::vector<LookAlike>& rivals);

}  // namespace trussmap
