// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The page of a model set against recordings.
#pragma once

#include "criticism/comparison.hpp"
#include "criticism/response.hpp"
#include "report/fit_page.hpp"
#include "report/page.hpp"

#include <string>
#include <vector>

namespace trussmap {

/// A variable with the channel whose error goes with it most.
struct TrendPicture {
  Trend trend;
  Response response;
};

/// One per variable, the most telling first.
[[nodiscard]] std::vector<TrendPicture> trend_pictures(const Comparison& comparison,
                                                       const ModelFit& fit, const ScoreTest& tests);

[[nodiscard]] Page comparison_page(const FittedModel& model,
                                   const std::vector<TrendPicture>& trends,
                                   const std::string& subject);

/// In a sentence: does the model explain the recordings, and if not, how far off is it?
[[nodiscard]] std::string comparison_verdict(const Comparison& comparison);

}  // namespace trussmap
