// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The ROS 2 messages that bags of ours hold: of each its name, its definition and its bytes.
//
// Fields are those of the plane; what a planar robot cannot know is filled in as is the custom:
// z = 0, no roll and no pitch, with variances of 1e6 (in m^2, rad^2 and the like) where a
// covariance has a place for them. Units as everywhere: m, s, rad.
//
// Sources: ros2/common_interfaces, geometry2 (tf2_msgs), rcl_interfaces (builtin_interfaces).
#pragma once

#include "trussmap/planar.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::logs {

/// Of what was not measured, and must not count.
inline constexpr double kUnknownVariance = 1e6;

struct RosHeader {
  std::int64_t stamp = 0;  ///< ns since the Unix epoch
  std::string frame_id;
};

/// nav_msgs/msg/Odometry
struct OdometryMessage {
  RosHeader header;
  std::string child_frame_id;
  Pose pose;
  Matrix3 pose_covariance = Matrix3::Zero();  ///< of (x, y, heading)
  Pose twist = {};                            ///< per s, in the axes of child_frame_id
  Matrix3 twist_covariance = Matrix3::Zero();
};

/// sensor_msgs/msg/JointState, positions alone
struct JointStateMessage {
  RosHeader header;
  std::vector<std::string> names;
  std::vector<double> positions;  ///< rad
};

/// sensor_msgs/msg/Imu
struct ImuMessage {
  struct Measured {
    double value = 0.0;     ///< rad; rad/s
    double variance = 0.0;  ///< its square
  };
  RosHeader header;
  std::optional<Measured> heading;
  std::optional<Measured> yaw_rate;
};

struct TransformMessage {
  RosHeader header;
  std::string child_frame_id;
  Pose transform;
};

/// sensor_msgs/msg/Range
struct RangeMessage {
  RosHeader header;
  double range = 0.0;     ///< m
  double variance = 0.0;  ///< m^2; older releases of ROS 2 have no place for it, and pass over it
};

// Names as schemas have them (PACKAGE/msg/NAME).
inline constexpr const char* kOdometryType = "nav_msgs/msg/Odometry";
inline constexpr const char* kJointStateType = "sensor_msgs/msg/JointState";
inline constexpr const char* kImuType = "sensor_msgs/msg/Imu";
inline constexpr const char* kPoseStampedType = "geometry_msgs/msg/PoseStamped";
inline constexpr const char* kPointStampedType = "geometry_msgs/msg/PointStamped";
inline constexpr const char* kTransformsType = "tf2_msgs/msg/TFMessage";
inline constexpr const char* kRangeType = "sensor_msgs/msg/Range";
inline constexpr const char* kTextType = "std_msgs/msg/String";
inline constexpr const char* kNumberType = "std_msgs/msg/Float64";

/// The type's definition and those of all types within it (ros2msg). Throws std::invalid_argument
/// of a type that is not above.
[[nodiscard]] std::string ros_definition(const std::string& type);

[[nodiscard]] std::string to_cdr(const OdometryMessage& message);
[[nodiscard]] std::string to_cdr(const JointStateMessage& message);
[[nodiscard]] std::string to_cdr(const ImuMessage& message);
[[nodiscard]] std::string to_cdr(const std::vector<TransformMessage>& message);
[[nodiscard]] std::string to_cdr(const RangeMessage& message);
[[nodiscard]] std::string pose_to_cdr(const RosHeader& header, const Pose& pose);
[[nodiscard]] std::string point_to_cdr(const RosHeader& header, const Vector2& point);
[[nodiscard]] std::string text_to_cdr(const std::string& text);
[[nodiscard]] std::string number_to_cdr(double number);

}  // namespace trussmap::logs
