// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Fields over the floor as files: cells for other people's programs, and a picture each.
#pragma once

#include "commands.hpp"
#include "page_runtime.hpp"
#include "trussmap/diagnose.hpp"

#include <string>
#include <vector>

namespace trussmap::app {

/// --floor-map DIR.
void add_floor_map_option(const Command& command, std::string& folder);

/// floor-CHANNEL.geojson and, where the program can draw, floor-CHANNEL.png of each field, in the
/// folder; those of a run before that told of other channels go.
void add_floor_maps(Files& files, const std::vector<FieldOfPlaces>& fields,
                    const std::string& folder);

/// Where they are, or that there are none; empty without a folder.
[[nodiscard]] std::string floor_maps_text(const std::vector<FieldOfPlaces>& fields,
                                          const std::string& folder);

/// Whether floor_png draws: this build has libpng.
[[nodiscard]] bool draws_png();

/// The field as a PNG picture, north up: a square per cell from blue through white to red, paler
/// where less is known, grey where the robot never was; beside it the scale, its ends and 0 as
/// numbers in the unit that reports show (%, degrees). Empty where it cannot draw.
[[nodiscard]] std::string floor_png(const FieldOfPlaces& field);

}  // namespace trussmap::app
