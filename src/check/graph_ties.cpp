// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What hangs together, and what stands twice.
#include "check/graph_findings.hpp"
#include "geometry/index.hpp"
#include "pose_graph/pose_graph_descent.hpp"
#include "pose_graph/pose_graph_gauge.hpp"
#include "text/number_text.hpp"
#include "trussmap/planar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace trussmap::check {
namespace {

constexpr std::size_t kVerticesNamed = 5;
constexpr double kSameDigits = 2e-6;  // m, rad: six decimals, and those of an inverse

std::string several(std::size_t count, const char* one, const char* many) {
  return text::joined(count, " ", count == 1 ? one : many);
}

std::string named(const CheckedGraph& checked, const std::vector<int>& vertices) {
  std::string names;
  for (std::size_t k = 0; k < std::min(kVerticesNamed, vertices.size()); ++k) {
    names += text::joined(k == 0 ? "" : ", ", checked.id(vertices[k]));
  }
  if (vertices.size() > kVerticesNamed) {
    names += text::joined(" and ", vertices.size() - kVerticesNamed, " more");
  }
  return names;
}

/// A measurement, whichever way round, to be sorted by the pair and by what was measured.
struct Twin {
  int low = 0;
  int high = 0;
  int kind = 0;
  std::array<double, 3> measured{};
  std::size_t place = 0;  ///< among all edges

  [[nodiscard]] auto key() const { return std::tie(kind, low, high); }
  [[nodiscard]] bool same_as(const Twin& other) const {
    if (key() != other.key()) return false;
    const double turn = wrap_angle(measured[2] - other.measured[2]);
    const auto close = [&](std::size_t k) {
      const double size = std::max(1.0, std::abs(measured[k]));
      return std::abs(measured[k] - other.measured[k]) <= kSameDigits * size;
    };
    return close(0) && close(1) && std::abs(turn) <= kSameDigits;
  }
};

std::vector<Twin> twins_of(const CheckedGraph& checked) {
  std::vector<Twin> twins;
  const PoseGraph& graph = checked.graph;
  const auto add = [&](int kind, int from, int to, const Pose& measured) {
    twins.push_back({from, to, kind, {measured.x, measured.y, measured.heading}, twins.size()});
  };
  for (const PoseEdge& edge : graph.pose_edges) {
    const bool forwards = edge.from < edge.to;
    add(0, std::min(edge.from, edge.to), std::max(edge.from, edge.to),
        forwards ? edge.measured : inverse(edge.measured));
  }
  for (const PointEdge& edge : graph.point_edges) {
    add(1, edge.pose, edge.point, {edge.measured.x(), edge.measured.y(), 0.0});
  }
  for (const DisplacementEdge& edge : graph.displacement_edges) {
    const double sign = edge.from < edge.to ? 1.0 : -1.0;
    add(2, std::min(edge.from, edge.to), std::max(edge.from, edge.to),
        {sign * edge.measured.x(), sign * edge.measured.y(), 0.0});
  }
  return twins;
}

}  // namespace

void check_parts(CheckedGraph& checked) {
  const std::vector<pose_graph::GraphPart> parts = pose_graph::graph_parts(checked.graph);
  if (parts.size() < 2) return;
  std::vector<int> alone;
  std::vector<const pose_graph::GraphPart*> pieces;
  for (const pose_graph::GraphPart& part : parts) {
    if (part.vertices.size() > 1) {
      pieces.push_back(&part);
    } else if (!part.is_fixed()) {
      alone.push_back(part.vertices.front());
    }
  }
  if (!alone.empty()) {
    checked.add("VERTEX", "vertex without edges",
                text::joined("no edge ties ", several(alone.size(), "vertex: ", "vertices: "),
                             named(checked, alone)),
                "add edges, or take the lines away");
  }
  const bool loose =
      std::any_of(pieces.begin(), pieces.end(),
                  [](const pose_graph::GraphPart* part) { return !part->is_fixed(); });
  if (pieces.size() < 2 || !loose) return;
  const auto largest =
      std::max_element(pieces.begin(), pieces.end(),
                       [](const pose_graph::GraphPart* one, const pose_graph::GraphPart* other) {
                         return one->vertices.size() < other->vertices.size();
                       });
  std::string evidence =
      text::joined("the graph falls into ", pieces.size(),
                   " parts that no edge ties together: ", (*largest)->vertices.size(),
                   " vertices with ", checked.id((*largest)->vertices.front()));
  constexpr std::size_t kPartsNamed = 3;
  std::size_t named_parts = 0;
  for (const pose_graph::GraphPart* part : pieces) {
    if (part == *largest || ++named_parts > kPartsNamed) continue;
    evidence +=
        text::joined("; ", part->vertices.size(), " (", named(checked, part->vertices), ")");
  }
  if (named_parts > kPartsNamed)
    evidence += text::joined("; and ", named_parts - kPartsNamed, " more");
  checked.add("EDGE", "separate parts", evidence,
              "add the edges that tie them, or fix a vertex of each part (FIX)");
}

void check_loose(CheckedGraph& checked) {
  pose_graph::PoseGraphSystem system(checked.graph, pose_graph::choose_gauge(checked.graph));
  const std::vector<int> loose = pose_graph::find_loose_vertices(system, checked.fit.estimates);
  if (loose.empty()) return;
  checked.add("EDGE", "loose vertex",
              text::joined(several(loose.size(), "vertex", "vertices"),
                           " can move without contradicting any edge: ", named(checked, loose)),
              "measure more of them: a pose that sees one landmark alone can turn about it");
}

void check_duplicates(CheckedGraph& checked) {
  std::vector<Twin> twins = twins_of(checked);
  std::sort(twins.begin(), twins.end(), [](const Twin& one, const Twin& other) {
    return std::tie(one.kind, one.low, one.high, one.measured, one.place) <
           std::tie(other.kind, other.low, other.high, other.measured, other.place);
  });
  std::size_t count = 0;
  const Twin* first = nullptr;
  for (std::size_t k = 0; k < twins.size(); ++k) {
    // Rounding may put another measurement of the same pair between two that are alike.
    constexpr std::size_t kNear = 8;
    bool twice = false;
    for (std::size_t back = 1; back <= std::min(k, kNear) && !twice; ++back) {
      if (twins[k - back].key() != twins[k].key()) break;
      twice = twins[k].same_as(twins[k - back]);
    }
    if (!twice) continue;
    ++count;
    if (first == nullptr || twins[k].place < first->place) first = &twins[k];
  }
  if (first == nullptr) return;
  checked.add("EDGE", "duplicate edges",
              text::joined(several(count, "edge says", "edges say"),
                           " to the last digit what another one says already, the first of them ",
                           checked.ends(first->low, first->high)),
              "give each measurement once: counted twice it weighs twice");
}

}  // namespace trussmap::check
