// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The linear adjustment against dense algebra, and what it says of itself.
#include "map/linear_truss.hpp"

#include "geometry/index.hpp"
#include "trussmap/error.hpp"

#include <cmath>
#include <random>
#include <string>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace trussmap::linear_truss_test {
using namespace map;
namespace {

/// A ring with chords, each route driven 1 to 4 times (seed).
LandmarkGraph random_map(int landmarks, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  LandmarkGraph map;
  for (int k = 0; k < landmarks; ++k) {
    map.add_landmark("n" + std::to_string(k), {5.0 * normal(random), 5.0 * normal(random)});
  }
  for (int k = 0; k < landmarks; ++k) {
    for (const int step : {1, 3}) {
      const int to = (k + step) % landmarks;
      for (int t = 0; t <= k % 4; ++t) {
        const Matrix2 root = (Matrix2() << 0.2, 0.0, 0.1 * normal(random), 0.1).finished();
        const Vector2 truth = map.landmark(to).position - map.landmark(k).position;
        map.add_traversal(
            k, to,
            {truth + root * Vector2(normal(random), normal(random)), root * root.transpose()});
      }
    }
  }
  return map;
}

TEST(LinearTruss, EqualsADenseSolve) {
  const LandmarkGraph map = random_map(12, 5);
  const LinearAdjustment result = adjust_linear(map);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(24, 24);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(24);
  double constant = 0.0;
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    const Matrix2 B = route.traversals * route.covariance.inverse();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2, 24);
    A.block<2, 2>(0, 2 * route.target).setIdentity();
    A.block<2, 2>(0, 2 * route.source) = -Matrix2::Identity();
    K += A.transpose() * B * A;
    f += A.transpose() * B * route.displacement;
    constant += route.displacement.dot(B * route.displacement);
  }
  // The first landmark stays where it is.
  const Vector2 held = map.landmark(0).position;
  const Eigen::VectorXd p =
      K.bottomRightCorner(22, 22).ldlt().solve(f.tail(22) - K.bottomLeftCorner(22, 2) * held);
  Eigen::VectorXd all(24);
  all << held, p;
  for (int k = 0; k < 12; ++k) {
    EXPECT_LE((result.map.landmark(k).position - all.segment<2>(2 * k)).norm(), 1e-10);
  }
  const double chi2 = constant - 2.0 * f.dot(all) + all.dot(K * all);
  EXPECT_NEAR(result.chi2, chi2, 1e-9 * constant);
  EXPECT_EQ(result.dof, 2 * (24 - 12 + 1));
}

/// At rest the bars' forces balance at every landmark that is not held; chi2 is their work.
TEST(LinearTruss, ForcesAreInEquilibrium) {
  const LandmarkGraph map = random_map(20, 6);
  const LinearAdjustment result = adjust_linear(map);
  std::vector<Vector2> sums(20, Vector2::Zero());
  double work = 0.0;
  double largest = 0.0;
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    const Vector2& force = result.bar_forces[idx(number)];
    sums[idx(route.target)] += force;
    sums[idx(route.source)] -= force;
    largest = std::max(largest, force.norm());
    const Vector2 strain = result.map.landmark(route.target).position -
                           result.map.landmark(route.source).position - route.displacement;
    work += force.dot(strain);
  }
  for (int k = 0; k < 20; ++k) EXPECT_LE(sums[idx(k)].norm(), 1e-9 * largest) << k;
  EXPECT_NEAR(result.chi2, work, 1e-9 * work);
}

/// Noise of the stated size: chi2/dof is 1 on average. 300 maps of 26 degrees of freedom (seeds 1
/// to 300): the mean's standard error is sqrt(2/26/300) = 0.016. Covariances differ between the
/// traversals of a route, whose plain mean is then not the best: only equal ones give 1 exactly, so
/// each route's are made equal here.
TEST(LinearTruss, Chi2IsCalibrated) {
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    LandmarkGraph map;
    for (int k = 0; k < 12; ++k) map.add_landmark(std::to_string(k), {1.0 * k, 0.5 * k * k});
    for (int k = 0; k < 12; ++k) {
      for (const int step : {1, 3}) {
        const int to = (k + step) % 12;
        const Matrix2 root = (Matrix2() << 0.2, 0.0, 0.02 * k, 0.1).finished();
        const Vector2 truth = map.landmark(to).position - map.landmark(k).position;
        for (int t = 0; t <= k % 3; ++t) {
          map.add_traversal(
              k, to,
              {truth + root * Vector2(normal(random), normal(random)), root * root.transpose()});
        }
      }
    }
    const LinearAdjustment result = adjust_linear(map);
    sum += result.chi2 / result.dof;
  }
  EXPECT_NEAR(sum / 300.0, 1.0, 4.0 * 0.016);
}

TEST(LinearTruss, NamesALandmarkThatIsTiedToNothing) {
  LandmarkGraph map = random_map(6, 7);
  map.add_landmark("the far shed", {100.0, 0.0});
  try {
    (void)adjust_linear(map);
    FAIL();
  } catch (const SolveError& error) {
    EXPECT_NE(std::string(error.what()).find("the far shed is tied to nothing"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace trussmap::linear_truss_test
