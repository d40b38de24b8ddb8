// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/ros_messages.hpp"

#include "logs/calendar.hpp"
#include "logs/cdr_write.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace trussmap::logs {
namespace {

/// A type's own definition, and the types it names.
struct MessageDefinition {
  std::string_view type;  // PACKAGE/NAME
  std::string_view fields;
  std::array<std::string_view, 3> parts = {};
};

// Fields in the order of the published definitions: the bytes of a message depend on it.
constexpr MessageDefinition kMessageDefinitions[] = {
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/PointStamped",
     "std_msgs/Header header\ngeometry_msgs/Point point\n",
     {"std_msgs/Header", "geometry_msgs/Point"}},
    {"geometry_msgs/Pose",
     "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n",
     {"geometry_msgs/Point", "geometry_msgs/Quaternion"}},
    {"geometry_msgs/PoseStamped",
     "std_msgs/Header header\ngeometry_msgs/Pose pose\n",
     {"std_msgs/Header", "geometry_msgs/Pose"}},
    {"geometry_msgs/PoseWithCovariance",
     "geometry_msgs/Pose pose\nfloat64[36] covariance\n",
     {"geometry_msgs/Pose"}},
    {"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
    {"geometry_msgs/Transform",
     "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n",
     {"geometry_msgs/Vector3", "geometry_msgs/Quaternion"}},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n",
     {"std_msgs/Header", "geometry_msgs/Transform"}},
    {"geometry_msgs/Twist",
     "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n",
     {"geometry_msgs/Vector3"}},
    {"geometry_msgs/TwistWithCovariance",
     "geometry_msgs/Twist twist\nfloat64[36] covariance\n",
     {"geometry_msgs/Twist"}},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist\n",
     {"std_msgs/Header", "geometry_msgs/PoseWithCovariance", "geometry_msgs/TwistWithCovariance"}},
    {"sensor_msgs/Imu",
     "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
     "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
     "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
     "float64[9] linear_acceleration_covariance\n",
     {"std_msgs/Header", "geometry_msgs/Quaternion", "geometry_msgs/Vector3"}},
    {"sensor_msgs/JointState",
     "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
     "float64[] effort\n",
     {"std_msgs/Header"}},
    {"sensor_msgs/Range",
     "std_msgs/Header header\nuint8 ULTRASOUND=0\nuint8 INFRARED=1\nuint8 radiation_type\n"
     "float32 field_of_view\nfloat32 min_range\nfloat32 max_range\nfloat32 range\n"
     "float32 variance\n",
     {"std_msgs/Header"}},
    {"std_msgs/Float64", "float64 data\n"},
    {"std_msgs/Header",
     "builtin_interfaces/Time stamp\nstring frame_id\n",
     {"builtin_interfaces/Time"}},
    {"std_msgs/String", "string data\n"},
    {"tf2_msgs/TFMessage",
     "geometry_msgs/TransformStamped[] transforms\n",
     {"geometry_msgs/TransformStamped"}},
};

const MessageDefinition& definition_of(std::string_view type) {
  const auto* const found =
      std::find_if(std::begin(kMessageDefinitions), std::end(kMessageDefinitions),
                   [&](const MessageDefinition& one) { return one.type == type; });
  if (found == std::end(kMessageDefinitions)) {
    throw std::invalid_argument("no definition of the message type " + std::string(type));
  }
  return *found;
}

/// All types within, each once, in the order in which they are met.
void collect_parts(const MessageDefinition& of, std::vector<std::string_view>& found) {
  for (const std::string_view part : of.parts) {
    if (part.empty() || std::find(found.begin(), found.end(), part) != found.end()) continue;
    found.push_back(part);
    collect_parts(definition_of(part), found);
  }
}

void put(CdrWriter& out, const RosHeader& header) {
  out.number(static_cast<std::int32_t>(header.stamp / kNanosecondsPerSecond));
  out.number(static_cast<std::uint32_t>(header.stamp % kNanosecondsPerSecond));
  out.text(header.frame_id);
}

void put_point(CdrWriter& out, double x, double y, double z = 0.0) {
  out.number(x).number(y).number(z);
}

void put_rotation(CdrWriter& out, double heading) {
  const double half = 0.5 * wrap_angle(heading);
  out.number(0.0).number(0.0).number(std::sin(half)).number(std::cos(half));
}

void put(CdrWriter& out, const Pose& pose) {
  put_point(out, pose.x, pose.y);
  put_rotation(out, pose.heading);
}

