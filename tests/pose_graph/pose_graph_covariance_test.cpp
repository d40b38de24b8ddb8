// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "pose_graph/pose_graph_gauge.hpp"
#include "pose_graph/pose_graph_system.hpp"
#include "pose_graph/synthetic_graph.hpp"
#include "trussmap/pose_graph.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::pose_graph_covariance_test {
namespace {

using testing::landmark_walk;
using testing::SyntheticGraph;

TEST(Covariances, AreTheBlocksOfTheInverseNormalMatrix) {
  const SyntheticGraph world = landmark_walk(30, 3, 6, 4.0, {0.1, 0.05}, 12);
  const PoseGraphAdjustment result = adjust(world.graph);
  pose_graph::PoseGraphSystem system(world.graph, pose_graph::choose_gauge(world.graph));
  system.linearise(result.estimates);
  const Eigen::MatrixXd inverse =
      Eigen::MatrixXd(
          Eigen::MatrixXd(system.normal_equations().matrix()).selfadjointView<Eigen::Lower>())
          .inverse();
  const std::vector<int> chosen{0, 7, 29, 31};
  const std::vector<Eigen::MatrixXd> found =
      marginal_covariances(world.graph, result.estimates, chosen);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[0], Eigen::MatrixXd::Zero(3, 3));
  for (std::size_t k = 1; k < 4; ++k) {
    const int size = chosen[k] < 30 ? 3 : 2;
    const int at = system.normal_equations().offset(chosen[k]);
    ASSERT_EQ(found[k].rows(), size);
    EXPECT_LT((found[k] - inverse.block(at, at, size, size)).norm(), 1e-10 * found[k].norm());
  }
}

TEST(Covariances, GrowLikeARandomWalkAlongAChain) {
  // A straight chain of n steps: var(x) = n sx^2, var(heading) = n sh^2, and y gains the lever of
  // each heading error: n sy^2 + sh^2 sum k^2, k = 0 ... n-1.
  constexpr int kSteps = 10;
  SyntheticGraph world;
  PoseGraph& graph = world.graph;
  for (int k = 0; k <= kSteps; ++k) {
    add_vertex(world, VertexKind::pose, {static_cast<double>(k), 0.0, 0.0});
    if (k == 0) continue;
    graph.pose_edges.push_back(
        {k - 1, k, {1.0, 0.0, 0.0}, Eigen::Vector3d(100.0, 25.0, 400.0).asDiagonal()});
  }
  const Eigen::MatrixXd C = marginal_covariances(graph, world.truth, {kSteps}).front();
  EXPECT_NEAR(C(0, 0), kSteps / 100.0, 1e-12);
  EXPECT_NEAR(C(2, 2), kSteps / 400.0, 1e-12);
  EXPECT_NEAR(C(1, 1), kSteps / 25.0 + 285.0 / 400.0, 1e-12);
}

}  // namespace
}  // namespace trussmap::pose_graph_covariance_test
