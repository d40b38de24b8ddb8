// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Rows that stand twice, the same to the last digit: a log that was joined to its own copy. They
// are one measurement.
#pragma once

#include "trussmap/recording.hpp"

#include <vector>

namespace trussmap::recording {

/// Per row, whether an earlier one of the same time is the same in all columns. Rows in order of
/// time.
[[nodiscard]] std::vector<bool> repeated_rows(const std::vector<Sighting>& sightings);
/// Likewise, wherever the earlier one stands.
[[nodiscard]] std::vector<bool> repeated_rows(const std::vector<Loop>& loops);

}  // namespace trussmap::recording
