// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/pose_reckoner.hpp"

#include "estimation/measurement_rows.hpp"

#include <cmath>

#include <Eigen/LU>

namespace trussmap::estimation {

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
    if (gives_pose(*one)) meet(*one);
  }
  for (const Measurement* one : seen) {
    if (correct && is_known(*one)) meet(*one);
  }
  for (const Measurement* one : seen) {
    if (locates(*one)) {
      std::optional<Vector2>& landmark = landmarks_[idx(one->to)];
      if (!landmark) landmark = one->kind->seen_from(*one, pose_, one->mounted);
    } else if (is_yaw(*one)) {
      std::optional<double>& orientation = orientations_[idx(one->to - problem_.pose_end())];
      if (!orientation)
        orientation = wrap_angle(pose_.heading + one->mounted.heading + one->value[0]);
    }
  }
}

bool PoseReckoner::is_known(const Measurement& one) const {
  if (is_sighting(one)) return landmarks_[idx(one.to)].has_value();
  if (is_yaw(one)) return orientations_[idx(one.to - problem_.pose_end())].has_value();
  return tells_of_map(one) && !gives_pose(one);
}

void PoseReckoner::meet(const Measurement& one) {
  Ends at;
  at.from = pose_;
  if (is_sighting(one)) at.landmark = *landmarks_[idx(one.to)];
  if (is_yaw(one)) at.orientation = *orientations_[idx(one.to - problem_.pose_end())];
  const MeasurementRows rows = one.kind->rows(one, at, one.value, one.mounted);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(one.rows, covariance_.cols());
  H.leftCols<3>() = rows.by_from.topRows(one.rows);
  update(H, -rows.error.head(one.rows),
         covariance_of(one) + one.kind->slack(one, rows, options_.map_sd));
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

}  // namespace trussmap::estimation
