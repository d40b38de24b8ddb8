// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Steps and covariances from a recording system's normal equations.
#include "estimation/recording_system.hpp"
#include "linalg/damped_step.hpp"
#include "linalg/dense.hpp"

#include <cmath>

#include <Eigen/LU>

namespace trussmap::estimation {

void RecordingSystem::build_schur(double damping) {
  A_inverse_B_ = B_.cols() > 0 ? normal_.solve(B_) : B_;
  schur_ = D_ - B_.transpose() * A_inverse_B_;
  schur_ = (0.5 * (schur_ + schur_.transpose())).eval();
  schur_.diagonal() += damping * D_.diagonal();
  if (schur_.cols() == 0) return;
  const linalg::DenseCholesky factor(schur_);
  if (!factor.positive_definite()) throw linalg::NotPositiveDefinite(-1);
  schur_inverse_ = factor.inverse();
}

RecordingSystem::Step RecordingSystem::solve_step(double damping) {
  linalg::factorise_damped(normal_, damping);
  build_schur(damping);
  Step step;
  step.nodes = -gradient_;
  normal_.solve_in_place(step.nodes);
  step.coefficients = Eigen::VectorXd::Zero(B_.cols());
  if (B_.cols() > 0) {
    step.coefficients = schur_inverse_ * (-border_gradient_ - B_.transpose() * step.nodes);
    step.nodes -= A_inverse_B_ * step.coefficients;
  }
  step.predicted =
      linalg::predicted_decrease(step.nodes, gradient_, normal_.diagonal(), damping) +
      linalg::predicted_decrease(step.coefficients, border_gradient_, D_.diagonal(), damping);
  return step;
}

RecordingState RecordingSystem::moved(const RecordingState& state, const Step& step) const {
  RecordingState result = state;
  const auto states = static_cast<Eigen::Index>(problem_.noise_states.size());
  if (result.noise.size() != states) result.noise = Eigen::VectorXd::Zero(states);
  for (Eigen::Index k = 0; k < states; ++k) {
    result.noise[k] += step.nodes[normal_.offset(state_node(static_cast<int>(k)))];
  }
  for (int node = 0; node < problem_.nodes(); ++node) {
    if (normal_.size(node) == 0) continue;
    const int at = normal_.offset(node);
    if (problem_.is_landmark(node)) {
      result.landmarks[idx(node)] += step.nodes.segment<2>(at);
    } else if (problem_.is_orientation(node)) {
      result.orientations[idx(node - problem_.pose_end())] += step.nodes[at];
    } else {
      Pose& pose = result.poses[idx(node - problem_.landmark_count())];
      pose.x += step.nodes[at];
      pose.y += step.nodes[at + 1];
      pose.heading += step.nodes[at + 2];
    }
  }
  return result;
}

void RecordingSystem::factorise() {
  if (normal_.unknowns() > 0) normal_.factorise();
  build_schur(0.0);
}

Eigen::MatrixXd RecordingSystem::solve(const Eigen::MatrixXd& b) const {
  const Eigen::Index n = normal_.unknowns();
  Eigen::MatrixXd x(b.rows(), b.cols());
  if (b.cols() == 0) return x;
  x.topRows(n) = normal_.solve(b.topRows(n));
  if (B_.cols() > 0) {
    x.bottomRows(B_.cols()) =
        schur_inverse_ * (b.bottomRows(B_.cols()) - B_.transpose() * x.topRows(n));
    x.topRows(n) -= A_inverse_B_ * x.bottomRows(B_.cols());
  }
  return x;
}

Eigen::MatrixXd RecordingSystem::joint_covariance(const std::vector<int>& nodes) const {
  const Eigen::Index n = normal_.unknowns();
  Eigen::Index size = B_.cols();
  for (const int node : nodes) size += problem_.size_of(node);
  Eigen::MatrixXd selection = Eigen::MatrixXd::Zero(n + B_.cols(), size);
  Eigen::Index at = 0;
  for (const int node : nodes) {
    const int width = problem_.size_of(node);
    for (int k = 0; k < width && k < normal_.size(node); ++k) {
      const bool held =
          node == problem_.pose_node(0) && (k == 2 ? gauge_.hold_heading : gauge_.hold_position);
      if (!held) selection(normal_.offset(node) + k, at + k) = 1.0;
    }
    at += width;
  }
  selection.bottomRightCorner(B_.cols(), B_.cols()).setIdentity();
  const Eigen::MatrixXd covariance = selection.transpose() * solve(selection);
  return 0.5 * (covariance + covariance.transpose());
}

template <int Size>
std::vector<Eigen::Matrix<double, Size, Size>> RecordingSystem::covariances(int first,
                                                                            int count) const {
  const Eigen::MatrixXd blocks = normal_.inverse_blocks();
  std::vector<Eigen::Matrix<double, Size, Size>> result(idx(count),
                                                        Eigen::Matrix<double, Size, Size>::Zero());
  for (int k = 0; k < count; ++k) {
    const int node = first + k;
    if (normal_.size(node) == 0) continue;
    const Eigen::Index at = normal_.offset(node);
    auto& covariance = result[idx(k)];
    covariance = blocks.block<Size, Size>(0, at);
    if (B_.cols() == 0) continue;
    const auto own = A_inverse_B_.middleRows(at, Size);
    covariance += own * schur_inverse_ * own.transpose();
  }
  return result;
}

std::vector<Matrix2> RecordingSystem::landmark_covariances() const {
  return covariances<2>(0, problem_.landmark_count());
}

std::vector<double> RecordingSystem::orientation_variances() const {
  std::vector<double> result;
  const auto count = static_cast<int>(problem_.oriented.size());
  result.reserve(problem_.oriented.size());
  for (const auto& one : covariances<1>(problem_.pose_end(), count)) result.push_back(one(0, 0));
  return result;
}

std::vector<Matrix3> RecordingSystem::pose_covariances() const {
  std::vector<Matrix3> result =
      covariances<3>(problem_.landmark_count(), static_cast<int>(problem_.poses.size()));
  // The diagonal of what is held is there for the sake of the solution alone.
  if (gauge_.hold_heading) {
    result.front().row(2).setZero();
    result.front().col(2).setZero();
  }
  if (gauge_.hold_position) {
    result.front().topRows<2>().setZero();
    result.front().leftCols<2>().setZero();
  }
  return result;
}

Eigen::MatrixXd RecordingSystem::landmark_covariance_times(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd lifted = Eigen::MatrixXd::Zero(normal_.unknowns() + B_.cols(), b.cols());
  for (int node = 0; node < problem_.landmark_count(); ++node) {
    if (normal_.size(node) == 0) continue;
    lifted.middleRows(normal_.offset(node), 2) = b.middleRows(Eigen::Index{2} * node, 2);
  }
  const Eigen::MatrixXd solved = solve(lifted);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(b.rows(), b.cols());
  for (int node = 0; node < problem_.landmark_count(); ++node) {
    if (normal_.size(node) == 0) continue;
    result.middleRows(Eigen::Index{2} * node, 2) = solved.middleRows(normal_.offset(node), 2);
  }
  return result;
}

Eigen::MatrixXd RecordingSystem::coefficient_covariance() const {
  return B_.cols() == 0 ? B_.topRows(0) : schur_inverse_;
}

double RecordingSystem::log_determinant() const {
  double sum = normal_.unknowns() > 0 ? normal_.log_determinant() : 0.0;
  if (schur_.cols() == 0) return sum;
  return sum + linalg::DenseCholesky(schur_).log_determinant();
}

double RecordingSystem::gradient_norm() const {
  return 2.0 * std::hypot(gradient_.norm(), border_gradient_.norm());
}

Eigen::MatrixXd RecordingSystem::scaled_schur() const {
  const Eigen::VectorXd scale = D_.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  // Not D - B' A^-1 B, whose difference loses all digits where it matters, but what is left of M
  // when the nodes have taken what they can.
  const Eigen::MatrixXd left = M_ - times(A_inverse_B_);
  Eigen::MatrixXd schur = left.transpose() * left;
  for (Eigen::Index k = 0; k < schur.cols(); ++k) {
    const double prior_sd = border_[idx(unknown_[idx(k)])].prior_sd;
    schur(k, k) += 1.0 / (prior_sd * prior_sd);
  }
  return scale.asDiagonal() * schur * scale.asDiagonal();
}

}  // namespace trussmap::estimation
