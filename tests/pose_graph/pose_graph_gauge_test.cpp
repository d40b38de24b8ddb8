// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What is held, and what is refused: graphs without a single best fit.
#include "pose_graph/pose_graph_gauge.hpp"

#include "pose_graph/pose_graph_chain.hpp"
#include "pose_graph/synthetic_graph.hpp"
#include "trussmap/error.hpp"
#include "trussmap/pose_graph.hpp"

#include <gtest/gtest.h>

namespace trussmap::pose_graph_gauge_test {
using namespace pose_graph;
namespace {

using testing::Measurer;
using testing::SyntheticGraph;

SyntheticGraph chain(int poses) {
  SyntheticGraph world;
  Measurer measure({}, 1);
  for (int k = 0; k < poses; ++k) {
    add_vertex(world, VertexKind::pose, {1.0 * k, 0.5 * k, 0.3 * k});
    if (k > 0) world.graph.pose_edges.push_back(measure.pose_edge(world.truth, k - 1, k));
  }
  return world;
}

/// The message of the SolveError that adjusting ends in.
std::string refusal(const PoseGraph& graph) {
  try {
    static_cast<void>(adjust(graph));
  } catch (const SolveError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Gauge, HoldsTheFirstPoseOfAPlainGraph) {
  const SyntheticGraph world = chain(4);
  EXPECT_EQ(choose_gauge(world.graph), (std::vector<std::uint8_t>{estimation::held_all, 0, 0, 0}));
}

TEST(Gauge, HoldsWhatTheFileFixesAndNothingElse) {
  SyntheticGraph world = chain(4);
  world.graph.vertices[2].fixed = true;
  world.graph.vertices[2].estimate = Pose{};
  EXPECT_EQ(choose_gauge(world.graph), (std::vector<std::uint8_t>{0, 0, estimation::held_all, 0}));
}

TEST(Gauge, HoldsAPositionOnlyWhereDisplacementsCarryTheDirection) {
  // Two poses see two points whose displacement is known in map axes: holding a heading as well
  // would contradict it.
  SyntheticGraph world = chain(2);
  Measurer measure({}, 1);
  add_vertex(world, VertexKind::point, {3.0, 1.0, 0.0});
  add_vertex(world, VertexKind::point, {1.0, 4.0, 0.0});
  for (int pose = 0; pose < 2; ++pose) {
    for (int point = 2; point < 4; ++point) {
      world.graph.point_edges.push_back(measure.point_edge(world.truth, pose, point));
    }
  }
  world.graph.displacement_edges.push_back(measure.displacement_edge(world.truth, 2, 3));
  world.graph.displacement_edges[0].measured =
      rotation(0.7) * world.graph.displacement_edges[0].measured;  // the map is turned by 0.7
  EXPECT_EQ(choose_gauge(world.graph),
            (std::vector<std::uint8_t>{estimation::held_position, 0, 0, 0}));
  const PoseGraphAdjustment result = adjust(world.graph);
  EXPECT_LT(result.chi2, 1e-20);
  EXPECT_NEAR(result.estimates[0].heading, 0.7, 1e-10);
}

TEST(Gauge, HoldsAHeadingBesideASinglePointThatTheFileFixes) {
  SyntheticGraph world = testing::landmark_walk(10, 2, 4, 9.0, {}, 2);
  GraphVertex& point = world.graph.vertices.back();
  point.fixed = true;
  point.estimate = Pose{7.0, 8.0, 0.0};
  const std::vector<std::uint8_t> held = choose_gauge(world.graph);
  EXPECT_EQ(held.front(), estimation::held_heading);
  EXPECT_EQ(held.back(), estimation::held_all);
  const PoseGraphAdjustment result = adjust(world.graph);
  EXPECT_LT(result.chi2, 1e-20);
  EXPECT_EQ(result.estimates.back().x, 7.0);
}

TEST(Gauge, NamesTheVerticesOfEveryPart) {
  SyntheticGraph world = chain(6);
  world.graph.pose_edges.erase(world.graph.pose_edges.begin() + 3);  // 3 - 4
  world.graph.vertices[4].id = 17;
  world.graph.vertices[5].id = 18;
  const std::string message = refusal(world.graph);
  EXPECT_TRUE(contains(message, "vertices 17, 18 are tied to nothing that is tied to vertex 0"))
      << message;
  world.graph.vertices[0].fixed = world.graph.vertices[5].fixed = true;
  world.graph.vertices[0].estimate = world.graph.vertices[5].estimate = Pose{};
  EXPECT_EQ(refusal(world.graph), "");  // each part is fixed for itself
}

TEST(Gauge, TakesAnEdgeWithoutInformationForNoEdge) {
  SyntheticGraph world = chain(3);
  world.graph.pose_edges.back().information.setZero();
  EXPECT_TRUE(contains(refusal(world.graph), "vertex 2 is tied to nothing"));
}

TEST(Adjust, NamesAPoseThatSeesASinglePointOnly) {
  // It can still swing round the point, at a distance.
  SyntheticGraph world = testing::landmark_walk(20, 3, 5, 9.0, {}, 3);
  Measurer measure({}, 1);
  add_vertex(world, VertexKind::pose, {2.0, 2.0, 1.0});
  world.graph.vertices.back().id = 77;
  world.graph.point_edges.push_back(measure.point_edge(world.truth, 25, 22));
  const std::string message = refusal(world.graph);
  EXPECT_TRUE(contains(message, "vertex 77 can still move")) << message;
}

TEST(Adjust, NamesAPoseWhoseHeadingNobodyMeasured) {
  SyntheticGraph world = chain(5);
  world.graph.pose_edges.back().information(2, 2) = 0.0;
  EXPECT_TRUE(contains(refusal(world.graph), "vertex 4 can still move")) << refusal(world.graph);
}

TEST(Adjust, NamesAPointKnownAlongOneAxisOnly) {
  SyntheticGraph world = testing::landmark_walk(5, 3, 1, 9.0, {}, 4);
  for (PointEdge& edge : world.graph.point_edges) edge.information.setZero();
  world.graph.point_edges.front().information(0, 0) = 100.0;
  EXPECT_TRUE(contains(refusal(world.graph), "vertex 5 can still move"));
}

TEST(Adjust, DoesNotTakeALongChainForALooseOne) {
  // 3000 steps without a loop: as slender as can be, but determined.
  EXPECT_EQ(refusal(chain(3000).graph), "");
}

TEST(Adjust, NamesASecondPartThatHangsOnOnePoint) {
  // Two walks that share one point: one can turn about it.
  SyntheticGraph world = chain(3);
  Measurer measure({}, 1);
  for (int k = 3; k < 6; ++k) {
    add_vertex(world, VertexKind::pose, {10.0 - k, 5.0, 0.1 * k});
    if (k > 3) world.graph.pose_edges.push_back(measure.pose_edge(world.truth, k - 1, k));
  }
  add_vertex(world, VertexKind::point, {3.0, 3.0, 0.0});
  world.graph.point_edges.push_back(measure.point_edge(world.truth, 1, 6));
  world.graph.point_edges.push_back(measure.point_edge(world.truth, 4, 6));
  const std::string message = refusal(world.graph);
  EXPECT_TRUE(contains(message, "can still move")) << message;
  for (const char* name : {"3", "4", "5"}) EXPECT_TRUE(contains(message, name)) << message;
}

/// Points that only displacements tie to one another, either way round.
TEST(Chains, LeadThroughDisplacementsToWhereTheyPoint) {
  SyntheticGraph world;
  Measurer measure({}, 1);
  add_vertex(world, VertexKind::pose, {0.0, 0.0, 0.0});
  add_vertex(world, VertexKind::point, {3.0, 1.0, 0.0});
  add_vertex(world, VertexKind::point, {5.0, -2.0, 0.0});
  add_vertex(world, VertexKind::point, {4.0, 6.0, 0.0});
  world.graph.point_edges.push_back(measure.point_edge(world.truth, 0, 1));
  world.graph.displacement_edges.push_back(measure.displacement_edge(world.truth, 1, 2));
  world.graph.displacement_edges.push_back(measure.displacement_edge(world.truth, 3, 2));
  const std::vector<Pose> found =
      chain_measurements(world.graph, choose_gauge(world.graph), Tree::nearest);
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_NEAR((found[k].position() - world.truth[k].position()).norm(), 0.0, 1e-12) << k;
  }
}

}  // namespace
}  // namespace trussmap::pose_graph_gauge_test
