// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Pose graphs with known truth.
#pragma once

#include "geometry/index.hpp"
#include "trussmap/pose_graph.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace trussmap::testing {

struct Noise {
  double position = 0.0;  ///< sd of each coordinate of a measurement, m
  double heading = 0.0;   ///< sd, rad
};

struct SyntheticGraph {
  PoseGraph graph;          ///< without estimates
  std::vector<Pose> truth;  ///< per vertex; the first is the origin
};

/// Measures with the given noise and claims just that information (1 % and 0.01 rad at least, so
/// that noise-free graphs have finite weights).
class Measurer {
 public:
  Measurer(Noise noise, std::uint64_t seed) : noise_(noise), random_(seed) {}

  PoseEdge pose_edge(const std::vector<Pose>& truth, int from, int to) {
    Pose z = relative(truth[idx(from)], truth[idx(to)]);
    z.x += noise_.position * normal_(random_);
    z.y += noise_.position * normal_(random_);
    z.heading = wrap_angle(z.heading + noise_.heading * normal_(random_));
    const double p = weight(noise_.position);
    return {from, to, z, Eigen::Vector3d(p, p, weight(noise_.heading)).asDiagonal()};
  }

  PointEdge point_edge(const std::vector<Pose>& truth, int pose, int point) {
    const Pose& at = truth[idx(pose)];
    const Vector2 seen =
        rotation(at.heading).transpose() * (truth[idx(point)].position() - at.position());
    return {pose, point, seen + step(), weight(noise_.position) * Matrix2::Identity()};
  }

  DisplacementEdge displacement_edge(const std::vector<Pose>& truth, int from, int to) {
    const Vector2 d = truth[idx(to)].position() - truth[idx(from)].position();
    return {from, to, d + step(), weight(noise_.position) * Matrix2::Identity()};
  }

  std::mt19937_64& random() { return random_; }

 private:
  static double weight(double sd) {
    const double finite = std::max(sd, 0.01);
    return 1.0 / (finite * finite);
  }
  Vector2 step() {
    const double x = noise_.position * normal_(random_);
    const double y = noise_.position * normal_(random_);
    return {x, y};
  }

  Noise noise_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

inline void add_vertex(SyntheticGraph& world, VertexKind kind, const Pose& truth) {
  const auto id = static_cast<std::int64_t>(world.truth.size());
  world.graph.vertices.push_back({id, kind, std::nullopt, false});
  world.truth.push_back(truth);
}

/// Poses evenly round a circle, facing along it, each tied to the next and the last to the first.
inline SyntheticGraph ring(int poses, double radius, Noise noise, std::uint64_t seed) {
  SyntheticGraph world;
  for (int k = 0; k < poses; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / poses;
    const Pose at{radius * std::sin(angle), radius * (1.0 - std::cos(angle)), angle};
    add_vertex(world, VertexKind::pose, at);
  }
  Measurer measure(noise, seed);
  for (int k = 0; k < poses; ++k) {
    world.graph.pose_edges.push_back(measure.pose_edge(world.truth, k, (k + 1) % poses));
  }
  return world;
}

/// A random walk on the lattice -extent ... extent, one metre a step; a pose is tied to the next
/// and, with probability `closure`, to each older pose within a step of it.
inline SyntheticGraph lattice_walk(int poses, int extent, double closure, Noise noise,
                                   std::uint64_t seed) {
  SyntheticGraph world;
  Measurer measure(noise, seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int x = 0;
  int y = 0;
  int facing = 0;
  constexpr int kX[4] = {1, 0, -1, 0};
  constexpr int kY[4] = {0, 1, 0, -1};
  for (int k = 0; k < poses; ++k) {
    add_vertex(world, VertexKind::pose,
               {static_cast<double>(x), static_cast<double>(y), facing * std::numbers::pi / 2.0});
    for (int old = 0; old < k - 1; ++old) {
      const Pose& there = world.truth[idx(old)];
      const double apart = std::abs(there.x - x) + std::abs(there.y - y);
      if (apart < 1.5 && uniform(measure.random()) < closure) {
        world.graph.pose_edges.push_back(measure.pose_edge(world.truth, old, k));
      }
    }
    if (k > 0) world.graph.pose_edges.push_back(measure.pose_edge(world.truth, k - 1, k));
    const double choice = uniform(measure.random());
    if (choice < 0.5) facing += choice < 0.25 ? 1 : 3;
    for (;;) {
      facing %= 4;
      const int next_x = x + kX[facing];
      const int next_y = y + kY[facing];
      if (std::abs(next_x) <= extent && std::abs(next_y) <= extent) {
        x = next_x;
        y = next_y;
        break;
      }
      ++facing;
    }
  }
  return world;
}

/// The same walk with points strewn over the lattice, seen from within `sight` metres; no pose is
/// tied to another one but the next.
inline SyntheticGraph landmark_walk(int poses, int extent, int points, double sight, Noise noise,
                                    std::uint64_t seed) {
  SyntheticGraph world = lattice_walk(poses, extent, 0.0, noise, seed);
  Measurer measure(noise, seed + 1);
  std::uniform_real_distribution<double> place(-extent, extent);
  for (int k = 0; k < points; ++k) {
    const double x = place(measure.random());
    const double y = place(measure.random());
    std::vector<PointEdge> edges;
    world.truth.push_back({x, y, 0.0});
    const int point = static_cast<int>(world.truth.size()) - 1;
    for (int pose = 0; pose < poses; ++pose) {
      const Vector2 apart = world.truth[idx(point)].position() - world.truth[idx(pose)].position();
      if (apart.norm() < sight) edges.push_back(measure.point_edge(world.truth, pose, point));
    }
    world.truth.pop_back();
    if (edges.empty()) continue;
    const int number = static_cast<int>(world.truth.size());
    add_vertex(world, VertexKind::point, {x, y, 0.0});
    for (PointEdge& edge : edges) {
      edge.point = number;
      world.graph.point_edges.push_back(edge);
    }
  }
  return world;
}

}  // namespace trussmap::testing
