// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A fit's unknowns, rows and effects as they would be without noise of their own: where to ask what
// the data can show at all.
//
//   state     every pose exactly where the landmarks are that it stands on (the mean of them): what
//             a robot stands on it cannot miss by a share of the map's size
//   problem   each segment's rows less their noise (fitted_path.hpp); what was measured stays
//   border    the effects' columns from those rows
//
// Only there do directions that nothing measures (the map's scale) cost nothing at all, and noise
// that a smaller map would shrink is no evidence of a scale.
#pragma once

#include "fit/effect_columns.hpp"

#include <vector>

namespace trussmap::fitting {

/// The effects' columns in a context, held and referred as in the fit.
[[nodiscard]] estimation::EffectParameters border_as_fitted(
    const Model& model, const ShapeContext& context, const estimation::EffectParameters& fitted);

struct NoiseFree {
  /// `border` and the `offsets` of its coefficients are those of the fit. Keeps a reference to the
  /// recordings.
  NoiseFree(const std::vector<DrivenRecording>& recordings, const Model& model,
            const estimation::RecordingProblem& fitted,
            const estimation::EffectParameters& fitted_border, const Eigen::VectorXd& offsets,
            const estimation::RecordingState& fitted_state);

  estimation::RecordingState state;
  std::vector<SessionPath> paths;
  estimation::RecordingProblem problem;
  ShapeContext context;
  estimation::EffectParameters border;  ///< held and referred as in the fit
};

}  // namespace trussmap::fitting
