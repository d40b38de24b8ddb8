// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Paths through a map, beside all that there are.
#include "geometry/index.hpp"
#include "trussmap/landmark_map.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::paths_test {
namespace {

LandmarkGraph with_landmarks(int count) {
  LandmarkGraph graph;
  for (int k = 0; k < count; ++k) graph.add_landmark("L" + std::to_string(k), Vector2::Zero());
  return graph;
}

/// A route that was driven once.
void add(LandmarkGraph& graph, int a, int b, double stretch, double variance) {
  Route& route = graph.route(graph.add_route(a, b));
  route.traversals = 1;
  route.stretch = stretch;
  route.covariance = variance * Matrix2::Identity();
}

/// The best of all chains without a landmark twice, by the rule as it is stated.
class AllChains {
 public:
  AllChains(const LandmarkGraph& graph, int to, PathBy by)
      : graph_(graph), to_(to), by_(by), met_(idx(graph.landmarks()), false) {}

  std::vector<int> best_from(int from) {
    extend(from, 0.0);
    return best_ ? std::get<2>(*best_) : std::vector<int>();
  }

 private:
  using Chain = std::tuple<double, std::size_t, std::vector<int>>;  // ordered as paths are

  void extend(int here, double sum) {
    chain_.push_back(here);
    met_[idx(here)] = true;
    if (here == to_) {
      const Chain chain{sum, chain_.size(), chain_};
      if (!best_ || chain < *best_) best_ = chain;
    } else {
      for (const int number : graph_.routes_at(here)) {
        const Route& route = graph_.route(number);
        const int there = other_end(route, here);
        if (met_[idx(there)] || route.traversals == 0) continue;
        extend(there, sum + (by_ == PathBy::length ? route.stretch : route.covariance.trace()));
      }
    }
    met_[idx(here)] = false;
    chain_.pop_back();
  }

  const LandmarkGraph& graph_;
  int to_;
  PathBy by_;
  std::vector<bool> met_;
  std::vector<int> chain_;
  std::optional<Chain> best_;
};

/// Small whole numbers, zero among them: many chains are equally good, and sums are exact.
TEST(Path, IsTheBestOfAllChains) {
  constexpr int kLandmarks = 8;
  int none = 0;
  int ways = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<int> any(0, kLandmarks - 1);
    std::uniform_int_distribution<int> size(0, 3);
    LandmarkGraph graph = with_landmarks(kLandmarks);
    for (int k = 0; k < 16; ++k) {
      const int a = any(random);
      const int b = any(random);
      if (a == b || graph.route_between(a, b)) continue;
      add(graph, a, b, size(random), size(random));
      if (size(random) == 0) graph.route(graph.routes() - 1).traversals = 0;
    }
    for (const PathBy by : {PathBy::length, PathBy::uncertainty}) {
      for (int from = 0; from < kLandmarks; ++from) {
        for (int to = 0; to < kLandmarks; ++to) {
          const std::vector<int> found = path(graph, from, to, by);
          ASSERT_EQ(found, AllChains(graph, to, by).best_from(from)) << seed;
          ++(found.empty() ? none : ways);
        }
      }
    }
  }
  EXPECT_GT(none, 100);
  EXPECT_GT(ways, 1000);
}

/// A shortcut that was measured badly is not the surest way.
TEST(Path, ShortestAndSurestMayDiffer) {
  LandmarkGraph graph = with_landmarks(4);
  add(graph, 0, 3, 5.0, 1.0);
  add(graph, 1, 0, 4.0, 0.1);  // driven against its direction as well
  add(graph, 1, 2, 4.0, 0.1);
  add(graph, 3, 2, 4.0, 0.1);
  EXPECT_EQ(path(graph, 0, 3), (std::vector<int>{0, 3}));
  EXPECT_EQ(path(graph, 0, 3, PathBy::length), (std::vector<int>{0, 3}));
  EXPECT_EQ(path(graph, 0, 3, PathBy::uncertainty), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(path(graph, 3, 0, PathBy::uncertainty), (std::vector<int>{3, 2, 1, 0}));
}

/// Both components count, and the number of drives does not: it is the next drive that is asked
/// for.
TEST(Path, UncertaintyIsThatOfOneTraversal) {
  LandmarkGraph graph = with_landmarks(4);
  for (const int between : {1, 2}) {
    add(graph, 0, between, 1.0, 0.0);
    add(graph, between, 3, 1.0, 0.0);
  }
  graph.route(*graph.route_between(0, 1)).covariance << 1.0, 0.0, 0.0, 9.0;
  graph.route(*graph.route_between(0, 1)).traversals = 100;
  graph.route(*graph.route_between(0, 2)).covariance << 4.0, 0.0, 0.0, 4.0;
  EXPECT_EQ(path(graph, 0, 3, PathBy::uncertainty), (std::vector<int>{0, 2, 3}));
}

TEST(Path, LeadsNowhereWithoutARouteThatWasDriven) {
  LandmarkGraph graph = with_landmarks(4);
  add(graph, 0, 1, 1.0, 1.0);
  graph.add_route(1, 2);
  EXPECT_EQ(path(graph, 0, 0), std::vector<int>{0});
  EXPECT_EQ(path(graph, 3, 3), std::vector<int>{3});
  EXPECT_EQ(path(graph, 0, 1), (std::vector<int>{0, 1}));
  EXPECT_TRUE(path(graph, 0, 2).empty());
  EXPECT_TRUE(path(graph, 2, 0).empty());
  EXPECT_TRUE(path(graph, 0, 3).empty());
}

/// All ways are equally long and of as many routes: where they part, the lower number is taken.
TEST(Path, TiesFallTheSameWayWhateverTheOrderOfRoutes) {
  constexpr int kSide = 12;
  std::vector<std::pair<int, int>> routes;
  for (int k = 0; k < kSide * kSide; ++k) {
    if (k % kSide + 1 < kSide) routes.emplace_back(k, k + 1);
    if (k + kSide < kSide * kSide) routes.emplace_back(k, k + kSide);
  }
  std::vector<int> expected(kSide);
  std::iota(expected.begin(), expected.end(), 0);
  for (int row = 1; row < kSide; ++row) expected.push_back(row * kSide + kSide - 1);
  std::mt19937_64 random(1);
  for (int round = 0; round < 5; ++round) {
    LandmarkGraph graph = with_landmarks(kSide * kSide);
    for (const auto& [a, b] : routes) add(graph, a, b, 2.0, 1.0);
    EXPECT_EQ(path(graph, 0, kSide * kSide - 1), expected);
    std::shuffle(routes.begin(), routes.end(), random);
    for (auto& [a, b] : routes) std::swap(a, b);
  }
}

TEST(Path, RefusesWhatIsNotOfTheMap) {
  LandmarkGraph graph = with_landmarks(3);
  EXPECT_THROW(static_cast<void>(path(graph, -1, 0)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(path(graph, 0, 3)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(path(LandmarkGraph(), 0, 0)), std::invalid_argument);
  add(graph, 0, 1, -1.0, 1.0);
  EXPECT_THROW(static_cast<void>(path(graph, 0, 1)), std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::paths_test
