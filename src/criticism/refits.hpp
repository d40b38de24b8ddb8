// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A fit, done again with something else believed. All throw as refit does.
#pragma once

#include "trussmap/fit_model.hpp"

#include <optional>
#include <vector>

namespace trussmap {

/// With these effects in the model, after its own.
[[nodiscard]] ModelFit refit_with(const std::vector<DrivenRecording>& recordings,
                                  const ModelFit& fit, const std::vector<Effect>& effects);

/// Nothing where they cannot be fitted together.
[[nodiscard]] std::optional<ModelFit> if_fitted_with(const std::vector<DrivenRecording>& recordings,
                                                     const ModelFit& fit,
                                                     const std::vector<Effect>& effects);

/// With this noise.
[[nodiscard]] ModelFit refit_under(const std::vector<DrivenRecording>& recordings,
                                   const ModelFit& fit, const Noise& noise);

}  // namespace trussmap
