// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/channel_physics.hpp"
#include "effects/steering.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/Dense>

namespace trussmap {
namespace {

constexpr std::array<std::pair<DriveKind, std::string_view>, 7> kNames{{
    {DriveKind::differential, "differential"},
    {DriveKind::skid_steer, "skid-steer"},
    {DriveKind::tricycle, "tricycle"},
    {DriveKind::ackermann, "ackermann"},
    {DriveKind::omni3, "omni3"},
    {DriveKind::mecanum, "mecanum"},
    {DriveKind::wheels, "wheels"},
}};

[[noreturn]] void refuse(const Recording& recording, const std::string& what) {
  throw InputError(recording.name.empty() ? "drive.csv" : recording.name + "/drive.csv", 0, what);
}

/// 3 x columns, of the drives that have one.
Eigen::MatrixXd matrix_of(const Robot& robot) {
  const double root = std::sqrt(3.0);
  Eigen::MatrixXd M;
  switch (robot.drive) {
    case DriveKind::skid_steer: {
      const auto count = static_cast<Eigen::Index>(robot.columns.size());
      M = Eigen::MatrixXd::Zero(3, count);
      M.row(0).setConstant(1.0 / static_cast<double>(count));
      M.row(2).head(count / 2).setConstant(-2.0 / (robot.wheelbase * static_cast<double>(count)));
      M.row(2).tail(count / 2) = -M.row(2).head(count / 2);
      return M;
    }
    case DriveKind::omni3:
      M.resize(3, 3);
      M << -1.0 / root, 1.0 / root, 0.0,      //
          -1.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0,  //
          -1.0 / (3.0 * robot.length), -1.0 / (3.0 * robot.length), -1.0 / (3.0 * robot.length);
      return M;
    case DriveKind::mecanum: {
      const double lever = 2.0 * (robot.wheelbase + robot.length);
      M.resize(3, 4);
      M << 0.25, 0.25, 0.25, 0.25,   //
          -0.25, 0.25, 0.25, -0.25,  //
          -1.0 / lever, 1.0 / lever, -1.0 / lever, 1.0 / lever;
      return M;
    }
    default:
      return robot.matrix;
  }
}

const std::vector<double>& column_named(const Recording& recording, const std::string& name) {
  const Drive& drive = recording.drive;
  if (name == "left" && !drive.left.empty()) return drive.left;
  if (name == "right" && !drive.right.empty()) return drive.right;
  std::string there = drive.left.empty() ? "" : "left, right";
  for (const Covariate& one : drive.covariates) {
    if (one.name == name) return one.values;
    there += (there.empty() ? "" : ", ") + one.name;
  }
  refuse(recording, "has no column \"" + name + "\", which the model's [robot] names" +
                        (there.empty() ? "" : ", expected one of " + there));
}

void take_body(Drive& drive, std::size_t row, const Eigen::Vector3d& motion, double wheelbase) {
  drive.left[row] = motion[0] - 0.5 * wheelbase * motion[2];
  drive.right[row] = motion[0] + 0.5 * wheelbase * motion[2];
  if (!drive.sideways.empty()) drive.sideways[row] = motion[1];
}

void take_steered(const Recording& recording, const Robot& robot, Drive& drive) {
  const std::vector<double>& travel = drive.wheels[0].reading;
  const std::vector<double>& angle = drive.wheels[1].reading;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const SteeredMotion body = steered_motion(robot, travel[row], angle[row]);
    if (!body.possible) {
      refuse(recording,
             joined("a steering angle of ", short_text(angle[row]),
                    " rad at t = ", short_text(drive.t[row]),
                    " s leaves the measured wheel no way ahead, expected a smaller one"));
    }
    take_body(drive, row, body.motion, robot.wheelbase);
    for (std::size_t k = 0; k < 2; ++k) {
      const Eigen::Vector3d& by = body.by_reading[k];
      drive.wheels[k].by_reading.push_back({by[0], by[1], by[2]});
    }
  }
}

void take_matrix(const Eigen::MatrixXd& M, double wheelbase, Drive& drive) {
  if (!M.row(1).isZero(0.0)) drive.sideways.assign(drive.rows(), 0.0);
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    Eigen::Vector3d motion = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < drive.wheels.size(); ++k) {
      const Eigen::Vector3d by = M.col(static_cast<Eigen::Index>(k));
      drive.wheels[k].by_reading.push_back({by[0], by[1], by[2]});
      motion += drive.wheels[k].reading[row] * by;
    }
    take_body(drive, row, motion, wheelbase);
  }
}

}  // namespace

