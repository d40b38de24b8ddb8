// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A drive of stretches of constant speed and turn rate, its exact poses, and what wheels of other
// diameters on another wheelbase would record of it. Computed from the floor up, without a line of
// the library's effects.
#pragma once

#include "trussmap/recording.hpp"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace trussmap::testing {

struct Stretch {
  double seconds = 1.0;
  double speed = 0.0;      ///< m/s
  double turn_rate = 0.0;  ///< rad/s
};

struct DrawnRobot {
  double nominal_wheelbase = 0.34;  ///< m
  double E_d = 1.0;
  double E_b = 1.0;
  double E_s = 1.0;
  double k_left = 0.0;            ///< m^(1/2)
  double k_right = 0.0;           ///< m^(1/2)
  double truth_sd = 0.0;          ///< m
  double truth_heading_sd = 0.0;  ///< rad
  double ahead = 0.0;             ///< m, the point that truth tracks
  double left = 0.0;              ///< m
  double heading = 0.0;           ///< rad, truth's less the robot's
  double late = 0.0;              ///< s
  double clock = 0.0;             ///< s/s
};

struct DrawnPose {
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;
};

/// `pose` after `dt` of an arc.
inline DrawnPose after(DrawnPose pose, const Stretch& stretch, double dt) {
  const double turn = stretch.turn_rate * dt;
  const double way = stretch.speed * dt;
  // Chord of the arc; the series keeps straight lines finite.
  const double chord = std::abs(turn) < 1e-9 ? way : way * std::sin(0.5 * turn) / (0.5 * turn);
  pose.x += chord * std::cos(pose.heading + 0.5 * turn);
  pose.y += chord * std::sin(pose.heading + 0.5 * turn);
  pose.heading += turn;
  return pose;
}

/// Where the drive is at time t; at rest before and after.
inline DrawnPose pose_at(const std::vector<Stretch>& training_segments, double t) {
  DrawnPose pose;
  for (const Stretch& one : training_segments) {
    if (t <= 0.0) break;
    pose = after(pose, one, std::fmin(t, one.seconds));
    t -= one.seconds;
  }
  return pose;
}

/// Rows of 0.1 s with a truth row at the end of each. TrainingSegments must be multiples of it.
inline Recording draw(const std::vector<Stretch>& training_segments, const DrawnRobot& robot,
                      std::uint64_t seed = 1) {
  constexpr double kRow = 0.1;  // s
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.name = "drawn";
  // True travel over what is recorded: wheels in the ratio E_d whose mean is E_s.
  const double right_gain = robot.E_s * 2.0 * robot.E_d / (1.0 + robot.E_d);
  const double left_gain = robot.E_s * 2.0 / (1.0 + robot.E_d);
  const double wheelbase = robot.E_b * robot.nominal_wheelbase;
  double t = 0.0;
  for (const Stretch& one : training_segments) {
    const int rows = static_cast<int>(std::lround(one.seconds / kRow));
    for (int row = 0; row < rows; ++row) {
      t += kRow;
      const double right = kRow * (one.speed + 0.5 * wheelbase * one.turn_rate);
      const double left = kRow * (one.speed - 0.5 * wheelbase * one.turn_rate);
      recording.drive.t.push_back(t);
      recording.drive.right.push_back(right / right_gain +
                                      robot.k_right * std::sqrt(std::abs(right)) * normal(random));
      recording.drive.left.push_back(left / left_gain +
                                     robot.k_left * std::sqrt(std::abs(left)) * normal(random));
      const DrawnPose pose = pose_at(training_segments, t - robot.late - robot.clock * t);
      const double c = std::cos(pose.heading);
      const double s = std::sin(pose.heading);
      recording.truth.push_back(
          {t, pose.x + c * robot.ahead - s * robot.left + robot.truth_sd * normal(random),
           pose.y + s * robot.ahead + c * robot.left + robot.truth_sd * normal(random),
           std::remainder(pose.heading + robot.heading + robot.truth_heading_sd * normal(random),
                          2.0 * M_PI)});
    }
  }
  return recording;
}

/// Straight lines, turns on the spot and arcs, both ways, between two rests; 33 m.
inline std::vector<Stretch> figure() {
  std::vector<Stretch> result = {{1.0, 0.0, 0.0}};
  for (const double way : {1.0, -1.0, -1.0, 1.0, 1.0, -1.0}) {
    result.push_back({6.0, 0.5, 0.0});
    result.push_back({2.0, 0.0, way * 0.8});
    result.push_back({5.0, 0.5, -way * 0.6});
    result.push_back({1.0, 0.0, 0.0});
  }
  return result;
}

}  // namespace trussmap::testing
