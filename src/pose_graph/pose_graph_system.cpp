// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "pose_graph/pose_graph_system.hpp"

#include "estimation/held_unknowns.hpp"
#include "linalg/damped_step.hpp"

#include <cmath>
#include <stdexcept>

namespace trussmap::pose_graph {
namespace {

std::vector<linalg::NodePair> pairs_of(const PoseGraph& graph) {
  std::vector<linalg::NodePair> pairs;
  pairs.reserve(graph.edges());
  for (const PoseEdge& edge : graph.pose_edges) pairs.push_back({edge.from, edge.to});
  for (const PointEdge& edge : graph.point_edges) pairs.push_back({edge.pose, edge.point});
  for (const DisplacementEdge& edge : graph.displacement_edges) {
    pairs.push_back({edge.from, edge.to});
  }
  return pairs;
}

std::vector<int> sizes_of(const PoseGraph& graph, const std::vector<std::uint8_t>& held) {
  std::vector<int> sizes;
  sizes.reserve(held.size());
  for (std::size_t v = 0; v < held.size(); ++v) {
    const bool pose = is_pose(graph.vertices[v]);
    const std::uint8_t whole = pose ? estimation::held_all : estimation::held_position;
    sizes.push_back((held[v] & whole) == whole ? 0 : (pose ? 3 : 2));
  }
  return sizes;
}

}  // namespace

PoseGraphSystem::PoseGraphSystem(const PoseGraph& graph, const std::vector<std::uint8_t>& held)
    : held_(held),
      pinned_(held),
      directions_(graph.vertices.size()),
      pairs_(pairs_of(graph)),
      order_(linalg::elimination_order(static_cast<int>(graph.vertices.size()), pairs_)),
      normal_(sizes_of(graph, held), pairs_, order_) {
  pose_bars_.reserve(graph.pose_edges.size());
  for (const PoseEdge& edge : graph.pose_edges) {
    const Matrix3& I = edge.information;
    const double c = std::cos(edge.measured.heading);
    const double s = std::sin(edge.measured.heading);
    const Vector2 z = rotation(edge.measured.heading).transpose() * edge.measured.position();
    pose_bars_.push_back({edge.from, edge.to, edge.measured.heading, c, s, z.x(), z.y(), I(0, 0),
                          I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2)});
  }
  vector_bars_.reserve(graph.point_edges.size() + graph.displacement_edges.size());
  for (const PointEdge& edge : graph.point_edges) {
    const Matrix2& I = edge.information;
    vector_bars_.push_back({edge.pose, edge.point, true, edge.measured.x(), edge.measured.y(),
                            I(0, 0), I(0, 1), I(1, 1)});
  }
  for (const DisplacementEdge& edge : graph.displacement_edges) {
    const Matrix2& I = edge.information;
    vector_bars_.push_back({edge.from, edge.to, false, edge.measured.x(), edge.measured.y(),
                            I(0, 0), I(0, 1), I(1, 1)});
  }
  full_pose_bars_ = pose_bars_;
  full_vector_bars_ = vector_bars_;
  vertex_of_.resize(idx(normal_.unknowns()));
  for (int v = 0; v < static_cast<int>(graph.vertices.size()); ++v) {
    for (int k = 0; k < normal_.size(v); ++k) vertex_of_[idx(normal_.offset(v) + k)] = v;
  }
}

void PoseGraphSystem::set_weights(const std::vector<double>& weights) {
  if (weights.size() != pairs_.size()) throw std::invalid_argument("one weight per edge is needed");
  const auto scale = [](double factor, auto&... entries) { ((entries *= factor), ...); };
  pose_bars_ = full_pose_bars_;
  vector_bars_ = full_vector_bars_;
  for (std::size_t k = 0; k < pose_bars_.size(); ++k) {
    Bar3& bar = pose_bars_[k];
    scale(weights[k], bar.xx, bar.xy, bar.xt, bar.yy, bar.yt, bar.tt);
  }
  for (std::size_t k = 0; k < vector_bars_.size(); ++k) {
    Bar2& bar = vector_bars_[k];
    scale(weights[pose_bars_.size() + k], bar.xx, bar.xy, bar.yy);
  }
}

double PoseGraphSystem::chi_squared(const std::vector<Pose>& estimates) {
  return evaluate<false>(estimates);
}

double PoseGraphSystem::linearise(const std::vector<Pose>& estimates, bool hold_headings) {
  pinned_ = held_;
  if (hold_headings) {
    for (std::uint8_t& pinned : pinned_) pinned |= estimation::held_heading;
  }
  normal_.clear();
  gradient_.setZero(normal_.unknowns());
  const double chi2 = evaluate<true>(estimates);
  estimation::hold_unknowns(normal_, gradient_, pinned_);
  return chi2;
}

PoseGraphSystem::Step PoseGraphSystem::solve_step(double damping) {
  constexpr double kLeastStiffness = 1e-9;  // of the largest, to be damped by
  Step step{-gradient_};
  if (normal_.unknowns() == 0) return step;
  linalg::factorise_damped(normal_, damping, kLeastStiffness);
  normal_.solve_in_place(step.nodes);
  step.predicted = linalg::predicted_decrease(step.nodes, gradient_, normal_.diagonal(), damping);
  return step;
}

std::vector<Pose> PoseGraphSystem::moved(const std::vector<Pose>& estimates,
                                         const Eigen::VectorXd& step) const {
  std::vector<Pose> result = estimates;
  for (int v = 0; v < static_cast<int>(result.size()); ++v) {
    const int size = normal_.size(v);
    if (size == 0) continue;
    const int at = normal_.offset(v);
    result[idx(v)].x += step[at];
    result[idx(v)].y += step[at + 1];
    if (size == 3) result[idx(v)].heading += step[at + 2];
  }
  return result;
}

}  // namespace trussmap::pose_graph
