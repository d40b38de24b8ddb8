// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/pose_graph.hpp"

#include "pose_graph/synthetic_graph.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace trussmap::pose_graph_test {
namespace {

Eigen::Isometry2d transform(const Pose& pose) {
  Eigen::Isometry2d T = Eigen::Isometry2d::Identity();
  T.translate(pose.position()).rotate(pose.heading);
  return T;
}

TEST(EdgeError, IsTheVectorOfTheProductOfTransforms) {
  // t2v(Z^-1 (X_i^-1 X_j)), with Eigen's transforms instead of the formulas.
  const Pose from{1.0, -2.0, 2.5};
  const Pose to{-3.0, 0.5, -2.0};
  const PoseEdge edge{0, 1, {0.7, 0.3, 1.1}, Matrix3::Identity()};
  const Eigen::Isometry2d E =
      transform(edge.measured).inverse() * (transform(from).inverse() * transform(to));
  const Eigen::Vector3d e = edge_error(edge, from, to);
  EXPECT_NEAR(e.x(), E.translation().x(), 1e-14);
  EXPECT_NEAR(e.y(), E.translation().y(), 1e-14);
  EXPECT_NEAR(e.z(), std::atan2(E.linear()(1, 0), E.linear()(0, 0)), 1e-14);
}

TEST(EdgeError, OfAPointIsInTheRobotsFrame) {
  const PointEdge edge{0, 1, Vector2(1.0, 2.0), Matrix2::Identity()};
  const Pose pose{3.0, 1.0, -0.4};
  const Vector2 point(2.0, 5.0);
  const Vector2 expected = transform(pose).inverse() * point - edge.measured;
  EXPECT_LT((edge_error(edge, pose, point) - expected).norm(), 1e-14);
}

TEST(ChiSquared, AddsAllKindsOfEdges) {
  PoseGraph graph;
  graph.vertices = {{0, VertexKind::pose, Pose{}, false},
                    {1, VertexKind::pose, Pose{}, false},
                    {2, VertexKind::point, Pose{}, false},
                    {3, VertexKind::point, Pose{}, false}};
  graph.pose_edges = {{0, 1, {1.0, 0.0, 0.0}, Eigen::Vector3d(2.0, 3.0, 5.0).asDiagonal()}};
  graph.point_edges = {{0, 2, Vector2(0.0, 1.0), 7.0 * Matrix2::Identity()}};
  graph.displacement_edges = {{2, 3, Vector2(1.0, 0.0), 11.0 * Matrix2::Identity()}};
  const std::vector<Pose> at{{}, {2.0, 1.0, 0.5}, {0.0, 2.0, 0.0}, {1.0, 4.0, 0.0}};
  // Errors (1, 1, 0.5), (0, 1) and (0, 2).
  EXPECT_NEAR(chi_squared(graph, at), 2.0 + 3.0 + 5.0 * 0.25 + 7.0 + 44.0, 1e-13);
  EXPECT_THROW(static_cast<void>(chi_squared(graph, {})), std::invalid_argument);
}

TEST(Information, MayBeSemidefiniteButNotIndefinite) {
  EXPECT_TRUE(is_information(Matrix3(Matrix3::Identity())));
  EXPECT_TRUE(is_information(Matrix3(Matrix3::Zero())));
  EXPECT_TRUE(is_information(Matrix3(Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal())));
  EXPECT_TRUE(is_information(Matrix2((Matrix2() << 4.0, 2.0, 2.0, 1.0).finished())));
  EXPECT_FALSE(is_information(Matrix2((Matrix2() << 1.0, 2.0, 2.0, 1.0).finished())));
  EXPECT_FALSE(is_information(Matrix2((Matrix2() << -1.0, 0.0, 0.0, -1.0).finished())));
  EXPECT_FALSE(is_information(Matrix2((Matrix2() << 1.0, 0.5, 0.0, 1.0).finished())));
  EXPECT_FALSE(is_information(Matrix3(Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal())));
  EXPECT_FALSE(is_information(Matrix3(Eigen::Vector3d(1.0, 1.0, -1e-3).asDiagonal())));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_information(Matrix2((Matrix2() << nan, 0.0, 0.0, 1.0).finished())));
}

struct Faulty {
  std::string name;
  void (*spoil)(PoseGraph&);
  std::string expected;
};

void PrintTo(const Faulty& test, std::ostream* out) {
  *out << test.name;
}

class GraphFault : public ::testing::TestWithParam<Faulty> {};

TEST_P(GraphFault, IsNamed) {
  PoseGraph graph = testing::landmark_walk(6, 2, 2, 9.0, {}, 1).graph;
  ASSERT_EQ(find_fault(graph), std::nullopt);
  GetParam().spoil(graph);
  const std::optional<std::string> fault = find_fault(graph);
  ASSERT_TRUE(fault);
  EXPECT_NE(fault->find(GetParam().expected), std::string::npos) << *fault;
}

INSTANTIATE_TEST_SUITE_P(
    Each, GraphFault,
    ::testing::Values(
        Faulty{"outside", [](PoseGraph& g) { g.pose_edges[0].to = 99; }, "leaves the list"},
        Faulty{"loop", [](PoseGraph& g) { g.pose_edges[0].to = 0; }, "vertex 0 to itself"},
        Faulty{"kind", [](PoseGraph& g) { g.point_edges[0].point = 1; }, "not of the kinds"},
        Faulty{"information", [](PoseGraph& g) { g.point_edges[0].information(0, 0) = -1.0; },
               "edge 6 has information that is not semidefinite"},
        Faulty{"infinite", [](PoseGraph& g) { g.pose_edges[1].measured.x = INFINITY; },
               "edge 2 measures something that is not finite"},
        Faulty{"fixed", [](PoseGraph& g) { g.vertices[2].fixed = true; },
               "vertex 2 is fixed but has no estimate"}),
    [](const auto& hard) { return hard.param.name; });

}  // namespace
}  // namespace trussmap::pose_graph_test
