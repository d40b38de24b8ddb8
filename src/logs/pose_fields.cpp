// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/pose_fields.hpp"

#include "logs/calendar.hpp"

#include <cmath>

namespace trussmap::logs {
namespace {

constexpr double kUnit = 0.1;  // how far off 1 a quaternion's length may be

std::optional<double> number_at(FieldRef group, std::string_view name) {
  const std::optional<FieldRef> field = group.member(name);
  if (!field || !field->is_number() || !std::isfinite(field->number())) return std::nullopt;
  return field->number();
}

std::optional<Eigen::Vector3d> vector_at(FieldRef group) {
  const auto x = number_at(group, "x");
  const auto y = number_at(group, "y");
  if (!x || !y) return std::nullopt;
  return Eigen::Vector3d(*x, *y, number_at(group, "z").value_or(0.0));
}

std::optional<Eigen::Quaterniond> unit_quaternion(double x, double y, double z, double w) {
  const Eigen::Quaterniond quaternion(w, x, y, z);
  if (!(std::abs(quaternion.norm() - 1.0) < kUnit)) return std::nullopt;
  return quaternion.normalized();
}

std::optional<Eigen::Quaterniond> quaternion_at(FieldRef group) {
  const FieldRef within = group.member("q").value_or(group);  // WPILib's Rotation3d
  for (const auto& [x, y, z, w] :
       {std::array{"x", "y", "z", "w"}, std::array{"X", "Y", "Z", "W"}}) {
    const auto qx = number_at(within, x);
    const auto qy = number_at(within, y);
    const auto qz = number_at(within, z);
    const auto qw = number_at(within, w);
    if (!qx || !qy || !qz || !qw) continue;
    return unit_quaternion(*qx, *qy, *qz, *qw);
  }
  for (const char* name : {"value", "theta", "heading", "yaw"}) {
    if (const auto angle = number_at(group, name)) {
      return Eigen::Quaterniond(Eigen::AngleAxisd(*angle, Eigen::Vector3d::UnitZ()));
    }
  }
  return std::nullopt;
}

std::optional<FieldPose> pose_by(FieldRef group, const char* position, const char* rotation) {
  const std::optional<FieldRef> at = group.member(position);
  const std::optional<FieldRef> turned = group.member(rotation);
  if (!at || !turned) return std::nullopt;
  const auto vector = vector_at(*at);
  const auto quaternion = quaternion_at(*turned);
  if (!vector || !quaternion) return std::nullopt;
  return FieldPose{*vector, *quaternion, true};
}

}  // namespace

double FieldPose::yaw() const {
  const Eigen::Vector3d ahead = rotation * Eigen::Vector3d::UnitX();
  return std::atan2(ahead.y(), ahead.x());
}

std::optional<FieldPose> pose_of(FieldRef field) {
  if (auto found = pose_by(field, "position", "orientation")) return found;
  if (auto found = pose_by(field, "translation", "rotation")) return found;
  for (const char* below : {"pose", "transform"}) {
    if (const auto group = field.member(below)) return pose_of(*group);
  }
  const std::optional<FieldRef> point = field.member("point");
  const auto vector = vector_at(point ? *point : field);
  if (!vector) return std::nullopt;
  const std::optional<Eigen::Quaterniond> rotation =
      field.member("w") ? std::nullopt : quaternion_at(field);
  if (rotation) {
    const bool planar = field.member("z") == std::nullopt;
    return FieldPose{planar ? Eigen::Vector3d(vector->x(), vector->y(), 0.0) : *vector, *rotation,
                     true};
  }
  return FieldPose{*vector, Eigen::Quaterniond::Identity(), false};
}

std::optional<FieldTwist> twist_of(FieldRef field) {
  const std::optional<FieldRef> linear = field.member("linear");
  const std::optional<FieldRef> angular = field.member("angular");
  if (linear && angular) {
    const auto x = number_at(*linear, "x");
    const auto turn = number_at(*angular, "z");
    if (!x || !turn) return std::nullopt;
    return FieldTwist{*x, number_at(*linear, "y").value_or(0.0), *turn};
  }
  if (const auto below = field.member("twist")) return twist_of(*below);
  const auto x = number_at(field, "vx");
  const auto turn = number_at(field, "omega");
  if (!x || !turn) return std::nullopt;
  return FieldTwist{*x, number_at(field, "vy").value_or(0.0), *turn};
}

std::optional<FieldTwist> twist_of_modules(FieldRef list, const std::vector<Vector2>& places) {
  const std::vector<FieldRef> modules = list.children();
  if (list.kind() != FieldKind::list || modules.size() != places.size()) return std::nullopt;
  // The mean wheel moves as the body does at the mean place; the rest is its turn.
  Vector2 place = Vector2::Zero();
  Vector2 velocity = Vector2::Zero();
  std::vector<Vector2> velocities;
  const double share = 1.0 / static_cast<double>(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto speed = number_at(modules[k], "speed");
    const std::optional<FieldRef> angle = modules[k].member("angle");
    const auto direction = angle ? number_at(*angle, "value") : std::nullopt;
    if (!speed || !direction) return std::nullopt;
    velocities.emplace_back(*speed * std::cos(*direction), *speed * std::sin(*direction));
    place += share * places[k];
    velocity += share * velocities.back();
  }
  double moment = 0.0;
  double inertia = 0.0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Vector2 arm = places[k] - place;
    const Vector2 rest = velocities[k] - velocity;
    moment += arm.x() * rest.y() - arm.y() * rest.x();
    inertia += arm.squaredNorm();
  }
  if (!(inertia > 0.0)) return std::nullopt;
  const double turn = moment / inertia;
  return FieldTwist{velocity.x() + turn * place.y(), velocity.y() - turn * place.x(), turn};
}

std::optional<double> yaw_of_quaternion(FieldRef field) {
  if (field.kind() != FieldKind::group) return std::nullopt;
  const auto quaternion = quaternion_at(field);
  if (!quaternion) return std::nullopt;
  return FieldPose{Eigen::Vector3d::Zero(), *quaternion, true}.yaw();
}

std::optional<double> yaw_of_quaternion(double x, double y, double z, double w) {
  const auto quaternion = unit_quaternion(x, y, z, w);
  if (!quaternion) return std::nullopt;
  return FieldPose{Eigen::Vector3d::Zero(), *quaternion, true}.yaw();
}

std::optional<std::int64_t> stamp_of(FieldRef message) {
  const std::optional<FieldRef> header = message.member("header");
  const std::optional<FieldRef> stamp = (header ? *header : message).member("stamp");
  if (!stamp) return std::nullopt;
  const std::optional<FieldRef> sec = stamp->member("sec");
  const std::optional<FieldRef> nanosec = stamp->member("nanosec");
  if (!sec || !nanosec) return std::nullopt;
  constexpr std::int64_t kLargest = 4000000000;  // s: beyond, nanoseconds overflow
  if (std::abs(sec->field().integer) > kLargest) return std::nullopt;
  if (std::abs(nanosec->field().integer) > kLargest) return std::nullopt;
  const std::int64_t t = sec->field().integer * kNanosecondsPerSecond + nanosec->field().integer;
  if (t == 0) return std::nullopt;
  return t;
}

std::string frame_of(FieldRef message) {
  const std::optional<FieldRef> header = message.member("header");
  const std::optional<FieldRef> frame = header ? header->member("frame_id") : std::nullopt;
  return frame ? std::string(frame->field().text) : std::string();
}

}  // namespace trussmap::logs
