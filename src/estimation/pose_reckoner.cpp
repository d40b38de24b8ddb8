// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/pose_reckoner.hpp"

#include "estimation/measurement_rows.hpp"

#include <cmath>

#include <Eigen/LU>

namespace trussmap {

KnownCoefficients prior_of(const EffectParameters& border) {
  const std::vector<int> unknown = unknown_coefficients(border);
  const auto count = static_cast<Eigen::Index>(unknown.size());
  KnownCoefficients prior{Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count)};
  for (std::size_t k = 0; k < unknown.size(); ++k) {
    const double sd = border[idx(unknown[k])].prior_sd;
    const auto at = static_cast<Eigen::Index>(k);
    prior.covariance(at, at) = sd * sd;
  }
  return prior;
}

Eigen::MatrixXd covariance_of(const Measurement& one) {
  const Eigen::MatrixXd W = one.whitener.topLeftCorner(one.rows, one.rows);
  return (W.transpose() * W).inverse();
}

Vector2 offset_of(const Measurement& one) {
  switch (one.kind) {
    case MeasurementKind::view:
      return one.rows == 1 ? Vector2(one.value[0], 0.0)
                           : Vector2(one.value[0] * rotation(one.value[1]).col(0));
    case MeasurementKind::standing:
    case MeasurementKind::cartesian_view:
      return one.value.head<2>();
    default:
      return Vector2::Zero();
  }
}

void PoseReckoner::place(const Pose& pose, const Matrix3& covariance,
                         const KnownCoefficients& coefficients) {
  pose_ = pose;
  coefficients_ = coefficients.values;
  const Eigen::Index count = coefficients_.size();
  covariance_ = Eigen::MatrixXd::Zero(3 + count, 3 + count);
  covariance_.topLeftCorner<3, 3>() = covariance;
  covariance_.bottomRightCorner(count, count) = coefficients.covariance;
}

KnownCoefficients PoseReckoner::coefficients() const {
  const Eigen::Index count = coefficients_.size();
  return {coefficients_, covariance_.bottomRightCorner(count, count)};
}

PoseReckoner::Motion PoseReckoner::motion_of(const Measurement& segment) const {
  Motion result;
  result.value = segment.value;
  result.by_coefficients.setZero(4, coefficients_.size());
  if (border_.empty()) return result;
  const SegmentWithEffects with = segment_motion(problem_.segments[segment.source],
                                                 drive_patterns(border_, idx(segment.session)),
                                                 offsets_at(border_, coefficients_));
  const Pose& d = with.motion.displacement;
  result.value.head<3>() = Eigen::Vector3d(d.x, d.y, d.heading);
  if (segment.rows == 4) result.value[3] = with.motion.mean_heading;
  const std::vector<int> unknown = unknown_coefficients(border_);
  for (std::size_t k = 0; k < unknown.size(); ++k) {
    result.by_coefficients.col(static_cast<Eigen::Index>(k)) = with.derivatives.col(unknown[k]);
  }
  return result;
}

void PoseReckoner::read_compass(const Measurement& segment) {
  if (segment.rows < 4) return;
  const Motion motion = motion_of(segment);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(1, covariance_.cols());
  H(0, 2) = 1.0;
  H.rightCols(coefficients_.size()) = -motion.by_coefficients.row(3);
  Eigen::VectorXd innovation(1);
  innovation << wrap_angle(motion.value[3] - pose_.heading);
  update(H, innovation, covariance_of(segment).bottomRightCorner(1, 1));
}

void PoseReckoner::drive(const Measurement& segment) {
  const Motion motion = motion_of(segment);
  const Matrix3 T = pose_rotation(pose_.heading);
  const Vector2 step = T.topLeftCorner<2, 2>() * motion.value.head<2>();
  const Eigen::Index count = coefficients_.size();
  Eigen::MatrixXd F = Eigen::MatrixXd::Identity(3 + count, 3 + count);
  F.block<2, 1>(0, 2) = quarter_turn(step);
  F.topRightCorner(3, count) = T * motion.by_coefficients.topRows<3>();
  const Matrix3 own = covariance_of(segment).topLeftCorner(3, 3);
  covariance_ = (F * covariance_ * F.transpose()).eval();
  covariance_.topLeftCorner<3, 3>() += T * own * T.transpose();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  pose_ = {pose_.x + step.x(), pose_.y + step.y(), pose_.heading + motion.value[2]};
}

