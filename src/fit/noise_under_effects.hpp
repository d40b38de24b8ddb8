// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A factor of travel or turn acts on a row's noise as on its motion. With F the factor, m the noise
// and T the motion that a fit believes,
//
//   T = F (recorded + m)
//
// A fitted path finds m beside columns that were made of the m before. Where the measurements
// determine T that takes the error of m 1 - F times, and so runs away for F beyond 2; where they do
// not, T follows the columns, and m is found as it is. A step by a mean of the two,
//
//   m <- m_before + ((1 + F)/2)^-1 (m_found - m_before)
//
// leaves (F - 1)/(F + 1) of the error of both. Where F is below 1, m is taken as it is found; where
// it is negative, as where wheels are exchanged, no step serves both, and m is left out of the
// columns: noise comes after the effect there. With a gyro the same of noise and excess together.
#pragma once

#include "fit/fit_state.hpp"

#include <vector>

namespace trussmap::fitting {

/// Takes the step for the fit's paths, just found beside columns of the paths `before`. Of shapes
/// that are not constant the columns are taken as they are.
void step_noise_under_effects(const std::vector<SessionPath>& before, FitState& fit);

}  // namespace trussmap::fitting
