// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/findings.hpp"
#include "check/graph_findings.hpp"
#include "check/graph_loops.hpp"
#include "geometry/index.hpp"
#include "text/number_text.hpp"
#include "trussmap/check.hpp"

#include <stdexcept>
#include <utility>

namespace trussmap::check {

void CheckedGraph::add(const std::string& column, const char* kind, const std::string& evidence,
                       const std::string& remedy) {
  findings.push_back({file, column, kind, evidence, remedy});
}

std::int64_t CheckedGraph::id(int vertex) const {
  return graph.vertices[idx(vertex)].id;
}

std::string CheckedGraph::ends(int from, int to) const {
  return text::joined(id(from), " to ", id(to));
}

bool check_loops(CheckedGraph& checked) {
  constexpr std::size_t kNamed = 5;
  const bool trusted = !checked.all_alike;
  const std::optional<ReversedLoops> found =
      reversed_loops(checked.graph, checked.loops, checked.fit, trusted);
  if (!found) return false;
  std::string which = "reversing ";
  if (found->all) {
    which += checked.loops.size() == 1 ? "the one loop, "
                                       : text::joined("all ", checked.loops.size(), " loops, ");
  } else {
    which += text::joined(found->edges.size(), " of ", checked.loops.size(), " loops, ");
  }
  for (std::size_t k = 0; k < std::min(kNamed, found->edges.size()); ++k) {
    const PoseEdge& edge = checked.graph.pose_edges[idx(found->edges[k])];
    which += text::joined(k == 0 ? "" : ", ", checked.ends(edge.from, edge.to));
  }
  if (found->edges.size() > kNamed)
    which += text::joined(" and ", found->edges.size() - kNamed, " more");
  checked.add(
      "EDGE", "loops reversed",
      text::joined(which, ", explains ",
                   found->after < 0.2 * found->before ? "the misfit: " : "it: ", "chi2 ",
                   figure(found->before), " becomes ", figure(found->after), " for ",
                   checked.fit.dof, " degrees of freedom"),
      "an edge i j gives j as seen from i: exchange the two ids, or invert the measured pose");
  return true;
}

}  // namespace trussmap::check

namespace trussmap {
using namespace check;

std::vector<CheckFinding> check_graph(const PoseGraph& graph, const std::string& file) {
  if (graph.edges() == 0) throw std::invalid_argument("the graph has no edges");
  if (const std::optional<std::string> fault = find_fault(graph)) {
    throw std::invalid_argument(*fault);
  }
  std::vector<CheckFinding> findings;
  CheckedGraph checked{file, findings, graph, loop_edges(graph)};
  checked.edges_given = graph.pose_edges.size();
  check_source(checked);
  check_parts(checked);
  check_duplicates(checked);
  checked.graph = tied_together(std::move(checked.graph));
  check_graph_headings(checked);
  checked.fit = fit_graph(checked.graph);
  check_identity(checked);
  check_covariance(checked);
  if (!check_loops(checked)) check_small_turns(checked);
  check_loose(checked);
  return findings;
}

const std::vector<std::string>& check_graph_kinds() {
  static const std::vector<std::string> kKinds = {
      "information order",    "roots beside information",
      "vertex without edges", "separate parts",
      "duplicate edges",      "identity information",
      "angle unit",           "covariance for information",
      "loops reversed",       "loose vertex"};
  return kKinds;
}

}  // namespace trussmap
