// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// Motion of a differential-drive robot along one arc of constant curvature, and how unsure it is.
//
//   L, R   signed travel of the left and right wheel                       m
//   B      wheelbase                                                       m
//   D      (L + R)/2, signed path length of the axle's centre              m
//   a      (R - L)/B, signed turn                                          rad
//   k_L    wheel noise: variance of a wheel's travel = k^2 |travel|        m^(1/2)
//
// Chong & Kleeman (1997), eq. 13-18 with misprints repaired, in one closed form that has no
// special case: arc, straight line (a = 0), turn on the spot (D = 0), reverse, no motion. It is
// the limit of infinitely many small steps, so a path cut into segments gives the same covariance
// as the whole (first order in the noise: a heading spread of 0.3 rad is off by some 20 %).
//
// A Motion is expressed in the frame of its own start: x ahead, y to the left.
#pragma once

#include "trussmap/planar.hpp"
#include "trussmap/robot.hpp"

namespace trussmap {

struct WheelNoise {
  double left = 0.0;   ///< k_L, m^(1/2)
  double right = 0.0;  ///< k_R, m^(1/2)
};

struct Motion {
  Pose displacement;                     ///< end pose in the frame of the start
  Matrix3 covariance = Matrix3::Zero();  ///< of (x, y, heading), in the frame of the start
};

/// Exact displacement along the arc (eq. 13).
[[nodiscard]] Pose arc_displacement(const WheelTravel& travel, double wheelbase);
/// The same of an arc of signed length `path` (m) that turns by `turn` (rad).
[[nodiscard]] Pose arc_displacement(double path, double turn);

/// Cov(U) of eq. 17 in the axes of the arc's start. `wheelbase` > 0, else std::invalid_argument.
[[nodiscard]] Matrix3 arc_covariance(const WheelTravel& travel, double wheelbase,
                                     const WheelNoise& noise);

/// Where the uncertainty of an arc comes from. Chong & Kleeman's wheels give along = c2/4,
/// heading = c2/B^2, shared = d/(2B), with c2, d = k_R^2|R| +- k_L^2|L|; other sources add to it.
struct ArcNoise {
  double along = 0.0;    ///< variance of the path length, m^2
  double heading = 0.0;  ///< variance of the turn, rad^2
  double shared = 0.0;   ///< their covariance, m rad
  // Of wheels that move the body to the side as well:
  double lateral = 0.0;          ///< variance of the way to the left, m^2
  double along_lateral = 0.0;    ///< its covariance with the path length, m^2
  double heading_lateral = 0.0;  ///< and with the turn, m rad
};

/// ArcNoise of the two wheels.
[[nodiscard]] ArcNoise wheel_arc_noise(const WheelTravel& travel, double wheelbase,
                                       const WheelNoise& noise);

/// Covariance in the axes of the arc's start, of an arc of signed length `path` (m) that turns by
/// `turn` (rad), when the noise arises evenly along it.
[[nodiscard]] Matrix3 arc_covariance(double path, double turn, const ArcNoise& noise);

/// The same of a body that moves to the side as well, as on omnidirectional wheels: `way` (m) ahead
/// and to the left, in the body's own axes, evenly as it turns.
[[nodiscard]] Matrix3 slanting_covariance(const Vector2& way, double turn, const ArcNoise& noise);
/// Its displacement, exact.
[[nodiscard]] Pose slanting_displacement(const Vector2& way, double turn);

/// Displacement and covariance of one arc.
[[nodiscard]] Motion arc_motion(const WheelTravel& travel, double wheelbase,
                                const WheelNoise& noise);

/// First one motion, then another that starts where it ends: P = F P1 F' + T P2 T' (eq. 2, with
/// the exact Jacobian F of the pose). The two are taken as independent.
[[nodiscard]] Motion then(const Motion& first, const Motion& second);

/// A landmark as seen from the robot.
struct LandmarkOffset {
  Vector2 offset_robot = Vector2::Zero();      ///< m, robot frame: x ahead, y to the left
  Matrix2 covariance_robot = Matrix2::Zero();  ///< m^2
};

/// At a range (m) and a bearing (rad, counter-clockwise from ahead), with their standard
/// deviations. Throws std::invalid_argument unless all are finite, the range and `sd_range` above 0
/// and `sd_bearing` not below.
[[nodiscard]] LandmarkOffset seen_at(double range, double bearing, double sd_range,
                                     double sd_bearing);

}  // namespace trussmap
