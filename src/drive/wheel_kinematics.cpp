// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/wheel_kinematics.hpp"

#include "drive/body_motion.hpp"
#include "drive/steered_motion.hpp"
#include "text/named_values.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/Dense>

namespace trussmap {
namespace {

constexpr text::NamedValues<DriveKind, 8> kDriveNames{{
    {DriveKind::differential, "differential"},
    {DriveKind::unicycle, "unicycle"},
    {DriveKind::skid_steer, "skid-steer"},
    {DriveKind::tricycle, "tricycle"},
    {DriveKind::ackermann, "ackermann"},
    {DriveKind::omni3, "omni3"},
    {DriveKind::mecanum, "mecanum"},
    {DriveKind::wheels, "wheels"},
}};

[[noreturn]] void refuse_drive(const Observations& recording, const std::string& what) {
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
  refuse_drive(recording, "has no column \"" + name + "\", which the model's [robot] names" +
                              (there.empty() ? "" : ", expected one of " + there));
}

/// Of a column that the robot names.
std::vector<double> reading_of(const Recording& recording, const std::string& name) {
  const std::vector<double>& reading = column_named(recording, name);
  const std::vector<double>& t = recording.drive.t;
  if (reading.size() != t.size()) {
    throw std::invalid_argument(text::joined("recording \"", recording.name, "\": column ", name,
                                             " of the drive has ", reading.size(),
                                             " rows, expected ", t.size(), " as t has"));
  }
  for (std::size_t row = 0; row < reading.size(); ++row) {
    if (drive::is_possible_reading(reading[row])) continue;
    refuse_drive(recording, text::joined("column ", name, " is ", text::short_text(reading[row]),
                                         " at t = ", text::short_text(t[row]),
                                         " s, expected a travel in metres or an angle in radians"));
  }
  return reading;
}

[[noreturn]] void refuse_without_wheels(const Recording& recording) {
  std::string there;
  for (const Covariate& one : recording.drive.covariates) {
    there += (there.empty() ? "" : ", ") + one.name;
  }
  refuse_drive(
      recording,
      "has no columns left and right, expected them, or a model whose [robot] says which drive " +
          there + " are of");
}

void take_body(MotionRows& drive, std::size_t row, const Eigen::Vector3d& motion) {
  drive.forward[row] = motion[0];
  drive.turn[row] = motion[2];
  if (!drive.sideways.empty()) drive.sideways[row] = motion[1];
}

/// The turn of a unicycle that shows none: its gyro's, which is no further sensor then.
std::vector<double> turn_of_gyro(const Observations& recording, MotionRows& drive) {
  if (!drive.has_gyro()) {
    refuse_drive(recording,
                 "has no column yaw_rate, expected one: drive unicycle has one column, the travel");
  }
  std::vector<double> turn;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    turn.push_back(drive.yaw_rate[row] * drive.duration(row));
    if (std::isfinite(turn.back())) continue;
    refuse_drive(recording,
                 text::joined("has no yaw_rate at t = ", text::short_text(drive.t[row]),
                              " s, expected one in every row: it is how the robot turns"));
  }
  drive.yaw_rate.clear();
  return turn;
}

void take_unicycle(std::vector<WheelColumn>& columns, const Robot& robot, DrivenRecording& taken) {
  MotionRows& drive = taken.drive;
  drive.unicycle = robot.columns;
  if (columns.size() == 1) drive.unicycle.emplace_back("yaw_rate");
  drive.turn = columns.size() > 1 ? std::move(columns[1].reading) : turn_of_gyro(taken, drive);
  drive.forward = std::move(columns.front().reading);
}

void take_pair(WheelPair pair, const Robot& robot, MotionRows& drive) {
  if (!(robot.wheelbase > 0.0)) throw std::invalid_argument("the wheelbase must be above 0 m");
  drive.pair = std::move(pair);
  const std::size_t rows = std::min(drive.pair.left.size(), drive.pair.right.size());
  for (std::size_t row = 0; row < rows; ++row) {
    const BodyMotion motion = drive::body_motion(drive.pair.at(row), robot.wheelbase);
    drive.forward.push_back(motion.forward);
    drive.turn.push_back(motion.turn);
  }
}

std::size_t columns_of(const Robot& robot) {
  switch (robot.drive) {
    case DriveKind::tricycle:
    case DriveKind::ackermann:
      return 2;
    case DriveKind::omni3:
      return 3;
    case DriveKind::mecanum:
      return 4;
    case DriveKind::wheels:
      return static_cast<std::size_t>(robot.matrix.cols());
    default:
      return robot.columns.size();
  }
}

void require_geometry(const Robot& robot) {
  const std::size_t columns = columns_of(robot);
  const std::string drive = "drive " + std::string(name_of(robot.drive));
  const bool halves = robot.drive != DriveKind::skid_steer || columns % 2 == 0;
  if (columns == 0 || robot.columns.size() != columns || !halves) {
    throw std::invalid_argument(
        text::joined(drive, " has ", robot.columns.size(), " columns, expected ",
                     halves && columns > 0 ? text::joined(columns) : "an even number"));
  }
  if (!(robot.wheelbase > 0.0)) throw std::invalid_argument("the wheelbase must be above 0 m");
  const bool long_one = robot.drive != DriveKind::skid_steer && robot.drive != DriveKind::wheels;
  if (long_one && !(robot.length > 0.0)) {
    throw std::invalid_argument(drive + " has a length of " + text::short_text(robot.length) +
                                " m, expected more than 0");
  }
  if (robot.drive == DriveKind::wheels && robot.matrix.rows() != 3) {
    throw std::invalid_argument(drive + " has a matrix that has not three rows");
  }
}

}  // namespace

