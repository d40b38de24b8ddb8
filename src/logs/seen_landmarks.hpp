// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Sightings out of a log: landmarks that messages name, and frames that a camera sees.
#pragma once

#include "logs/gathered_log.hpp"

#include <cstdint>
#include <vector>

namespace trussmap::logs {

struct SeenSighting {
  std::int64_t t = 0;  ///< ns
  Sighting sighting;   ///< its t is not set
};

struct SightingCounts {
  std::size_t outside = 0;   ///< of the drive
  std::size_t no_frame = 0;  ///< no way from their frame to the robot's at their time
  std::size_t repeated = 0;  ///< the same as another, time and all
};

/// In order of time, each once. Throws InputError with the map's line where no frame is like the
/// one asked for, or none of them is joined to the base.
[[nodiscard]] std::vector<SeenSighting> seen_sightings(const LogMap& map, const GatheredLog& log,
                                                       SightingCounts& counts);

}  // namespace trussmap::logs
