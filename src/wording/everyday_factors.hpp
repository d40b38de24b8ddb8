// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Factors that a constant is wrong by where a unit, a gear or a radius was mistaken.
#pragma once

#include "trussmap/channel.hpp"

#include <string>

namespace trussmap::wording {

/// " (twice: a radius taken for a diameter, or a gear?)", of a channel with the shape 1 and
/// the coefficient g, with its standard error; empty where the factor is no such one.
[[nodiscard]] std::string everyday_factor_in_words(Channel channel, double g, double sd);

}  // namespace trussmap::wording
