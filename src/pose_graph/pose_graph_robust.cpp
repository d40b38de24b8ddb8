// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/robust_weights.hpp"
#include "linalg/connected_parts.hpp"
#include "pose_graph/pose_graph_chain.hpp"
#include "pose_graph/pose_graph_descent.hpp"
#include "pose_graph/pose_graph_gauge.hpp"
#include "text/number_text.hpp"
#include "trussmap/pose_graph.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace trussmap {
using namespace pose_graph;

namespace {

constexpr int kRounds = 60;  // of weights: mu grows by 1.4^60 = 6e8, which is the truncated square
constexpr linalg::DescentOptions kRound{10, 1e-6};

bool is_loop_closure(const PoseEdge& edge) {
  return std::abs(edge.from - edge.to) != 1;
}

class Graduation {
 public:
  Graduation(const PoseGraph& graph, double gate)
      : graph_(graph), gate_(gate), system_(graph, choose_gauge(graph)) {
    for (std::size_t k = 0; k < graph.pose_edges.size(); ++k) {
      if (is_loop_closure(graph.pose_edges[k])) closures_.push_back(k);
    }
  }

  /// Estimates at the end of a graduation that begins with `start`.
  std::vector<Pose> run(std::vector<Pose> estimates) {
    std::vector<double> weights(graph_.edges(), 1.0);
    double largest = 0.0;
    for (const std::size_t k : closures_) largest = std::max(largest, square(k, estimates));
    if (largest <= gate_) return estimates;
    const auto weigh = [&](double mu) {
      bool graded = false;
      for (const std::size_t k : closures_) {
        weights[k] = estimation::gnc_weight(square(k, estimates), gate_, mu);
        graded = graded || (weights[k] > 0.0 && weights[k] < 1.0);
      }
      system_.set_weights(weights);
      return graded;
    };
    estimation::bend({.first = estimation::first_bend(largest, gate_), .most_rounds = kRounds},
                     weigh,
                     [&] { estimates = descend(system_, std::move(estimates), kRound).estimates; });
    return estimates;
  }

  /// Dead reckoning, closures unheard.
  [[nodiscard]] std::vector<Pose> odometry() const {
    return chain_measurements(graph_, choose_gauge(graph_), Tree::odometry);
  }

  [[nodiscard]] double truncated(const std::vector<Pose>& estimates) const {
    double cost = chi_squared(graph_, estimates);
    for (const std::size_t k : closures_) {
      cost -= std::max(0.0, square(k, estimates) - gate_);
    }
    return cost;
  }

  [[nodiscard]] std::vector<std::size_t> outside(const std::vector<Pose>& estimates) const {
    std::vector<std::size_t> result;
    for (const std::size_t k : closures_) {
      if (square(k, estimates) > gate_) result.push_back(k);
    }
    std::sort(result.begin(), result.end(), [&](std::size_t a, std::size_t b) {
      return square(a, estimates) < square(b, estimates);
    });
    return result;
  }

 private:
  [[nodiscard]] double square(std::size_t edge, const std::vector<Pose>& estimates) const {
    const PoseEdge& at = graph_.pose_edges[edge];
    const Eigen::Vector3d e = edge_error(at, estimates[idx(at.from)], estimates[idx(at.to)]);
    return e.dot(at.information * e);
  }

  const PoseGraph& graph_;
  double gate_;
  PoseGraphSystem system_;
  std::vector<std::size_t> closures_;
};

/// Those of `wrong` (the least wrong first) that the graph can do without and stay in one piece.
std::vector<int> dispensable(const PoseGraph& graph, const std::vector<std::size_t>& wrong) {
  linalg::DisjointSets parts(static_cast<int>(graph.vertices.size()));
  std::vector<bool> out(graph.pose_edges.size(), false);
  for (const std::size_t k : wrong) out[k] = true;
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (!out[k]) parts.join(graph.pose_edges[k].from, graph.pose_edges[k].to);
  }
  for (const PointEdge& edge : graph.point_edges) parts.join(edge.pose, edge.point);
  for (const DisplacementEdge& edge : graph.displacement_edges) parts.join(edge.from, edge.to);
  std::vector<int> result;
  for (const std::size_t k : wrong) {
    const PoseEdge& edge = graph.pose_edges[k];
    if (parts.lowest(edge.from) == parts.lowest(edge.to)) {
      result.push_back(static_cast<int>(k));
    } else {
      parts.join(edge.from, edge.to);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

PoseGraph without(const PoseGraph& graph, const std::vector<int>& left_out) {
  PoseGraph kept = graph;
  kept.pose_edges.clear();
  for (std::size_t k = 0; k < graph.pose_edges.size(); ++k) {
    if (!std::binary_search(left_out.begin(), left_out.end(), static_cast<int>(k))) {
      kept.pose_edges.push_back(graph.pose_edges[k]);
    }
  }
  return kept;
}

std::string describe(const PoseGraph& graph, const std::vector<int>& left_out) {
  constexpr std::size_t kClosuresNamed = 8;
  std::string text = text::joined(left_out.size(), " loop closure", left_out.size() == 1 ? "" : "s",
                                  " left out as wrong: ");
  for (std::size_t k = 0; k < std::min(kClosuresNamed, left_out.size()); ++k) {
    const PoseEdge& edge = graph.pose_edges[idx(left_out[k])];
    text += text::joined(k == 0 ? "" : ", ", graph.vertices[idx(edge.from)].id, " to ",
                         graph.vertices[idx(edge.to)].id);
  }
  if (left_out.size() > kClosuresNamed)
    text += text::joined(" and ", left_out.size() - kClosuresNamed, " more");
  return text;
}

}  // namespace

RobustAdjustment adjust_robustly(const PoseGraph& graph, const RobustOptions& options) {
  RobustAdjustment result;
  result.adjustment = adjust(graph, options.adjustment);
  Graduation graduation(graph, options.gate);
  if (graduation.outside(result.adjustment.estimates).empty()) return result;

  const std::vector<Pose> from_all = graduation.run(result.adjustment.estimates);
  const std::vector<Pose> from_odometry = graduation.run(graduation.odometry());
  const bool all_is_better = graduation.truncated(from_all) <= graduation.truncated(from_odometry);
  const std::vector<Pose>& best = all_is_better ? from_all : from_odometry;
  std::vector<int> left_out = dispensable(graph, graduation.outside(best));
  estimation::reconsider([&](int) {
    result.left_out = left_out;
    result.adjustment = adjust(without(graph, left_out), options.adjustment);
    left_out = dispensable(graph, graduation.outside(result.adjustment.estimates));
    return left_out != result.left_out;
  });
  if (!result.left_out.empty()) {
    result.adjustment.warnings.insert(result.adjustment.warnings.begin(),
                                      describe(graph, result.left_out));
  }
  return result;
}

}  // namespace trussmap
