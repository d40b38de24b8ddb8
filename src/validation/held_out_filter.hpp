// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A Kalman filter that follows the robot through one session, with the map as known, and how its
// estimate would move with further effects.
#pragma once

#include "estimation/effect_parameters.hpp"
#include "estimation/measurement_rows.hpp"
#include "estimation/recording_problem.hpp"

#include <vector>

namespace trussmap::validation {

/// One step of the filter, as it would move with further effects:
///   s' = A s + B c + L dl     s    what one unit of a coefficient moves the estimate by
///                             c    the measurement's whitened rows by the coefficient
///                             dl   what it moves the measurement's landmark by, or of a yaw the
///                                  landmark's orientation (in the first column of L)
struct FilterStep {
  std::ptrdiff_t measurement = -1;  ///< -1: a new session begins
  Matrix3 A = Matrix3::Identity();
  Eigen::Matrix<double, 3, 4> B = Eigen::Matrix<double, 3, 4>::Zero();
  Eigen::Matrix<double, 3, 2> L = Eigen::Matrix<double, 3, 2>::Zero();
  int seen = -1;  ///< node
};

class HeldOutFilter {
 public:
  /// Keeps references to all but the map, whose unknown landmarks and orientations are NaN.
  HeldOutFilter(const estimation::RecordingProblem& problem,
                const estimation::EffectParameters& border, const Eigen::VectorXd& offsets,
                const estimation::RecordingState& map, const std::vector<Matrix2>& map_covariances,
                const std::vector<double>& orientation_variances)
      : effects_(estimation::summed_patterns(border, offsets, problem.sessions.size())),
        problem_(problem),
        border_(border),
        offsets_(offsets),
        state_(map),
        covariances_(map_covariances),
        orientation_variances_(orientation_variances) {}

  void start(int node, const Pose& pose);
  [[nodiscard]] const Pose& pose(int node) const {
    return state_.poses[idx(node - problem_.landmark_count())];
  }
  /// Of the present pose: x and y, m^2, heading, rad^2.
  [[nodiscard]] const Matrix3& pose_covariance() const { return P_; }
  /// Of a landmark (2 x 2, m^2) or an orientation (1 x 1, rad^2).
  [[nodiscard]] Eigen::MatrixXd covariance(int node) const;
  /// Along a segment: its compass innovation first, which shares noise with its motion.
  FilterStep drive(std::size_t segment);
  /// A sighting of a known landmark, a yaw of one with a known orientation, or a truth row.
  FilterStep see(std::size_t measurement);
  /// What a sighting or truth row says at the present estimate, of its pose.
  [[nodiscard]] estimation::MeasurementRows rows(std::size_t measurement) const;

 private:
  [[nodiscard]] bool is_known(int node) const;
  Pose& at(int node) { return state_.poses[idx(node - problem_.landmark_count())]; }

  std::vector<std::vector<effects::DrivePattern>> effects_;  ///< of each session, together
  const estimation::RecordingProblem& problem_;
  const estimation::EffectParameters& border_;
  const Eigen::VectorXd& offsets_;
  estimation::RecordingState state_;
  const std::vector<Matrix2>& covariances_;
  const std::vector<double>& orientation_variances_;
  Matrix3 P_ = Matrix3::Zero();
};

}  // namespace trussmap::validation
