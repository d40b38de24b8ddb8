// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The two classical models with diagonal input noise, kept to show what is wrong with them.
//
//   u = (D, a)      driven distance and turn of one step, with Cov(u) = diag(s_D^2, s_a^2)
//   turn_then_drive x += D cos(theta + a),    y += D sin(theta + a),    theta += a
//                   Chong & Kleeman (1997), eq. 1-3
//   midpoint        x += D cos(theta + a/2),  y += D sin(theta + a/2),  theta += a
//                   the same with the chord's direction (their slides)
//
// Both are inconsistent: a path given as one step or as several has different covariances, even
// when the steps' noises add up to the whole's. A straight 2D in one step has Cov22 = 4 D^2 s_a^2,
// in two steps of half the variance each 5/2 D^2 s_a^2. arc.hpp has the model that is not.
#pragma once

#include "trussmap/arc.hpp"

namespace trussmap::odometry {

enum class ClassicalModel { turn_then_drive, midpoint };

struct ClassicalStep {
  double distance = 0.0;           ///< D, m
  double turn = 0.0;               ///< a, rad
  double distance_variance = 0.0;  ///< s_D^2, m^2
  double turn_variance = 0.0;      ///< s_a^2, rad^2
};

/// One step, in the frame of its start; join steps with then().
[[nodiscard]] Motion classical_step(ClassicalModel model, const ClassicalStep& step);

}  // namespace trussmap::odometry
