// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Held-out legs (trussmap/held_out.hpp), and how their predictions would move with further effects.
#pragma once

#include "fit/fit_state.hpp"
#include "trussmap/held_out.hpp"
#include "validation/leg_predictor.hpp"

#include <memory>
#include <vector>

namespace trussmap::validation {

/// The held-out legs of a model, and how their predictions would move with further effects.
class HeldOutLegs {
 public:
  /// Starts from a fit of the model to all legs. Its coefficients are estimated anew without the
  /// held-out legs (those that cannot be stay as they are); legs to landmarks that neither another
  /// leg sees nor a survey knows are passed over. Throws like fit_model.
  HeldOutLegs(const std::vector<DrivenRecording>& recordings, const fitting::FitState& fit,
              const fitting::FitterOptions& options, const LegOptions& legs = {});
  HeldOutLegs(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
              const LegOptions& legs)
      : HeldOutLegs(recordings, *fit.state, fitting::fitter_options(fit.options), legs) {}

  [[nodiscard]] HeldOut metrics() const { return moved(Eigen::VectorXd()); }

  /// What one unit of an effect's coefficients does, to first order, from their whitened columns
  /// over the fit's measurements (ColumnBuilder) and what they move its landmarks by (two rows
  /// each, then one for each orientation): per leg six rows, of the arrival error, the predicted
  /// chord and the true one.
  [[nodiscard]] Eigen::MatrixXd slopes(const Effect& effect, const Eigen::MatrixXd& columns,
                                       const Eigen::MatrixXd& landmarks) const;
  /// Metrics with the legs' predictions moved by that much (empty: not at all).
  [[nodiscard]] HeldOut moved(const Eigen::VectorXd& change) const;
  /// Whether slopes can be told: not after a delay has changed the order of sightings.
  [[nodiscard]] bool has_slopes() const { return has_slopes_; }

 private:
  class OwnColumns;

  [[nodiscard]] bool same_layout(const estimation::RecordingProblem& problem) const;
  [[nodiscard]] Eigen::MatrixXd slopes(const Eigen::MatrixXd& columns,
                                       const Eigen::MatrixXd& landmarks) const;

  estimation::RecordingProblem problem_;
  bool has_slopes_ = false;
  std::shared_ptr<OwnColumns> own_;  ///< where the fit has not all measurements that legs pass
  std::vector<int> first_row_;       ///< of each measurement
  std::vector<FilterStep> steps_;
  std::vector<PredictedLeg> legs_;
};

/// The figures, without the legs.
[[nodiscard]] inline HeldOutMetrics metrics_of(const HeldOutMetrics& metrics) {
  return metrics;
}

}  // namespace trussmap::validation
