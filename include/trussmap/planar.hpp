// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// The plane: angles, rotations and poses.
//
//   x, y      position                                   m     map frame
//   heading   angle of the robot's forward axis, counter-clockwise from +x   rad
//
// A pose T = (x, y, heading) stands for the motion that carries the map frame onto the robot:
// compose(A, B) drives A first and then B, with B given in A's frame.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>  // inverse and determinant of the small matrices

namespace trussmap {

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;
using Matrix3 = Eigen::Matrix3d;

struct Pose {
  double x = 0.0;        ///< m
  double y = 0.0;        ///< m
  double heading = 0.0;  ///< rad, not wrapped: whole turns are kept

  [[nodiscard]] Vector2 position() const { return {x, y}; }
};

struct PoseEstimate {
  Pose pose;                             ///< map axes
  Matrix3 covariance = Matrix3::Zero();  ///< of (x, y, heading), map axes
};

struct HeadingEstimate {
  double heading = 0.0;   ///< rad, map frame
  double variance = 0.0;  ///< rad^2
};

/// The angle's representative in (-pi, pi].
[[nodiscard]] double wrap_angle(double angle);

/// The angle's representative within half a turn of `reference`.
[[nodiscard]] double unwrap_near(double angle, double reference);

/// Direction of a vector, atan2(y, x), in (-pi, pi].
[[nodiscard]] double direction(const Vector2& vector);

/// The vector turned by a quarter turn counter-clockwise.
[[nodiscard]] inline Vector2 quarter_turn(const Vector2& vector) {
  return {-vector.y(), vector.x()};
}

/// R(angle): R * v turns v counter-clockwise.
[[nodiscard]] Matrix2 rotation(double angle);

/// R(angle) acting on (x, y), leaving the heading alone: carries 3x3 pose covariances over.
[[nodiscard]] Matrix3 pose_rotation(double angle);

/// First `a`, then `b` as seen from where `a` ended.
[[nodiscard]] Pose compose(const Pose& a, const Pose& b);

[[nodiscard]] Pose inverse(const Pose& pose);

/// `to` as seen from `from`; the heading difference is not wrapped.
[[nodiscard]] Pose relative(const Pose& from, const Pose& to);

/// Symmetric part, to keep rounding from spoiling a covariance.
[[nodiscard]] Matrix3 symmetrised(const Matrix3& matrix);

// ----------------------------------------
// Laying one set of points over another, to judge a map whose frame is arbitrary.
//
// Minimises sum |s R a_k + v - b_k|^2 over the rotation R, the translation v and, if wanted, the
// scale s (Horn's closed form in the plane). Two points at least. Where all points coincide the
// angle is arbitrary (0) and there is no scale.

struct Alignment {
  double scale = 1.0;                     ///< multiplies the first set
  double angle = 0.0;                     ///< rad
  Vector2 translation = Vector2::Zero();  ///< m
  double rms = 0.0;                       ///< root mean square distance left, m

  [[nodiscard]] Vector2 apply(const Vector2& point) const {
    return scale * (rotation(angle) * point) + translation;
  }
};

/// Rotation and translation only. Throws std::invalid_argument on unequal sizes or < 2 points.
[[nodiscard]] Alignment align_rigidly(const std::vector<Vector2>& points,
                                      const std::vector<Vector2>& onto);

/// Rotation, translation and scale. Throws like align_rigidly, and where all points coincide.
[[nodiscard]] Alignment align_by_similarity(const std::vector<Vector2>& points,
                                            const std::vector<Vector2>& onto);

}  // namespace trussmap
