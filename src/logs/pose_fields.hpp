// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Poses, velocities and times as messages have them, found by the names of their fields.
//
//   pose    position x y z, orientation x y z w   geometry_msgs; also below pose, pose.pose
//           translation, rotation                 transforms; WPILib, where rotation is value or q
//           x, y, theta | heading | yaw           Pose2D, Road Runner
//   twist   linear x y z, angular x y z           geometry_msgs; also below twist, twist.twist
//           vx, vy, omega                         WPILib's ChassisSpeeds
//   stamp   header.stamp or stamp: sec, nanosec
#pragma once

#include "logs/field_tree.hpp"
#include "trussmap/planar.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace trussmap::logs {

struct FieldPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  bool turned = true;  ///< false: a position alone

  /// Direction of the x axis in the plane, rad.
  [[nodiscard]] double yaw() const;
};

/// m/s ahead and to the left, rad/s.
struct FieldTwist {
  double ahead = 0.0;
  double left = 0.0;
  double turn = 0.0;
};

[[nodiscard]] std::optional<FieldPose> pose_of(FieldRef field);
[[nodiscard]] std::optional<FieldTwist> twist_of(FieldRef field);
/// Of a body whose wheels stand at `places` (m; x ahead, y to the left) and all steer, by a list of
/// their speeds and angles (WPILib's SwerveModuleState), by least squares; none where the list is
/// none of as many.
[[nodiscard]] std::optional<FieldTwist> twist_of_modules(FieldRef list,
                                                         const std::vector<Vector2>& places);
/// Of a group x, y, z, w, and of length 1; rad.
[[nodiscard]] std::optional<double> yaw_of_quaternion(FieldRef field);
/// The same of its four numbers.
[[nodiscard]] std::optional<double> yaw_of_quaternion(double x, double y, double z, double w);
/// ns; none where there is none, or it is 0.
[[nodiscard]] std::optional<std::int64_t> stamp_of(FieldRef message);
/// header.frame_id; empty where there is none.
[[nodiscard]] std::string frame_of(FieldRef message);

}  // namespace trussmap::logs
