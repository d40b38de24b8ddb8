// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Noise beside effects that the model lacks (trussmap/noise_fit.hpp).
#pragma once

#include "fit/noise_reml.hpp"
#include "trussmap/noise_fit.hpp"

namespace trussmap::fitting {

/// Sizes are kept as stated where they can be, and start from those of the fit. `nuisance`:
/// whitened columns, rows as of the fit, of what else may be missing: noise is what
/// they do not explain.
[[nodiscard]] FittedNoise fit_noise(NoiseReml& reml, const Eigen::MatrixXd& nuisance,
                                    const NoiseFitOptions& options);

/// -2 log of the likelihood under a noise (restricted but for `columns`, whitened as above, whose
/// sizes are at their likeliest). Differences between noises and columns of one fit count.
[[nodiscard]] double minus_two_log_under(NoiseReml& reml, const Noise& noise,
                                         const Eigen::MatrixXd& columns);

}  // namespace trussmap::fitting
