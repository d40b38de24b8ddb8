// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A model that effects are added to: its fit, and the candidate behind each effect added.
#pragma once

#include "criticism/candidates.hpp"
#include "trussmap/fit_model.hpp"
#include "validation/dead_reckoned_horizons.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace trussmap::criticism {

class GrownModel {
 public:
  /// `recordings` must outlive it.
  GrownModel(const std::vector<DrivenRecording>& recordings, ModelFit given)
      : recordings_(recordings),
        fit_(std::move(given)),
        given_(fit_.model.effects.size()),
        candidates_(given_) {}

  [[nodiscard]] const ModelFit& fit() const { return fit_; }
  /// How many effects were added, and are still there.
  [[nodiscard]] std::size_t added() const { return candidates_.size() - given_; }

  /// The same effects, believed under another noise.
  void take_fit(ModelFit fit) { fit_ = std::move(fit); }
  /// `fit` has these effects after those that were there.
  void add(const std::vector<Candidate>& effects, ModelFit fit);

  /// What refit throws.
  [[nodiscard]] ModelFit fitted(const std::vector<Effect>& effects) const;

  /// Places and thresholds of all effects added, each with the others in the model.
  void seek_parameters_anew();
  /// Takes out the effects that the others have made superfluous, the weakest first, but not the
  /// newest. Their names.
  std::vector<std::string> eliminate_backward();

  /// Of dead reckoning by the present fit; reckoned once.
  [[nodiscard]] const validation::HorizonErrors& horizons();

  /// The fit, with standard errors that are as wide as the places that were sought make them.
  [[nodiscard]] ModelFit finished() &&;

 private:
  const std::vector<DrivenRecording>& recordings_;
  ModelFit fit_;
  std::size_t given_;
  std::vector<Candidate> candidates_;  ///< one per effect of the model; empty for those given
  std::shared_ptr<const fitting::FitState> judged_;  ///< of which the errors over the horizons are
  validation::HorizonErrors horizons_;
};

}  // namespace trussmap::criticism
