// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The systematic errors that nearly every robot has, as coefficients beside the map: unknowns that
// nobody asked for, freed so that they do no harm.
//
//   difference   wheel diameters' ratio, E_d           sd 0.01
//   turn         wheelbase, E_b                        sd 0.05
//   drift        turn per time                         sd 0.01 rad/s
//   compass      hard iron, once round per turn        sd 0.2 rad, two coefficients
//
// The standard deviations are those of weak priors: what robots have as they come out of the box.
#pragma once

#include "estimation/effect_parameters.hpp"
#include "trussmap/model.hpp"

#include <vector>

namespace trussmap::estimation {

/// As the catalogue has them, coefficients 0; those of the compass only where one was read, those
/// per time only where no row lasts minutes.
[[nodiscard]] std::vector<Effect> common_errors(const std::vector<DrivenRecording>& recordings);

/// Standard deviation of the weak prior on such an effect's coefficients.
[[nodiscard]] double common_error_sd(const Effect& effect);

/// Their columns, in the order of their coefficients. Headings are the compass's readings less the
/// hard iron that these coefficients have of it (none: 0).
[[nodiscard]] EffectParameters common_error_columns(const std::vector<DrivenRecording>& recordings,
                                                    const Robot& robot,
                                                    const Eigen::VectorXd& coefficients = {});

}  // namespace trussmap::estimation
