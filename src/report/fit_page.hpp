// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The page of a fit: a model with its effects beside the same robot without them.
#pragma once

#include "criticism/comparison.hpp"
#include "criticism/diagnosis.hpp"
#include "criticism/response.hpp"
#include "estimation/source_residuals.hpp"
#include "fit/fitted_map.hpp"
#include "report/page.hpp"

#include <string>
#include <vector>

namespace trussmap {

/// What the page shows of a model.
struct FittedModel {
  Comparison comparison;
  FittedMap map;
  std::vector<SourceResiduals> residuals;
};

/// `comparison` is of this fit.
[[nodiscard]] FittedModel fitted_model(const ModelFit& fit, Comparison comparison);

/// Compared here, as it was fitted; `tests` is of the fit.
[[nodiscard]] FittedModel fitted_model(const std::vector<Recording>& recordings,
                                       const ModelFit& fit, const ScoreTest& tests,
                                       const ComparisonOptions& options);

/// An effect as fitted, and what the recordings show of it where the model lacks it alone.
struct FittedEffect {
  EffectEstimate estimate;
  Response response;  ///< of the fit without it; no bins where there is nothing to draw
  EffectRange range = {};
  std::vector<Effect> rivals = {};  ///< of which the response has curves
};

/// Pictures of effects that a fit lacks, each with the others taken into account. `rivals` may be
/// shorter: what looks like each.
[[nodiscard]] std::vector<FittedEffect> fitted_effects(
    const ModelFit& without, const std::vector<EffectEstimate>& effects,
    const std::vector<std::vector<LookAlike>>& rivals = {});

[[nodiscard]] Page fit_page(const FittedModel& without, const FittedModel& with,
                            const std::vector<FittedEffect>& effects, const std::string& subject);

}  // namespace trussmap
