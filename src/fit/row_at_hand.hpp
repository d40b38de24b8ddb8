// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One row at hand: what wheels and gyro say of it, as it is read, steered and cleared of effects.
#pragma once

#include "drive/body_motion.hpp"
#include "drive/causal_variables.hpp"
#include "drive/row_motion.hpp"
#include "drive/wheel_kinematics.hpp"
#include "effects/channel_physics.hpp"
#include "odometry/row_reckoner.hpp"
#include "odometry/wheels_and_gyro.hpp"
#include "text/number_text.hpp"
#include "trussmap/corrected_odometry.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace trussmap::fitting {

[[noreturn]] inline void refuse_row(const std::string& why) {
  throw std::invalid_argument(why);
}

/// Where travel is a unicycle's one column, the gyro says how it turns, and is no further sensor.
inline bool turns_by_gyro(const Robot& robot) {
  return robot.drive == DriveKind::unicycle && robot.columns.size() == 1;
}

/// What wheels and gyro say of one row.
class RowAtHand {
 public:
  RowAtHand(Robot robot, const Noise& noise, bool gyro)
      : robot_(std::move(robot)), noise_(noise), gyro_(gyro) {
    if (!(robot_.wheelbase > 0.0)) refuse_row("the wheelbase must be above 0 m");
    if (robot_.drive == DriveKind::unicycle && (columns() < 1 || columns() > 2)) {
      refuse_row(text::joined("drive unicycle has ", columns(), " columns, expected 1 or 2"));
    }
    drive_.forward = drive_.turn = {0.0};
    if (robot_.drive == DriveKind::differential) drive_.pair = {{0.0}, {0.0}};
    if (robot_.drive == DriveKind::differential || robot_.drive == DriveKind::unicycle) return;
    kinematics_.emplace(robot_);
    kinematics_->prepare(drive_, 1);
  }

  void check(const WheelRow& row) const {
    if (!std::isfinite(row.duration) || row.duration <= 0.0) {
      refuse_row("a row lasts " + text::short_text(row.duration) + " s, expected more than 0");
    }
    if (!std::isfinite(row.left) || !std::isfinite(row.right)) {
      refuse_row("a row's travel is not finite");
    }
    if (row.readings.size() != columns()) {
      refuse_row(text::joined("a row has readings of ", row.readings.size(), " wheels, expected ",
                              expected_readings()));
    }
    if (columns() > 0 && (row.left != 0.0 || row.right != 0.0)) {
      refuse_row("a row has travels left and right, expected readings of " + expected_readings());
    }
    if (turns_by_gyro(robot_) && std::isnan(row.yaw_rate)) {
      refuse_row("a row has no yaw rate, expected one: it is how the robot turns");
    }
    for (std::size_t k = 0; k < row.readings.size(); ++k) {
      if (drive::is_possible_reading(row.readings[k])) continue;
      refuse_row(text::joined("column ", robot_.columns[k], " reads ",
                              text::short_text(row.readings[k]),
                              ", expected a travel in metres or an angle in radians"));
    }
  }

  /// The row as it is read, what the gyro adds to it.
  GyroShare take(const WheelRow& row) {
    if (!kinematics_) {
      if (!drive_.pair.empty()) {
        drive_.pair.left.front() = row.left;
        drive_.pair.right.front() = row.right;
      }
      set(columns() > 0 ? unicycle_motion(row)
                        : drive::body_motion({row.left, row.right}, robot_.wheelbase));
      return share_of(row);
    }
    for (std::size_t k = 0; k < row.readings.size(); ++k) {
      drive_.wheels[k].reading.front() = row.readings[k];
    }
    if (!kinematics_->move(drive_, 0)) {
      refuse_row("a steering angle of " + text::short_text(row.readings.back()) +
                 " rad leaves the measured wheel no way ahead, expected a smaller one");
    }
    return share_of(row);
  }

