// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The map builder's promises.
#include "trussmap/map_builder.hpp"

#include "geometry/index.hpp"
#include "trussmap/error.hpp"
#include "trussmap/truss.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace trussmap::map_builder_test {
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

constexpr std::array kScopes{RefinementScope::Kind::automatic, RefinementScope::Kind::all,
                             RefinementScope::Kind::nearest, RefinementScope::Kind::estimated};

TEST(MapBuilder, NoiseFreeLegsGiveTheExactMapByEveryMethod) {
  const Walk walk = random_walk(12, 150, 0.0, 3);
  for (const Method method : {Method::elastic, Method::elastic_printed, Method::gauss_markov}) {
    for (const RefinementScope::Kind kind : kScopes) {
      MapBuilderOptions options;
      options.method = method;
      options.scope = {kind, 5};
      const MapBuilder builder = built(walk, options);
      for (int k = 0; k < builder.landmarks(); ++k) {
        const auto known = builder.find(name(k));
        ASSERT_TRUE(known);
        EXPECT_LE((builder.position(*known) - walk.truth[idx(k)]).norm(), 1e-9);
      }
      EXPECT_LE(builder.energy(), 1e-12);
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

/// Pooled, it is the least-squares map of the routes' means.
TEST(MapBuilder, PooledGaussMarkovIsTheBatchOfTheMeans) {
  const Walk walk = random_walk(8, 120, 1.0, 9);
  MapBuilderOptions options;
  options.method = Method::gauss_markov;
  options.pooled = true;
  options.gate = std::numeric_limits<double>::infinity();
  const LandmarkGraph map = built(walk, options).map();
  const int n = 2 * map.landmarks();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(n);
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    const int i = 2 * route.source;
    const int j = 2 * route.target;
    const Matrix2 B = route.traversals * route.covariance.inverse();
    K.block<2, 2>(i, i) += B;
    K.block<2, 2>(j, j) += B;
    K.block<2, 2>(i, j) -= B;
    K.block<2, 2>(j, i) -= B;
    f.segment<2>(j) += B * route.displacement;
    f.segment<2>(i) -= B * route.displacement;
  }
  const Eigen::VectorXd p = K.bottomRightCorner(n - 2, n - 2).ldlt().solve(f.tail(n - 2));
  for (int k = 1; k < map.landmarks(); ++k) {
    const Vector2 expected = walk.truth[0] + p.segment<2>(2 * (k - 1));
    EXPECT_LE((map.landmark(k).position - expected).norm(), 1e-9);
  }
}

TEST(MapBuilder, ASmallEtaMovesNoMoreLandmarksAndNeverTheFirst) {
  const Walk walk = random_walk(40, 400, 1.0, 5);
  MapBuilderOptions options;
  options.scope = {RefinementScope::Kind::nearest, 8, false};
  MapBuilder builder(options);
  builder.start(name(0), walk.truth[0]);
  for (std::size_t k = 0; k < walk.legs.size(); ++k) {
    const Arrival arrival = builder.arrive(name(walk.visits[k + 1]), walk.legs[k]);
    EXPECT_LE(arrival.eta, 10);
    if (arrival.kind == Arrival::Kind::refinement) {
      EXPECT_LE(arrival.landmarks_moved, 10);
    }
    EXPECT_LE((builder.position(0) - walk.truth[0]).norm(), 1e-9);
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
    EXPECT_THROW(builder.arrive(other, Traversal{{nan, 0.0}, C}), std::invalid_argument);
    EXPECT_THROW(builder.arrive("new", Traversal{{0.0, 0.0}, C}), std::invalid_argument);
    EXPECT_THROW(builder.arrive(other, Traversal{{1.0, 0.0}, -C}), std::invalid_argument);
    EXPECT_THROW(builder.arrive(before.landmark(here).name, Traversal{{1.0, 0.0}, C}),
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
  EXPECT_THROW(MapBuilder().arrive("A", Traversal{{1.0, 0.0}, C}), std::invalid_argument);
  MapBuilderOptions bad;
  bad.scope.eta = 1;
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
    last = builder.arrive(name((k + 1) % 6), Traversal{leg, 0.01 * Matrix2::Identity()});
  }
  EXPECT_EQ(last.kind, Arrival::Kind::first_sight);
  EXPECT_EQ(last.landmarks_moved, 5);
  EXPECT_LE((last.misfit - sum).norm(), 1e-12);
  // Equal compliances: landmark k has moved by k sixths of what was missing.
  EXPECT_LE((builder.position(1) - (Vector2(1.0, 0.0) - sum / 6.0)).norm(), 1e-12);
}

/// At equilibrium the routes' forces balance at every landmark but the held first.
TEST(MapBuilder, WithAllLandmarksFreeNoForceIsLeft) {
  for (const StiffnessLaw law : {StiffnessLaw::mean_error, StiffnessLaw::variance}) {
    MapBuilderOptions options;
    options.law = law;
    options.pooled = true;
    const MapBuilder builder = built(random_walk(10, 120, 1.0, 9), options);
    const LandmarkGraph map = builder.map();
    std::vector<Vector2> force(idx(map.landmarks()), Vector2::Zero());
    double largest = 0.0;
    double energy = 0.0;
    for (int k = 0; k < map.routes(); ++k) {
      const Route& route = map.route(k);
      const Vector2 span =
          map.landmark(route.target).position - map.landmark(route.source).position;
      const Matrix2 B = bar_stiffness(law, route.covariance, route.orientation, route.traversals);
      const Vector2 rest = law == StiffnessLaw::variance ? route.displacement : route.mean_vector();
      const Vector2 pull = B * (rest - span);
      energy += 0.5 * pull.dot(rest - span);
      largest = std::max(largest, pull.norm());
      force[idx(route.target)] += pull;
      force[idx(route.source)] -= pull;
    }
    for (int k = 1; k < map.landmarks(); ++k) EXPECT_LE(force[idx(k)].norm(), 1e-9 * largest) << k;
    EXPECT_NEAR(builder.energy(), energy, 1e-9 * energy);
  }
}

/// Whatever the scope, the energy at the end of many tours is that of the equilibrium, or near.
TEST(MapBuilder, RelaxingTheWholeLetsTheEnergyFallToItsLeast) {
  const Walk walk = random_walk(40, 400, 1.0, 9);
  MapBuilder exact = built(walk, {});
  const double least = exact.energy();
  for (const bool groups : {false, true}) {
    MapBuilderOptions options;
    options.scope = {RefinementScope::Kind::nearest, 9, groups};
    MapBuilder builder = built(walk, options);
    EXPECT_GE(builder.energy(), least * (1.0 - 1e-9));
    EXPECT_LE(builder.energy(), least * (groups ? 1.05 : 3.0));
    builder.relax();
    EXPECT_NEAR(builder.energy(), least, 1e-9 * least);
    for (int k = 0; k < builder.landmarks(); ++k) {
      const Vector2 other = exact.position(*exact.find(builder.map().landmark(k).name));
      EXPECT_LE((builder.position(k) - other).norm(), 1e-7);
    }
  }
}

/// Covariances are those of batch least squares: the inverse of its matrix.
TEST(MapBuilder, CovariancesAreThoseOfLeastSquares) {
  const Walk walk = random_walk(9, 90, 1.0, 12);
  for (const Method method : {Method::elastic, Method::gauss_markov}) {
    MapBuilderOptions options;
    options.method = method;
    options.gate = std::numeric_limits<double>::infinity();
    const MapBuilder builder = built(walk, options);
    const LandmarkGraph map = builder.map();
    const int n = 2 * map.landmarks();
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    const auto add = [&](int i, int j, const Matrix2& B) {
      K.block<2, 2>(2 * i, 2 * i) += B;
      K.block<2, 2>(2 * j, 2 * j) += B;
      K.block<2, 2>(2 * i, 2 * j) -= B;
      K.block<2, 2>(2 * j, 2 * i) -= B;
    };
    if (method == Method::elastic) {  // which knows mean covariances alone
      for (int number = 0; number < map.routes(); ++number) {
        const Route& route = map.route(number);
        add(route.source, route.target, route.traversals * route.covariance.inverse());
      }
    } else {
      for (std::size_t k = 0; k < walk.legs.size(); ++k) {
        add(*map.find(name(walk.visits[k])), *map.find(name(walk.visits[k + 1])),
            walk.legs[k].covariance.inverse());
      }
    }
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
    C.bottomRightCorner(n - 2, n - 2) = K.bottomRightCorner(n - 2, n - 2).inverse();
    const std::vector<Matrix2> all = builder.covariances();
    for (int k = 0; k < map.landmarks(); ++k) {
      EXPECT_LE((all[idx(k)] - C.block<2, 2>(2 * k, 2 * k)).norm(), 1e-12);
      const Matrix2 between = C.block<2, 2>(2 * k, 2 * k) + C.block<2, 2>(6, 6) -
                              C.block<2, 2>(6, 2 * k) - C.block<2, 2>(2 * k, 6);
      EXPECT_LE((builder.covariance_between(3, k) - between).norm(), 1e-12) << k;
    }
    EXPECT_THROW((void)builder.covariance_between(0, 99), std::invalid_argument);
  }
}

/// Round a square, legs of covariances a and b by turns; without refinement, which would be
/// refused.
MapBuilder square_of(double a, double b, const MapBuilderOptions& options) {
  MapBuilder builder(options);
  builder.start("A");
  const Vector2 sides[] = {{4.0, 0.0}, {0.0, 4.0}, {-4.0, 0.1}, {0.1, -4.0}};
  const char* const corners[] = {"B", "C", "D", "A"};
  for (int k = 0; k < 4; ++k) {
    const Matrix2 C = (k % 2 == 0 ? a : b) * Matrix2::Identity();
    builder.arrive(corners[k], Traversal{sides[k], C});
  }
  return builder;
}

/// By hand: with a far below b, A and B are as one, C and D as one, and two legs b tie these.
TEST(MapBuilder, CovariancesThatRoundingHasEatenAreRefused) {
  constexpr double kGateless = std::numeric_limits<double>::infinity();
  for (const Method method : {Method::elastic, Method::gauss_markov}) {
    const MapBuilderOptions options{.method = method, .refine = false, .gate = kGateless};
    for (const double b : {1e-8, 1e-4, 1.0, 1e2, 1e6, 1e20, 1e100}) {
      for (const double a : {1e-150, 1e-100, 1e-18, 1e-14, 1e-9}) {
        const MapBuilder builder = square_of(a, b, options);
        const double half = 0.5 * b * (1.0 + a / b);  // of C: a + b and the other way round, b + a
        try {
          const Matrix2 C = builder.covariances()[2];
          EXPECT_LE((C - half * Matrix2::Identity()).norm(), 1e-3 * half) << a << " " << b;
          EXPECT_LE((builder.covariance_between(0, 2) - C).norm(), 1e-3 * half) << a << " " << b;
          EXPECT_EQ(builder.expected_falls({{0, 1}, {1, 2}}).size(), 2U);
          EXPECT_GE(a, 1e-13 * b);
        } catch (const SolveError& error) {
          EXPECT_LT(a, 1e-11 * b) << error.what();
          EXPECT_NE(std::string(error.what()).find("too many magnitudes"), std::string::npos);
          EXPECT_THROW((void)builder.covariance_between(0, 2), SolveError);
          EXPECT_THROW((void)builder.expected_falls({{0, 1}}), SolveError);
        }
      }
    }
  }
}

/// Many magnitudes by themselves do no harm: outwards ever softer, nothing cancels.
TEST(MapBuilder, CovariancesThatGrowAlongAChainAddUpWhateverTheirMagnitudes) {
  MapBuilder builder;
  builder.start("A");
  const double variances[] = {1e-100, 1e-3, 1e20, 1e60};
  double sum = 0.0;
  for (int k = 0; k < 4; ++k) {
    const Matrix2 C = variances[k] * Matrix2::Identity();
    const int landmark = builder.arrive("n" + std::to_string(k), Traversal{{1.0, 2.0}, C}).landmark;
    sum += variances[k];
    EXPECT_NEAR(builder.covariances()[idx(landmark)](0, 0), sum, 1e-12 * sum) << k;
    EXPECT_NEAR(builder.covariance_between(0, landmark)(1, 1), sum, 1e-12 * sum) << k;
  }
}

TEST(MapBuilder, KnowsTheNearestLandmarksOfAPoint) {
  const Walk walk = random_walk(30, 300, 1.0, 10);
  const MapBuilder builder = built(walk, {});
  const Vector2 point(8.0, 3.0);
  const std::vector<int> near = builder.nearest(point, 7);
  ASSERT_EQ(near.size(), 7U);
  std::vector<double> all;
  for (int k = 0; k < builder.landmarks(); ++k) all.push_back((builder.position(k) - point).norm());
  std::sort(all.begin(), all.end());
  for (std::size_t n = 0; n < near.size(); ++n) {
    EXPECT_EQ((builder.position(near[n]) - point).norm(), all[n]);
  }
  EXPECT_EQ(builder.nearest(point, 1000).size(), idx(builder.landmarks()));
  EXPECT_THROW((void)builder.nearest(point, 0), std::invalid_argument);
}

/// Exact increments know no more of the past than the routes' averages where the covariances of all
/// traversals were alike.
TEST(MapBuilder, GoesOnFromAMap) {
  Walk walk = random_walk(12, 240, 1.0, 31);
  for (Traversal& leg : walk.legs) leg.covariance = 0.02 * Matrix2::Identity();
  for (const Method method : {Method::elastic, Method::gauss_markov}) {
    MapBuilderOptions options;
    options.method = method;
    options.scope = {RefinementScope::Kind::nearest, 5};
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
}  // namespace trussmap::map_builder_test
