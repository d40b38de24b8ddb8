// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "pose_graph/pose_graph_gauge.hpp"

#include "geometry/index.hpp"
#include "linalg/connected_parts.hpp"
#include "linalg/dense.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"

#include <algorithm>

namespace trussmap::pose_graph {
namespace {

constexpr std::size_t kNamed = 3;       // vertices named per part, and
constexpr std::size_t kPartsNamed = 4;  // parts, before "and so on"

}  // namespace

std::vector<GraphPart> graph_parts(const PoseGraph& graph) {
  linalg::DisjointSets sets(static_cast<int>(graph.vertices.size()));
  const auto join = [&sets](const auto& edge, int a, int b) {
    if (!edge.information.isZero(0.0)) sets.join(a, b);
  };
  for (const PoseEdge& edge : graph.pose_edges) join(edge, edge.from, edge.to);
  for (const PointEdge& edge : graph.point_edges) join(edge, edge.pose, edge.point);
  for (const DisplacementEdge& edge : graph.displacement_edges) join(edge, edge.from, edge.to);

  std::vector<GraphPart> parts;
  std::vector<int> number(graph.vertices.size(), -1);
  for (std::size_t v = 0; v < graph.vertices.size(); ++v) {
    const int vertex = static_cast<int>(v);
    int& part = number[idx(sets.lowest(vertex))];
    if (part < 0) {
      part = static_cast<int>(parts.size());
      parts.emplace_back();
    }
    GraphPart& mine = parts[idx(part)];
    mine.vertices.push_back(vertex);
    const bool pose = is_pose(graph.vertices[v]);
    if (pose && !mine.first_pose) mine.first_pose = vertex;
    if (graph.vertices[v].fixed) ++(pose ? mine.fixed_poses : mine.fixed_points);
  }
  for (const DisplacementEdge& edge : graph.displacement_edges) {
    parts[idx(number[idx(sets.lowest(edge.from))])].has_displacements = true;
  }
  return parts;
}

namespace {

std::string name_vertices(const PoseGraph& graph, const GraphPart& part) {
  std::string names = part.vertices.size() == 1 ? "vertex " : "vertices ";
  for (std::size_t k = 0; k < std::min(kNamed, part.vertices.size()); ++k) {
    if (k > 0) names += ", ";
    names += std::to_string(graph.vertices[idx(part.vertices[k])].id);
  }
  if (part.vertices.size() > kNamed) {
    names += text::joined(" and ", part.vertices.size() - kNamed, " more");
  }
  return names;
}

[[noreturn]] void refuse(const PoseGraph& graph, const std::vector<GraphPart>& parts) {
  const std::int64_t first = graph.vertices[idx(parts.front().vertices.front())].id;
  std::string message = text::joined("the graph falls into ", parts.size(),
                                     " parts that no measurement ties together: ");
  for (std::size_t k = 1; k < std::min(parts.size(), kPartsNamed); ++k) {
    if (k > 1) message += "; ";
    const bool one = parts[k].vertices.size() == 1;
    message += text::joined(name_vertices(graph, parts[k]), one ? " is" : " are",
                            " tied to nothing that is tied to vertex ", first);
  }
  if (parts.size() > kPartsNamed) message += "; and so on";
  throw SolveError(message + " (tie them by an edge, or fix a vertex of each part)");
}

void hold(const PoseGraph& graph, const GraphPart& part, std::vector<std::uint8_t>& held) {
  const bool has_poses = part.first_pose.has_value();
  const bool turns = has_poses && !part.has_displacements;
  if (part.fixed_poses > 0 || part.fixed_points > 1) return;
  if (part.fixed_points == 0) {
    const int first = part.vertices.front();
    const bool whole = is_pose(graph.vertices[idx(first)]) && turns;
    held[idx(first)] |= whole ? estimation::held_all : estimation::held_position;
    if (whole) return;
  }
  if (turns) held[idx(*part.first_pose)] |= estimation::held_heading;
}

template <typename Matrix>
int rank(const Matrix& information) {
  constexpr double kZero = 1e-9;
  const double size = information.cwiseAbs().maxCoeff();
  return static_cast<int>(
      (linalg::symmetric_eigenvalues(information).array() > kZero * kZero * size).count());
}

}  // namespace

std::vector<std::uint8_t> choose_gauge(const PoseGraph& graph) {
  const std::vector<GraphPart> parts = graph_parts(graph);
  const bool loose = std::any_of(parts.begin(), parts.end(),
                                 [](const GraphPart& part) { return !part.is_fixed(); });
  if (parts.size() > 1 && loose) refuse(graph, parts);

  std::vector<std::uint8_t> held(graph.vertices.size(), estimation::held_nothing);
  for (std::size_t v = 0; v < held.size(); ++v) {
    if (graph.vertices[v].fixed) held[v] = estimation::held_all;
  }
  for (const GraphPart& part : parts) hold(graph, part, held);
  return held;
}

int count_unknowns(const PoseGraph& graph, const std::vector<std::uint8_t>& held) {
  int unknowns = 0;
  for (std::size_t v = 0; v < held.size(); ++v) {
    if ((held[v] & estimation::held_position) == 0) unknowns += 2;
    if (is_pose(graph.vertices[v]) && (held[v] & estimation::held_heading) == 0) unknowns += 1;
  }
  return unknowns;
}

int count_measurements(const PoseGraph& graph) {
  int count = 0;
  for (const PoseEdge& edge : graph.pose_edges) count += rank(edge.information);
  for (const PointEdge& edge : graph.point_edges) count += rank(edge.information);
  for (const DisplacementEdge& edge : graph.displacement_edges) count += rank(edge.information);
  return count;
}

}  // namespace trussmap::pose_graph
