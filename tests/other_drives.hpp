// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Drives with other wheels than two, driven along a known path: what each wheel then shows, by the
// way of its contact point in a rigid body, with effects and noise.
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/planar.hpp"

#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace trussmap::testing {

/// Of a row.
struct Twist {
  double f = 0.0;  ///< m ahead
  double s = 0.0;  ///< m to the left
  double a = 0.0;  ///< rad
};

/// What each column shows of a row.
using Wheels = std::function<std::vector<double>(const Twist&)>;

struct OtherDrive {
  Model model;
  std::vector<Twist> rows;
  Wheels wheels;
  std::vector<Channel> constants;  ///< what can be wrong with it
  bool steers = false;             ///< the second column is an angle
};

inline constexpr double kOtherRow = 0.1;  ///< s

/// 60 s of bends both ways and, where it can, ways to the side.
inline std::vector<Twist> driven(bool to_the_side) {
  std::vector<Twist> rows;
  for (int k = 0; k < 600; ++k) {
    const double t = kOtherRow * k;
    rows.push_back({0.03 + 0.01 * std::sin(0.31 * t),
                    to_the_side ? 0.02 * std::sin(0.17 * t + 1.0) : 0.0,
                    0.025 * std::sin(0.23 * t) + 0.01 * std::cos(0.71 * t)});
  }
  return rows;
}

/// Along the direction at a place of the body.
inline double way_along(const Twist& row, double x, double y, double direction) {
  return (row.f - row.a * y) * std::cos(direction) + (row.s + row.a * x) * std::sin(direction);
}

inline OtherDrive other_drive(DriveKind kind) {
  OtherDrive drive;
  Robot& robot = drive.model.robot;
  robot.drive = kind;
  robot.length = 0.6;
  robot.wheelbase = 0.5;
  drive.steers = kind == DriveKind::tricycle || kind == DriveKind::ackermann;
  drive.rows = driven(!drive.steers && kind != DriveKind::skid_steer);
  drive.constants = {Channel::turn};
  switch (kind) {
    case DriveKind::unicycle:
      robot.columns = {"travel", "turn"};
      drive.rows = driven(false);
      drive.constants = {Channel::turn, Channel::travel, Channel::wheels};
      drive.wheels = [](const Twist& row) { return std::vector<double>{row.f, row.a}; };
      return drive;
    case DriveKind::skid_steer:
      robot.columns = {"fl", "rl", "fr", "rr"};
      drive.constants.push_back(Channel::wheels);
      drive.wheels = [](const Twist& row) {
        const double left = way_along(row, 0.0, 0.25, 0.0);
        const double right = way_along(row, 0.0, -0.25, 0.0);
        return std::vector<double>{left, left, right, right};
      };
      return drive;
    case DriveKind::tricycle:
      robot.columns = {"wheel", "steer"};
      drive.constants = {Channel::turn, Channel::wheels, Channel::steer};
      drive.wheels = [](const Twist& row) {
        return std::vector<double>{std::hypot(row.f, 0.6 * row.a), std::atan2(0.6 * row.a, row.f)};
      };
      return drive;
    case DriveKind::ackermann:
      robot.wheel_left = 0.2;
      robot.columns = {"wheel", "steer"};
      drive.constants = {Channel::turn, Channel::wheels};
      drive.wheels = [](const Twist& row) {
        return std::vector<double>{way_along(row, 0.0, 0.2, 0.0), std::atan(0.6 * row.a / row.f)};
      };
      return drive;
    case DriveKind::omni3:
      robot.length = 0.2;
      robot.columns = {"wheel1", "wheel2", "wheel3"};
      drive.constants = {Channel::wheel1, Channel::wheel2, Channel::wheel3, Channel::turn};
      drive.wheels = [](const Twist& row) {
        std::vector<double> shown;
        for (const double at : {-M_PI / 3.0, M_PI / 3.0, M_PI}) {
          shown.push_back(way_along(row, 0.2 * std::cos(at), 0.2 * std::sin(at), at - M_PI / 2.0));
        }
        return shown;
      };
      return drive;
    case DriveKind::mecanum:
      robot.columns = {"fl", "fr", "rl", "rr"};
      drive.constants = {Channel::sideways, Channel::turn, Channel::travel};
      drive.wheels = [](const Twist& row) {
        const double root = std::sqrt(0.5);
        return std::vector<double>{way_along(row, 0.3, 0.25, -M_PI / 4.0) / root,
                                   way_along(row, 0.3, -0.25, M_PI / 4.0) / root,
                                   way_along(row, -0.3, 0.25, M_PI / 4.0) / root,
                                   way_along(row, -0.3, -0.25, -M_PI / 4.0) / root};
      };
      return drive;
    default:
      // Two tracking wheels ahead and one across.
      robot.columns = {"left", "right", "across"};
      robot.places = {{0.0, 0.2, 0.0, 0.0}, {0.0, -0.2, 0.0, 0.0}, {-0.15, 0.0, M_PI / 2.0, 0.0}};
      robot.matrix = wheel_matrix(robot.places);
      drive.constants = {Channel::wheel1, Channel::wheel2, Channel::wheel3};
      drive.wheels = [](const Twist& row) {
        return std::vector<double>{way_along(row, 0.0, 0.2, 0.0), way_along(row, 0.0, -0.2, 0.0),
                                   way_along(row, -0.15, 0.0, M_PI / 2.0)};
      };
      return drive;
  }
}

