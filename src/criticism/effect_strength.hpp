// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How surely a fitted effect is there.
#pragma once

#include "trussmap/fit_model.hpp"

#include <cstddef>

namespace trussmap::criticism {

/// Wald statistic per coefficient, by the scatter that there is, that keeps an effect: p = 0.0001.
inline constexpr double kWorthKeeping = 15.0;

/// a' C^-1 a of an effect's coefficients, by the scatter that there is where that is less than the
/// model's noise allows.
[[nodiscard]] double wald(const ModelFit& fit, std::size_t effect);

/// What the gate left out costs what it allows, or a fit would be the better for leaving out more.
[[nodiscard]] double chi2_of_all(const ModelFit& fit);

/// chi^2/dof, at least 1.
[[nodiscard]] double scatter_left(const ModelFit& fit);

/// Whether a fit with so many constants fewer is hardly worse.
[[nodiscard]] bool does_as_well(const ModelFit& with_fewer, const ModelFit& fit,
                                std::size_t fewer = 1);

}  // namespace trussmap::criticism
