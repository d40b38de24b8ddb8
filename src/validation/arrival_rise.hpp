// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Whether one model predicts held-out legs worse than another, beyond what chance makes of so few.
#pragma once

#include "trussmap/held_out.hpp"

#include <vector>

namespace trussmap::validation {

/// Their sum over its standard error. Infinity of fewer than two, or of values all alike.
[[nodiscard]] double sum_in_sds(const std::vector<double>& values);

/// Mean rise of the squared arrival errors of the legs that both have, over its standard error.
/// Infinity where fewer than two are the same or all rise alike.
[[nodiscard]] double rise_in_sds(const HeldOut& before, const HeldOut& after);

}  // namespace trussmap::validation
