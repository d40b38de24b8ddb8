// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Coefficients in words that a robot's owner can act on.
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/planar.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap {

/// "the wheelbase is 2.0 +- 0.1 % larger than nominal". `effect` has coefficients;
/// `sd` as many standard errors (0 or infinite: none is given).
[[nodiscard]] std::string in_words(const Effect& effect, const std::vector<double>& sd);

/// A name as a sentence has it: "slippery patch at x 12.3 m, y 9.8 m, radius 3.1 m" for
/// "slippery patch (x=12.345, y=9.8, r=3.1)", "turning error with turn rate" for "turn with
/// turn_rate". A user's own name stays.
[[nodiscard]] std::string name_in_words(const Effect& effect);
/// The same without what is open in the catalogue: "slippery patch".
[[nodiscard]] std::string short_name(const Effect& effect);

/// The most that an effect does in some recordings, from its least to its largest g there: "the
/// compass reads up to 2.9 deg too much or too little".
[[nodiscard]] std::string size_in_words(const Effect& effect, double least, double most);

/// Centre of an effect that acts at one place alone, m.
[[nodiscard]] std::optional<Vector2> place_of(const Effect& effect);

/// "2.9", "0.031", "120": two digits, and never an exponent above 1.
[[nodiscard]] std::string two_digits(double value);

}  // namespace trussmap
