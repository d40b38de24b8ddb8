// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Headings in degrees, of edges and of vertices.
#include "check/findings.hpp"
#include "check/graph_findings.hpp"
#include "geometry/index.hpp"
#include "geometry/units.hpp"
#include "statistics/median.hpp"
#include "text/number_text.hpp"
#include "trussmap/planar.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::check {
namespace {

constexpr double kMostDegrees = 361.0;
constexpr double kTurning = 1.0;           // rad that headings spread, for degrees to show
constexpr double kSuits = 30.0;            // chi^2 per degree of freedom, in radians
constexpr double kDoubtful = 5.0;          // chi^2 per degree of freedom, as stated
constexpr double kFarBetter = 100.0;       // factor of chi^2
constexpr double kSurelyBetter = 7.0;      // log likelihood ratio
constexpr double kVerticesDisagree = 0.3;  // rad, of vertices' turns from edges'
constexpr int kEnoughLarge = 2;            // edges beyond a whole turn
constexpr std::size_t kEnoughTurns = 3;

PoseGraph in_radians(PoseGraph graph, std::size_t edges) {
  for (std::size_t k = 0; k < edges; ++k) graph.pose_edges[k].measured.heading *= geometry::kDegree;
  return graph;
}

double largest_turn(const CheckedGraph& checked) {
  double largest = 0.0;
  for (std::size_t k = 0; k < checked.edges_given; ++k) {
    largest = std::max(largest, std::abs(checked.graph.pose_edges[k].measured.heading));
  }
  return largest;
}

/// Edges that turn by more than a whole turn, as no program writes them in radians.
bool beyond_a_turn(const CheckedGraph& checked, double largest) {
  if (largest > kMostDegrees) return false;
  int beyond = 0;
  int turning = 0;
  for (std::size_t k = 0; k < checked.edges_given; ++k) {
    const double turn = std::abs(checked.graph.pose_edges[k].measured.heading);
    if (turn > geometry::kFullTurn) ++beyond;
    if (turn > geometry::kDegree) ++turning;
  }
  return beyond >= kEnoughLarge && 50 * beyond >= turning;
}

/// Whether odometry's headings come round far enough for their unit to matter.
bool comes_round(const CheckedGraph& checked) {
  double heading = 0.0;
  double least = 0.0;
  double most = 0.0;
  for (std::size_t k = 0; k < checked.edges_given; ++k) {
    const PoseEdge& edge = checked.graph.pose_edges[k];
    if (closes_loop(checked.graph, edge)) continue;
    heading += edge.to > edge.from ? edge.measured.heading : -edge.measured.heading;
    least = std::min(least, heading);
    most = std::max(most, heading);
  }
  return most - least > kTurning;
}

/// Turn of the vertices along each edge less what the edge says, rad; medians of the sizes.
struct VertexTurns {
  double as_stated = 0.0;
  double in_degrees = 0.0;
  std::size_t turns = 0;
};

VertexTurns vertex_turns(const CheckedGraph& checked) {
  std::vector<double> as_stated;
  std::vector<double> in_degrees;
  for (std::size_t k = 0; k < checked.edges_given; ++k) {
    const PoseEdge& edge = checked.graph.pose_edges[k];
    const GraphVertex& from = checked.graph.vertices[idx(edge.from)];
    const GraphVertex& to = checked.graph.vertices[idx(edge.to)];
    if (!from.estimate || !to.estimate || closes_loop(checked.graph, edge)) continue;
    const double turn = to.estimate->heading - from.estimate->heading;
    if (std::abs(turn) < geometry::kDegree) continue;
    as_stated.push_back(std::abs(wrap_angle(turn - edge.measured.heading)));
    in_degrees.push_back(std::abs(wrap_angle(geometry::kDegree * turn - edge.measured.heading)));
  }
  if (as_stated.empty()) return {};
  return {statistics::median(as_stated), statistics::median(in_degrees), as_stated.size()};
}

bool vertices_in_degrees(const CheckedGraph& checked) {
  double largest = 0.0;
  for (const GraphVertex& one : checked.graph.vertices) {
    if (one.estimate) largest = std::max(largest, std::abs(one.estimate->heading));
  }
  if (largest < geometry::kFullTurn) return false;
  const VertexTurns turns = vertex_turns(checked);
  return turns.turns >= kEnoughTurns && turns.as_stated > 5.0 * turns.in_degrees &&
         turns.in_degrees < kVerticesDisagree;
}

void mend_vertices(PoseGraph& graph) {
  for (GraphVertex& one : graph.vertices) {
    if (one.estimate) one.estimate->heading *= geometry::kDegree;
  }
}

}  // namespace

namespace {

void add_degrees(CheckedGraph& checked, const char* column, const std::string& evidence) {
  checked.add(column, "angle unit", evidence, "convert headings to rad");
}

}  // namespace

void check_graph_headings(CheckedGraph& checked) {
  const double largest = largest_turn(checked);
  const bool edges = beyond_a_turn(checked, largest);
  if (edges) checked.graph = in_radians(std::move(checked.graph), checked.edges_given);
  const bool vertices = vertices_in_degrees(checked);
  if (vertices) mend_vertices(checked.graph);
  if (edges) {
    add_degrees(
        checked, vertices ? "theta,dtheta" : "dtheta",
        text::joined("turns reach ", figure(largest), ", as degrees do and radians do not"));
  } else if (vertices) {
    add_degrees(checked, "theta",
                "the vertices' headings turn with the edges if they are taken for degrees, and not "
                "as radians");
  }
}

void check_small_turns(CheckedGraph& checked) {
  const GraphFit& fit = checked.fit;
  if (!comes_round(checked) || fit.dof <= 0) return;
  if (!checked.all_alike && fit.chi2 < kDoubtful * fit.dof) return;
  const PoseGraph mended = in_radians(checked.graph, checked.edges_given);
  const GraphFit better = fit_graph(mended);
  const double ratio = fit.chi2 / std::max(better.chi2, 1e-12 * fit.chi2);
  const bool suits = checked.all_alike || better.per_dof() < kSuits;
  if (!suits || ratio < kFarBetter || 0.5 * fit.dof * std::log(ratio) < kSurelyBetter) return;
  add_degrees(
      checked, "dtheta",
      text::joined("chi2 is ", figure(fit.chi2), " for ", fit.dof, " degrees of freedom, and ",
                   figure(better.chi2), " with the edges' turns taken for degrees"));
}

}  // namespace trussmap::check
