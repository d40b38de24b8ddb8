// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trussmap {
namespace {

/// The position turned about the centre of rotation, which lies on the axle; a chord, so that it
/// also serves where the wheels run alike and the centre is infinitely far away.
void roll(Pose& pose, double left, double right, double wheelbase) {
  const double half_turn = (right - left) / (2.0 * wheelbase);
  const double arc = 0.5 * (left + right);
  const double chord = half_turn == 0.0 ? arc : arc * std::sin(half_turn) / half_turn;
  const double middle = pose.heading + half_turn;
  pose.x += chord * std::cos(middle);
  pose.y += chord * std::sin(middle);
  pose.heading += 2.0 * half_turn;
}

}  // namespace

TapeRobot misbuilt_robot(double wheelbase, double diameter_ratio, double wheelbase_ratio) {
  TapeRobot robot;
  robot.wheelbase_believed = wheelbase;
  robot.wheelbase = wheelbase * wheelbase_ratio;
  robot.left_share = 2.0 / (1.0 + diameter_ratio);
  robot.right_share = 2.0 - robot.left_share;
  return robot;
}

TapeRobot reprogrammed(const TapeRobot& robot, double left_share, double right_share,
                       double wheelbase_believed) {
  TapeRobot result = robot;
  result.left_share /= left_share;
  result.right_share /= right_share;
  result.wheelbase_believed = wheelbase_believed;
  return result;
}

Pose drive_once(const TapeRobot& robot, const TestPath& path, std::mt19937_64& random) {
  if (!(robot.wheelbase > 0.0 && robot.wheelbase_believed > 0.0 && robot.step > 0.0)) {
    throw std::invalid_argument("wheelbase and step of a robot must be above 0");
  }
  std::normal_distribution<double> normal;
  const bool noisy = robot.left_noise != 0.0 || robot.right_noise != 0.0;
  Pose believed;
  Pose actual;
  for (const PathSegment& segment : path) {
    const double difference = segment.turn * robot.wheelbase_believed;
    const double left = segment.distance - 0.5 * difference;
    const double right = segment.distance + 0.5 * difference;
    roll(believed, left, right, robot.wheelbase_believed);
    const double longest = std::max(std::abs(left), std::abs(right));
    const int steps = noisy ? std::max(1, static_cast<int>(std::ceil(longest / robot.step))) : 1;
    for (int k = 0; k < steps; ++k) {
      double true_left = robot.left_share * left / steps;
      double true_right = robot.right_share * right / steps;
      if (noisy) {
        true_left += robot.left_noise * std::sqrt(std::abs(left) / steps) * normal(random);
        true_right += robot.right_noise * std::sqrt(std::abs(right) / steps) * normal(random);
      }
      roll(actual, true_left, true_right, robot.wheelbase);
    }
  }
  const auto tape = [&](double sd) { return sd == 0.0 ? 0.0 : sd * normal(random); };
  const double tape_x = tape(robot.tape_sd);
  const double tape_y = tape(robot.tape_sd);
  return {actual.x - believed.x + tape_x, actual.y - believed.y + tape_y,
          actual.heading - believed.heading + tape(robot.tape_heading_sd)};
}

std::vector<Pose> drive_often(const TapeRobot& robot, const TestPath& path, int runs,
                              std::mt19937_64& random) {
  std::vector<Pose> ends;
  ends.reserve(static_cast<std::size_t>(std::max(runs, 0)));
  for (int run = 0; run < runs; ++run) ends.push_back(drive_once(robot, path, random));
  return ends;
}

}  // namespace trussmap
