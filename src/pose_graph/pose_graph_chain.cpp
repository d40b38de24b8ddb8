// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "pose_graph/pose_graph_chain.hpp"

#include "geometry/index.hpp"
#include "pose_graph/pose_graph_gauge.hpp"
#include "trussmap/planar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

#include <Eigen/LU>

namespace trussmap::pose_graph {
namespace {

/// For each vertex the numbers of the edges at it, in rows laid end to end.
struct Incidence {
  std::vector<int> begin;
  std::vector<int> edge;
};

template <typename Edges, typename Ends>
Incidence incidence_of(const Edges& edges, std::size_t vertices, const Ends& ends) {
  Incidence result;
  result.begin.assign(vertices + 1, 0);
  for (const auto& edge : edges) {
    for (const int v : ends(edge)) ++result.begin[idx(v) + 1];
  }
  for (std::size_t v = 0; v < vertices; ++v) result.begin[v + 1] += result.begin[v];
  result.edge.resize(2 * edges.size());
  std::vector<int> next = result.begin;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    for (const int v : ends(edges[k])) result.edge[idx(next[idx(v)]++)] = static_cast<int>(k);
  }
  return result;
}

class Chainer {
 public:
  Chainer(const PoseGraph& graph, const std::vector<std::uint8_t>& held, Tree tree)
      : graph_(graph),
        held_(held),
        tree_(tree),
        poses_(incidence_of(graph.pose_edges, graph.vertices.size(),
                            [](const PoseEdge& e) {
                              return std::array{e.from, e.to};
                            })),
        points_(incidence_of(graph.point_edges, graph.vertices.size(),
                             [](const PointEdge& e) {
                               return std::array{e.pose, e.point};
                             })),
        displacements_(incidence_of(graph.displacement_edges, graph.vertices.size(),
                                    [](const DisplacementEdge& e) {
                                      return std::array{e.from, e.to};
                                    })),
        placed_(graph.vertices.size(), false),
        cluster_(graph.vertices.size(), -1),
        estimates_(graph.vertices.size()) {}

  std::vector<Pose> run() {
    chain_clusters();
    seed();
    while (const std::optional<int> next = best_tied_cluster()) attach(*next);
    shift_to_held_position();
    return std::move(estimates_);
  }

 private:
  struct Cluster {
    std::vector<int> poses;
    bool placed = false;
    int sightings_of_placed = 0;
  };
  // Least first: rank, then the order of arrival, so that ties fall the same way every time.
  using Candidate = std::tuple<double, long, int, int>;  // rank, arrival, pose edge, new pose

  [[nodiscard]] Pose held_estimate(int vertex) const {
    return graph_.vertices[idx(vertex)].estimate.value_or(Pose{});
  }

  [[nodiscard]] double rank(const PoseEdge& edge, double so_far) const {
    switch (tree_) {
      case Tree::odometry:
        return std::abs(edge.from - edge.to) == 1 ? 0.0 : 1.0;
      case Tree::strongest:
        return -heading_information(edge);
      case Tree::nearest:
        break;
    }
    const double information = heading_information(edge);
    return information > 0.0 ? so_far + 1.0 / information : std::numeric_limits<double>::max();
  }

  void chain_clusters() {
    const int count = static_cast<int>(graph_.vertices.size());
    for (int v = 0; v < count; ++v) {  // clusters with held headings grow from these, all at once
      if (is_pose(graph_.vertices[idx(v)]) && held_[idx(v)] == estimation::held_all)
        roots_.push_back(v);
    }
    for (const int v : roots_) cluster_[idx(v)] = 0;
    if (!roots_.empty()) grow(roots_, true);
    for (int v = 0; v < count; ++v) {
      if (is_pose(graph_.vertices[idx(v)]) && cluster_[idx(v)] < 0) grow({v}, false);
    }
  }

