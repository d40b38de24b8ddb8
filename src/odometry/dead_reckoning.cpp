// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/dead_reckoning.hpp"

#include "odometry/merge.hpp"

#include <cmath>

namespace trussmap {
namespace {

/// Moves the estimate by a motion given in the robot's frame.
PoseEstimate moved(const PoseEstimate& start, const Pose& displacement, const Matrix3& covariance) {
  const Motion end = then({start.pose, start.covariance}, {displacement, covariance});
  return {end.displacement, end.covariance};
}

/// What wheels show, and a slip to the left besides that is spread evenly along the same arc.
Pose displacement_of(const WheelTravel& travel, double slip, double wheelbase) {
  Pose end = arc_displacement(travel, wheelbase);
  if (slip == 0.0) return end;
  const double swing = 0.5 * (travel.right - travel.left);
  const Vector2 aside =
      quarter_turn(arc_displacement({slip - swing, slip + swing}, wheelbase).position());
  end.x += aside.x();
  end.y += aside.y();
  return end;
}

void correct_heading(PoseEstimate& estimate, double reading, double variance) {
  const double innovation = wrap_angle(reading - estimate.pose.heading);
  const double total = estimate.covariance(2, 2) + variance;
  const Eigen::Vector3d gain = estimate.covariance.col(2) / total;
  estimate.pose.x += gain(0) * innovation;
  estimate.pose.y += gain(1) * innovation;
  estimate.pose.heading += gain(2) * innovation;
  estimate.covariance = symmetrised(estimate.covariance - gain * estimate.covariance.row(2));
}

}  // namespace

Matrix3 arc_covariance(const WheelTravel& travel, double duration, const Robot& robot,
                       const Noise& noise) {
  ArcNoise sources = wheel_arc_noise(travel, robot.wheelbase, WheelNoise{noise.left, noise.right});
  const double turn = (travel.right - travel.left) / robot.wheelbase;
  sources.along += noise.travel_per_s * noise.travel_per_s * duration;
  sources.heading += noise.heading_per_s * noise.heading_per_s * duration +
                     noise.heading_per_rad * noise.heading_per_rad * std::abs(turn);
  return arc_covariance(0.5 * (travel.left + travel.right), turn, sources);
}

LandmarkOffset landmark_offset(const Sighting& sighting, const Noise& noise) {
  if (sighting.standing()) {
    return {Vector2::Zero(), noise.sighting * noise.sighting * Matrix2::Identity()};
  }
  const Matrix2 R = rotation(sighting.bearing);
  const double along =
      noise.range * noise.range + std::pow(noise.range_relative * sighting.range, 2);
  const double across = std::pow(noise.bearing * sighting.range, 2);
  return {sighting.range * R.col(0), R * Vector2(along, across).asDiagonal() * R.transpose()};
}

InitialHeading initial_heading(const Drive& drive, double t, const Robot& robot,
                               const Noise& noise) {
  double turn = 0.0;
  double variance = 0.0;
  for (const DriveRow& row : rows_between(drive, t, drive.t.back())) {
    if (!drive.has_compass()) break;
    const WheelTravel travel = travel_of(drive, row);
    turn += (travel.right - travel.left) / robot.wheelbase;
    variance += arc_covariance(travel, row.duration, robot, noise)(2, 2);
    const double reading = drive.heading[row.row];
    if (!std::isnan(reading)) {
      return {{wrap_angle(reading - turn), noise.compass * noise.compass + variance},
              drive.t[row.row]};
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

PoseEstimate dead_reckon(const PoseEstimate& start, const Drive& drive, double from, double to,
                         const Robot& robot, const Noise& noise, double readings_used_until,
                         const std::vector<double>& slip) {
  const std::vector<DriveRow> rows = rows_between(drive, from, to);
  const auto displacement = [&](const DriveRow& row) {
    return displacement_of(travel_of(drive, row), slip.empty() ? 0.0 : row.part * slip[row.row],
                           robot.wheelbase);
  };
  PoseEstimate estimate = start;
  if (drive.has_compass()) {
    for (const DriveRow& row : rows) {
      const WheelTravel travel = travel_of(drive, row);
      estimate =
          moved(estimate, displacement(row), arc_covariance(travel, row.duration, robot, noise));
      const double reading = drive.heading[row.row];
      if (row.ends && !std::isnan(reading) && drive.t[row.row] > readings_used_until) {
        correct_heading(estimate, reading, noise.compass * noise.compass);
      }
    }
    return estimate;
  }
  for (const DriveArc& arc : merge_rows(drive, rows, robot.wheelbase, {noise.left, noise.right})) {
    estimate = moved(estimate, arc_displacement(arc.travel, robot.wheelbase),
                     arc_covariance(arc.travel, arc.duration, robot, noise));
  }
  Pose exact = start.pose;
  for (const DriveRow& row : rows) exact = compose(exact, displacement(row));
  estimate.pose = exact;
  return estimate;
}

std::vector<PoseEstimate> dead_reckoned_estimates(const Drive& drive, const Robot& robot,
                                                  const Noise& noise,
                                                  const std::vector<double>& slip) {
  const InitialHeading first = initial_heading(drive, drive.start(), robot, noise);
  PoseEstimate at;
  at.pose.heading = first.heading.heading;
  at.covariance(2, 2) = first.heading.variance;
  std::vector<PoseEstimate> result;
  result.reserve(drive.rows());
  double before = drive.start();
  if (drive.has_compass()) {
    for (const double t : drive.t) {
      at = dead_reckon(at, drive, before, t, robot, noise, first.reading_time, slip);
      before = t;
      result.push_back(at);
    }
    return result;
  }
  const std::vector<DriveRow> rows = rows_between(drive, before, drive.t.back());
  std::size_t row = 0;
  for (const DriveArc& arc : merge_rows(drive, rows, robot.wheelbase, {noise.left, noise.right})) {
    const PoseEstimate anchor = at;
    WheelTravel part;
    double duration = 0.0;
    for (const std::size_t end = row + arc.rows; row < end; ++row) {
      const WheelTravel travel = travel_of(drive, rows[row]);
      part = {part.left + travel.left, part.right + travel.right};
      duration += rows[row].duration;
      const Pose exact = compose(
          at.pose, displacement_of(travel, slip.empty() ? 0.0 : slip[row], robot.wheelbase));
      at = moved(anchor, arc_displacement(part, robot.wheelbase),
                 arc_covariance(part, duration, robot, noise));
      at.pose = exact;
      result.push_back(at);
    }
  }
  return result;
}

std::vector<Pose> dead_reckoned_path(const Drive& drive, const Robot& robot, const Noise& noise,
                                     const std::vector<double>& slip) {
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
