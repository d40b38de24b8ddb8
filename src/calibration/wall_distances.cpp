// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/units.hpp"
#include "trussmap/wheel_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr double kLargestHeading = std::numbers::pi / 4.0;

Vector2 direction(Faces faces) {
  switch (faces) {
    case Faces::ahead:
      return {1.0, 0.0};
    case Faces::left:
      return {0.0, 1.0};
    case Faces::behind:
      return {-1.0, 0.0};
    case Faces::right:
      return {0.0, -1.0};
  }
  return Vector2::Zero();
}

/// Numbers of the two sensors that face the same wall, and of the third.
struct Roles {
  std::size_t first = 0;
  std::size_t second = 0;
  std::size_t third = 0;
};

Roles roles_of(const WallSensors& sensors) {
  for (std::size_t third = 0; third < 3; ++third) {
    const std::size_t first = third == 0 ? 1 : 0;
    const std::size_t second = third == 2 ? 1 : 2;
    if (sensors[first].faces == sensors[second].faces) return {first, second, third};
  }
  throw std::invalid_argument(
      "no two sensors face the same wall, expected two that do, and a third at right angles");
}

/// The solution of u . R(heading) m = difference next to 0.
double heading_by(const Vector2& u, const Vector2& m, double difference) {
  const double share = difference / m.norm();
  if (!(std::abs(share) <= 1.0)) {
    throw std::invalid_argument(
        fmt::format("the distances of the two sensors that face one wall differ by {:.3g} m, more "
                    "than the {:.3g} m between them",
                    std::abs(difference), m.norm()));
  }
  const double middle = std::atan2(u.dot(quarter_turn(m)), u.dot(m));
  const double plus = wrap_angle(middle + std::acos(share));
  const double minus = wrap_angle(middle - std::acos(share));
  const double heading = std::abs(plus) < std::abs(minus) ? plus : minus;
  if (std::abs(heading) > kLargestHeading) {
    throw std::invalid_argument(
        fmt::format("the distances say that the robot stands askew to the walls by {:.0f} degrees, "
                    "expected 45 or less",
                    std::abs(heading) * geometry::kDegrees));
  }
  return heading;
}

}  // namespace

void check_wall_sensors(const WallSensors& sensors) {
  const Roles roles = roles_of(sensors);
  const WallSensor& first = sensors[roles.first];
  const Vector2 u = direction(first.faces);
  if (direction(sensors[roles.third].faces).dot(u) != 0.0) {
    throw std::invalid_argument(
        "the third sensor does not face a wall at right angles to that of the two others");
  }
  const Vector2 apart = first.at - sensors[roles.second].at;
  if (!(std::abs(quarter_turn(u).dot(apart)) > std::abs(u.dot(apart)))) {
    throw std::invalid_argument(
        "the two sensors that face one wall are not apart along it, so that they say nothing of "
        "the heading");
  }
  for (const WallSensor& sensor : sensors) {
    if (!sensor.at.allFinite() || !(sensor.sd >= 0.0) || !std::isfinite(sensor.sd)) {
      throw std::invalid_argument(
          "places of sensors must be finite, their standard deviations 0 or more");
    }
  }
}

WallPose pose_by_walls(const WallSensors& sensors, const WallDistances& distances) {
  check_wall_sensors(sensors);
  const Roles roles = roles_of(sensors);
  const WallSensor& first = sensors[roles.first];
  const WallSensor& third = sensors[roles.third];
  const Vector2 u_a = direction(first.faces);
  const Vector2 u_b = direction(third.faces);
  const Vector2 apart = first.at - sensors[roles.second].at;
  const double heading = heading_by(u_a, apart, distances[roles.second] - distances[roles.first]);
  const Matrix2 R = rotation(heading);
  // -d_i - u . R m_i is the same of both sensors that face wall A.
  const double along_a = -distances[roles.first] - u_a.dot((R * first.at));
  const double along_b = -distances[roles.third] - u_b.dot((R * third.at));
  const Vector2 position = along_a * u_a + along_b * u_b;

  const auto by_heading = [&](const Vector2& u, const Vector2& m) {
    return u.dot(quarter_turn(R * m));
  };
  const auto unit = [](std::size_t sensor) {
    return Eigen::RowVector3d(Eigen::RowVector3d::Unit(static_cast<Eigen::Index>(sensor)));
  };
  const Eigen::RowVector3d heading_row =
      (unit(roles.second) - unit(roles.first)) / by_heading(u_a, apart);
  const Eigen::RowVector3d row_a = -unit(roles.first) - by_heading(u_a, first.at) * heading_row;
  const Eigen::RowVector3d row_b = -unit(roles.third) - by_heading(u_b, third.at) * heading_row;
  Matrix3 jacobian;
  jacobian << u_a.x() * row_a + u_b.x() * row_b, u_a.y() * row_a + u_b.y() * row_b, heading_row;
  const Eigen::Vector3d variances(std::pow(sensors[0].sd, 2), std::pow(sensors[1].sd, 2),
                                  std::pow(sensors[2].sd, 2));
  return {{position.x(), position.y(), heading},
          jacobian * variances.asDiagonal() * jacobian.transpose()};
}

WallError end_error(const WallSensors& sensors, const WallRun& run) {
  const WallPose start = pose_by_walls(sensors, run.start);
  const WallPose end = pose_by_walls(sensors, run.end);
  const Vector2 off = end.pose.position() - start.pose.position();
  const Vector2 moved = rotation(-start.pose.heading) * off;
  const Vector2 by_heading = -quarter_turn(moved);
  const Matrix3 by_end = pose_rotation(-start.pose.heading);
  Matrix3 by_start = -by_end;
  by_start.block<2, 1>(0, 2) = by_heading;
  WallError result;
  result.error << moved.x() - run.odometry.x, moved.y() - run.odometry.y,
      wrap_angle(end.pose.heading - start.pose.heading - run.odometry.heading);
  result.covariance = by_end * end.covariance * by_end.transpose() +
                      by_start * start.covariance * by_start.transpose();
  return result;
}

}  // namespace trussmap
