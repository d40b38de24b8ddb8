// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Which way a robot without a compass looks when it wakes up in a map that exists already.
//
// It drives on in a frame of its own. Every landmark of the map that it then sights says how that
// frame is turned: by the landmark's direction from the first one in the map, less that which was
// reckoned. What most sightings agree on counts, and of these the surest; a misread label is
// outvoted.
#pragma once

#include "build_map/sighted_drive.hpp"

#include <functional>
#include <optional>
#include <string>

namespace trussmap {

/// Where the map has a landmark, if anywhere, m.
using Believed = std::function<std::optional<Vector2>(const std::string&)>;

/// Heading in the map at the time of `start`, a sighting of a landmark of the map. None if no
/// other landmark of the map is sighted while the reckoning is still good for a direction, or if
/// most of these sightings contradict one another. `map_sd`: how wrong the map may be, m.
[[nodiscard]] std::optional<HeadingEstimate> heading_in_map(const SightedDrive& drive,
                                                            const Sighting& start, double map_sd,
                                                            const Believed& believed);

}  // namespace trussmap