void PoseReckoner::look(const std::vector<const Measurement*>& seen, bool correct) {
  for (const Measurement* one : seen) {
    if (one->kind == MeasurementKind::truth) meet_truth(*one);
  }
  if (correct) {
    for (const Measurement* one : seen) {
      if (one->kind == MeasurementKind::fix) meet_fix(*one);
      if (is_sighting(one->kind) && landmarks_[idx(one->to)]) meet_landmark(*one);
      if (one->kind == MeasurementKind::sighting_yaw) meet_orientation(*one);
    }
  }
  for (const Measurement* one : seen) {
    if (!locates(*one)) continue;
    std::optional<Vector2>& landmark = landmarks_[idx(one->to)];
    if (!landmark) landmark = sighted(*one);
  }
  for (const Measurement* one : seen) {
    if (one->kind != MeasurementKind::sighting_yaw) continue;
    std::optional<double>& orientation = orientations_[idx(one->to - problem_.pose_end())];
    if (!orientation) orientation = wrap_angle(pose_.heading + one->value[0]);
  }
}

Vector2 PoseReckoner::sighted(const Measurement& one) const {
  return pose_.position() + rotation(pose_.heading) * offset_of(one);
}

void PoseReckoner::meet_truth(const Measurement& one) {
  Eigen::VectorXd innovation = one.value.head<3>();
  innovation -= Eigen::Vector3d(pose_.x, pose_.y, pose_.heading);
  innovation[2] = wrap_angle(innovation[2]);
  update(Eigen::MatrixXd::Identity(3, covariance_.cols()), innovation, covariance_of(one));
}

/// The antenna is taken to be at the robot, as nearly as a landmark is known.
void PoseReckoner::meet_fix(const Measurement& one) {
  Eigen::VectorXd innovation = one.value.head<2>();
  innovation -= pose_.position();
  Eigen::MatrixXd R = covariance_of(one);
  R.diagonal().array() += options_.map_sd * options_.map_sd;
  update(Eigen::MatrixXd::Identity(2, covariance_.cols()), innovation, R);
}

void PoseReckoner::meet_landmark(const Measurement& one) {
  RecordingState state;
  state.landmarks.assign(problem_.landmarks.size(), Vector2::Zero());
  Measurement here = one;
  here.from = problem_.landmark_count();
  state.landmarks[idx(one.to)] = *landmarks_[idx(one.to)];
  state.poses = {pose_};
  const MeasurementRows rows = measurement_rows(problem_, here, state, one.value, {});
  const Eigen::MatrixXd by_landmark = rows.by_to.topLeftCorner(one.rows, 2);
  const Eigen::MatrixXd R = covariance_of(one) + options_.map_sd * options_.map_sd * by_landmark *
                                                     by_landmark.transpose();
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(one.rows, covariance_.cols());
  H.leftCols<3>() = rows.by_from.topRows(one.rows);
  update(H, -rows.error.head(one.rows), R);
}

/// An orientation is as certain as the heading that it was read from.
void PoseReckoner::meet_orientation(const Measurement& one) {
  constexpr double kOrientationSd = 0.05;  // rad
  const std::optional<double>& orientation = orientations_[idx(one.to - problem_.pose_end())];
  if (!orientation) return;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(1, covariance_.cols());
  H(0, 2) = 1.0;
  Eigen::VectorXd innovation(1);
  innovation << wrap_angle(*orientation - one.value[0] - pose_.heading);
  Eigen::MatrixXd R = covariance_of(one);
  R.array() += kOrientationSd * kOrientationSd;
  update(H, innovation, R);
}

void PoseReckoner::update(const Eigen::MatrixXd& H, const Eigen::VectorXd& innovation,
                          const Eigen::MatrixXd& R) {
  const Eigen::MatrixXd S = H * covariance_ * H.transpose() + R;
  const Eigen::MatrixXd inverse = S.inverse();
  if (innovation.dot(inverse * innovation) > options_.gate) {
    doubt();
    return;
  }
  const Eigen::MatrixXd gain = covariance_ * H.transpose() * inverse;
  const Eigen::VectorXd change = gain * innovation;
  pose_.x += change[0];
  pose_.y += change[1];
  pose_.heading += change[2];
  coefficients_ += change.tail(coefficients_.size());
  covariance_ = (covariance_ - gain * H * covariance_).eval();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
}

/// After several contradictions it is the robot that is lost, not the sightings that are wrong.
void PoseReckoner::doubt() {
  constexpr double kDoubt = 0.05;  // m and rad
  covariance_.topLeftCorner<3, 3>().diagonal().array() += kDoubt * kDoubt;
}

}  // namespace trussmap
