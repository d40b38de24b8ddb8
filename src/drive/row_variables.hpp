// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a shape may speak of: the state of the drive in every row.
//
//   speed, turn_rate, acceleration   m/s (signed), rad/s, m/s^2
//   curvature                        turned per way while driving, signed; 0 otherwise    1/m
//   arc_angle, spin_angle            turned in the row while driving, on the spot; not signed rad
//   heading, x, y                    of an estimated path, at the row's middle    rad, m
//   t, distance                      since the recording's start, at the middle   s, m
//   session                          0, 1, ...
//   starts, spins                    1 in the first row of a drive after standing or spinning, of a
//                                    turn on the spot
//   reverses_left, reverses_right    1 in the row in which that wheel goes over to the other sense
//   any covariate column             under its own name
//
// All but the pose are those of the drive as it was read, whatever steering effects were taken in.
// Rates are smoothed over about a second, never across a change between driving, turning on the
// spot and standing: single rows carry the same encoder noise as the residuals that they are to
// explain.
#pragma once

#include "recording/variable_names.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/robot.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace trussmap::drive {

/// A wheel that travels less in a row is taken as standing, m: its sense tells nothing.
inline constexpr double kMoving = 1e-6;
/// Rates are means over so much time about a row, s; over half of it where the kind of motion
/// changes.
inline constexpr double kRateWindow = 1.0;

enum class MotionKind { standing, spinning, driving };

/// By a row's travels (own_travel), duration (s) and way to the left (m).
[[nodiscard]] MotionKind motion_kind(const WheelTravel& travel, double duration,
                                     double sideways = 0.0);
/// Kind of motion of each row.
[[nodiscard]] std::vector<MotionKind> motion_kinds(const MotionRows& drive, const Robot& robot);

/// `path`: pose at the end of each row, from `start`. Throws std::invalid_argument where its length
/// is not the drive's.
[[nodiscard]] RowVariables row_variables(const MotionRows& drive, const Robot& robot,
                                         const Pose& start, const std::vector<Pose>& path,
                                         int session);

/// The same at any instants, in any order, with the pose there: what a compass reading at the end
/// of its row, or a sighting, is made at. Rates are the mean of those of the two rows that meet at
/// a row's end, within one kind of motion; events and covariates are those of the row.
[[nodiscard]] RowVariables instant_variables(const MotionRows& drive, const Robot& robot,
                                             const std::vector<double>& instants,
                                             const std::vector<Pose>& poses, int session);

/// The row that contains time t; the last one that does where two meet.
[[nodiscard]] std::size_t row_at(const MotionRows& drive, double t);

}  // namespace trussmap::drive
