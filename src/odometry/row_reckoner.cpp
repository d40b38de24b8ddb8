// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "odometry/row_reckoner.hpp"

#include "drive/body_motion.hpp"
#include "odometry/wheels_and_gyro.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::odometry {
namespace {

/// Moves the estimate by a motion given in the robot's frame.
PoseEstimate moved(const PoseEstimate& start, const Pose& displacement, const Matrix3& covariance) {
  const Motion end = then({start.pose, start.covariance}, {displacement, covariance});
  return {end.displacement, end.covariance};
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

Matrix3 covariance_of(const ReckonedRow& row, const Robot& robot, const Noise& noise) {
  return slanting_covariance(
      Vector2(row.motion.forward, row.motion.sideways), row.motion.turn,
      row.noise ? *row.noise
                : arc_noise(drive::wheel_travel(row.motion, robot), row.duration, robot, noise));
}

Pose displacement_of(const BodyMotion& motion) {
  if (motion.sideways == 0.0) return arc_displacement(motion.forward, motion.turn);
  return slanting_displacement({motion.forward, motion.sideways}, motion.turn);
}

Matrix3 row_covariance(const MotionRows& drive, std::size_t row, double part, double duration,
                       const Robot& robot, const Noise& noise) {
  const BodyMotion motion = part * drive.motion(row);
  return slanting_covariance(Vector2(motion.forward, motion.sideways), motion.turn,
                             row_noise(drive, row, part, duration, robot, noise));
}

double reading_variance(const Noise& noise) {
  double variance = noise.compass * noise.compass;
  for (const NoiseProcess& one : noise.processes) {
    if (one.channel == Channel::compass) variance += one.sd * one.sd;
  }
  return variance;
}

double white_equivalent(const Noise& noise, double duration, double way) {
  constexpr double kMost = 2000.0;  // rows: what lasts for longer is hardly ever averaged
  double variance = noise.compass * noise.compass;
  for (const NoiseProcess& one : noise.processes) {
    if (one.channel != Channel::compass) continue;
    double times = kMost;
    if (one.process == ProcessKind::white) times = 1.0;
    if (is_correlated(one.process)) {
      const double lag = one.process == ProcessKind::correlated_in_t ? duration : way;
      const double phi = std::exp(-lag / one.length);
      times = phi < 1.0 ? std::min(kMost, (1.0 + phi) / (1.0 - phi)) : kMost;
    }
    variance += times * one.sd * one.sd;
  }
  return variance;
}

void RowReckoner::take(const ReckonedRow& row, const Robot& robot, const Noise& noise) {
  const Pose displacement = displacement_of(row.whole());
  if (compass_ || row.noise) {
    at_ = moved(at_, displacement, covariance_of(row, robot, noise));
    if (!std::isnan(row.reading)) {
      const double way = std::abs(row.motion.forward);
      correct_heading(at_, row.reading, white_equivalent(noise, row.duration, way));
    }
    return;
  }
  if (arc_.take(row.motion, row.duration, robot, {noise.left, noise.right})) anchor_ = at_;
  const DriveArc& arc = arc_.arc();
  const Pose exact = compose(at_.pose, displacement);
  at_ = moved(anchor_, displacement_of(arc.motion),
              arc_covariance(drive::wheel_travel(arc.motion, robot), arc.duration, robot, noise));
  at_.pose = exact;
}

void RowReckoner::add_first_variance(double variance) {
  Eigen::Vector3d by_heading;
  by_heading << quarter_turn(at_.pose.position()), 1.0;
  at_.covariance += variance * by_heading * by_heading.transpose();
}

}  // namespace trussmap::odometry
