// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/measurement_kind.hpp"

#include "effects/channel_physics.hpp"
#include "effects/channel_record.hpp"

#include <Eigen/LU>

namespace trussmap::estimation {

Matrix4 MeasurementKind::fixed_covariance(const Measurement& one, const Noise&) const {
  Matrix4 fixed = Matrix4::Zero();
  if (facts_.noise_is_sought && !one.own_sd) return fixed;
  const Eigen::MatrixXd colour = one.whitener.topLeftCorner(one.rows, one.rows).inverse();
  fixed.topLeftCorner(one.rows, one.rows) = colour * colour.transpose();
  return fixed;
}

bool MeasurementKind::shows(Channel channel, const Measurement& one) const {
  if (facts_.stream == RecordingStream::drive)
    return effects::acts_on(channel) != effects::ActsOn::views;
  if (effects::acts_on(channel) != effects::ActsOn::views) return false;
  if (effects::record_of(channel).reading) return !reading_variance(channel, one).isZero(0.0);
  switch (facts_.stream) {
    case RecordingStream::sightings:
      return effects::acts_on_sightings(channel);
    case RecordingStream::truth:
      return effects::acts_on_truth(channel);
    case RecordingStream::fixes:
      return effects::acts_on_fixes(channel);
    case RecordingStream::loops:
      return effects::acts_on_loops(channel);
    case RecordingStream::drive:
    case RecordingStream::survey:
      break;
  }
  return false;
}

Matrix4 MeasurementKind::reading_variance(Channel channel, const Measurement& one) const {
  Matrix4 variance = Matrix4::Zero();
  for (Eigen::Index row = 0; row < one.rows; ++row) {
    if (noise(row) == effects::record_of(channel).noise_source) variance(row, row) = 1.0;
  }
  return variance;
}

effects::ViewVector MeasurementKind::unit_view(Channel channel, const Measurement&, double speed,
                                               double turn_rate) const {
  return effects::view_pattern(channel, 1.0, speed, turn_rate).vector();
}

std::optional<Vector2> MeasurementKind::seen_from(const Measurement&, const Pose&,
                                                  const effects::ViewPattern&) const {
  return std::nullopt;
}

Eigen::Matrix<double, 2, 4> MeasurementKind::seen_by_rows(const Measurement&, const Pose&,
                                                          const effects::ViewPattern&) const {
  return Eigen::Matrix<double, 2, 4>::Identity();
}

double MeasurementKind::missed(const Measurement& one, const Pose& pose, const Vector2& landmark,
                               const effects::ViewPattern& view) const {
  const std::optional<Vector2> seen = seen_from(one, pose, view);
  return seen ? (landmark - *seen).norm() : kAbsent;
}

Eigen::MatrixXd MeasurementKind::slack(const Measurement& one, const MeasurementRows&,
                                       double) const {
  return Eigen::MatrixXd::Zero(one.rows, one.rows);
}

std::vector<NamedResidual> MeasurementKind::residuals(int) const {
  return {};
}

void MeasurementKind::draw(const Vector4&, const Noise&, statistics::NormalDraws&,
                           Sighting&) const {}

}  // namespace trussmap::estimation
