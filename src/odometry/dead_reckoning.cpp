// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/dead_reckoning.hpp"

#include "drive/body_motion.hpp"
#include "odometry/merge.hpp"
#include "odometry/row_reckoner.hpp"
#include "odometry/wheels_and_gyro.hpp"
#include "recording/floor_code.hpp"

#include <cmath>
#include <optional>

namespace trussmap {
using namespace odometry;

namespace {

/// Nothing where two wheels' alone is meant.
std::optional<ArcNoise> noise_of_row(const MotionRows& drive, const DriveRow& row,
                                     const Robot& robot, const Noise& noise) {
  if (drive.gyro.empty() && drive.wheels.empty() && !drive.factors) return std::nullopt;
  return row_noise(drive, row.row, row.part, row.duration, robot, noise);
}

}  // namespace

ArcNoise arc_noise(const WheelTravel& travel, double duration, const Robot& robot,
                   const Noise& noise) {
  ArcNoise sources = wheel_arc_noise(travel, robot.wheelbase, WheelNoise{noise.left, noise.right});
  const ArcNoise laws =
      laws_noise(drive::body_motion(travel, robot.wheelbase).turn, duration, noise);
  sources.along += laws.along;
  sources.heading += laws.heading;
  return sources;
}

Matrix3 arc_covariance(const WheelTravel& travel, double duration, const Robot& robot,
                       const Noise& noise) {
  const BodyMotion motion = drive::body_motion(travel, robot.wheelbase);
  return arc_covariance(motion.forward, motion.turn, arc_noise(travel, duration, robot, noise));
}

LandmarkOffset landmark_offset(const Sighting& sighting, const Noise& noise) {
  if (sighting.standing()) {
    return {recording::code_from_robot(sighting),
            noise.sighting * noise.sighting * Matrix2::Identity()};
  }
  const Matrix2 R = rotation(sighting.bearing);
  const double along =
      noise.range * noise.range + std::pow(noise.range_relative * sighting.range, 2);
  const double across = std::pow(noise.bearing * sighting.range, 2);
  return {sighting.range * R.col(0), R * Vector2(along, across).asDiagonal() * R.transpose()};
}

InitialHeading initial_heading(const MotionRows& drive, double t, const Robot& robot,
                               const Noise& noise) {
  double turn = 0.0;
  double variance = 0.0;
  for (const DriveRow& row : rows_between(drive, t, drive.t.back())) {
    if (!drive.has_compass()) break;
    turn += motion_of(drive, row).turn;
    variance += row_covariance(drive, row.row, row.part, row.duration, robot, noise)(2, 2);
    const double reading = drive.heading[row.row];
    if (!std::isnan(reading)) {
      return {{wrap_angle(reading - turn), reading_variance(noise) + variance}, drive.t[row.row]};
    }
  }
  return {};
}

PoseEstimate pose_from_landmark(const HeadingEstimate& heading, const LandmarkOffset& landmark) {
  const Matrix2 R = rotation(heading.heading);
  const Vector2 offset = R * landmark.offset_robot;
  const Vector2 swing = -quarter_turn(offset);  // d(position)/d(heading)
  PoseEstimate robot;
  robot.pose = {-offset.x(), -offset.y(), heading.heading};
  robot.covariance.topLeftCorner<2, 2>() =
      R * landmark.covariance_robot * R.transpose() + heading.variance * swing * swing.transpose();
  robot.covariance.topRightCorner<2, 1>() = heading.variance * swing;
  robot.covariance.bottomLeftCorner<1, 2>() = heading.variance * swing.transpose();
  robot.covariance(2, 2) = heading.variance;
  return robot;
}

PoseEstimate dead_reckon(const PoseEstimate& start, const MotionRows& drive, double from, double to,
                         const Robot& robot, const Noise& noise, double readings_used_until,
                         const std::vector<double>& slip) {
  if (drive.has_gyro() && drive.gyro.empty()) {
    return dead_reckon(start, with_gyro(drive, robot, noise), from, to, robot, noise,
                       readings_used_until, slip);
  }
  const std::vector<DriveRow> rows = rows_between(drive, from, to);
  const auto slip_in = [&slip](const DriveRow& row) {
    return slip.empty() ? 0.0 : row.part * slip[row.row];
  };
  if (drive.has_compass() || drive.has_gyro() || !drive.wheels.empty()) {
    RowReckoner reckoner(start, drive.has_compass());
    for (const DriveRow& row : rows) {
      const bool reads = drive.has_compass() && row.ends && drive.t[row.row] > readings_used_until;
      reckoner.take(
          {motion_of(drive, row), row.duration, slip_in(row),
           reads ? drive.heading[row.row] : kAbsent, noise_of_row(drive, row, robot, noise)},
          robot, noise);
    }
    return reckoner.at();
  }
  PoseEstimate estimate = start;
  for (const DriveArc& arc : merge_rows(drive, rows, robot, {noise.left, noise.right})) {
    const Motion end =
        then({estimate.pose, estimate.covariance},
             {displacement_of(arc.motion),
              arc_covariance(drive::wheel_travel(arc.motion, robot), arc.duration, robot, noise)});
    estimate = {end.displacement, end.covariance};
  }
  estimate.pose = start.pose;
  for (const DriveRow& row : rows) {
    const BodyMotion slipped{0.0, slip_in(row), 0.0};
    estimate.pose = compose(estimate.pose, displacement_of(motion_of(drive, row) + slipped));
  }
  return estimate;
}

std::vector<PoseEstimate> dead_reckoned_estimates(const MotionRows& drive, const Robot& robot,
                                                  const Noise& noise,
                                                  const std::vector<double>& slip) {
  if (drive.has_gyro() && drive.gyro.empty()) {
    return dead_reckoned_estimates(with_gyro(drive, robot, noise), robot, noise, slip);
  }
  const InitialHeading first = initial_heading(drive, drive.start(), robot, noise);
  PoseEstimate start;
  start.pose.heading = first.heading.heading;
  start.covariance(2, 2) = first.heading.variance;
  RowReckoner reckoner(start, drive.has_compass());
  std::vector<PoseEstimate> result;
  result.reserve(drive.rows());
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const bool reads = drive.has_compass() && drive.t[row] > first.reading_time;
    reckoner.take({drive.motion(row), drive.duration(row), slip.empty() ? 0.0 : slip[row],
                   reads ? drive.heading[row] : kAbsent,
                   noise_of_row(drive, {row, 1.0, drive.duration(row)}, robot, noise)},
                  robot, noise);
    result.push_back(reckoner.at());
  }
  return result;
}

std::vector<Pose> dead_reckoned_path(const MotionRows& drive, const Robot& robot,
                                     const Noise& noise, const std::vector<double>& slip) {
  std::vector<Pose> path;
  path.reserve(drive.rows());
  for (const PoseEstimate& one : dead_reckoned_estimates(drive, robot, noise, slip)) {
    path.push_back(one.pose);
  }
  return path;
}

PositionEstimate landmark_from_pose(const PoseEstimate& pose, const LandmarkOffset& landmark) {
  const Matrix2 R = rotation(pose.pose.heading);
  const Vector2 offset = R * landmark.offset_robot;
  Eigen::Matrix<double, 2, 3> J = Eigen::Matrix<double, 2, 3>::Zero();
  J.leftCols<2>().setIdentity();
  J.col(2) = quarter_turn(offset);
  return {pose.pose.position() + offset,
          J * pose.covariance * J.transpose() + R * landmark.covariance_robot * R.transpose()};
}

}  // namespace trussmap
