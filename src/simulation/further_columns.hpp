// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Covariate columns of the user's own naming.
#pragma once

#include "trussmap/simulation.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace trussmap::simulation {

/// Throws std::invalid_argument: a letter, then letters, digits, _ is expected, and no variable or
/// column that is there already.
void check_covariates(const std::vector<std::string>& names);

/// Each column, anew at one stop in two, between 0 and 1.
[[nodiscard]] std::vector<Covariate> further_columns(const TrueMotion& motion,
                                                     const std::vector<std::string>& names,
                                                     std::uint64_t seed);

/// The same as the style's orders have them.
[[nodiscard]] std::vector<Covariate> ordered_columns(const TrueMotion& motion,
                                                     const DrivingStyle& style);

}  // namespace trussmap::simulation
