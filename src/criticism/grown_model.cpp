// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/grown_model.hpp"

#include "criticism/effect_strength.hpp"
#include "criticism/place_uncertainty.hpp"
#include "fit/fit_state.hpp"

#include <utility>

namespace trussmap::criticism {

void GrownModel::add(const std::vector<Candidate>& effects, ModelFit fit) {
  candidates_.insert(candidates_.end(), effects.begin(), effects.end());
  fit_ = std::move(fit);
}

ModelFit GrownModel::fitted(const std::vector<Effect>& effects) const {
  Model model = fit_.model;
  model.effects = effects;
  return fitting::refit(recordings_, model, fit_);
}

void GrownModel::seek_parameters_anew() {
  for (std::size_t k = given_; k < candidates_.size(); ++k) {
    if (candidates_[k].parameters.empty()) continue;
    std::vector<Effect> others = fit_.model.effects;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const ModelFit without = fitted(others);
    const Candidate better = refined(ScoreTest(*without.state), candidates_[k]);
    if (better.parameters == candidates_[k].parameters) continue;
    std::vector<Effect> effects = fit_.model.effects;
    effects[k] = better.effect;
    ModelFit fit = fitted(effects);
    if (chi2_of_all(fit) >= chi2_of_all(fit_)) continue;
    candidates_[k] = better;
    fit_ = std::move(fit);
  }
}

std::vector<std::string> GrownModel::eliminate_backward() {
  std::vector<std::string> dropped;
  while (true) {
    std::size_t weakest = candidates_.size();
    double least = 1.0;
    for (std::size_t k = given_; k < candidates_.size(); ++k) {
      const double enough = kWorthKeeping * static_cast<double>(candidates_[k].effect.shape.size());
      const double strength = wald(fit_, k) / enough;
      if (strength < least) {
        least = strength;
        weakest = k;
      }
    }
    // The one just added is there because it was significant.
    if (weakest + 1 >= candidates_.size()) return dropped;
    dropped.push_back(candidates_[weakest].effect.name);
    std::vector<Effect> effects = fit_.model.effects;
    effects.erase(effects.begin() + static_cast<std::ptrdiff_t>(weakest));
    candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(weakest));
    fit_ = fitted(effects);
  }
}

const validation::HorizonErrors& GrownModel::horizons() {
  if (judged_ != fit_.state) {
    judged_ = fit_.state;
    horizons_ = validation::horizon_errors(*judged_);
  }
  return horizons_;
}

ModelFit GrownModel::finished() && {
  widen_for_places(fit_, candidates_);
  return std::move(fit_);
}

}  // namespace trussmap::criticism
