// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/index.hpp"
#include "pose_graph/synthetic_graph.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_files.hpp"

#include <random>

#include <gtest/gtest.h>

namespace trussmap::g2o_test {
namespace {

constexpr const char* kEveryKind =
    "# a comment\n"
    "VERTEX_SE2 0 0.5 -1 0.25\n"
    "\n"
    "  VERTEX_SE2\t7 1e-3 +2.5 -.5   # and another\r\n"
    "VERTEX_XY 3 4 5\n"
    "VERTEX_XY 12 6 7\n"
    "FIX 0 3\n"
    "EDGE_SE2 0 7  1 2 3  11 12 13 22 23 33\n"
    "EDGE_SE2_XY 7 3 1 2 11 2 22\n"
    "EDGE_POINTXY 3 12 -1 -2 11 2 22";

TEST(G2o, ReadsEveryKindOfLine) {
  // The 3x3 information is made diagonally dominant to be one.
  std::string text = kEveryKind;
  text.replace(text.find("11 12 13 22 23 33"), 17, "50 12 13 60 23 70");
  const PoseGraph graph = parse_g2o(text, "x.g2o");
  ASSERT_EQ(graph.vertices.size(), 4U);
  EXPECT_EQ(graph.vertices[1].id, 7);
  EXPECT_EQ(graph.vertices[1].estimate->y, 2.5);
  EXPECT_EQ(graph.vertices[1].estimate->heading, -0.5);
  EXPECT_EQ(graph.vertices[2].kind, VertexKind::point);
  EXPECT_EQ(graph.vertices[2].estimate->position(), Vector2(4.0, 5.0));
  EXPECT_TRUE(graph.vertices[0].fixed);
  EXPECT_FALSE(graph.vertices[1].fixed);
  EXPECT_TRUE(graph.vertices[2].fixed);
  ASSERT_EQ(graph.pose_edges.size(), 1U);
  EXPECT_EQ(graph.pose_edges[0].to, 1);
  EXPECT_EQ(graph.pose_edges[0].measured.heading, 3.0);
  EXPECT_EQ(graph.pose_edges[0].information,
            (Matrix3() << 50, 12, 13, 12, 60, 23, 13, 23, 70).finished());
  ASSERT_EQ(graph.point_edges.size(), 1U);
  EXPECT_EQ(graph.point_edges[0].pose, 1);
  EXPECT_EQ(graph.point_edges[0].point, 2);
  EXPECT_EQ(graph.point_edges[0].information, (Matrix2() << 11, 2, 2, 22).finished());
  ASSERT_EQ(graph.displacement_edges.size(), 1U);
  EXPECT_EQ(graph.displacement_edges[0].measured, Vector2(-1.0, -2.0));
}

TEST(G2o, ReadsIsamsRootsAndItsOwnCountOfLandmarks) {
  const PoseGraph graph = parse_g2o(
      "EDGE2 0 1 1 2 3 5 1 2 6 3 7\nLANDMARK 1 1 4 5 2 1 3\nLANDMARK 0 0 6 7 2 0 2\n", "x.txt");
  ASSERT_EQ(graph.vertices.size(), 4U);
  const Matrix3 R = (Matrix3() << 5, 1, 2, 0, 6, 3, 0, 0, 7).finished();
  EXPECT_EQ(graph.pose_edges[0].information, R.transpose() * R);
  EXPECT_EQ(graph.point_edges[0].information, (Matrix2() << 4, 2, 2, 10).finished());
  EXPECT_EQ(graph.vertices[idx(graph.point_edges[0].point)].id, 3);  // landmark 1 after pose 1
  EXPECT_EQ(graph.vertices[idx(graph.point_edges[1].point)].id, 2);
  EXPECT_EQ(graph.vertices[idx(graph.point_edges[0].point)].kind, VertexKind::point);
}

TEST(G2o, ReadsTorosOrderOfTheInformation) {
  // TORO: I11 I12 I22 I33 I13 I23.
  const PoseGraph toro =
      parse_g2o("VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0\nEDGE2 0 1 1 2 3 50 12 60 70 13 23\n", "x.graph");
  const PoseGraph g2o = parse_g2o("EDGE_SE2 0 1 1 2 3 50 12 13 60 23 70\n", "x.g2o");
  EXPECT_EQ(toro.pose_edges[0].information, g2o.pose_edges[0].information);
  EXPECT_EQ(toro.vertices.size(), 2U);
}

TEST(G2o, ReadsAnEdgeTheSameWhateverStandsBesideIt) {
  const std::string edge = "EDGE_SE2 0 1 1 2 3 50 12 13 60 23 70\n";
  const PoseGraph alone = parse_g2o(edge, "x.g2o");
  for (const char* name : {"x.g2o", "x.graph", "x.txt"}) {
    const PoseGraph beside = parse_g2o(edge + "LANDMARK 0 9 1 1 10 0 10\n", name);
    EXPECT_EQ(beside.pose_edges[0].information, alone.pose_edges[0].information);
    EXPECT_EQ(beside.point_edges[0].information, Matrix2(100.0 * Matrix2::Identity()));
    EXPECT_EQ(beside.source.roots, 1U);
  }
  // With vertices, too: the landmark's own line, or a number of its own.
  const std::string poses = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n";
  const std::string landmark = "LANDMARK 0 1 1 1 10 0 10\n";
  EXPECT_EQ(parse_g2o(poses + edge + landmark, "x.g2o").vertices[2].id, 3);
  const std::string stated = "LANDMARK 0 5 1 1 10 0 10\n";
  EXPECT_EQ(parse_g2o(poses + "VERTEX_XY 5 1 1\n" + edge + stated, "x.g2o").vertices.size(), 3U);
}

TEST(G2o, TakesEdge2ByNameOrAsSaid) {
  const std::string edge = "EDGE2 0 1 1 2 3 5 0 6 7 0 0\n";
  const Matrix3 toro = Eigen::Vector3d(5, 6, 7).asDiagonal();
  EXPECT_EQ(parse_g2o(edge, "x.graph").pose_edges[0].information, toro);
  EXPECT_EQ(parse_g2o(edge, "x.txt", Edge2::toro).pose_edges[0].information, toro);
  const std::string vertices = "VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0\n";
  EXPECT_EQ(parse_g2o(vertices + edge, "x.txt").pose_edges[0].information, toro);
  const std::string root = "EDGE2 0 1 1 2 3 5 0 0 6 0 7\n";
  const Matrix3 squared = Eigen::Vector3d(25, 36, 49).asDiagonal();
  EXPECT_EQ(parse_g2o(root, "x.txt").pose_edges[0].information, squared);
  EXPECT_EQ(parse_g2o(root, "x.graph", Edge2::isam).pose_edges[0].information, squared);
  const std::string both = edge + "LANDMARK 0 9 1 1 10 0 10\n";
  EXPECT_EQ(parse_g2o(both, "x.graph", Edge2::toro).pose_edges[0].information, toro);
}

TEST(G2o, TakesTheVerticesFromTheEdgesWhereThereAreNone) {
  const PoseGraph graph = parse_g2o(
      "EDGE_SE2 4 9 1 0 0 1 0 0 1 0 1\nEDGE_SE2_XY 9 2 1 0 1 0 1\nEDGE_POINTXY 2 5 1 0 1 0 1\n",
      "x.g2o");
  ASSERT_EQ(graph.vertices.size(), 4U);
  EXPECT_EQ(graph.vertices[1].id, 9);
  EXPECT_EQ(graph.vertices[2].kind, VertexKind::point);
  EXPECT_EQ(graph.vertices[3].id, 5);
  EXPECT_FALSE(graph.vertices[0].estimate);
}

TEST(G2o, ReadsBackWhatItWritesToTheLastBit) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  testing::SyntheticGraph world = testing::landmark_walk(30, 4, 8, 3.0, {0.1, 0.05}, 2);
  for (std::size_t v = 0; v < world.truth.size(); ++v) {
    GraphVertex& vertex = world.graph.vertices[v];
    vertex.estimate = Pose{normal(random), 1e-300 * normal(random), 1e15 * normal(random)};
    if (!is_pose(vertex)) vertex.estimate->heading = 0.0;
  }
  world.graph.vertices[5].fixed = true;
  const std::string text = format_g2o(world.graph);
  const PoseGraph back = parse_g2o(text, "x.g2o");
  ASSERT_EQ(back.vertices.size(), world.graph.vertices.size());
  for (std::size_t v = 0; v < back.vertices.size(); ++v) {
    EXPECT_EQ(back.vertices[v].id, world.graph.vertices[v].id);
    EXPECT_EQ(back.vertices[v].fixed, v == 5);
    EXPECT_EQ(back.vertices[v].estimate->y, world.graph.vertices[v].estimate->y);
    EXPECT_EQ(back.vertices[v].estimate->heading, world.graph.vertices[v].estimate->heading);
  }
  for (std::size_t k = 0; k < back.pose_edges.size(); ++k) {
    EXPECT_EQ(back.pose_edges[k].measured.x, world.graph.pose_edges[k].measured.x);
    EXPECT_EQ(back.pose_edges[k].information, world.graph.pose_edges[k].information);
  }
  EXPECT_EQ(back.point_edges.size(), world.graph.point_edges.size());
  EXPECT_EQ(format_g2o(back), text);
}

struct Bad {
  std::string name;
  std::string text;
  std::string message;
};

void PrintTo(const Bad& test, std::ostream* out) {
  *out << test.name;
}

class BadG2o : public ::testing::TestWithParam<Bad> {};

TEST_P(BadG2o, IsRefusedInOneLineThatSaysWhere) {
  try {
    static_cast<void>(parse_g2o(GetParam().text, "bad.g2o"));
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), GetParam().message);
  }
}