  void grow(const std::vector<int>& roots, bool placed) {
    const int number = static_cast<int>(clusters_.size());
    clusters_.emplace_back();
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
    long arrivals = 0;
    const auto reach = [&](int pose, double so_far) {
      cluster_[idx(pose)] = number;
      placed_[idx(pose)] = placed;
      clusters_.back().poses.push_back(pose);
      for (int k = poses_.begin[idx(pose)]; k < poses_.begin[idx(pose) + 1]; ++k) {
        const int number_of_edge = poses_.edge[idx(k)];
        const PoseEdge& edge = graph_.pose_edges[idx(number_of_edge)];
        const int other = edge.from == pose ? edge.to : edge.from;
        if (cluster_[idx(other)] < 0) {
          queue.emplace(rank(edge, so_far), arrivals++, number_of_edge, other);
        }
      }
    };
    for (const int root : roots) {
      const bool known = (held_[idx(root)] & estimation::held_heading) != 0;
      estimates_[idx(root)] = known ? held_estimate(root) : Pose{};
      reach(root, 0.0);
    }
    while (!queue.empty()) {
      const auto [ranked, arrival, number_of_edge, pose] = queue.top();
      queue.pop();
      if (cluster_[idx(pose)] >= 0) continue;
      const PoseEdge& edge = graph_.pose_edges[idx(number_of_edge)];
      estimates_[idx(pose)] = edge.to == pose
                                  ? compose(estimates_[idx(edge.from)], edge.measured)
                                  : compose(estimates_[idx(edge.to)], inverse(edge.measured));
      reach(pose, tree_ == Tree::nearest ? ranked : 0.0);
    }
    clusters_.back().placed = placed;
  }

  /// Something has to stand first: what is held, else displacements, which know the direction.
  void seed() {
    bool any = false;
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
      if (!clusters_[c].placed) continue;
      any = true;
      settle(clusters_[c]);
    }
    for (std::size_t v = 0; v < held_.size(); ++v) {
      const bool point = !is_pose(graph_.vertices[v]);
      if (!point || (held_[v] & estimation::held_position) == 0) continue;
      any = true;
      place_point(static_cast<int>(v), held_estimate(static_cast<int>(v)).position());
    }
    if (any) return;
    if (!graph_.displacement_edges.empty()) {
      place_point(graph_.displacement_edges.front().from, Vector2::Zero());
    } else if (!clusters_.empty()) {
      settle(clusters_.front());
    }
  }

  void settle(Cluster& cluster) {
    cluster.placed = true;
    for (const int pose : cluster.poses) {
      placed_[idx(pose)] = true;
      for (int k = points_.begin[idx(pose)]; k < points_.begin[idx(pose) + 1]; ++k) {
        const PointEdge& edge = graph_.point_edges[idx(points_.edge[idx(k)])];
        place_point(edge.point, seen_at(edge));
      }
    }
  }

  [[nodiscard]] Vector2 seen_at(const PointEdge& edge) const {
    const Pose& pose = estimates_[idx(edge.pose)];
    return pose.position() + rotation(pose.heading) * edge.measured;
  }

  /// Places the point and those that displacements tie to it.
  void place_point(int first, const Vector2& position) {
    if (placed_[idx(first)]) return;
    estimates_[idx(first)] = {position.x(), position.y(), 0.0};
    placed_[idx(first)] = true;
    std::vector<int> reached{first};
    for (std::size_t next = 0; next < reached.size(); ++next) {
      const int point = reached[next];
      announce(point);
      const Vector2 here = estimates_[idx(point)].position();
      for (int k = displacements_.begin[idx(point)]; k < displacements_.begin[idx(point) + 1];
           ++k) {
        const DisplacementEdge& edge = graph_.displacement_edges[idx(displacements_.edge[idx(k)])];
        const bool forwards = edge.from == point;
        const int other = forwards ? edge.to : edge.from;
        if (placed_[idx(other)]) continue;
        const Vector2 there = forwards ? Vector2(here + edge.measured) : here - edge.measured;
        estimates_[idx(other)] = {there.x(), there.y(), 0.0};
        placed_[idx(other)] = true;
        reached.push_back(other);
      }
    }
  }

