// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How well a model predicts legs that it has not seen.
//
//   legs, numbered through all sessions:   0 1 2 3 4 | 5 6 7 8 9 | 10 ...      blocks of five
//   held out, share 0.3:                   blocks 3, 6, 9, 13, ...: by the number alone
//
// Landmark positions and coefficients come from the other legs (survey, truth). A held-out leg is
// predicted one step ahead: a Kalman filter follows the robot with all that it measured up to the
// leg's start, then with wheels and compass alone to its end, which is compared with where its
// landmark is (its truth row, where there are no sightings).
//
//   start landmark as sighted o----------------> * end landmark as predicted
//                              \  stretch s, orientation     | arrival error
//                               '--------------------------> x where it is (s0, theta0)
#pragma once

#include "fit/model_fit.hpp"

#include <string>
#include <vector>

namespace trussmap {

/// A leg of the problem: between two measurements of the same session (sightings of the stops'
/// references, or truth rows).
struct LegSpan {
  int session = 0;
  TimeSpan time;
  std::size_t from = 0;  ///< measurement
  std::size_t to = 0;    ///< measurement
  bool held_out = false;
};

struct LegOptions {
  double min_drive = 0.25;  ///< m: legs between sightings are at least this long
  double leg = 1.0;         ///< m: legs between truth rows reach this
  double share = 0.3;       ///< of the legs held out, in [0, 1)
};

/// Legs of a problem, in order.
[[nodiscard]] std::vector<LegSpan> leg_spans(const std::vector<Recording>& recordings,
                                             const RecordingProblem& problem,
                                             const LegOptions& options = {});

struct LegPrediction {
  std::size_t leg = 0;  ///< of leg_spans
  std::string from;     ///< landmarks; empty for truth rows
  std::string to;
  double t = 0.0;                           ///< s, at its end
  Vector2 arrival_error = Vector2::Zero();  ///< predicted - true, m
  double stretch_error = 0.0;               ///< |s - s0|/s0
  double orientation_error = 0.0;           ///< |theta - theta0|, rad
  bool has_chord = true;  ///< false: shorter than 0.1 m, counts for the arrival only
};

struct HeldOut {
  std::vector<LegPrediction> legs;
  double arrival_rms = 0.0;        ///< m; 0 without legs
  double stretch_error = 0.0;      ///< mean
  double orientation_error = 0.0;  ///< mean, rad
};

/// One step of the filter, as it would move with further effects:
///   s' = A s + B c + L dl     s    what one unit of a coefficient moves the estimate by
///                             c    the measurement's whitened rows by the coefficient
///                             dl   what it moves the measurement's landmark by
struct FilterStep {
  std::ptrdiff_t measurement = -1;  ///< -1: a new session begins
  Matrix3 A = Matrix3::Identity();
  Eigen::Matrix<double, 3, 4> B = Eigen::Matrix<double, 3, 4>::Zero();
  Eigen::Matrix<double, 3, 2> L = Eigen::Matrix<double, 3, 2>::Zero();
  int landmark = -1;
};

/// The held-out legs of a model, and how their predictions would move with further effects.
class HeldOutLegs {
 public:
  /// Starts from a fit of the model to all legs. Its coefficients are estimated anew without the
  /// held-out legs (those that cannot be stay as they are); legs to landmarks that neither another
  /// leg sees nor a survey knows are passed over. Throws like fit_model.
  HeldOutLegs(const std::vector<Recording>& recordings, const ModelFit& fit,
              const ModelFitOptions& options, const LegOptions& legs = {});

  [[nodiscard]] HeldOut metrics() const { return moved(Eigen::VectorXd()); }

  /// What one unit of further coefficients does, to first order, from their whitened columns over
  /// all measurements (ColumnBuilder) and what they move the landmarks by (two rows each): per leg
  /// six rows, of the arrival error, the predicted chord and the true one.
  [[nodiscard]] Eigen::MatrixXd slopes(const Eigen::MatrixXd& columns,
                                       const Eigen::MatrixXd& landmarks) const;
  /// Figures with the legs' numbers moved by that much (empty: not at all).
  [[nodiscard]] HeldOut moved(const Eigen::VectorXd& change) const;
  /// Whether columns of this problem are columns of the legs' problem too: not after a delay has
  /// changed the order of sightings.
  [[nodiscard]] bool same_layout(const RecordingProblem& problem) const;

 private:
  /// A leg's first or last measurement: how what it sees moves.
  struct End {
    std::size_t measurement = 0;
    Eigen::Matrix<double, 2, 4> by_rows = Eigen::Matrix<double, 2, 4>::Zero();
    Eigen::Matrix<double, 2, 3> by_pose = Eigen::Matrix<double, 2, 3>::Zero();
    Matrix2 by_landmark = Matrix2::Zero();
    int landmark = -1;
  };
  struct Leg {
    LegPrediction told;
    Vector2 predicted = Vector2::Zero();
    Vector2 chord = Vector2::Zero();
    std::size_t after = 0;  ///< steps of the filter
    std::vector<FilterStep> ahead;
    End from;
    End to;
  };

  [[nodiscard]] static End end_of(const RecordingProblem& problem, std::size_t measurement,
                                  const Pose& pose, const ViewPattern& view,
                                  const Eigen::Matrix<double, 4, 3>& by_pose,
                                  const Eigen::Matrix<double, 4, 3>& by_landmark);

  RecordingProblem problem_;
  std::vector<int> first_row_;  ///< of each measurement
  std::vector<FilterStep> steps_;
  std::vector<Leg> legs_;
};

/// Figures of HeldOutLegs.
[[nodiscard]] HeldOut predict_held_out(const std::vector<Recording>& recordings,
                                       const ModelFit& fit, const ModelFitOptions& options,
                                       const LegOptions& legs = {});

}  // namespace trussmap
