// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/graph_fit.hpp"

#include "geometry/index.hpp"
#include "pose_graph/pose_graph_chain.hpp"
#include "pose_graph/pose_graph_descent.hpp"
#include "pose_graph/pose_graph_gauge.hpp"
#include "pose_graph/pose_graph_headings.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace trussmap::check {
namespace {

constexpr linalg::DescentOptions kQuickFit{30, 1e-5};
constexpr double kWellFitted = 3.0;  // chi^2 per degree of freedom that needs no second start

struct QuickStart {
  std::vector<Pose> estimates;
  double chi2 = 0.0;
};

std::vector<QuickStart> quick_starts(const PoseGraph& graph, const std::vector<std::uint8_t>& held,
                                     pose_graph::PoseGraphSystem& system) {
  std::vector<QuickStart> starts;
  const auto add = [&](std::vector<Pose> estimates) {
    const double chi2 = system.chi_squared(estimates);
    starts.push_back({std::move(estimates), chi2});
  };
  if (graph.pose_edges.empty()) {
    add(pose_graph::chain_measurements(graph, held, pose_graph::Tree::odometry));
  } else {
    pose_graph::HeadingSystem headings(graph, held, system.order());
    const std::vector<Pose> nearest =
        pose_graph::chain_measurements(graph, held, pose_graph::Tree::nearest);
    add(pose_graph::fit_positions(system, headings.fit(nearest)));
    add(pose_graph::fit_positions(system, headings.relax(nearest)));
    add(pose_graph::fit_positions(system, headings.fit(pose_graph::chain_measurements(
                                              graph, held, pose_graph::Tree::odometry))));
  }
  const bool stated = std::all_of(graph.vertices.begin(), graph.vertices.end(),
                                  [](const GraphVertex& one) { return one.estimate.has_value(); });
  if (stated) {
    std::vector<Pose> estimates;
    for (const GraphVertex& one : graph.vertices) estimates.push_back(*one.estimate);
    add(std::move(estimates));
  }
  std::sort(starts.begin(), starts.end(),
            [](const QuickStart& a, const QuickStart& b) { return a.chi2 < b.chi2; });
  return starts;
}

}  // namespace

GraphFit fit_graph(const PoseGraph& graph) {
  const std::vector<std::uint8_t> held = pose_graph::choose_gauge(graph);
  pose_graph::PoseGraphSystem system(graph, held);
  GraphFit best;
  best.dof = pose_graph::count_measurements(graph) - pose_graph::count_unknowns(graph, held);
  for (QuickStart& start : quick_starts(graph, held, system)) {
    if (!best.estimates.empty() && start.chi2 > 100.0 * best.chi2) break;
    pose_graph::Descent descent =
        pose_graph::descend(system, std::move(start.estimates), kQuickFit);
    const bool better = best.estimates.empty() || descent.chi2 < best.chi2;
    if (better) {
      best.estimates = std::move(descent.estimates);
      best.chi2 = descent.chi2;
    }
    if (best.chi2 < kWellFitted * best.dof) break;
  }
  return best;
}

std::vector<double> squared_errors(const PoseGraph& graph, const std::vector<Pose>& estimates) {
  std::vector<double> squares;
  squares.reserve(graph.pose_edges.size());
  for (const PoseEdge& edge : graph.pose_edges) {
    const Eigen::Vector3d e = edge_error(edge, estimates[idx(edge.from)], estimates[idx(edge.to)]);
    squares.push_back(e.dot(edge.information * e));
  }
  return squares;
}

PoseGraph tied_together(PoseGraph graph) {
  const std::vector<pose_graph::GraphPart> parts = pose_graph::graph_parts(graph);
  for (std::size_t k = 1; k < parts.size(); ++k) {
    const bool loose = !parts[k].is_fixed() || !parts.front().is_fixed();
    if (!loose) continue;
    const int first = parts.front().vertices.front();
    const int here = parts[k].vertices.front();
    const bool first_pose = is_pose(graph.vertices[idx(first)]);
    const bool here_pose = is_pose(graph.vertices[idx(here)]);
    const Vector2 nothing = Vector2::Zero();
    const Matrix2 loosely = Matrix2::Identity();
    if (first_pose && here_pose) {
      PoseEdge tie{first, here, Pose{}, Matrix3::Identity()};
      if (parts.front().has_displacements && parts[k].has_displacements) {
        tie.information(2, 2) = 0.0;
      }
      graph.pose_edges.push_back(tie);
    } else if (first_pose) {
      graph.point_edges.push_back({first, here, nothing, loosely});
    } else if (here_pose) {
      graph.point_edges.push_back({here, first, nothing, loosely});
    } else {
      graph.displacement_edges.push_back({first, here, nothing, loosely});
    }
  }
  return graph;
}

bool closes_loop(const PoseGraph& graph, const PoseEdge& edge) {
  const std::int64_t by_id = graph.vertices[idx(edge.from)].id - graph.vertices[idx(edge.to)].id;
  return std::abs(edge.from - edge.to) != 1 && std::abs(by_id) != 1;
}

std::vector<int> loop_edges(const PoseGraph& graph) {
  std::vector<int> places;
  for (std::size_t k = 0; k < graph.pose_edges.size(); ++k) {
    if (closes_loop(graph, graph.pose_edges[k])) places.push_back(static_cast<int>(k));
  }
  return places;
}

PoseGraph with_information(PoseGraph graph,
                           const std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>& changed) {
  for (PoseEdge& edge : graph.pose_edges) edge.information = changed(edge.information);
  for (PointEdge& edge : graph.point_edges) edge.information = changed(edge.information);
  for (DisplacementEdge& edge : graph.displacement_edges) {
    edge.information = changed(edge.information);
  }
  return graph;
}

}  // namespace trussmap::check