inline Pose after(const Pose& pose, const Twist& row) {
  const double half = 0.5 * row.a;
  const double chord = std::abs(half) < 1e-12 ? 1.0 : std::sin(half) / half;
  const Vector2 step = chord * (rotation(pose.heading + half) * Vector2(row.f, row.s));
  return {pose.x + step.x(), pose.y + step.y(), pose.heading + row.a};
}

/// The columns as a folder would have them, and the truth once a second.
inline Recording recorded(const OtherDrive& drive, const Wheels& wheels) {
  const std::vector<std::string>& columns = drive.model.robot.columns;
  Recording recording;
  recording.name = "other drive";
  for (const std::string& name : columns) recording.drive.covariates.push_back({name, {}});
  Pose pose;
  recording.truth.push_back({0.0, 0.0, 0.0, 0.0});
  for (std::size_t k = 0; k < drive.rows.size(); ++k) {
    const double t = kOtherRow * static_cast<double>(k + 1);
    recording.drive.t.push_back(t);
    const std::vector<double> shown = wheels(drive.rows[k]);
    for (std::size_t n = 0; n < columns.size(); ++n) {
      recording.drive.covariates[n].values.push_back(shown[n]);
    }
    pose = after(pose, drive.rows[k]);
    if (k % 10 == 9) recording.truth.push_back({t, pose.x, pose.y, wrap_angle(pose.heading)});
  }
  return recording;
}

/// The effect's g makes the columns show less than they would.
inline Wheels with_effect(const OtherDrive& drive, Channel channel, double g) {
  return [wheels = drive.wheels, steers = drive.steers, channel, g](Twist row) {
    if (channel == Channel::sideways) row.s /= 1.0 + g;
    if (channel == Channel::travel) row.f /= 1.0 + g;
    if (channel == Channel::turn) row.a /= 1.0 + g;
    std::vector<double> shown = wheels(row);
    if (const std::optional<std::size_t> n = wheel_of(channel)) shown[*n] /= 1.0 + g;
    if (channel == Channel::wheels) {
      for (std::size_t n = 0; n < (steers ? 1 : shown.size()); ++n) shown[n] /= 1.0 + g;
    }
    // A wheel that stands further left than it says.
    if (channel == Channel::steer) shown[1] -= g;
    if (channel == Channel::steer_gain) shown[1] /= 1.0 + g;
    return shown;
  };
}

/// With the noise that the model states: of each wheel, and of the steering.
inline Wheels noisy(const OtherDrive& drive, const Wheels& wheels, std::mt19937_64& random) {
  const trussmap::Noise& noise = drive.model.noise;
  const double k = std::sqrt(0.5 * (noise.left * noise.left + noise.right * noise.right));
  if (drive.model.robot.drive == DriveKind::unicycle) {  // two wheels err, and show it together
    return [wheels, k, b = drive.model.robot.wheelbase, &random](const Twist& row) {
      std::normal_distribution<double> normal;
      const std::vector<double> shown = wheels(row);
      const double apart = 0.5 * b * shown[1];
      const double left = k * std::sqrt(std::abs(shown[0] - apart)) * normal(random);
      const double right = k * std::sqrt(std::abs(shown[0] + apart)) * normal(random);
      return std::vector<double>{shown[0] + 0.5 * (left + right), shown[1] + (right - left) / b};
    };
  }
  return [wheels, k, steer = noise.steer, steers = drive.steers, &random](const Twist& row) {
    std::normal_distribution<double> normal;
    std::vector<double> shown = wheels(row);
    const double way = std::abs(shown[0]);
    for (std::size_t n = 0; n < shown.size(); ++n) {
      const double sd =
          steers && n == 1 ? steer / std::sqrt(way) : k * std::sqrt(std::abs(shown[n]));
      shown[n] += sd * normal(random);
    }
    return shown;
  };
}

}  // namespace trussmap::testing
