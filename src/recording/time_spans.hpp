// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Spans of time. Two that only touch do not overlap.
#pragma once

#include "trussmap/recording.hpp"

#include <vector>

namespace trussmap::recording {

/// In order of time; those that touch or overlap as one, and those of no length gone.
[[nodiscard]] std::vector<TimeSpan> merged(std::vector<TimeSpan> spans);

[[nodiscard]] bool overlaps_any(const TimeSpan& one, const std::vector<TimeSpan>& spans);

}  // namespace trussmap::recording
