// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A robot for rehearsing calibrations with a tape measure: it drives a path exactly by its own
// odometry, and ends where its true wheels and the noise have brought it.
//
//   in small steps: what a wheel truly travels = share x what its odometry counts
//                                                + k sqrt(|what its odometry counts|) x normal
//
// Each step is a rigid motion about the true centre of rotation. The tape adds its own error once
// per run.
#pragma once

#include "trussmap/planar.hpp"
#include "trussmap/test_path.hpp"

#include <random>
#include <vector>

namespace trussmap {

struct TapeRobot {
  double wheelbase_believed = 0.34;  ///< m, that its odometry takes for true
  double wheelbase = 0.34;           ///< m, true
  double left_share = 1.0;           ///< true travel of the left wheel per counted travel
  double right_share = 1.0;          ///< the same of the right wheel
  double left_noise = 0.0;           ///< k of the left wheel, m^(1/2)
  double right_noise = 0.0;          ///< k of the right wheel, m^(1/2)
  double step = 0.05;                ///< m: longest wheel travel per step, where there is noise
  double tape_sd = 0.0;              ///< m, per coordinate of a measured end position
  double tape_heading_sd = 0.0;      ///< rad, of a measured end heading
};

/// A robot of this nominal wheelbase (m) whose right wheel is `diameter_ratio` times as large as
/// its left (their mean as believed) and whose true wheelbase is `wheelbase_ratio` times as wide.
[[nodiscard]] TapeRobot misbuilt_robot(double wheelbase, double diameter_ratio,
                                       double wheelbase_ratio);

/// The robot once its software divides its counts by these shares and believes this wheelbase (m).
[[nodiscard]] TapeRobot reprogrammed(const TapeRobot& robot, double left_share, double right_share,
                                     double wheelbase_believed);

/// End error of one run, absolute - calculated, in the frame of the start; the heading is not
/// wrapped. Throws std::invalid_argument on a wheelbase or step that is not above 0.
[[nodiscard]] Pose drive_once(const TapeRobot& robot, const TestPath& path,
                              std::mt19937_64& random);

[[nodiscard]] std::vector<Pose> drive_often(const TapeRobot& robot, const TestPath& path, int runs,
                                            std::mt19937_64& random);

}  // namespace trussmap
