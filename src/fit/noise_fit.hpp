// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Noise beside effects that the model lacks (trussmap/noise_fit.hpp).
#pragma once

#include "fit/fit_state.hpp"
#include "trussmap/noise_fit.hpp"

namespace trussmap {

/// Sizes are kept as `stated` where they can be, and start from those of the fit. `nuisance`:
/// whitened columns, rows as of the fit, of what else may be missing: noise is what
/// they do not explain.
[[nodiscard]] FittedNoise fit_noise(const FitState& fit, const Noise& stated,
                                    const Eigen::MatrixXd& nuisance,
                                    const NoiseFitOptions& options);

}  // namespace trussmap
