// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The map by adjustment: all measurements of the recordings at once.
//
//   recordings --fit_recordings, effects held, gated--> landmarks, covariances
//        \--map_leg_by_leg, guided by these landmarks--> legs and routes
//
// The fit gives the positions; the map builder, which takes its headings from them, gives the
// routes. Survey and truth have no part in either.
#pragma once

#include "build_map/leg_by_leg.hpp"

#include <vector>

namespace trussmap {

/// `sessions` are the recordings', cleared of the model's effects. Throws as build_map does.
[[nodiscard]] BuiltMap map_by_adjustment(const std::vector<Recording>& recordings,
                                         const Model& model,
                                         const std::vector<SightedDrive>& sessions,
                                         const BuildMapOptions& options);

}  // namespace trussmap
