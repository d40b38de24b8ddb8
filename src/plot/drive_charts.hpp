// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A robot's wheels as charts.
//
//   wheels_chart     where they are and which way they roll, seen from above, with their columns
//   steering_chart   how far it steered, forwards and backwards
#pragma once

#include "plot/chart.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <optional>
#include <vector>

namespace trussmap::plot {

/// `steered`: the smallest and the largest angle, rad, of a robot that steers. Without layers where
/// nobody said where the wheels are.
[[nodiscard]] Chart wheels_chart(const Robot& robot, const std::optional<Range>& steered);

/// By the steering column of recordings with their wheels taken in (with_wheels). Nothing where the
/// robot does not steer or stood still.
struct Steering {
  Range angles;  ///< rad, as far as it steered as it moved
  Chart chart;
};
[[nodiscard]] std::optional<Steering> steering_of(const std::vector<DrivenRecording>& recordings);

}  // namespace trussmap::plot