std::string_view name_of(DriveKind drive) {
  return std::find_if(kNames.begin(), kNames.end(),
                      [drive](const auto& one) { return one.first == drive; })
      ->second;
}

DriveKind drive_named(std::string_view name) {
  std::string all;
  for (const auto& [drive, known] : kNames) {
    if (known == name) return drive;
    all += (all.empty() ? "" : ", ") + std::string(known);
  }
  throw std::invalid_argument("drive \"" + std::string(name) + "\" is unknown, expected one of " +
                              all);
}

Eigen::MatrixXd wheel_matrix(const std::vector<WheelPlace>& places) {
  constexpr double kNothing = 1e-9;  // m per m, and m per rad
  // What a wheel shows of (f, s, a): the way of its place along its rollers' axes, over how much of
  // that is its own rolling.
  Eigen::MatrixXd shows(static_cast<Eigen::Index>(places.size()), 3);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const WheelPlace& one = places[k];
    const double axis = one.direction + one.roller;
    const double c = std::cos(axis) / std::cos(one.roller);
    const double s = std::sin(axis) / std::cos(one.roller);
    shows.row(static_cast<Eigen::Index>(k)) << c, s, one.x * s - one.y * c;
  }
  const bool to_the_side = shows.col(1).cwiseAbs().maxCoeff() > kNothing;
  Eigen::MatrixXd unknown(shows.rows(), to_the_side ? 3 : 2);
  if (to_the_side) {
    unknown = shows;
  } else {
    unknown << shows.col(0), shows.col(2);
  }
  // Turn in the unit of the drive's size, so that the rank has one.
  const double size = std::max(unknown.rightCols<1>().cwiseAbs().maxCoeff(), kNothing);
  unknown.rightCols<1>() /= size;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(unknown);
  qr.setThreshold(1e-6);
  if (qr.rank() < unknown.cols()) {
    throw std::invalid_argument(
        to_the_side ? "the wheels do not tell forward, sideways and turn apart, expected at least "
                      "three that roll in different directions or past different places"
                    : "the wheels do not tell forward and turn apart, expected two at least that "
                      "roll side by side");
  }
  Eigen::MatrixXd inverse = qr.solve(Eigen::MatrixXd::Identity(shows.rows(), shows.rows()));
  inverse.bottomRows<1>() /= size;
  if (to_the_side) return inverse;
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(3, shows.rows());
  M.row(0) = inverse.row(0);
  M.row(2) = inverse.row(1);
  return M;
}

Recording with_wheels(Recording recording, const Robot& robot) {
  Drive& drive = recording.drive;
  if (!drive.wheels.empty()) return recording;
  if (robot.columns.empty()) {
    if (!drive.left.empty() || drive.rows() == 0) return recording;
    std::string there;
    for (const Covariate& one : drive.covariates) {
      there += (there.empty() ? "" : ", ") + one.name;
    }
    refuse(
        recording,
        "has no columns left and right, expected them, or a model whose [robot] says which drive " +
            there + " are of");
  }
  constexpr double kLargest = 1e6;  // m, rad: beyond all that a row may hold
  std::vector<WheelColumn> wheels;
  for (const std::string& name : robot.columns) {
    wheels.push_back({name, false, column_named(recording, name), {}});
    const std::vector<double>& reading = wheels.back().reading;
    for (std::size_t row = 0; row < reading.size(); ++row) {
      if (std::abs(reading[row]) <= kLargest) continue;
      refuse(recording, joined("column ", name, " is ", short_text(reading[row]),
                               " at t = ", short_text(drive.t[row]),
                               " s, expected a travel in metres or an "
                               "angle in radians"));
    }
  }
  if (robot.drive == DriveKind::differential) {
    drive.left = wheels[0].reading;
    drive.right = wheels[1].reading;
    return recording;
  }
  drive.wheels = std::move(wheels);
  drive.left.assign(drive.rows(), 0.0);
  drive.right.assign(drive.rows(), 0.0);
  if (is_of_drive(Channel::steer, robot)) {
    drive.wheels[1].steers = true;
    take_steered(recording, robot, drive);
  } else {
    take_matrix(matrix_of(robot), robot.wheelbase, drive);
  }
  return recording;
}

}  // namespace trussmap
