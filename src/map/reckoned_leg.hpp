// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a robot without a compass knows of a route: how long it is, and how it lies to the route
// that it came by.
//
//   start          v = d + R(turn) o_1 - o_0: the chord, axes of the robot where the motion began
//     o--d,turn-->o end          alpha   direction of v in these axes               rad
//     |           |              beta    turn - alpha: heading at the end against the chord
//     o_0         o_1            corner  beta of one chord + alpha of the next: the angle from the
//     A --- v --- B                      one to the other at the landmark that they share
//
// Both angles depend on the offset of that landmark, o_1 of the one chord, which is o_0 of the
// next: `by_offset` keeps that part apart, so that a corner counts it once.
#pragma once

#include "trussmap/arc.hpp"
#include "trussmap/landmark_map.hpp"
#include "trussmap/planar.hpp"

namespace trussmap::map {

struct SharedAngle {
  double value = 0.0;                   ///< rad
  double variance = 0.0;                ///< rad^2, all but the shared landmark's offset
  Vector2 by_offset = Vector2::Zero();  ///< gradient by that offset, rad/m
};

struct Chord {
  Vector2 vector = Vector2::Zero();      ///< m, axes of the robot at the start
  Matrix2 covariance = Matrix2::Zero();  ///< m^2, likewise
  double length_variance = 0.0;          ///< m^2
  SharedAngle alpha;                     ///< shared: the landmark at the start
  SharedAngle beta;                      ///< shared: the landmark at the end
  double turn_variance = 0.0;            ///< rad^2, of the heading from start to end
  double turn = 0.0;                     ///< rad
};

/// Throws std::invalid_argument unless all is finite, the landmarks are apart and length and
/// directions are uncertain.
[[nodiscard]] Chord chord_of(const LandmarkOffset& from, const Motion& motion,
                             const LandmarkOffset& to);

/// A vector measured in the axes of a robot with this heading, in map axes.
[[nodiscard]] Traversal in_map_axes(const HeadingEstimate& heading, const Vector2& vector,
                                    const Matrix2& covariance);

/// A mean of numbers, and of their variances.
struct Average {
  int count = 0;
  double mean = 0.0;
  double variance = 0.0;

  void take(double value, double its_variance);
  /// The value is an angle.
  void take_angle(double value, double its_variance);
};

/// Angle and variance of the corner between a chord and the next one, which share a landmark that
/// is seen with this covariance.
struct MeasuredAngle {
  double value = 0.0;     ///< rad
  double variance = 0.0;  ///< rad^2
};
[[nodiscard]] MeasuredAngle corner_between(const SharedAngle& beta, const SharedAngle& alpha,
                                           const Matrix2& covariance_offset);

/// The variance of such an angle by itself.
[[nodiscard]] double variance_of(const SharedAngle& angle, const Matrix2& covariance_offset);

}  // namespace trussmap::map
