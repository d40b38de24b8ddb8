// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a diagnosis has found is tested against noise that lasts.
//
//   effect found --> noise estimated without it --> which process would stand for it?
//       of its own sensor       effect_or_process.hpp, against the sensor's effects alone
//       another, or a larger    the likelihood with the effect against that without it under the
//                               noise that is likeliest then, p times all that was tried
//
// Who asks whether a gyro's bias drifts or walks has a few effects to choose from, not the
// hundreds among which the search chose: those of the catalogue, else all that act on the gyro.
//
// The bias of a gyro walks by nature (IEEE Std 952: rate random walk), however little of that chi^2
// as a whole shows: its few values drown among all others. So effects of a gyro have to stand
// against a walk in any case, all others where the errors are larger than is stated.
#pragma once

#include "fit/noise_fit.hpp"

#include <optional>
#include <vector>

namespace trussmap::criticism {

/// Which of these effects, found under `found.fit`'s noise, noise that lasts cannot stand for, each
/// with the others there. The noise without those that it can stand for comes with it, where there
/// are any.
struct Defended {
  std::vector<bool> effects;
  std::optional<FitWithNoise> otherwise = std::nullopt;
};
struct DefenceOptions {
  Noise stated;            ///< the noise that sizes are kept at where they can be
  double tried = 1.0;      ///< effects that were asked of
  double level = 0.05;     ///< of significance
  bool as_stated = false;  ///< the errors are as large as stated
};
/// `with`: fitted with the effects (if_fitted_with, refits.hpp). Throws as refit does.
[[nodiscard]] Defended defended_against_noise(const std::vector<DrivenRecording>& recordings,
                                              const FitWithNoise& found,
                                              const std::optional<ModelFit>& with,
                                              const std::vector<Effect>& effects,
                                              const DefenceOptions& options);

}  // namespace trussmap::criticism
