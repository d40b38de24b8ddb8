// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Does a channel differ from place to place, as a smooth field over the floor? By what the driving
// near each place says of it (place_scores.hpp: G, s), beside the same everywhere.
//
//   u ~ N(0, sigma^2 R),   R: Matern's of some length (matern_field.hpp)
//   s ~ N(0, phi G + sigma^2 G R G)
//
//   is there one   s'Rs with the mean R of three lengths, a quadratic form in normal errors; its
//                  tail by saddlepoint, times the channels that are asked (Holm)
//   sigma, length  restricted likelihood, phi = chi^2/dof of what they leave, at least 1
//   map            u given s: the mean over all sizes and lengths, each by its likelihood, less its
//                  own mean over the way driven
//
// Channels are taken in turn, the one that explains most first, each beside those before it; what
// explained nearly as much then, and nothing more beside it, is a rival. One of them is a patch,
// and no field, where an effect at a place explains as much: log likelihood less half of log dof
// for each number that it takes (Schwarz 1978), or where nothing is left beside it.
#pragma once

#include "criticism/place_scores.hpp"
#include "trussmap/diagnose.hpp"

#include <vector>

namespace trussmap::criticism {

/// p below which a field is told: it is asked beside all else.
inline constexpr double kFieldLevel = 0.01;

/// Surest first, the chance of any where there is none at most `level`.
[[nodiscard]] std::vector<FieldOfPlaces> place_fields(const PlaceScores& scores,
                                                      double level = kFieldLevel);

}  // namespace trussmap::criticism
