// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/reckoned_leg.hpp"

#include <cmath>
#include <stdexcept>

namespace trussmap::map {

Chord chord_of(const LandmarkOffset& from, const Motion& motion, const LandmarkOffset& to) {
  const Pose& end = motion.displacement;
  const Matrix2 R = rotation(end.heading);
  const Vector2 to_end = R * to.offset_robot;
  Chord chord;
  chord.vector = end.position() + to_end - from.offset_robot;
  const double length = chord.vector.norm();
  Eigen::Matrix<double, 2, 3> by_motion;  // of the chord, by (x, y, turn)
  by_motion << Matrix2::Identity(), quarter_turn(to_end);
  const Matrix2 of_motion = by_motion * motion.covariance * by_motion.transpose();
  const Matrix2 of_from = from.covariance_robot;
  const Matrix2 of_to = R * to.covariance_robot * R.transpose();
  chord.covariance = of_motion + of_from + of_to;
  chord.turn = end.heading;
  chord.turn_variance = motion.covariance(2, 2);
  if (!(length > 0.0) || !std::isfinite(length) || !chord.covariance.allFinite() ||
      !motion.covariance.allFinite()) {
    throw std::invalid_argument(
        "a motion needs a finite displacement from landmark to landmark other than zero and a "
        "finite covariance");
  }
  const Vector2 along = chord.vector / length;
  const Vector2 across = quarter_turn(along) / length;  // gradient of alpha by the chord
  chord.length_variance = along.dot(chord.covariance * along);
  chord.alpha.value = direction(chord.vector);
  chord.alpha.variance = across.dot((of_motion + of_to) * across);
  chord.alpha.by_offset = -across;
  chord.beta.value = end.heading - chord.alpha.value;
  Eigen::RowVector3d by = -across.transpose() * by_motion;
  by[2] += 1.0;
  chord.beta.variance = by * motion.covariance * by.transpose() + across.dot(of_from * across);
  chord.beta.by_offset = -R.transpose() * across;
  if (!(chord.length_variance > 0.0) || !(across.dot(chord.covariance * across) > 0.0)) {
    throw std::invalid_argument(
        "a motion needs a covariance that leaves length and direction of its way uncertain");
  }
  return chord;
}

Traversal in_map_axes(const HeadingEstimate& heading, const Vector2& vector,
                      const Matrix2& covariance) {
  const Matrix2 R = rotation(heading.heading);
  const Vector2 d = R * vector;
  const Vector2 lever = quarter_turn(d);
  const Matrix2 C = R * covariance * R.transpose() + heading.variance * lever * lever.transpose();
  return {d, 0.5 * (C + C.transpose())};
}

void Average::take(double value, double its_variance) {
  ++count;
  mean += (value - mean) / count;
  variance += (its_variance - variance) / count;
}

void Average::take_angle(double value, double its_variance) {
  take(count == 0 ? value : unwrap_near(value, mean), its_variance);
}

MeasuredAngle corner_between(const SharedAngle& beta, const SharedAngle& alpha,
                             const Matrix2& covariance_offset) {
  const Vector2 by = beta.by_offset + alpha.by_offset;
  return {wrap_angle(beta.value + alpha.value),
          beta.variance + alpha.variance + by.dot(covariance_offset * by)};
}

double variance_of(const SharedAngle& angle, const Matrix2& covariance_offset) {
  return angle.variance + angle.by_offset.dot(covariance_offset * angle.by_offset);
}

}  // namespace trussmap::map
