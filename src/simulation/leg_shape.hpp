// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The shape of a leg before it is scaled and turned to where it is to lead.
#pragma once

#include "trussmap/planar.hpp"

#include <array>
#include <vector>

namespace trussmap::simulation {

/// Where a row of unit length leads whose heading changes evenly from `first` to `last`: five-point
/// Gauss-Legendre quadrature, exact to rounding for turns below a radian.
[[nodiscard]] Vector2 unit_step(double first, double last);

/// Share of the mean speed in each row of a drive that begins and ends with a ramp of so many rows.
[[nodiscard]] std::vector<double> speed_profile(int rows, int ramp_rows);

/// Headings at the ends of a leg's rows, against the direction in which it set out to be driven.
struct LegShape {
  std::vector<double> headings;   ///< rad, one more than there are rows
  Vector2 end = Vector2::Zero();  ///< where it leads if it is 1 m long, m
};

/// Over what a leg's bends are even.
enum class Bends { in_time, by_way };

/// A bow, a sweep and an S [rad], one row per entry of the speed profile.
[[nodiscard]] LegShape leg_shape(const std::array<double, 3>& bends,
                                 const std::vector<double>& profile, Bends even = Bends::in_time);

/// The sharpest bend of such a leg if it is 1 m long, at most [rad/m].
[[nodiscard]] double sharpest_bend(const std::array<double, 3>& bends);

}  // namespace trussmap::simulation
