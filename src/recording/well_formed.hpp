// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What recording.hpp asks of a recording that a caller has put together.
#pragma once

#include "trussmap/recording.hpp"

#include <vector>

namespace trussmap {

/// Throws std::invalid_argument, naming the recording, the column and the place, where columns of
/// the drive differ in length, times do not increase (of sightings and truth: decrease) or leave
/// the drive, a travel, covariate or time is not finite, or a range has no bearing.
void require_well_formed(const Recording& recording);
void require_well_formed(const std::vector<Recording>& recordings);

}  // namespace trussmap
