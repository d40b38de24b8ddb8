// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What went on during the recordings: speed and covariates in time, a flat chart each.
#pragma once

#include "plot/chart.hpp"
#include "trussmap/robot.hpp"

#include <vector>

namespace trussmap::plot {

/// What is marked in the strips, in their own time (elapsed_shifts).
struct MarkedTimes {
  std::vector<TimeSpan> chosen;
  std::vector<TimeSpan> excluded;
};

/// Sessions one after the other; a point is the mean over its share of the time. Covariates that
/// all sessions have and that vary, the first few.
[[nodiscard]] std::vector<Chart> time_strips(const std::vector<DrivenRecording>& recordings,
                                             const MarkedTimes& marked = {});

}  // namespace trussmap::plot