  /// The same, steered as effects have it.
  GyroShare steer(const WheelRow& row, const drive::SteeringChange& more) {
    if (kinematics_ && !kinematics_->move(drive_, 0, more)) {
      refuse_row(
          "a steering angle of " + text::short_text(row.readings.back() + more.angle) +
          " rad, which the model's steering effects lead to, leaves the measured wheel no way "
          "ahead, expected a smaller one");
    }
    return share_of(row);
  }

  /// As wheels and gyro together say.
  odometry::ReckonedRow recorded(const WheelRow& row, const GyroShare& gyro) {
    odometry::ReckonedRow result{odometry::together(gyro), row.duration, 0.0, row.compass};
    result.noise = noise_of(result, gyro);
    return result;
  }

  /// The row less what is added to it.
  odometry::ReckonedRow cleared(const odometry::ReckonedRow& row, const GyroShare& gyro,
                                const effects::DrivePattern& more) {
    odometry::ReckonedRow clear = row;
    clear.motion = row.motion + BodyMotion{more.advance, 0.0, more.turn};
    clear.slip = more.slip;
    clear.noise = noise_of(clear, gyro);
    return clear;
  }

  /// As shapes of the kind of motion see the row that was taken.
  [[nodiscard]] drive::WheelWay wheels(const GyroShare& gyro) const {
    return {drive_.pair.empty() ? drive::wheel_travel(gyro.wheels, robot_) : drive_.pair.at(0),
            gyro.wheels.sideways};
  }

  /// As channels see it.
  [[nodiscard]] drive::RowMotion shown(const odometry::ReckonedRow& row,
                                       const GyroShare& gyro) const {
    drive::RowMotion shown = drive::row_motion(gyro, row.duration, robot_);
    if (kinematics_) shown.wheels = &drive_.wheels;
    return shown;
  }

  [[nodiscard]] Motion motion(const odometry::ReckonedRow& row) const {
    return {odometry::displacement_of(row.whole()), odometry::covariance_of(row, robot_, noise_)};
  }

  [[nodiscard]] const Robot& robot() const { return robot_; }
  [[nodiscard]] const Noise& noise() const { return noise_; }

 private:
  /// Of two wheels none: they are left and right.
  [[nodiscard]] std::size_t columns() const {
    return robot_.drive == DriveKind::differential ? 0 : robot_.columns.size();
  }

  [[nodiscard]] BodyMotion unicycle_motion(const WheelRow& row) const {
    const double turn = turns_by_gyro(robot_) ? row.yaw_rate * row.duration : row.readings[1];
    return {row.readings[0], 0.0, turn};
  }

  void set(const BodyMotion& motion) {
    drive_.forward.front() = motion.forward;
    drive_.turn.front() = motion.turn;
  }

  [[nodiscard]] GyroShare share_of(const WheelRow& row) {
    drive_.gyro.clear();
    const double beside = turns_by_gyro(robot_) ? kAbsent : row.yaw_rate;
    return odometry::gyro_share(drive_, 0, beside, row.duration, robot_, noise_);
  }

  /// Nothing of two wheels without a gyro: then that of the wheels.
  [[nodiscard]] std::optional<ArcNoise> noise_of(const odometry::ReckonedRow& row,
                                                 const GyroShare& gyro) {
    if (!gyro_ && !kinematics_) return std::nullopt;
    set(row.motion);
    drive_.gyro.clear();
    if (gyro_) drive_.gyro.push_back(gyro);
    return odometry::row_noise(drive_, 0, 1.0, row.duration, robot_, noise_);
  }

  [[nodiscard]] std::string expected_readings() const {
    if (columns() == 0) return "none of two wheels, but left and right";
    std::string names;
    for (const std::string& one : robot_.columns) names += (names.empty() ? "" : ", ") + one;
    return names;
  }

  Robot robot_;
  Noise noise_;
  bool gyro_;
  std::optional<drive::WheelKinematics> kinematics_;  ///< of other wheels than two
  MotionRows drive_;                                  ///< of this row alone
};

}  // namespace trussmap::fitting
