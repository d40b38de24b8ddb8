// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What commands that read pose graphs have in common.
#pragma once

#include "command_line.hpp"
#include "trussmap/map_files.hpp"

#include <string>

namespace trussmap::app {

inline constexpr const char* kEdge2ByName = "name";

/// --edge2.
void add_edge2(const Command& command, std::string& edge2);
[[nodiscard]] Edge2 edge2_named(const std::string& name);

/// What trussmap check finds of a graph, a line each, on standard error: before anything is solved.
void warn_of_graph_mistakes(const PoseGraph& graph, const std::string& file);

}  // namespace trussmap::app
