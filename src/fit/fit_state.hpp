// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// All that is known of a model fitted to recordings (trussmap/fit_model.hpp), and the fit.
//
//   model --effect_columns--> border --adjust--> state, coefficients --fitted_paths--> paths
//             ^                                                                          |
//             '--------- shapes that speak of heading, x, y; delays --------------------'
//
// Shapes see the path of the fit itself, so the two are repeated in turn until the coefficients
// stay. Time stamps are moved back by a delay before each round.
//
// Nothing is fitted that the data cannot show: a coefficient keeps its value, and is named, where
// no measurement tells it from the unknowns, or too little does (kLeastShare, kLargestUncertainty).
#pragma once

#include "estimation/recording_adjustment.hpp"
#include "fit/effect_columns.hpp"
#include "trussmap/fit_model.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::fitting {

struct FitterOptions {
  bool fit_effects = true;  ///< as FitOptions
  /// What is left out is given in the recordings' own times; delays move it with its sightings.
  estimation::ProblemOptions problem;
  std::optional<double> gate;  ///< against wrong sightings, as RecordingAdjustmentOptions
  double most_left_out = 1.0;  ///< by the gate, as RecordingAdjustmentOptions
  /// Frees the systematic errors that nearly every robot has (common_errors.hpp): they come after
  /// the model's effects, and are fitted whether or not those are.
  bool free_common_errors = false;
  /// Segments linearised at the noise that the fit believes (segment_noise.hpp), else along the
  /// path as recorded.
  bool relinearise = true;
  bool landmark_uncertainties = true;  ///< as RecordingAdjustmentOptions
  bool paths = true;  ///< else they are only laid where the model's effects need them
  int max_rounds = 30;
  double still = 1e-6;  ///< change of a coefficient that ends the rounds, in sds
  /// Change of a segment's value by the noise believed that still goes on, in sds. The rounds end
  /// by the worst segment of all recordings: fits of some and of all are the same to about this.
  double still_offset = 1e-2;
  /// Start from this fit of the same recordings (to more or fewer of their measurements).
  const FitState* near = nullptr;
};

struct FitState {
  Model model;  ///< with resolved effects and their coefficients
  std::vector<EffectEstimate> effects;
  std::vector<DrivenRecording> recordings;  ///< as fitted: moved back by the delays
  estimation::RecordingProblem problem;
  estimation::ProblemOptions
      used;               ///< by which the problem was made; spans in the times of `recordings`
  EffectColumns columns;  ///< known effects held, the others free, at `coefficients`
  std::size_t common_errors = 0;  ///< how many of the last effects are freed common errors
  estimation::RecordingAdjustment adjustment;
  std::vector<SessionPath> paths;  ///< may be empty where the options ask for none
  bool settled = true;             ///< shapes and path agree
  int rounds = 0;                  ///< of shapes and path in turn
  std::string still_moving;        ///< in words, what the last round moved; empty where it settled
};

/// Throws SolveError as adjust does (but not for coefficients), std::invalid_argument on effects
/// that cannot be applied.
[[nodiscard]] FitState fit_recordings(const std::vector<DrivenRecording>& recordings,
                                      const Model& model, const FitterOptions& options = {});

[[nodiscard]] FitterOptions fitter_options(const FitOptions& options);

/// What of it everybody may see, the rest behind ModelFit::state.
[[nodiscard]] ModelFit model_fit(FitState state, const FitOptions& options);

/// Another model of the same recordings, by the same options, started from this fit.
[[nodiscard]] ModelFit refit(const std::vector<DrivenRecording>& recordings, const Model& model,
                             const ModelFit& near);

/// What the gate left out of it, in the user's words.
[[nodiscard]] std::vector<std::string> left_out_texts(const FitState& fit);

/// How many coefficients were estimated.
[[nodiscard]] int estimated_coefficients(const FitState& fit);

/// All that was measured, what the fit leaves out included.
[[nodiscard]] estimation::RecordingProblem whole_problem(const FitState& fit);

/// Where the fit has the landmarks, m, map frame.
[[nodiscard]] std::map<std::string, Vector2> landmark_places(const FitState& fit);

/// All effect parameters less their references.
[[nodiscard]] Eigen::VectorXd offsets_of(const FitState& fit);

}  // namespace trussmap::fitting