  /// Tells the clusters that see the point that it stands.
  void announce(int point) {
    for (int k = points_.begin[idx(point)]; k < points_.begin[idx(point) + 1]; ++k) {
      const int number = cluster_[idx(graph_.point_edges[idx(points_.edge[idx(k)])].pose)];
      Cluster& cluster = clusters_[idx(number)];
      if (!cluster.placed) waiting_.emplace(++cluster.sightings_of_placed, -number);
    }
  }

  std::optional<int> best_tied_cluster() {
    while (!waiting_.empty()) {
      const int number = -waiting_.top().second;
      waiting_.pop();
      if (!clusters_[idx(number)].placed) return number;
    }
    return std::nullopt;
  }

  void attach(int number) {
    Cluster& cluster = clusters_[idx(number)];
    std::vector<Vector2> seen;
    std::vector<Vector2> stands;
    for (const int pose : cluster.poses) {
      for (int k = points_.begin[idx(pose)]; k < points_.begin[idx(pose) + 1]; ++k) {
        const PointEdge& edge = graph_.point_edges[idx(points_.edge[idx(k)])];
        if (!placed_[idx(edge.point)]) continue;
        seen.push_back(seen_at(edge));
        stands.push_back(estimates_[idx(edge.point)].position());
      }
    }
    Alignment move;
    if (seen.size() > 1) {
      move = align_rigidly(seen, stands);
    } else {
      move.translation = stands.front() - seen.front();
    }
    for (const int pose : cluster.poses) {
      Pose& at = estimates_[idx(pose)];
      const Vector2 there = move.apply(at.position());
      at = {there.x(), there.y(), at.heading + move.angle};
    }
    settle(cluster);
  }

  /// With a held position and free headings the whole was placed anywhere.
  void shift_to_held_position() {
    for (std::size_t v = 0; v < held_.size(); ++v) {
      if ((held_[v] & estimation::held_position) == 0) continue;
      const Vector2 shift =
          held_estimate(static_cast<int>(v)).position() - estimates_[v].position();
      for (Pose& estimate : estimates_) {
        estimate.x += shift.x();
        estimate.y += shift.y();
      }
      const Pose exact = held_estimate(static_cast<int>(v));
      estimates_[v].x = exact.x;
      estimates_[v].y = exact.y;
      return;
    }
  }

  const PoseGraph& graph_;
  const std::vector<std::uint8_t>& held_;
  Tree tree_;
  Incidence poses_;
  Incidence points_;
  Incidence displacements_;
  std::vector<int> roots_;
  std::vector<bool> placed_;
  std::vector<int> cluster_;  ///< of each pose; -1 of points
  std::vector<Cluster> clusters_;
  std::priority_queue<std::pair<int, int>> waiting_;  ///< sightings of placed points, -cluster
  std::vector<Pose> estimates_;
};

}  // namespace

std::vector<Pose> chain_measurements(const PoseGraph& graph, const std::vector<std::uint8_t>& held,
                                     Tree tree) {
  return Chainer(graph, held, tree).run();
}

double heading_information(const PoseEdge& edge) {
  const Matrix2 position = edge.information.topLeftCorner<2, 2>();
  const Vector2 mixed = edge.information.topRightCorner<2, 1>();
  const double heading = edge.information(2, 2);
  const double determinant = position.determinant();
  if (!(determinant > 1e-12 * position.trace() * position.trace())) return heading;
  const Matrix2 adjugate =
      (Matrix2() << position(1, 1), -position(0, 1), -position(1, 0), position(0, 0)).finished();
  return std::max(0.0, heading - mixed.dot(adjugate * mixed) / determinant);
}

}  // namespace trussmap::pose_graph
