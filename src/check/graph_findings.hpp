// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What each part of a pose graph's check looks at, and what it adds to the list.
#pragma once

#include "check/graph_fit.hpp"
#include "trussmap/check.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace trussmap::check {

/// A graph as far as it has been put right: what is found wrong is mended for the parts that
/// follow.
struct CheckedGraph {
  const std::string& file;
  std::vector<CheckFinding>& findings;
  PoseGraph graph;              ///< tied together
  std::vector<int> loops = {};  ///< places in pose_edges
  GraphFit fit = {};            ///< of `graph`
  std::size_t edges_given = 0;  ///< pose edges of the file; ties follow
  bool all_alike = false;       ///< every edge has the identity for information

  void add(const std::string& column, const char* kind, const std::string& evidence,
           const std::string& remedy);
  [[nodiscard]] std::int64_t id(int vertex) const;
  /// "3 to 7".
  [[nodiscard]] std::string ends(int from, int to) const;
};

/// How the file gave its information: TORO's order, two programs' lines.
void check_source(CheckedGraph& checked);
/// Vertices without edges, separate parts. Before they are tied together.
void check_parts(CheckedGraph& checked);
void check_duplicates(CheckedGraph& checked);
/// The identity everywhere.
void check_identity(CheckedGraph& checked);
/// Degrees, in edges and in vertices, by the headings alone. Before the fit.
void check_graph_headings(CheckedGraph& checked);
/// Degrees that are small enough for radians: by what they lead to.
void check_small_turns(CheckedGraph& checked);
void check_covariance(CheckedGraph& checked);
/// True where loops are reversed.
bool check_loops(CheckedGraph& checked);
/// Vertices that can move although all is tied together.
void check_loose(CheckedGraph& checked);

}  // namespace trussmap::check
