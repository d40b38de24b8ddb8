// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The map builder's promises.
#include "trussmap/map_builder.hpp"

#include "geometry/index.hpp"
#include "trussmap/error.hpp"
#include "trussmap/truss.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace trussmap {
namespace {

std::string name(int k) {
  return "n" + std::to_string(k);
}

/// A random walk over points with noisy legs, the same for every builder (seed).
struct Walk {
  std::vector<Vector2> truth;
  std::vector<int> visits;
  std::vector<Traversal> legs;
};

Walk random_walk(int landmarks, int legs, double noise, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> place(0.0, 20.0);
  Walk walk;
  for (int k = 0; k < landmarks; ++k) walk.truth.emplace_back(place(random), place(random));
  walk.visits = {0};
  for (int k = 0; k < legs; ++k) {
    int next = walk.visits.back();
    while (next == walk.visits.back()) {
      next = std::uniform_int_distribution<int>(0, landmarks - 1)(random);
    }
    const Matrix2 R = rotation(normal(random));
    const Matrix2 C = R * Vector2(0.04, 0.01).asDiagonal() * R.transpose();
    const Vector2 error = noise * (R * Vector2(0.2 * normal(random), 0.1 * normal(random)));
    walk.legs.push_back({walk.truth[idx(next)] - walk.truth[idx(walk.visits.back())] + error, C});
    walk.visits.push_back(next);
  }
  return walk;
}

MapBuilder built(const Walk& walk, const MapBuilderOptions& options) {
  MapBuilder builder(options);
  builder.start(name(0), walk.truth[0]);
  for (std::size_t k = 0; k < walk.legs.size(); ++k) {
    builder.arrive(name(walk.visits[k + 1]), walk.legs[k]);
  }
  return builder;
}

TEST(MapBuilder, NoiseFreeLegsGiveTheExactMapByEveryMethod) {
  const Walk walk = random_walk(12, 150, 0.0, 3);
  for (const Method method : {Method::elastic, Method::elastic_printed, Method::gauss_markov}) {
    for (const Eta::Kind kind : {Eta::Kind::all, Eta::Kind::fixed, Eta::Kind::estimated}) {
      MapBuilderOptions options;
      options.method = method;
      options.eta = {kind, 5};
      const MapBuilder builder = built(walk, options);
      for (int k = 0; k < builder.landmarks(); ++k) {
        const auto known = builder.find(name(k));
        ASSERT_TRUE(known);
        EXPECT_LE((builder.position(*known) - walk.truth[idx(k)]).norm(), 1e-9);
      }
    }
  }
}

TEST(MapBuilder, ALandmarkThatIsNotThereHasNoPosition) {
  MapBuilder builder;
  EXPECT_THROW(static_cast<void>(builder.position(builder.here())), std::invalid_argument);
  builder.start("A");
  EXPECT_EQ(builder.position(0), Vector2(0.0, 0.0));
  EXPECT_THROW(static_cast<void>(builder.position(1)), std::invalid_argument);
}

TEST(MapBuilder, GaussMarkovIsTheBatchLeastSquaresMap) {
  const Walk walk = random_walk(15, 200, 1.0, 4);
  MapBuilderOptions options;
  options.method = Method::gauss_markov;
  const MapBuilder builder = built(walk, options);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(30, 30);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(30);
  for (std::size_t k = 0; k < walk.legs.size(); ++k) {
    const int i = 2 * walk.visits[k];
    const int j = 2 * walk.visits[k + 1];
    const Matrix2 B = walk.legs[k].covariance.inverse();
    K.block<2, 2>(i, i) += B;
    K.block<2, 2>(j, j) += B;
    K.block<2, 2>(i, j) -= B;
    K.block<2, 2>(j, i) -= B;
    f.segment<2>(j) += B * walk.legs[k].displacement;
    f.segment<2>(i) -= B * walk.legs[k].displacement;
  }
  const Eigen::VectorXd p = K.bottomRightCorner(28, 28).ldlt().solve(f.tail(28));
  for (int k = 1; k < 15; ++k) {
    const Vector2 expected = walk.truth[0] + p.segment<2>(2 * (k - 1));
    EXPECT_LE((builder.position(*builder.find(name(k))) - expected).norm(), 1e-9);
  }
}

/// The same recursion with K built anew, densely, at every traversal.
TEST(MapBuilder, PooledGaussMarkovIsItsRecursion) {
  const Walk walk = random_walk(8, 120, 1.0, 9);
  MapBuilderOptions options;
  options.method = Method::gauss_markov;
  options.pooled = true;
  MapBuilder builder(options);
  builder.start(name(0), walk.truth[0]);
  std::map<std::string, Vector2> expected{{name(0), walk.truth[0]}};
  LandmarkGraph graph;
  graph.add_landmark(name(0), walk.truth[0]);
  for (std::size_t k = 0; k < walk.legs.size(); ++k) {
    const std::string from = name(walk.visits[k]);
    const std::string to = name(walk.visits[k + 1]);
    builder.arrive(to, walk.legs[k]);
    const bool known = expected.contains(to);
    if (!known) {
      expected[to] = expected[from] + walk.legs[k].displacement;
      graph.add_landmark(to, expected[to]);
    }
    const int i = *graph.find(from);
    const int j = *graph.find(to);
    const Matrix2 one = graph.route(graph.add_traversal(i, j, walk.legs[k])).covariance.inverse();
    if (!known) continue;
    const int n = 2 * graph.landmarks();
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    for (int number = 0; number < graph.routes(); ++number) {
      const Route& route = graph.route(number);
      const Matrix2 B = route.traversals * route.covariance.inverse();
      K.block<2, 2>(2 * route.source, 2 * route.source) += B;
      K.block<2, 2>(2 * route.target, 2 * route.target) += B;
      K.block<2, 2>(2 * route.source, 2 * route.target) -= B;
      K.block<2, 2>(2 * route.target, 2 * route.source) -= B;
    }
    Eigen::VectorXd f = Eigen::VectorXd::Zero(n);
    const Vector2 force = one * (walk.legs[k].displacement - (expected[to] - expected[from]));
    f.segment<2>(2 * j) += force;
    f.segment<2>(2 * i) -= force;
    const Eigen::VectorXd u = K.bottomRightCorner(n - 2, n - 2).ldlt().solve(f.tail(n - 2));
    for (int m = 1; m < graph.landmarks(); ++m) {
      expected[graph.landmark(m).name] += u.segment<2>(2 * (m - 1));
    }
  }
  for (const auto& [landmark, position] : expected) {
    EXPECT_LE((builder.position(*builder.find(landmark)) - position).norm(), 1e-9) << landmark;
  }
}

TEST(MapBuilder, ASmallEtaMovesNoMoreLandmarksAndNeverTheFirst) {
  const Walk walk = random_walk(40, 400, 1.0, 5);
  MapBuilderOptions options;
  options.eta.count = 8;
  MapBuilder builder(options);
  builder.start(name(0), walk.truth[0]);
  for (std::size_t k = 0; k < walk.legs.size(); ++k) {
    const Arrival arrival = builder.arrive(name(walk.visits[k + 1]), walk.legs[k]);
    if (arrival.kind == Arrival::Kind::refinement) {
      EXPECT_LE(arrival.eta, 10);
    }
    EXPECT_LE((builder.position(0) - walk.truth[0]).norm(), 1e-9);
  }
}

/// The part of the desired change that each refinement reached on its own route.
std::vector<double> gains(const Walk& walk, const MapBuilderOptions& options) {
  std::vector<double> result;
  MapBuilder builder(options);
  builder.start(name(0), walk.truth[0]);
  for (std::size_t k = 0; k < walk.legs.size(); ++k) {
    const int from = builder.here();
    const auto to = builder.find(name(walk.visits[k + 1]));
    const Vector2 before =
        to ? Vector2(builder.position(*to) - builder.position(from)) : Vector2(Vector2::Zero());
    const Arrival arrival = builder.arrive(name(walk.visits[k + 1]), walk.legs[k]);
    if (arrival.kind != Arrival::Kind::refinement) continue;
    const Route route = *builder.route_between(from, *to);
    const Vector2 target =
        route.source == from ? route.mean_vector() : Vector2(-route.mean_vector());
    const Vector2 after = builder.position(*to) - builder.position(from);
    result.push_back((after - before).norm() / (target - before).norm());
  }
  return result;
}

/// As printed some refinements reach more than the limit; limited they all stay within it, and
/// those that would reach more reach just as much.
TEST(MapBuilder, TheElasticGainIsLimitedAndThePrintedOneIsNot) {
  const Walk walk = random_walk(10, 200, 1.0, 6);
  for (const double limit : {0.5, 0.2}) {
    MapBuilderOptions options;
    options.gain_limit = limit;
    const std::vector<double> limited = gains(walk, options);
    options.method = Method::elastic_printed;
    const std::vector<double> printed = gains(walk, options);
    ASSERT_GT(limited.size(), 50U);
    EXPECT_NEAR(*std::max_element(limited.begin(), limited.end()), limit, 1e-9);
    EXPECT_GT(*std::max_element(printed.begin(), printed.end()), 1.1 * limit);
  }
}

TEST(MapBuilder, ARejectedLegChangesNothing) {
  const Walk walk = random_walk(8, 60, 1.0, 7);
  const double nan = std::nan("");
  const Matrix2 C = 0.01 * Matrix2::Identity();
  for (const Method method : {Method::elastic, Method::gauss_markov}) {
    MapBuilderOptions options;
    options.method = method;
    MapBuilder builder = built(walk, options);
    const LandmarkGraph before = builder.map();
    const int here = builder.here();
    const std::string other = name(here == *builder.find(name(1)) ? 2 : 1);
    EXPECT_THROW(builder.arrive(other, {{nan, 0.0}, C}), std::invalid_argument);
    EXPECT_THROW(builder.arrive("new", {{0.0, 0.0}, C}), std::invalid_argument);
    EXPECT_THROW(builder.arrive(other, {{1.0, 0.0}, -C}), std::invalid_argument);
    EXPECT_THROW(builder.arrive(before.landmark(here).name, {{1.0, 0.0}, C}),
                 std::invalid_argument);
    EXPECT_THROW(builder.start("never seen"), SolveError);
    const LandmarkGraph after = builder.map();
    ASSERT_EQ(after.landmarks(), before.landmarks());
    ASSERT_EQ(after.routes(), before.routes());
    EXPECT_EQ(builder.here(), here);
    for (int k = 0; k < after.landmarks(); ++k) {
      EXPECT_EQ(after.landmark(k).position, before.landmark(k).position);
    }
    for (int k = 0; k < after.routes(); ++k) {
      EXPECT_EQ(after.route(k).traversals, before.route(k).traversals);
      EXPECT_EQ(after.route(k).stretch, before.route(k).stretch);
    }
  }
  EXPECT_THROW(MapBuilder().arrive("A", {{1.0, 0.0}, C}), std::invalid_argument);
  MapBuilderOptions bad;
  bad.gain_limit = 0.0;
  EXPECT_THROW(MapBuilder{bad}, std::invalid_argument);
}

/// The hexagon of the paper's Figure 5: six legs that do not close are made to, and the last
/// landmark met is where it was first.
TEST(MapBuilder, AClosedPolygonSharesItsMisclosureOut) {
  MapBuilder builder;
  builder.start(name(0));
  Vector2 sum = Vector2::Zero();
  Arrival last;
  for (int k = 0; k < 6; ++k) {
    const double angle = k * 1.0471975511965976 + 0.02 * k;
    const Vector2 leg(std::cos(angle), std::sin(angle));
    sum += leg;
    last = builder.arrive(name((k + 1) % 6), {leg, 0.01 * Matrix2::Identity()});
  }
  EXPECT_EQ(last.kind, Arrival::Kind::first_sight);
  EXPECT_EQ(last.landmarks_moved, 5);
  EXPECT_LE((last.misfit - sum).norm(), 1e-12);
  // Equal compliances: landmark k has moved by k sixths of what was missing.
  EXPECT_LE((builder.position(1) - (Vector2(1.0, 0.0) - sum / 6.0)).norm(), 1e-12);
}

TEST(MapBuilder, SettlingComesToRest) {
  const Walk walk = random_walk(10, 120, 1.0, 8);
  MapBuilder builder = built(walk, {});
  const double first = builder.settle(0.5);
  double later = first;
  for (int round = 2; round <= 40; ++round) later = builder.settle(0.5 / round);
  EXPECT_LT(later, 0.2 * first);
}

/// At rest the routes' forces balance at every landmark but the held first: the minimum of their
/// strain energy, solved densely here.
TEST(MapBuilder, AtRestNoForceIsLeft) {
  MapBuilder builder = built(random_walk(10, 120, 1.0, 9), {});
  builder.rest();
  EXPECT_LE(builder.rest(), 1e-2);  // stiffness has followed the routes' directions
  for (int round = 0; round < 10; ++round) builder.rest();
  const LandmarkGraph map = builder.map();
  std::vector<Vector2> force(idx(map.landmarks()), Vector2::Zero());
  double largest = 0.0;
  for (int k = 0; k < map.routes(); ++k) {
    const Route& route = map.route(k);
    const Vector2 span = map.landmark(route.target).position - map.landmark(route.source).position;
    const Matrix2 B =
        bar_stiffness(StiffnessLaw::printed, route.covariance, direction(span), route.traversals);
    const Vector2 pull = B * (route.mean_vector() - span);
    largest = std::max(largest, pull.norm());
    force[idx(route.target)] += pull;
    force[idx(route.source)] -= pull;
  }
  for (int k = 1; k < map.landmarks(); ++k) EXPECT_LE(force[idx(k)].norm(), 1e-6 * largest) << k;
}

/// Exact increments know no more of the past than the routes' averages where the covariances of all
/// traversals were alike.
TEST(MapBuilder, GoesOnFromAMap) {
  Walk walk = random_walk(12, 240, 1.0, 31);
  for (Traversal& leg : walk.legs) leg.covariance = 0.02 * Matrix2::Identity();
  for (const Method method : {Method::elastic, Method::gauss_markov}) {
    MapBuilderOptions options;
    options.method = method;
    options.eta = {Eta::Kind::fixed, 5, false};
    options.gate = std::numeric_limits<double>::infinity();
    Walk half = walk;
    half.legs.resize(120);
    MapBuilder whole = built(half, options);
    MapBuilder second(whole.map(), options);
    second.start(name(walk.visits[120]));
    for (std::size_t k = 120; k < walk.legs.size(); ++k) {
      whole.arrive(name(walk.visits[k + 1]), walk.legs[k]);
      second.arrive(name(walk.visits[k + 1]), walk.legs[k]);
    }
    for (int k = 0; k < whole.landmarks(); ++k) {
      EXPECT_LE((whole.position(k) - second.position(k)).norm(), 1e-9) << name_of(method);
    }
  }
}

TEST(MapBuilder, RefusesAMapThatNoBuilderCanHave) {
  LandmarkGraph map;
  map.add_landmark("A", {0.0, 0.0});
  map.add_landmark("B", 0, {{1.0, 0.0}, 0.01 * Matrix2::Identity()});
  map.add_landmark("C", {5.0, 0.0});
  try {
    MapBuilder builder(map);
    FAIL();
  } catch (const SolveError& error) {
    EXPECT_STREQ(error.what(),
                 "landmark C is tied to nothing: no chain of routes leads to it from landmark A");
  }
  map.add_route(1, 2);
  EXPECT_THROW(MapBuilder{map}, std::invalid_argument);  // never driven
  EXPECT_EQ(MapBuilder(LandmarkGraph()).landmarks(), 0);
}

}  // namespace
}  // namespace trussmap
