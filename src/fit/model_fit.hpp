// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A model fitted to recordings: map, poses and, where wanted, the coefficients of its effects.
//
//   model --effect_columns--> border --adjust--> state, coefficients --fitted_paths--> paths
//             ^                                                                          |
//             '--------- shapes that speak of heading, x, y; delays --------------------'
//
// Shapes see the path of the fit itself, so the two are repeated in turn until the coefficients
// stay. A delay is taken out of the time stamps before each round.
//
// Nothing is fitted that the data cannot show: a coefficient is left as it was, and named, where no
// measurement tells it from the unknowns, or too little does (kLeastShare, kLargestUncertainty).
#pragma once

#include "estimation/recording_adjustment.hpp"
#include "fit/effect_columns.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

struct ModelFit;

struct ModelFitOptions {
  bool fit_effects = true;  ///< false: coefficients stay as the model has them (0 where absent)
  /// What is left out is given in the recordings' own times; delays move it with its sightings.
  ProblemOptions problem;
  std::optional<double> gate;  ///< against wrong sightings, as RecordingAdjustmentOptions
  int max_rounds = 30;
  double still = 1e-6;  ///< change of a coefficient that ends the rounds, in sds
  /// Start from this fit of the same recordings (to more or fewer of their measurements).
  const ModelFit* near = nullptr;
};

struct EffectEstimate {
  Effect effect;           ///< with coefficients
  std::vector<double> sd;  ///< standard errors; 0 where held, infinite where not fitted
  std::vector<std::string> not_fitted;  ///< why, one line per coefficient that is not
};

struct ModelFit {
  Model model;  ///< its effects with their coefficients
  std::vector<EffectEstimate> effects;
  std::vector<Recording> recordings;  ///< as fitted: delays taken out
  RecordingProblem problem;
  EffectColumns columns;  ///< known effects held, the others free, at `coefficients`
  RecordingAdjustment adjustment;
  std::vector<SessionPath> paths;
  bool settled = true;  ///< shapes and path agree
};

/// Throws SolveError as adjust does (but not for coefficients), std::invalid_argument on effects
/// that cannot be applied.
[[nodiscard]] ModelFit fit_model(const std::vector<Recording>& recordings, const Model& model,
                                 const ModelFitOptions& options = {});

/// Where the fit has the landmarks, m, map frame.
[[nodiscard]] std::map<std::string, Vector2> landmark_places(const ModelFit& fit);

/// All coefficients of the border less their references.
[[nodiscard]] Eigen::VectorXd offsets_of(const ModelFit& fit);

}  // namespace trussmap