std::string_view name_of(DriveKind drive) {
  return text::name_in(kDriveNames, drive);
}

DriveKind drive_named(std::string_view name) {
  return text::value_named(kDriveNames, "drive", name);
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

DrivenRecording with_wheels(Recording recording, const Robot& robot) {
  const Drive& read = recording.drive;
  std::vector<WheelColumn> wheels;
  for (const std::string& name : robot.columns) {
    wheels.push_back({name, false, reading_of(recording, name), {}});
  }
  if (wheels.empty() && read.left.empty() && read.rows() > 0) refuse_without_wheels(recording);
  const bool named = !wheels.empty();
  DrivenRecording result{std::move(static_cast<Observations&>(recording)), {}};
  MotionRows& drive = result.drive;
  static_cast<DriveColumns&>(drive) = std::move(static_cast<DriveColumns&>(recording.drive));
  if (robot.drive == DriveKind::differential || !named) {
    take_pair(named ? WheelPair{std::move(wheels[0].reading), std::move(wheels[1].reading)}
                    : WheelPair{std::move(recording.drive.left), std::move(recording.drive.right)},
              robot, drive);
    return result;
  }
  if (robot.drive == DriveKind::unicycle) {
    take_unicycle(wheels, robot, result);
    return result;
  }
  const drive::WheelKinematics kinematics(robot);
  kinematics.prepare(drive, drive.rows());
  for (std::size_t k = 0; k < wheels.size(); ++k) {
    drive.wheels[k].reading = std::move(wheels[k].reading);
  }
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    if (kinematics.move(drive, row)) continue;
    refuse_drive(
        result, text::joined("a steering angle of ", text::short_text(drive.wheels[1].reading[row]),
                             " rad at t = ", text::short_text(drive.t[row]),
                             " s leaves the measured wheel no way ahead, expected a smaller one"));
  }
  return result;
}

std::vector<DrivenRecording> with_wheels(std::vector<Recording> recordings, const Robot& robot) {
  std::vector<DrivenRecording> result;
  result.reserve(recordings.size());
  for (Recording& one : recordings) result.push_back(with_wheels(std::move(one), robot));
  return result;
}

}  // namespace trussmap

namespace trussmap::drive {

bool is_own_column(const Robot& robot, const std::string& name) {
  return std::find(robot.columns.begin(), robot.columns.end(), name) != robot.columns.end();
}

bool is_possible_reading(double reading) {
  constexpr double kLargest = 1e6;  // m, rad: beyond all that a row may hold
  return std::abs(reading) <= kLargest;
}

WheelKinematics::WheelKinematics(const Robot& robot) : robot_(robot), steers_(has_steering(robot)) {
  require_geometry(robot_);
  if (!steers_) matrix_ = matrix_of(robot_);
}

void WheelKinematics::prepare(MotionRows& drive, std::size_t rows) const {
  drive.forward.assign(rows, 0.0);
  drive.turn.assign(rows, 0.0);
  drive.sideways.assign(!steers_ && !matrix_.row(1).isZero(0.0) ? rows : 0, 0.0);
  drive.wheels.clear();
  for (const std::string& name : robot_.columns) {
    const bool steers = steers_ && !drive.wheels.empty();
    drive.wheels.push_back({name, steers, std::vector<double>(rows, 0.0),
                            std::vector<std::array<double, 3>>(rows),
                            std::vector<double>(steers ? rows : 0, 1.0)});
  }
}

bool WheelKinematics::move(MotionRows& drive, std::size_t row, const SteeringChange& change) const {
  if (!steers_) {
    Eigen::Vector3d motion = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < drive.wheels.size(); ++k) {
      const Eigen::Vector3d by = matrix_.col(static_cast<Eigen::Index>(k));
      drive.wheels[k].by_reading[row] = {by[0], by[1], by[2]};
      motion += drive.wheels[k].reading[row] * by;
    }
    take_body(drive, row, motion);
    return true;
  }
  const SteeredMotion body =
      steered_motion(robot_, drive.wheels[0].reading[row], drive.wheels[1].reading[row], change);
  if (!body.possible) return false;
  take_body(drive, row, body.motion);
  drive.wheels[1].gain[row] = 1.0 + change.gain;
  for (std::size_t k = 0; k < 2; ++k) {
    const Eigen::Vector3d& by = body.by_reading[k];
    drive.wheels[k].by_reading[row] = {by[0], by[1], by[2]};
  }
  return true;
}

}  // namespace trussmap::drive
