// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The page of a fit: a model with its effects beside the same robot without them.
#pragma once

#include "trussmap/criticism/comparison.hpp"
#include "trussmap/criticism/fitted_map.hpp"
#include "trussmap/criticism/response.hpp"
#include "trussmap/report/page.hpp"

#include <string>
#include <vector>

namespace trussmap {

/// What the page shows of a model.
struct FittedModel {
  Comparison comparison;
  FittedMap map;
};

/// An effect as fitted, and what the recordings show of it where the model lacks it.
struct FittedEffect {
  EffectEstimate estimate;
  Response response;  ///< of the fit without effects; no bins where there is nothing to draw
};

[[nodiscard]] Page fit_page(const FittedModel& without, const FittedModel& with,
                            const std::vector<FittedEffect>& effects, const std::string& subject);

}  // namespace trussmap
