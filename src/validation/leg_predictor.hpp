// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Predictions of held-out legs: a filter follows the robot through all sessions, and at the start
// of each held-out leg a copy of it drives ahead to the leg's end. What the fit to all legs leaves
// out it does not take in. A leg is passed over whose end such a sighting is, if the robot is
// predicted to see it where another landmark is: any model would be judged by its name alone.
#pragma once

#include "fit/fit_state.hpp"
#include "trussmap/held_out.hpp"
#include "validation/held_out_filter.hpp"
#include "validation/leg_spans.hpp"

#include <map>
#include <optional>
#include <set>
#include <vector>

namespace trussmap::validation {

/// All measurements of all legs, by the model and the map of a fit to some of them (the training).
struct TrainedModel {
  std::vector<DrivenRecording> recordings;  ///< moved back by the training's delays
  estimation::RecordingProblem problem;
  estimation::EffectParameters effects;
  Eigen::VectorXd offsets;           ///< of the effects' coefficients from their references
  estimation::RecordingState state;  ///< landmarks and orientations that are not known: NaN
  std::vector<Matrix2> covariances;  ///< of the landmarks, m^2
  std::vector<double> orientation_variances;  ///< rad^2
  std::set<std::size_t> left_out;             ///< measurements that the fit to all leaves out
};

/// Landmarks that the training has not are where a survey in use has them.
[[nodiscard]] TrainedModel trained_model(const fitting::FitState& training,
                                         const std::vector<DrivenRecording>& recordings,
                                         const estimation::ProblemOptions& options);

/// A leg's first or last measurement: how what it sees moves.
struct LegEnd {
  std::size_t measurement = 0;
  Eigen::Matrix<double, 2, 4> by_rows = Eigen::Matrix<double, 2, 4>::Zero();
  Eigen::Matrix<double, 2, 3> by_pose = Eigen::Matrix<double, 2, 3>::Zero();
  Matrix2 by_landmark = Matrix2::Zero();
  int landmark = -1;
};

struct PredictedLeg {
  LegPrediction prediction;
  Vector2 predicted = Vector2::Zero();  ///< chord, m
  Vector2 chord = Vector2::Zero();      ///< true, m
  std::size_t after = 0;                ///< steps of the filter
  std::vector<FilterStep> ahead;
  LegEnd from;
  LegEnd to;
  bool misread = false;  ///< its end has another landmark's name
};

class LegPredictor {
 public:
  /// Keeps references.
  LegPredictor(const TrainedModel& trained, const std::vector<LegSpan>& legs);

  void run();

  [[nodiscard]] std::vector<FilterStep> take_steps() { return std::move(steps_); }
  [[nodiscard]] std::vector<PredictedLeg> take_legs() { return std::move(predicted_); }

 private:
  /// All measurements at a pose, and the segment that leaves it.
  struct PoseEvents {
    std::vector<std::size_t> views;
    int segment = -1;
  };

  void begin_session(std::size_t pose);
  /// A few that end at another landmark than the one named there judge no model.
  void pass_over_misread();
  [[nodiscard]] bool is_misread(std::size_t measurement, const Vector2& seen_at) const;
  [[nodiscard]] std::optional<PredictedLeg> predicted(std::size_t leg) const;
  [[nodiscard]] LegEnd end_of(std::size_t measurement, const HeldOutFilter& filter) const;
  /// m, root mean square of the arrival error.
  [[nodiscard]] static double expected_error(const LegEnd& end, const HeldOutFilter& filter);
  [[nodiscard]] std::optional<Vector2> seen_by(std::size_t measurement,
                                               const HeldOutFilter& filter) const;
  /// NaN where it is not known.
  [[nodiscard]] Vector2 true_place(const estimation::Measurement& measurement) const;

  const TrainedModel& trained_;
  const estimation::RecordingProblem& problem_;
  const std::vector<LegSpan>& legs_;
  std::vector<PoseEvents> events_;
  std::map<int, std::vector<std::size_t>> starting_;  ///< node -> held-out legs
  HeldOutFilter filter_;
  std::vector<FilterStep> steps_;
  std::vector<PredictedLeg> predicted_;
};

}  // namespace trussmap::validation