const std::string kTwoPoses = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n";

INSTANTIATE_TEST_SUITE_P(
    EachRule, BadG2o,
    ::testing::Values(
        Bad{"empty", "", "bad.g2o: has no edges, expected a pose graph"},
        Bad{"no_edges", kTwoPoses, "bad.g2o: has no edges, expected a pose graph"},
        Bad{"tag", "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n",
            "bad.g2o:1: \"VERTEX_SE3:QUAT\" is unknown, expected VERTEX_SE2, VERTEX_XY, EDGE_SE2, "
            "EDGE_SE2_XY, EDGE_POINTXY, FIX, VERTEX2, EDGE2, ODOMETRY or LANDMARK"},
        Bad{"short", kTwoPoses + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0\n",
            "bad.g2o:3: the line ends before an entry of the information, expected a number"},
        Bad{"long", kTwoPoses + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1 5\n",
            "bad.g2o:3: \"5\" is too much, the line should end here"},
        Bad{"text", "\nVERTEX_SE2 0 0 zero 0\n", "bad.g2o:2: y is \"zero\", expected a number"},
        Bad{"nan", "VERTEX_SE2 0 0 0 nan\n", "bad.g2o:1: theta is \"nan\", expected a number"},
        Bad{"infinity", "VERTEX_XY 0 -inf 0\n", "bad.g2o:1: x is \"-inf\", expected a number"},
        Bad{"glued", "VERTEX_XY 0 1.5.2 0\n", "bad.g2o:1: x is \"1.5.2\", expected a number"},
        Bad{"id", "VERTEX_XY 1.5 1 0\n",
            "bad.g2o:1: the vertex is \"1.5\", expected a whole number"},
        Bad{"twice", kTwoPoses + "VERTEX_XY 1 0 0\n",
            "bad.g2o:3: vertex 1 is defined a second time, expected it once"},
        Bad{"undefined", kTwoPoses + "EDGE_SE2 0 2 1 0 0 1 0 0 1 0 1\n",
            "bad.g2o:3: vertex 2 has no VERTEX line, expected one for every vertex or for none"},
        Bad{"loop", kTwoPoses + "EDGE_SE2 1 1 1 0 0 1 0 0 1 0 1\n",
            "bad.g2o:3: the edge joins vertex 1 to itself, expected two vertices"},
        Bad{"kind", kTwoPoses + "EDGE_SE2_XY 0 1 1 0 1 0 1\n",
            "bad.g2o:3: vertex 1 is a pose, expected a point here"},
        Bad{"indefinite", kTwoPoses + "EDGE_SE2 0 1 1 0 0 1 2 0 1 0 1\n",
            "bad.g2o:3: the information matrix is not positive semidefinite, expected the inverse "
            "of a covariance"},
        Bad{"toros_order", kTwoPoses + "EDGE_SE2 0 1 1 0 0 5 0 5 7 0 0\n",
            "bad.g2o:3: the information matrix is not positive semidefinite, expected the inverse "
            "of a covariance; in the order I11 I12 I22 I33 I13 I23 of TORO it would be one"},
        Bad{"two_programs", "EDGE2 0 1 1 2 3 5 0 6 7 0 0\nLANDMARK 0 9 1 1 10 0 10\n",
            "bad.g2o:1: EDGE2 is TORO's here, but line 2 is iSAM's, whose EDGE2 has the root of "
            "the information; expected --edge2 isam or --edge2 toro"},
        Bad{"fixed", "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nFIX 0\n",
            "bad.g2o:2: vertex 0 is fixed but has no VERTEX line, expected one that says where"},
        Bad{"fix_nothing", kTwoPoses + "FIX\n",
            "bad.g2o:3: the line ends before the fixed vertex, expected a whole number"}),
    [](const auto& bad) { return bad.param.name; });

TEST(G2o, SaysWhichFileCannotBeRead) {
  EXPECT_THROW(static_cast<void>(read_g2o("/nowhere/at/all.g2o")), InputError);
}

}  // namespace
}  // namespace trussmap::g2o_test
