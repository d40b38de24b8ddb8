// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/landmark_conversion.hpp"

#include "geometry/index.hpp"
#include "trussmap/pose_graph.hpp"
#include "trussmap/truss.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::landmark_conversion_test {
using namespace io;
namespace {

const Matrix2 kCovariance = (Matrix2() << 0.04, 0.01, 0.01, 0.09).finished();

LandmarkGraph square(const std::vector<std::string>& names) {
  LandmarkGraph map;
  for (int k = 0; k < 4; ++k) map.add_landmark(names[idx(k)], Vector2(k % 2, k / 2));
  const auto drive = [&map](int from, int to, double dx, double dy, double scale) {
    map.add_traversal(from, to, {Vector2(dx, dy), scale * kCovariance});
  };
  drive(0, 1, 1.1, 0.1, 1.0);
  drive(1, 3, -0.1, 0.9, 2.0);
  drive(3, 2, -1.0, 0.1, 1.0);
  drive(2, 0, 0.2, -1.1, 3.0);
  drive(1, 0, -0.9, 0.0, 1.5);
  drive(0, 3, 1.05, 0.95, 1.0);
  return map;
}

TEST(LandmarkConversion, AdjustsToTheGaussMarkovTruss) {
  const LandmarkGraph map = square({"A", "B", "C", "D"});
  const PoseGraphAdjustment adjusted = adjust(to_pose_graph(map));
  std::vector<Bar> bars;
  std::vector<Load> loads;
  for (int k = 0; k < map.routes(); ++k) {
    const Route& r = map.route(k);
    const Matrix2 B =
        bar_stiffness(StiffnessLaw::variance, r.covariance, r.orientation, r.traversals);
    bars.push_back({r.source, r.target, B});
    loads.push_back({r.target, B * r.displacement});
    loads.push_back({r.source, -B * r.displacement});
  }
  const Deflection truss = solve_truss(4, bars, {{0, map.landmark(0).position}}, loads);
  for (int k = 0; k < 4; ++k) {
    EXPECT_LT((adjusted.estimates[idx(k)].position() - truss.displacements[idx(k)]).norm(), 1e-10);
  }
}

TEST(LandmarkConversion, KeepsNamesThatAreNumbers) {
  EXPECT_EQ(to_pose_graph(square({"7", "-2", "0", "31"})).vertices[3].id, 31);
  EXPECT_EQ(to_pose_graph(square({"7", "x", "0", "31"})).vertices[3].id, 3);
  EXPECT_EQ(to_pose_graph(square({"7", "07", "0", "31"})).vertices[3].id, 3);
}

TEST(LandmarkConversion, FixesTheFirstLandmark) {
  const PoseGraph graph = to_pose_graph(square({"A", "B", "C", "D"}));
  EXPECT_TRUE(graph.vertices[0].fixed);
  EXPECT_FALSE(graph.vertices[1].fixed);
}

TEST(LandmarkConversion, ComesBackAsAnEquivalentMap) {
  const PoseGraph graph = to_pose_graph(square({"7", "-2", "0", "31"}));
  const PoseGraph again = to_pose_graph(to_landmark_graph(graph));
  ASSERT_EQ(again.displacement_edges.size(), graph.displacement_edges.size());
  for (std::size_t k = 0; k < graph.displacement_edges.size(); ++k) {
    const DisplacementEdge& a = graph.displacement_edges[k];
    const DisplacementEdge& b = again.displacement_edges[k];
    EXPECT_LT((a.measured - b.measured).norm(), 1e-15);
    EXPECT_LT((a.information - b.information).norm(), 1e-12 * a.information.norm());
  }
  EXPECT_EQ(again.vertices[3].id, 31);
}

TEST(LandmarkConversion, MergesParallelEdgesWithoutChangingTheFit) {
  PoseGraph graph = to_pose_graph(square({"0", "1", "2", "3"}));
  DisplacementEdge other{1, 0, Vector2(-1.3, 0.2), (Matrix2() << 9.0, -2.0, -2.0, 4.0).finished()};
  graph.displacement_edges.push_back(other);
  other.measured = Vector2(-0.8, 0.3);
  other.information *= 3.0;
  graph.displacement_edges.push_back(other);
  const PoseGraph merged = to_pose_graph(to_landmark_graph(graph));
  EXPECT_EQ(merged.displacement_edges.size(), graph.displacement_edges.size() - 2);
  const PoseGraphAdjustment a = adjust(graph);
  const PoseGraphAdjustment b = adjust(merged);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT((a.estimates[k].position() - b.estimates[k].position()).norm(), 1e-12);
  }
}

TEST(LandmarkConversion, RefusesWhatIsNoLandmarkMap) {
  PoseGraph graph = to_pose_graph(square({"0", "1", "2", "3"}));
  graph.displacement_edges[0].information = Eigen::Vector2d(1.0, 0.0).asDiagonal();
  EXPECT_THROW(static_cast<void>(to_landmark_graph(graph)), std::invalid_argument);
  graph = to_pose_graph(square({"0", "1", "2", "3"}));
  graph.vertices[2].estimate.reset();
  EXPECT_THROW(static_cast<void>(to_landmark_graph(graph)), std::invalid_argument);
  graph.vertices.push_back({9, VertexKind::pose, Pose{}, false});
  EXPECT_THROW(static_cast<void>(to_landmark_graph(graph)), std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::landmark_conversion_test
