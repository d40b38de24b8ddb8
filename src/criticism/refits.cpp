// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/refits.hpp"

#include "fit/fit_state.hpp"
#include "trussmap/error.hpp"

#include <utility>

namespace trussmap::criticism {

ModelFit refit_with(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                    const std::vector<Effect>& effects) {
  Model model = fit.model;
  model.effects.insert(model.effects.end(), effects.begin(), effects.end());
  return fitting::refit(recordings, model, fit);
}

std::optional<ModelFit> if_fitted_with(const std::vector<DrivenRecording>& recordings,
                                       const ModelFit& fit, const std::vector<Effect>& effects) {
  try {
    return refit_with(recordings, fit, effects);
  } catch (const SolveError&) {
    return std::nullopt;
  }
}

std::optional<ModelFit> refit_by(const std::vector<DrivenRecording>& recordings,
                                 const ModelFit& fit, std::vector<Effect> effects) {
  Model model = fit.model;
  model.effects = std::move(effects);
  return if_possible<ModelFit>([&] { return fitting::refit(recordings, model, fit); });
}

ModelFit refit_under(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                     const Noise& noise) {
  Model model = fit.model;
  model.noise = noise;
  return fitting::refit(recordings, model, fit);
}

}  // namespace trussmap::criticism
