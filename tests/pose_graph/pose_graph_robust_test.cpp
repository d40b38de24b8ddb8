// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "pose_graph/synthetic_graph.hpp"
#include "trussmap/pose_graph.hpp"

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::pose_graph_robust_test {
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

/// A ring of 16 poses with six more closures whose errors are some five times what they say: some
/// right, some wrong, some in between.
SyntheticGraph ring_with_doubtful_closures(std::uint64_t seed) {
  SyntheticGraph world = testing::ring(16, 5.0, {0.05, 0.02}, seed);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> pose(0, 15);
  const Matrix3 information = world.graph.pose_edges.front().information;
  while (world.graph.pose_edges.size() < 22) {
    const int from = pose(random);
    const int to = pose(random);
    if (std::abs(from - to) < 4) continue;
    Pose z = relative(world.truth[idx(from)], world.truth[idx(to)]);
    z.x += 0.3 * normal(random);
    z.y += 0.3 * normal(random);
    z.heading += 0.1 * normal(random);
    world.graph.pose_edges.push_back({from, to, z, information});
  }
  return world;
}

/// Of all 128 sets of closures that may be left out, by trying each: the one with the least chi^2,
/// a closure that is out counting as much as the gate.
std::vector<int> best_left_out(const PoseGraph& graph) {
  std::vector<int> closures;
  for (std::size_t k = 0; k < graph.pose_edges.size(); ++k) {
    const PoseEdge& edge = graph.pose_edges[k];
    if (std::abs(edge.from - edge.to) != 1) closures.push_back(static_cast<int>(k));
  }
  double least = std::numeric_limits<double>::infinity();
  std::vector<int> best;
  for (unsigned set = 0; set < (1U << closures.size()); ++set) {
    std::vector<int> out;
    for (std::size_t k = 0; k < closures.size(); ++k) {
      if ((set >> k & 1U) != 0U) out.push_back(closures[k]);
    }
    PoseGraph kept = graph;
    for (auto k = out.rbegin(); k != out.rend(); ++k) {
      kept.pose_edges.erase(kept.pose_edges.begin() + *k);
    }
    const double cost = adjust(kept).chi2 + kPoseGraphGate * static_cast<double>(out.size());
    if (cost >= least) continue;
    least = cost;
    best = std::move(out);
  }
  return best;
}

/// The descent from all closures and that from the odometry end in sets that differ by less than
/// one in chi^2 and in their number: each closure that is kept costs what it contradicts, and no
/// more. (On one graph in three like these both miss the best; seeds are some on which one has it.)
TEST(Robust, TakesTheCheaperOfTwoDescents) {
  for (const std::uint64_t seed : {1U, 348U, 372U, 411U, 579U, 986U, 1806U, 2268U}) {
    const SyntheticGraph world = ring_with_doubtful_closures(seed);
    EXPECT_EQ(adjust_robustly(world.graph).left_out, best_left_out(world.graph)) << seed;
  }
}

}  // namespace
}  // namespace trussmap::pose_graph_robust_test
