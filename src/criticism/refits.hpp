// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A fit, done again with something else believed. All throw as refit does.
#pragma once

#include "trussmap/error.hpp"
#include "trussmap/fit_model.hpp"

#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

namespace trussmap::criticism {

/// With these effects in the model, after its own.
[[nodiscard]] ModelFit refit_with(const std::vector<DrivenRecording>& recordings,
                                  const ModelFit& fit, const std::vector<Effect>& effects);

/// Nothing where they cannot be fitted together.
[[nodiscard]] std::optional<ModelFit> if_fitted_with(const std::vector<DrivenRecording>& recordings,
                                                     const ModelFit& fit,
                                                     const std::vector<Effect>& effects);

/// With these effects, their coefficients as a start, in place of its own; nothing where they
/// cannot be fitted together.
[[nodiscard]] std::optional<ModelFit> refit_by(const std::vector<DrivenRecording>& recordings,
                                               const ModelFit& fit, std::vector<Effect> effects);

/// With this noise.
[[nodiscard]] ModelFit refit_under(const std::vector<DrivenRecording>& recordings,
                                   const ModelFit& fit, const Noise& noise);

/// What a fit gives; nothing where that cannot be fitted, or leaves nothing to fit.
template <class Result>
[[nodiscard]] std::optional<Result> if_possible(const std::function<Result()>& fit) {
  try {
    return fit();
  } catch (const SolveError&) {
    return std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;
  } catch (const std::invalid_argument&) {  // steered to where a wheel has no way ahead
    return std::nullopt;
  }
}

}  // namespace trussmap::criticism
