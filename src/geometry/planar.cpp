// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/planar.hpp"

#include <cmath>
#include <numbers>

namespace trussmap {

double wrap_angle(double angle) {
  if (angle > -std::numbers::pi && angle <= std::numbers::pi) return angle;
  const double wrapped = std::remainder(angle, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

double unwrap_near(double angle, double reference) {
  return reference + std::remainder(angle - reference, 2.0 * std::numbers::pi);
}

double direction(const Vector2& vector) {
  return std::atan2(vector.y(), vector.x());
}

Matrix2 rotation(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return (Matrix2() << c, -s, s, c).finished();
}

Matrix3 pose_rotation(double angle) {
  Matrix3 result = Matrix3::Identity();
  result.topLeftCorner<2, 2>() = rotation(angle);
  return result;
}

Pose compose(const Pose& a, const Pose& b) {
  const double c = std::cos(a.heading);
  const double s = std::sin(a.heading);
  return {a.x + c * b.x - s * b.y, a.y + s * b.x + c * b.y, a.heading + b.heading};
}

Pose inverse(const Pose& pose) {
  const double c = std::cos(pose.heading);
  const double s = std::sin(pose.heading);
  return {-c * pose.x - s * pose.y, s * pose.x - c * pose.y, -pose.heading};
}

Pose relative(const Pose& from, const Pose& to) {
  return compose(inverse(from), to);
}

Matrix3 symmetrised(const Matrix3& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

}  // namespace trussmap
