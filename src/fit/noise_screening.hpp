// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Which further noise do the residuals of a fit speak for? Score tests of variances at 0:
//
//   q = r' V r     r the whitened residuals, V what a source adds to their covariance per variance
//   z = (q - E q)/sd q, mean and sd from draws of r under the present noise, after regression on
//   the
//       q of the sources that are estimated already: what they can take up is no sign of another
//       (efficient score)
//
// Of a process V = A K A', A its states' columns and K their prior covariance, a chain. One
// projection of the draws serves all; z above 2 or so is worth fitting.
#pragma once

#include "fit/noise_reml.hpp"

#include <vector>

namespace trussmap::fitting {

struct ScreenedNoise {
  NoiseComponent component;
  double z = 0.0;
  double sd = 0.0;  ///< first guess
};

/// `reml` stands at the present noise. Processes of fewer than six states are left out.
[[nodiscard]] std::vector<ScreenedNoise> screened_noise(
    const FitState& fit, const NoiseReml& reml, const std::vector<NoiseComponent>& candidates,
    const std::vector<NoiseComponent>& estimated);

}  // namespace trussmap::fitting
