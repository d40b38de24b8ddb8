// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The best map of all that was recorded: landmarks, poses and coefficients of least chi^2.
//
//   recordings --make_problem--> problem --start_of--> start --descend--> adjustment
//
// The optimum is the usual one of Gauss-Newton with damping, from a start that is laid down
// landmark by landmark (recording_start.hpp). Uncertainties are those of the linearised problem at
// the optimum, for the noise that the model states.
//
// What fails, as SolveErrors in the user's words: sessions that nothing ties together, a landmark
// or a pose that its measurements leave free, a coefficient that the motion cannot determine.
// Nothing is hidden by damping.
#pragma once

#include "estimation/effect_parameters.hpp"
#include "estimation/recording_problem.hpp"
#include "trussmap/error.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace trussmap::estimation {

struct RecordingAdjustment;

struct RecordingAdjustmentOptions {
  int max_iterations = 100;
  double tolerance = 1e-12;  ///< relative decrease of chi^2 that a next step may still promise
  /// With a gate, sightings whose squared whitened error exceeds it at the best fit of the others
  /// are left out: 16 for one right sighting in 3000 (chi^2, 2 dof).
  std::optional<double> gate;
  /// Share of the sightings: where more would be left out, the gate is widened, at last to none
  /// (recording_robust.hpp).
  double most_left_out = 1.0;
  /// With a gate: an adjustment of the same measurements that the state comes from. Its gate holds
  /// on, and what it left out is looked at again instead of being found anew.
  const RecordingAdjustment* near = nullptr;
  Eigen::VectorXd coefficients;  ///< to start from, the unknown ones; empty: 0
  /// Else landmark_covariances, landmark_sds and orientation_sds stay empty.
  bool landmark_uncertainties = true;
};

struct RecordingAdjustment {
  RecordingState state;
  std::vector<Matrix2> landmark_covariances;  ///< m^2, map frame; zero where held
  /// How far each landmark is from the truth after the best rotation and translation of them all,
  /// root mean square, m: what does not depend on what is held.
  std::vector<double> landmark_sds;
  /// rad, of each orientation in the map frame; NaN where every yaw of it was left out.
  std::vector<double> orientation_sds;
  Eigen::VectorXd coefficients;  ///< the unknown ones
  Eigen::MatrixXd coefficient_covariance;
  double chi2 = 0.0;     ///< of the measurements kept, and the coefficients' priors
  int dof = 0;           ///< measured values kept less unknowns
  double p_value = 1.0;  ///< chance of a chi^2 as large, if the model is right
  int iterations = 0;
  double gradient_norm = 0.0;  ///< 2-norm of the gradient of chi^2, 1/m and 1/rad
  bool converged = false;
  std::vector<int> left_out;  ///< measurements, ascending
  double gate_widened =
      1.0;  ///< by this factor (in sds), lest too many are left out; infinity: none
};

/// Coefficients that the motion cannot determine.
class UndeterminedError : public SolveError {
 public:
  UndeterminedError(const std::string& what, std::vector<int> coefficients)
      : SolveError(what), coefficients_(std::move(coefficients)) {}

  /// Places among the unknown ones, ascending.
  [[nodiscard]] const std::vector<int>& coefficients() const { return coefficients_; }

 private:
  std::vector<int> coefficients_;
};

/// Throws SolveError as said above.
[[nodiscard]] RecordingAdjustment adjust(const RecordingProblem& problem,
                                         const EffectParameters& border = {},
                                         const RecordingAdjustmentOptions& options = {});

/// The same from a start of one's own.
[[nodiscard]] RecordingAdjustment adjust_from(const RecordingState& start,
                                              const RecordingProblem& problem,
                                              const EffectParameters& border = {},
                                              const RecordingAdjustmentOptions& options = {});

/// A weight per measurement: 0 for those left out, 1 for the others.
[[nodiscard]] std::vector<double> weights_without(const std::vector<int>& left_out,
                                                  std::size_t measurements);

/// In words: landmarks of which there are ranges alone, all from about one line, so that they may
/// as well lie at their mirror images.
[[nodiscard]] std::vector<std::string> mirror_warnings(const RecordingProblem& problem,
                                                       const RecordingAdjustment& adjustment);

/// Fills in the uncertainties of landmarks and orientations of an adjustment without them.
void add_landmark_uncertainties(const RecordingProblem& problem, const EffectParameters& border,
                                RecordingAdjustment& adjustment);

/// Of each pose alone: (x, y, heading), map frame, zero where held.
[[nodiscard]] std::vector<Matrix3> pose_covariances(const RecordingProblem& problem,
                                                    const EffectParameters& border,
                                                    const RecordingAdjustment& adjustment);

/// Joint covariance of landmarks and poses (nodes, in the order given: 2 or 3 rows each) and,
/// after them, all coefficients; map frame, zero where held.
[[nodiscard]] Eigen::MatrixXd joint_covariance(const RecordingProblem& problem,
                                               const EffectParameters& border,
                                               const RecordingAdjustment& adjustment,
                                               const std::vector<int>& nodes);

}  // namespace trussmap::estimation
