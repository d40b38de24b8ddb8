// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/mesh_world.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::mesh_world_test {
using namespace simulation;
namespace {

TEST(MeshSize, IsReadFromText) {
  const MeshSize size = parse_mesh_size("12x7");
  EXPECT_EQ(size.columns, 12);
  EXPECT_EQ(size.rows, 7);
}

class BadMeshSize : public ::testing::TestWithParam<const char*> {};

TEST_P(BadMeshSize, IsRefused) {
  EXPECT_THROW((void)parse_mesh_size(GetParam()), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(EveryKind, BadMeshSize,
                         ::testing::Values("", "6", "x6", "6x", "6x6x6", "6x6 ", " 6x6", "6X6",
                                           "0x6", "-2x3", "2x-3", "1x1", "2.5x3", "1001x1000",
                                           "99999999999x2", "2147483647x2147483647"));

TEST(Mesh, HasTheRoutesOfALattice) {
  const Mesh mesh = even_mesh({4, 7}, 5.0);
  EXPECT_EQ(mesh.landmarks(), 28);
  EXPECT_EQ(mesh.routes.size(), 3U * 7U + 4U * 6U);
  std::set<std::pair<int, int>> seen;
  for (const MeshRoute& route : mesh.routes) {
    EXPECT_TRUE(seen.emplace(route.from, route.to).second);
    EXPECT_DOUBLE_EQ(mesh.displacement(route.from, route.to).norm(), 5.0);
    EXPECT_GT(mesh.displacement(route.from, route.to).sum(), 0.0) << "to the right or up";
  }
}

TEST(Mesh, NeighboursAreTheEndsOfRoutes) {
  const Mesh mesh = even_mesh({3, 4}, 1.0);
  std::vector<std::vector<int>> expected(12);
  for (const MeshRoute& route : mesh.routes) {
    expected[idx(route.from)].push_back(route.to);
    expected[idx(route.to)].push_back(route.from);
  }
  for (int k = 0; k < mesh.landmarks(); ++k) {
    std::sort(expected[idx(k)].begin(), expected[idx(k)].end());
    EXPECT_EQ(neighbours(mesh, k), expected[idx(k)]);
    EXPECT_EQ(mesh.landmark(mesh.column(k), mesh.row(k)), k);
  }
}

TEST(Mesh, LandmarksAreNamedByColumnAndRow) {
  const Mesh mesh = mesh_of_lines({0.0, 1.0, 9.0}, {0.0, 6.0});
  EXPECT_EQ(landmark_name(mesh, mesh.landmark(2, 1)), "L2_1");
  EXPECT_EQ(mesh.positions[idx(mesh.landmark(2, 1))], Vector2(9.0, 6.0));
  EXPECT_DOUBLE_EQ(shortest_route(mesh), 1.0);
}

TEST(Mesh, PerimeterGoesRoundFromTheCorner) {
  EXPECT_EQ(perimeter(even_mesh({3, 3}, 1.0)), (std::vector<int>{0, 3, 6, 7, 8, 5, 2, 1}));
  EXPECT_EQ(perimeter(even_mesh({2, 2}, 1.0)), (std::vector<int>{0, 2, 3, 1}));
  EXPECT_EQ(perimeter(even_mesh({1, 4}, 1.0)), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(perimeter(even_mesh({3, 1}, 1.0)), (std::vector<int>{0, 1, 2}));
}

TEST(Mesh, RandomLinesKeepTheirGaps) {
  std::mt19937_64 random(5);
  const std::vector<double> lines = random_lines(1000, 1.0, 10.0, random);
  double least = 10.0;
  double most = 0.0;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    least = std::min(least, lines[k] - lines[k - 1]);
    most = std::max(most, lines[k] - lines[k - 1]);
  }
  EXPECT_EQ(lines.front(), 0.0);
  EXPECT_GE(least, 1.0 - 1e-9);
  EXPECT_LE(most, 10.0 + 1e-9);
  // 1000 uniform draws miss the outer twentieth with probability 0.95^999 < 1e-22.
  EXPECT_LT(least, 1.45);
  EXPECT_GT(most, 9.55);
}

TEST(Mesh, JitterStaysWithinItsReach) {
  std::mt19937_64 random(6);
  const Mesh even = even_mesh({6, 6}, 5.0);
  const Mesh moved = jittered(even, 0.3, random);
  double most = 0.0;
  for (std::size_t k = 0; k < even.positions.size(); ++k) {
    most = std::max(most, (moved.positions[k] - even.positions[k]).cwiseAbs().maxCoeff());
  }
  EXPECT_LE(most, 0.3);
  EXPECT_GT(most, 0.25);
}

TEST(Mesh, RefusesWhatIsNoMesh) {
  std::mt19937_64 random(7);
  EXPECT_THROW((void)even_mesh({6, 6}, 0.0), std::invalid_argument);
  EXPECT_THROW((void)even_mesh({1, 1}, 1.0), std::invalid_argument);
  EXPECT_THROW((void)even_mesh({-2, -3}, 1.0), std::invalid_argument);
  EXPECT_THROW((void)random_lines(0, 1.0, 2.0, random), std::invalid_argument);
  EXPECT_THROW((void)mesh_of_lines({0.0, 1.0, 1.0}, {0.0}), std::invalid_argument);
  EXPECT_THROW((void)random_lines(3, 2.0, 1.0, random), std::invalid_argument);
  EXPECT_THROW((void)jittered(even_mesh({2, 2}, 1.0), 0.5, random), std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::mesh_world_test
