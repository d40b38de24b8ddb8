// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Coefficients in words that a robot's owner can act on.
#pragma once

#include "trussmap/effects/model.hpp"

#include <string>
#include <vector>

namespace trussmap {

/// "the wheelbase is 2.0 +- 0.1 % larger than nominal". `effect` is resolved and has coefficients;
/// `sd` as many standard errors (0 or infinite: none is given).
[[nodiscard]] std::string in_words(const Effect& effect, const std::vector<double>& sd);

}  // namespace trussmap
