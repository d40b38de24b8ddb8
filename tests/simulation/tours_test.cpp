// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/tours.hpp"

#include "simulation/mesh_world.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace trussmap::tours_test {
using namespace simulation;
namespace {

using Pair = std::pair<int, int>;

Pair ends(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

/// How often a walk drives each route; fails on a step that is no route.
std::map<Pair, int> drives(const Mesh& mesh, const std::vector<int>& walk) {
  std::map<Pair, int> count;
  for (const MeshRoute& route : mesh.routes) count[ends(route.from, route.to)] = 0;
  for (std::size_t k = 1; k < walk.size(); ++k) {
    const auto found = count.find(ends(walk[k - 1], walk[k]));
    if (found == count.end()) {
      ADD_FAILURE() << "no route from " << walk[k - 1] << " to " << walk[k];
    } else {
      ++found->second;
    }
  }
  return count;
}

int twice_driven(const std::map<Pair, int>& count) {
  int twice = 0;
  for (const auto& [route, times] : count) twice += times == 2 ? 1 : 0;
  return twice;
}

std::string name_of(MeshSize size) {
  return std::to_string(size.columns) + "x" + std::to_string(size.rows);
}

struct EulerCase {
  MeshSize size;
  int doubled;  ///< counted by hand
};

class EulerWalk : public ::testing::TestWithParam<EulerCase> {};

TEST_P(EulerWalk, DrivesEveryRouteOnceAndTheDoubledOnesTwice) {
  const Mesh mesh = even_mesh(GetParam().size, 1.0);
  std::map<Pair, int> expected;
  for (const MeshRoute& route : mesh.routes) expected[ends(route.from, route.to)] = 1;
  for (const MeshRoute& route : doubled_routes(mesh)) ++expected[ends(route.from, route.to)];
  EXPECT_EQ(twice_driven(expected), GetParam().doubled);
  std::mt19937_64 random(11);
  for (int k = 0; k < 50; ++k) {
    const std::vector<int> walk = euler_walk(mesh, random);
    EXPECT_EQ(walk.front(), 0);
    EXPECT_EQ(walk.back(), 0);
    EXPECT_EQ(drives(mesh, walk), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Meshes, EulerWalk,
    ::testing::Values(EulerCase{{6, 6}, 8},  // 4 odd a side: 2 pairs a side, 1 route each
                      EulerCase{{5, 5}, 8},  // 3 odd a side: 4 pairs along a side, 2 round corners
                      EulerCase{{4, 7}, 9},  // 5 pairs along a side, 2 round the upper corners
                      EulerCase{{3, 3}, 4},  // 2 pairs, each round a corner
                      EulerCase{{2, 2}, 0},  // no odd landmark
                      EulerCase{{2, 3}, 3},  // the rung's ends, joined round a corner and up
                      EulerCase{{1, 5}, 4},  // a line: there and back
                      EulerCase{{5, 1}, 4}, EulerCase{{1, 2}, 1}, EulerCase{{2, 1}, 1}),
    [](const auto& test) { return name_of(test.param.size); });

TEST(EulerWalkChoice, IsUniformAtTheStart) {
  // Two routes meet at the corner, and the walk begins with the one that was not chosen first. So
  // it goes either way with probability 1/2: of n = 4000 walks
  // n/2 +- 4 sqrt(n)/2 (4 standard deviations) go along +x.
  const Mesh mesh = even_mesh({6, 6}, 1.0);
  std::mt19937_64 random(12);
  constexpr int n = 4000;
  int along_x = 0;
  for (int k = 0; k < n; ++k) along_x += euler_walk(mesh, random)[1] == mesh.landmark(1, 0) ? 1 : 0;
  EXPECT_NEAR(along_x, 0.5 * n, 4.0 * 0.5 * std::sqrt(n));
}

class AnyWalk : public ::testing::TestWithParam<std::pair<const char*, MeshSize>> {
 protected:
  WalkKind kind_ = parse_walk_kind(GetParam().first);
  Mesh mesh_ = even_mesh(GetParam().second, 2.0);
};

TEST_P(AnyWalk, CoversEveryRouteInEveryTour) {
  std::mt19937_64 random(14);
  const Tours tours = make_tours(mesh_, kind_, 3, random);
  ASSERT_EQ(tours.ends.size(), 3U);
  EXPECT_EQ(tours.ends.back() + 1, tours.walk.size());
  std::size_t from = 0;
  for (const std::size_t to : tours.ends) {
    const auto begin = tours.walk.begin();
    const std::vector<int> tour(begin + static_cast<std::ptrdiff_t>(from),
                                begin + static_cast<std::ptrdiff_t>(to) + 1);
    for (const auto& [route, times] : drives(mesh_, tour)) EXPECT_GE(times, 1);
    from = to;
  }
}

TEST_P(AnyWalk, IsDrawnFromItsSeed) {
  std::mt19937_64 first(15);
  std::mt19937_64 same(15);
  std::mt19937_64 other(16);
  const std::vector<int> walk = make_tours(mesh_, kind_, 4, first).walk;
  EXPECT_EQ(walk, make_tours(mesh_, kind_, 4, same).walk);
  const bool is_line = mesh_.size.columns == 1 || mesh_.size.rows == 1;
  const bool has_choice = kind_ == WalkKind::random ? mesh_.landmarks() > 2
                                                    : kind_ != WalkKind::face_by_face && !is_line;
  EXPECT_EQ(walk != make_tours(mesh_, kind_, 4, other).walk, has_choice);
}

std::vector<std::pair<const char*, MeshSize>> every_walk_on_every_mesh() {
  std::vector<std::pair<const char*, MeshSize>> cases;
  for (const char* name : {"euler", "face", "depth-first", "random"}) {
    for (const MeshSize size :
         {MeshSize{6, 6}, {4, 7}, {2, 2}, {2, 5}, {1, 5}, {5, 1}, {2, 1}, {1, 2}}) {
      cases.emplace_back(name, size);
    }
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Walks, AnyWalk, ::testing::ValuesIn(every_walk_on_every_mesh()),
                         [](const auto& test) {
                           std::string name = test.param.first;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name + "_" + name_of(test.param.second);
                         });

TEST(Polygon, IsRegularAndEveryWalkGoesRoundIt) {
  const Mesh hexagon = regular_polygon(6, 5.0);
  ASSERT_EQ(hexagon.landmarks(), 6);
  ASSERT_EQ(hexagon.routes.size(), 6U);
  EXPECT_EQ(hexagon.positions.front(), Vector2(0.0, 0.0));
  EXPECT_NEAR((hexagon.positions[1] - Vector2(5.0, 0.0)).norm(), 0.0, 1e-12);
  Vector2 centre = Vector2::Zero();
  for (const Vector2& corner : hexagon.positions) centre += corner / 6.0;
  for (const Vector2& corner : hexagon.positions) {
    EXPECT_NEAR((corner - centre).norm(), 5.0, 1e-12);  // a hexagon's radius is its side
  }
  for (const MeshRoute& route : hexagon.routes) {
    EXPECT_NEAR(hexagon.displacement(route.from, route.to).norm(), 5.0, 1e-12);
  }
  std::mt19937_64 random(19);
  for (const char* kind : {"euler", "face", "depth-first"}) {
    const Tours tours = make_tours(hexagon, parse_walk_kind(kind), 2, random);
    EXPECT_EQ(tours.ends, (std::vector<std::size_t>{6, 12})) << kind;
    for (const auto& [route, times] : drives(hexagon, tours.walk)) EXPECT_EQ(times, 2) << kind;
  }
  EXPECT_THROW((void)regular_polygon(2, 5.0), std::invalid_argument);
  EXPECT_THROW((void)regular_polygon(6, 0.0), std::invalid_argument);
}

TEST(FaceWalk, GoesRoundEachFaceInTurn) {
  // 3x3: four faces of four routes, three drives from face to face; inner routes at least twice.
  const Mesh mesh = even_mesh({3, 3}, 1.0);
  const std::vector<int> walk = face_walk(mesh);
  EXPECT_EQ(walk.size(), 4U * 4U + 3U + 1U);
  const std::map<Pair, int> count = drives(mesh, walk);
  const int centre = mesh.landmark(1, 1);
  for (const int k : neighbours(mesh, centre)) EXPECT_GE(count.at(ends(centre, k)), 2);
  EXPECT_EQ(std::vector<int>(walk.begin() + 5, walk.begin() + 10),
            (std::vector<int>{3, 6, 7, 4, 3}))
      << "the second face of the first row comes second";
}

TEST(DepthFirstWalk, DrivesNoRouteAgainWhileThereIsAFreshOne) {
  const Mesh mesh = even_mesh({5, 5}, 1.0);
  std::mt19937_64 random(17);
  const std::vector<int> walk = depth_first_walk(mesh, 7, random);
  EXPECT_EQ(walk.front(), 7);
  std::map<Pair, int> count;
  for (std::size_t k = 1; k < walk.size(); ++k) {
    bool fresh_here = false;
    for (const int to : neighbours(mesh, walk[k - 1])) {
      fresh_here = fresh_here || count[ends(walk[k - 1], to)] == 0;
    }
    const bool fresh = ++count[ends(walk[k - 1], walk[k])] == 1;
    EXPECT_EQ(fresh, fresh_here) << "step " << k;
  }
  EXPECT_LT(walk.size(), 2U * mesh.routes.size() + 1U);
}

TEST(WalkKind, IsReadByName) {
  EXPECT_EQ(parse_walk_kind("depth-first"), WalkKind::depth_first);
  EXPECT_THROW((void)parse_walk_kind("Euler"), std::invalid_argument);
  std::mt19937_64 random(18);
  EXPECT_THROW((void)make_tours(even_mesh({2, 2}, 1.0), WalkKind::euler, 0, random),
               std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::tours_test
