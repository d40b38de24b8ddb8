// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Coefficients of physical effects as further unknowns: what one unit of each does to every row of
// every drive, and to every view of a landmark or truth row.
//
//   row of a drive   DrivePattern (segment_motion.hpp): advance, slip, turn, compass
//   view             the point that meets landmarks and carries the sensors lies `ahead` and
//                    `left` of the axle's centre, and looks `heading` further left; the readings
//                    are range (1 + range_scale) + range, and bearing + bearing
//   truth row        ahead, left, heading alike
//
// An effect is linear in its coefficient row by row; what rows add up to is not, and is computed
// anew at every coefficient. Effects change no covariance.
#pragma once

#include "estimation/segment_motion.hpp"

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

/// What one unit of a coefficient does to a view or a truth row.
struct ViewPattern {
  double ahead = 0.0;        ///< m
  double left = 0.0;         ///< m
  double heading = 0.0;      ///< rad
  double range = 0.0;        ///< m
  double range_scale = 0.0;  ///< fraction
  double bearing = 0.0;      ///< rad

  [[nodiscard]] Eigen::Matrix<double, 6, 1> vector() const {
    return (Eigen::Matrix<double, 6, 1>() << ahead, left, heading, range, range_scale, bearing)
        .finished();
  }
};

/// One coefficient. Per session a pattern per row (sighting, truth row), or none at all.
struct EffectPattern {
  std::string name;
  std::vector<std::vector<DrivePattern>> drives;
  std::vector<std::vector<ViewPattern>> sightings;
  std::vector<std::vector<ViewPattern>> truths;
  double prior_sd = std::numeric_limits<double>::infinity();  ///< of the coefficient, about 0
  std::optional<double> held = {};  ///< known at this value: acts, but is no unknown
  double reference = 0.0;  ///< of the coefficient, where the patterns leave all as recorded
};

/// All coefficients, in order. Those that are not held are the unknowns, in the same order.
using EffectParameters = std::vector<EffectPattern>;

/// Places in the border of the coefficients that are unknown.
[[nodiscard]] std::vector<int> unknown_coefficients(const EffectParameters& border);

/// Wheels' geometry as in formats.md: turn, dtheta (1 + g); difference, left (1 - g/2) and right
/// (1 + g/2); wheels, both (1 + g); and the compass, reading = heading + g.
enum class PlainEffect { turn, difference, wheels, compass };

/// One coefficient for all sessions.
[[nodiscard]] EffectPattern plain_effect(PlainEffect effect,
                                         const std::vector<Recording>& recordings,
                                         const Robot& robot);

}  // namespace trussmap