/// Of (x, y, z, roll, pitch, yaw), row by row.
void put_covariance(CdrWriter& out, const Matrix3& planar) {
  constexpr int kSize = 6;
  constexpr std::array kPlace = {0, 1, 5};  // x, y, yaw
  Eigen::Matrix<double, kSize, kSize> whole =
      kUnknownVariance * Eigen::Matrix<double, kSize, kSize>::Identity();
  for (std::size_t i = 0; i < kPlace.size(); ++i) {
    for (std::size_t j = 0; j < kPlace.size(); ++j) {
      whole(kPlace[i], kPlace[j]) = planar(static_cast<int>(i), static_cast<int>(j));
    }
  }
  for (int i = 0; i < kSize; ++i) {
    for (int j = 0; j < kSize; ++j) out.number(whole(i, j));
  }
}

/// Of (roll, pitch, yaw), where yaw alone was measured. REP 145: -1 first where nothing was.
std::array<double, 9> yaw_covariance(const std::optional<ImuMessage::Measured>& yaw) {
  std::array<double, 9> covariance{};
  if (yaw) {
    covariance[0] = covariance[4] = kUnknownVariance;
    covariance[8] = yaw->variance;
  } else {
    covariance[0] = -1.0;
  }
  return covariance;
}

}  // namespace

std::string ros_definition(const std::string& type) {
  constexpr std::string_view kWithin = "/msg/";
  std::string name = type;
  if (const std::size_t at = name.find(kWithin); at != std::string::npos) {
    name.replace(at, kWithin.size(), "/");
  }
  const MessageDefinition& of = definition_of(name);
  std::vector<std::string_view> parts;
  collect_parts(of, parts);
  std::string text(of.fields);
  for (const std::string_view part : parts) {
    text += std::string(80, '=') + "\nMSG: " + std::string(part) + "\n";
    text += definition_of(part).fields;
  }
  return text;
}

std::string to_cdr(const OdometryMessage& message) {
  CdrWriter out;
  put(out, message.header);
  out.text(message.child_frame_id);
  put(out, message.pose);
  put_covariance(out, message.pose_covariance);
  put_point(out, message.twist.x, message.twist.y);
  put_point(out, 0.0, 0.0, message.twist.heading);
  put_covariance(out, message.twist_covariance);
  return out.bytes();
}

std::string to_cdr(const JointStateMessage& message) {
  CdrWriter out;
  put(out, message.header);
  out.count(message.names.size());
  for (const std::string& one : message.names) out.text(one);
  out.count(message.positions.size());
  for (const double one : message.positions) out.number(one);
  out.count(0).count(0);  // velocities, efforts
  return out.bytes();
}

std::string to_cdr(const ImuMessage& message) {
  CdrWriter out;
  put(out, message.header);
  put_rotation(out, message.heading ? message.heading->value : 0.0);
  out.numbers(yaw_covariance(message.heading));
  put_point(out, 0.0, 0.0, message.yaw_rate ? message.yaw_rate->value : 0.0);
  out.numbers(yaw_covariance(message.yaw_rate));
  put_point(out, 0.0, 0.0);
  out.numbers(yaw_covariance(std::nullopt));
  return out.bytes();
}

std::string to_cdr(const std::vector<TransformMessage>& message) {
  CdrWriter out;
  out.count(message.size());
  for (const TransformMessage& one : message) {
    put(out, one.header);
    out.text(one.child_frame_id);
    put(out, one.transform);
  }
  return out.bytes();
}

std::string to_cdr(const RangeMessage& message) {
  CdrWriter out;
  put(out, message.header);
  out.number(std::uint8_t{0});  // radiation: of radios there is no word
  out.number(0.0F);             // field of view: unknown
  out.number(0.0F).number(std::numeric_limits<float>::max());
  out.number(static_cast<float>(message.range)).number(static_cast<float>(message.variance));
  return out.bytes();
}

std::string pose_to_cdr(const RosHeader& header, const Pose& pose) {
  CdrWriter out;
  put(out, header);
  put(out, pose);
  return out.bytes();
}

std::string point_to_cdr(const RosHeader& header, const Vector2& point) {
  CdrWriter out;
  put(out, header);
  put_point(out, point.x(), point.y());
  return out.bytes();
}

std::string text_to_cdr(const std::string& text) {
  return CdrWriter().text(text).bytes();
}

std::string number_to_cdr(double number) {
  return CdrWriter().number(number).bytes();
}

}  // namespace trussmap::logs
