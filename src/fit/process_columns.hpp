// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a noise process does to a fit's measurements, as columns of independent steps.
//
//   e = A z,  z = L eta,  eta ~ N(0, 1):   Z = W A L,   cov(W e) = sd^2 Z Z'
//
//   A   what one unit of each state adds to the measurements     W   their whiteners
//   L   the chain of the states (noise_states.hpp)
//
// What the process does between the ends of a measurement is left out. Of a walk, successive steps
// may go together so that there are few columns: its ends stay as uncertain as they are.
#pragma once

#include "estimation/noise_states.hpp"
#include "fit/fit_state.hpp"

#include <optional>

namespace trussmap::fitting {

/// Of a process: s or m. A shorter one is laid as one of this length.
inline constexpr double kLeastProcessLength = 1e-3;

/// What one unit of a view's pattern changes of a measurement, where the fit stands.
[[nodiscard]] effects::ByView by_view_of(const FitState& fit,
                                         const estimation::RecordingProblem& problem,
                                         std::size_t measurement);

/// Z, `rows` of them, those of the fit's measurements first; `most` columns. Nothing where the
/// process has more steps than that and is no walk, or acts on nothing that is measured.
[[nodiscard]] std::optional<Eigen::MatrixXd> process_columns(const FitState& fit,
                                                             const NoiseProcess& process,
                                                             Eigen::Index rows, Eigen::Index most);

}  // namespace trussmap::fitting
