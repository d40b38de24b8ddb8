// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "graph_options.hpp"

#include "recording_warnings.hpp"
#include "trussmap/check.hpp"

namespace trussmap::app {

void add_edge2(const Command& command, std::string& edge2) {
  command
      .add_option(
          "--edge2", edge2,
          "Whose EDGE2 lines a pose graph has: TORO's, with information, or iSAM's, with its "
          "square root; name: iSAM's in a .txt without VERTEX2 lines, else TORO's")
      .check(one_of({kEdge2ByName, "toro", "isam"}))
      .capture_default_str();
}

Edge2 edge2_named(const std::string& name) {
  if (name == "toro") return Edge2::toro;
  return name == "isam" ? Edge2::isam : Edge2::by_name;
}

void warn_of_graph_mistakes(const PoseGraph& graph, const std::string& file) {
  print_warnings(check_graph(graph, file));
}

}  // namespace trussmap::app
