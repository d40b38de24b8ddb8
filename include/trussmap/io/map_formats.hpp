// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A map for other people's programs: GeoJSON and Graphviz.
#pragma once

#include "trussmap/graph/landmark_graph.hpp"

#include <string>

namespace trussmap {

/// A FeatureCollection: a Point per landmark, a LineString per route, with their numbers as
/// properties. Coordinates are metres in the map frame, not degrees.
[[nodiscard]] std::string format_geojson(const LandmarkGraph& map);

/// An undirected graph with pinned positions in metres: `neato -Tsvg` draws it as it lies.
[[nodiscard]] std::string format_dot(const LandmarkGraph& map);

}  // namespace trussmap
