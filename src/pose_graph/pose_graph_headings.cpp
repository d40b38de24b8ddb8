// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "pose_graph/pose_graph_headings.hpp"

#include "geometry/units.hpp"
#include "pose_graph/pose_graph_chain.hpp"
#include "pose_graph/pose_graph_gauge.hpp"

#include <cmath>

namespace trussmap::pose_graph {
namespace {

constexpr int kRewindings = 5;

}  // namespace

HeadingSystem::HeadingSystem(const PoseGraph& graph, const std::vector<std::uint8_t>& held,
                             const std::vector<int>& order)
    : order_(order) {
  for (const PoseEdge& edge : graph.pose_edges) {
    const double information = heading_information(edge);
    if (!(information > 0.0)) continue;
    links_.push_back({edge.from, edge.to, edge.measured.heading, information});
    pairs_.push_back({edge.from, edge.to});
  }
  span(graph, held);
}

/// A spanning forest, breadth first from all held headings at once and then from every pose that
/// was not reached, whose heading is held from here on.
void HeadingSystem::span(const PoseGraph& graph, const std::vector<std::uint8_t>& held) {
  const std::size_t count = graph.vertices.size();
  std::vector<std::vector<int>> links_at(count);
  for (std::size_t k = 0; k < links_.size(); ++k) {
    links_at[idx(links_[k].from)].push_back(static_cast<int>(k));
    links_at[idx(links_[k].to)].push_back(static_cast<int>(k));
  }
  fixed_.assign(count, false);
  std::vector<bool> reached(count, false);
  std::vector<int> queue;
  const auto start = [&](std::size_t root) {
    fixed_[root] = true;
    reached[root] = true;
    queue.push_back(static_cast<int>(root));
  };
  std::size_t next = 0;
  const auto grow = [&] {
    for (; next < queue.size(); ++next) {
      for (const int link : links_at[idx(queue[next])]) {
        const bool forwards = links_[idx(link)].from == queue[next];
        const int other = forwards ? links_[idx(link)].to : links_[idx(link)].from;
        if (reached[idx(other)]) continue;
        reached[idx(other)] = true;
        tree_.push_back({link, forwards});
        queue.push_back(other);
      }
    }
  };
  for (std::size_t v = 0; v < count; ++v) {
    if (!is_pose(graph.vertices[v])) {
      fixed_[v] = true;
    } else if ((held[v] & estimation::held_heading) != 0) {
      start(v);
    }
  }
  grow();
  for (std::size_t v = 0; v < count; ++v) {
    if (!is_pose(graph.vertices[v]) || reached[v]) continue;
    start(v);
    grow();
  }
}

linalg::BlockSystem HeadingSystem::lay_out(int size) const {
  std::vector<int> sizes;
  sizes.reserve(fixed_.size());
  for (const bool fixed : fixed_) sizes.push_back(fixed ? 0 : size);
  return {sizes, pairs_, order_};
}

std::vector<Pose> HeadingSystem::fit(const std::vector<Pose>& estimates) {
  using Scalar = Eigen::Matrix<double, 1, 1>;
  if (!angles_) {
    angles_.emplace(lay_out(1));
    for (std::size_t k = 0; k < links_.size(); ++k) {
      const Scalar kappa(links_[k].information);
      angles_->add_diagonal(links_[k].from, kappa);
      angles_->add_diagonal(links_[k].to, kappa);
      angles_->add_coupling(static_cast<int>(k), Scalar(-kappa));
    }
    if (angles_->unknowns() > 0) angles_->factorise();
  }
  std::vector<Pose> result = estimates;
  if (angles_->unknowns() == 0) return result;
  std::vector<int> turns = windings(result);
  for (int round = 0; round < kRewindings; ++round) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(angles_->unknowns());
    for (const Link& link : links_) {
      const double off =
          result[idx(link.to)].heading - result[idx(link.from)].heading - link.measured;
      const double pull = link.information * std::remainder(off, geometry::kFullTurn);
      if (!fixed_[idx(link.from)]) step[angles_->offset(link.from)] += pull;
      if (!fixed_[idx(link.to)]) step[angles_->offset(link.to)] -= pull;
    }
    angles_->solve_in_place(step);
    for (std::size_t v = 0; v < result.size(); ++v) {
      const int vertex = static_cast<int>(v);
      if (!fixed_[v]) result[v].heading += step[angles_->offset(vertex)];
    }
    // Edges that were wound the wrong way may show it now: then the fit has to be made again.
    std::vector<int> now = windings(result);
    if (now == turns) break;
    turns = std::move(now);
  }
  return result;
}

std::vector<Pose> HeadingSystem::relax(const std::vector<Pose>& estimates) {
  linalg::BlockSystem system = lay_out(2);
  if (system.unknowns() == 0) return estimates;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(system.unknowns());
  const auto unit = [&estimates](int v) {
    return Vector2(std::cos(estimates[idx(v)].heading), std::sin(estimates[idx(v)].heading));
  };
  for (std::size_t k = 0; k < links_.size(); ++k) {
    const Link& link = links_[k];
    const Matrix2 kappa = link.information * Matrix2::Identity();
    const Matrix2 turned = link.information * rotation(link.measured);
    system.add_diagonal(link.from, kappa);
    system.add_diagonal(link.to, kappa);
    system.add_coupling(static_cast<int>(k), Matrix2(-turned.transpose()));
    const bool from_fixed = fixed_[idx(link.from)];
    const bool to_fixed = fixed_[idx(link.to)];
    if (from_fixed && !to_fixed) u.segment<2>(system.offset(link.to)) += turned * unit(link.from);
    if (to_fixed && !from_fixed) {
      u.segment<2>(system.offset(link.from)) += turned.transpose() * unit(link.to);
    }
  }
  system.factorise();
  system.solve_in_place(u);
  std::vector<Pose> result = estimates;
  for (std::size_t v = 0; v < result.size(); ++v) {
    const int vertex = static_cast<int>(v);
    if (!fixed_[v]) result[v].heading = direction(u.segment<2>(system.offset(vertex)));
  }
  return result;
}

std::vector<int> HeadingSystem::windings(const std::vector<Pose>& estimates) const {
  const auto turns_of = [&estimates](const Link& link) {
    const double off =
        estimates[idx(link.to)].heading - estimates[idx(link.from)].heading - link.measured;
    return static_cast<int>(std::lround(off / geometry::kFullTurn));
  };
  std::vector<int> excess(estimates.size(), 0);  // whole turns that a heading has too many
  for (const Branch& branch : tree_) {
    const Link& link = links_[idx(branch.link)];
    const int turns = turns_of(link);
    if (branch.forwards) {
      excess[idx(link.to)] = excess[idx(link.from)] + turns;
    } else {
      excess[idx(link.from)] = excess[idx(link.to)] - turns;
    }
  }
  std::vector<int> result;
  result.reserve(links_.size());
  for (const Link& link : links_) {
    result.push_back(turns_of(link) - excess[idx(link.to)] + excess[idx(link.from)]);
  }
  return result;
}

}  // namespace trussmap::pose_graph
