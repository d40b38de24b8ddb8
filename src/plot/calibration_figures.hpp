// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a calibration saw, as pictures: stopping positions round a square (Borenstein & Feng 1996,
// Figures 6 and 11) and end errors with the ellipses of data and model (Chong & Kleeman 1997, Fig.
// 4).
#pragma once

#include "plot/svg.hpp"
#include "trussmap/umbmark.hpp"
#include "trussmap/wheel_noise.hpp"

#include <optional>
#include <vector>

namespace trussmap::plot {

/// The cw and ccw clusters with their centres of gravity and a circle through the farther one; a
/// panel per round, all at the first one's scale. At least one round, else std::invalid_argument.
[[nodiscard]] Figure square_figure(const std::vector<SquareRuns>& rounds, double side);

/// End errors in three planes, with the 95 % ellipses of the runs and of the model, and of a stated
/// model those of 1, 2 and 3 standard deviations.
[[nodiscard]] Figure noise_figure(const EndErrors& errors, const NoiseEstimate& estimate,
                                  const std::optional<StatedNoise>& stated = std::nullopt);

}  // namespace trussmap::plot
