// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A map as GraphML, out and in without loss.
//
//   node id = landmark name; data x, y [m] and, where known, c_xx c_xy c_yy [m^2]
//   edge data traversals, stretch [m], orientation [rad] (source to target), dx, dy [m],
//   c_xx c_xy c_yy [m^2] (mean covariance of a traversal, map frame)
#pragma once

#include "trussmap/graph/landmark_graph.hpp"

#include <filesystem>
#include <string>

namespace trussmap {

/// Throws InputError, with the line where the XML reader knows it: no XML, no GraphML graph, a
/// directed graph, a landmark twice, a value missing or no number, an edge to an unknown landmark,
/// two edges between the same landmarks, a count below 1.
[[nodiscard]] LandmarkGraph read_map_graphml(const std::filesystem::path& file);

/// `comment`, if any, is written as an XML comment (which method made the map, say).
[[nodiscard]] std::string format_map_graphml(const LandmarkGraph& map,
                                             const std::string& comment = "");

}  // namespace trussmap
