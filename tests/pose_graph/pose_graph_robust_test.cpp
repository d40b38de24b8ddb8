// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "pose_graph/synthetic_graph.hpp"
#include "trussmap/pose_graph.hpp"

#include <random>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

using testing::SyntheticGraph;

/// Adds closures between random poses that measure nonsense; returns how many edges were right.
int add_nonsense(SyntheticGraph& world, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> shift(-2.0, 2.0);
  std::uniform_int_distribution<int> pose(0, static_cast<int>(world.truth.size()) - 1);
  const int right = static_cast<int>(world.graph.pose_edges.size());
  const Matrix3 information = world.graph.pose_edges.front().information;
  for (int added = 0; added < count;) {
    const int from = pose(random);
    const int to = pose(random);
    if (std::abs(from - to) < 10) continue;
    const Pose nonsense{shift(random), shift(random), shift(random)};
    const PoseEdge edge{from, to, nonsense, information};
    const Eigen::Vector3d e = edge_error(edge, world.truth[idx(from)], world.truth[idx(to)]);
    if (e.dot(information * e) < 100.0) continue;  // right by accident
    world.graph.pose_edges.push_back(edge);
    ++added;
  }
  return right;
}

TEST(Robust, LeavesOutExactlyTheWrongClosures) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SyntheticGraph world = testing::lattice_walk(300, 8, 0.15, {0.05, 0.02}, seed);
    const PoseGraphAdjustment clean = adjust(world.graph);
    const int right = add_nonsense(world, 20, seed + 50);
    const RobustAdjustment result = adjust_robustly(world.graph);
    // Of the right closures one in a thousand may fall to the gate.
    int right_ones_out = 0;
    int wrong_ones_out = 0;
    for (const int edge : result.left_out) ++(edge < right ? right_ones_out : wrong_ones_out);
    EXPECT_EQ(wrong_ones_out, 20) << "seed " << seed;
    EXPECT_LE(right_ones_out, 3) << "seed " << seed;
    EXPECT_FALSE(result.adjustment.warnings.empty());
    for (std::size_t v = 0; v < world.truth.size(); ++v) {
      const Vector2 apart =
          result.adjustment.estimates[v].position() - clean.estimates[v].position();
      EXPECT_LT(apart.norm(), 0.1) << "vertex " << v;  // two standard deviations of one edge
    }
  }
}

TEST(Robust, ChangesNothingWhereAllIsWell) {
  const SyntheticGraph world = testing::ring(60, 5.0, {0.05, 0.02}, 3);
  const PoseGraphAdjustment plain = adjust(world.graph);
  const RobustAdjustment robust = adjust_robustly(world.graph);
  EXPECT_TRUE(robust.left_out.empty());
  EXPECT_EQ(robust.adjustment.chi2, plain.chi2);
  EXPECT_TRUE(robust.adjustment.warnings.empty());
}

TEST(Robust, KeepsTheOnlyEdgeThatTiesTwoPartsTogether) {
  // Two walks whose tie contradicts nothing, however it is, and one whose pair contradicts.
  SyntheticGraph world = testing::lattice_walk(60, 4, 0.3, {0.02, 0.01}, 4);
  PoseGraph& graph = world.graph;
  std::erase_if(graph.pose_edges, [](const PoseEdge& e) {
    return std::min(e.from, e.to) < 30 && std::max(e.from, e.to) >= 30;
  });
  graph.pose_edges.push_back({5, 40, {1.0, 0.0, 0.0}, 1e4 * Matrix3::Identity()});
  graph.pose_edges.push_back({6, 41, {9.0, 0.0, 2.0}, 1e4 * Matrix3::Identity()});
  const RobustAdjustment result = adjust_robustly(graph);
  EXPECT_EQ(result.left_out.size(), 1U);
  EXPECT_TRUE(result.adjustment.converged);
}

}  // namespace
}  // namespace trussmap
