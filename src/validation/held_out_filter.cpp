// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "validation/held_out_filter.hpp"

#include <cmath>

#include <Eigen/LU>

namespace trussmap::validation {
namespace {

constexpr double kFirstPlaceSd = 1.0;    // m: the filter's prior on its first pose
constexpr double kFirstHeadingSd = 0.3;  // rad

}  // namespace

void HeldOutFilter::start(int node, const Pose& pose) {
  at(node) = pose;
  P_ = Eigen::Vector3d(kFirstPlaceSd * kFirstPlaceSd, kFirstPlaceSd * kFirstPlaceSd,
                       kFirstHeadingSd * kFirstHeadingSd)
           .asDiagonal();
}

FilterStep HeldOutFilter::drive(std::size_t k) {
  const estimation::Measurement& segment = problem_.measurements[k];
  const estimation::SegmentMotion motion = estimation::segment_motion(
      estimation::with_effects(problem_.segments[segment.source], effects_[idx(segment.session)]));
  estimation::Matrix4 W = segment.whitener;
  for (int row = segment.rows; row < 4; ++row) W(row, row) = 1.0;
  const estimation::Matrix4 inverse = W.inverse();
  const estimation::Matrix4 C = inverse * inverse.transpose();
  using Vector6 = Eigen::Matrix<double, 6, 1>;  // pose, displacement
  Eigen::Matrix<double, 6, 6> joint = Eigen::Matrix<double, 6, 6>::Zero();
  joint.topLeftCorner<3, 3>() = P_;
  joint.bottomRightCorner<3, 3>() = C.topLeftCorner<3, 3>();
  Vector6 mean = Vector6::Zero();
  Vector6 gain = Vector6::Zero();
  if (segment.rows == 4) {
    // m - heading = its own noise, which goes with the motion's.
    Vector6 with = joint.col(2);
    with.tail<3>() -= C.topRightCorner<3, 1>();
    const double variance = P_(2, 2) + C(3, 3);
    gain = with / variance;
    // The motion's noise is that of "measured - true" here, the innovation's likewise.
    mean = gain * wrap_angle(motion.mean_heading - pose(segment.from).heading);
    joint -= gain * with.transpose();
  }
  Pose from = pose(segment.from);
  from.x += mean[0];
  from.y += mean[1];
  from.heading += mean[2];
  Pose step = motion.displacement;
  step.x += mean[3];
  step.y += mean[4];
  step.heading += mean[5];
  at(segment.to) = compose(from, step);
  Eigen::Matrix<double, 3, 6> F = Eigen::Matrix<double, 3, 6>::Zero();
  F.leftCols<3>().setIdentity();
  F.block<2, 1>(0, 2) = quarter_turn(rotation(from.heading) * step.position());
  F.block<2, 2>(0, 3) = rotation(from.heading);
  F(2, 5) = 1.0;
  P_ = F * joint * F.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();

  FilterStep slopes;
  slopes.measurement = static_cast<std::ptrdiff_t>(k);
  Eigen::Matrix<double, 6, 3> by_pose = Eigen::Matrix<double, 6, 3>::Zero();
  by_pose.topRows<3>().setIdentity();
  by_pose.col(2) -= gain;
  slopes.A = F * by_pose;
  Eigen::Matrix<double, 6, 4> by_motion = Eigen::Matrix<double, 6, 4>::Zero();
  by_motion.bottomLeftCorner<3, 3>().setIdentity();
  by_motion.col(3) += gain;
  slopes.B = -(F * by_motion * inverse);  // rows are whitened "expected - measured"
  return slopes;
}

estimation::MeasurementRows HeldOutFilter::rows(std::size_t k) const {
  const estimation::Measurement& one = problem_.measurements[k];
  return estimation::measurement_rows(problem_, one, state_, one.value,
                                      estimation::view_of(border_, offsets_, one));
}

bool HeldOutFilter::is_known(int node) const {
  if (problem_.is_orientation(node)) {
    return !std::isnan(state_.orientations[idx(node - problem_.pose_end())]);
  }
  return !std::isnan(state_.landmarks[idx(node)].x());
}

Eigen::MatrixXd HeldOutFilter::covariance(int node) const {
  if (!problem_.is_orientation(node)) return covariances_[idx(node)];
  return Eigen::MatrixXd::Constant(1, 1, orientation_variances_[idx(node - problem_.pose_end())]);
}

FilterStep HeldOutFilter::see(std::size_t k) {
  const estimation::Measurement& one = problem_.measurements[k];
  FilterStep slopes;
  slopes.measurement = static_cast<std::ptrdiff_t>(k);
  if (one.to >= 0 && !is_known(one.to)) return slopes;
  const estimation::MeasurementRows rows = this->rows(k);
  const Eigen::MatrixXd W = one.whitener.topLeftCorner(one.rows, one.rows);
  const Eigen::MatrixXd H = W * rows.by_from.topRows(one.rows);
  const Eigen::VectorXd error = W * rows.error.head(one.rows);
  Eigen::MatrixXd S = H * P_ * H.transpose() + Eigen::MatrixXd::Identity(one.rows, one.rows);
  const int size = one.to < 0 ? 0 : problem_.size_of(one.to);
  const Eigen::MatrixXd by_seen = W * rows.by_to.topLeftCorner(one.rows, size);
  if (one.to >= 0) S += by_seen * covariance(one.to) * by_seen.transpose();
  const Eigen::MatrixXd gain = P_ * H.transpose() * S.inverse();
  const Eigen::Vector3d change = -gain * error;
  Pose& pose = at(one.from);
  pose.x += change[0];
  pose.y += change[1];
  pose.heading += change[2];
  P_ = (P_ - gain * H * P_).eval();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  slopes.A -= gain * H;
  slopes.B.leftCols(one.rows) = -gain;
  slopes.seen = one.to;
  if (one.to >= 0) slopes.L.leftCols(size) = -gain * by_seen;
  return slopes;
}

}  // namespace trussmap::validation
