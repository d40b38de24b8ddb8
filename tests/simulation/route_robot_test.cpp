// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The errors are those that were asked for, and the reference curves' single measurements and
// averages come out of Euler walks (tests/reference/elastic_curves.json).
#include "simulation/route_robot.hpp"

#include "shared_data.hpp"
#include "simulation/tours.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

namespace trussmap::route_robot_test {
using namespace simulation;
namespace {

using std::numbers::pi;

TEST(RouteRobot, MakesTheMeanErrorsAskedFor) {
  // |e| of a normal deviate with mean m has standard deviation m sqrt(pi/2 - 1): 4 of these / n.
  constexpr int n = 40000;
  const RouteErrors errors{0.05, 0.03};
  const Vector2 route(3.0, -4.0);
  std::mt19937_64 random(21);
  double stretch = 0.0;
  double orientation = 0.0;
  double product = 0.0;
  for (int k = 0; k < n; ++k) {
    const MeasuredRoute m = measure_route(route, errors, random);
    const double ds = m.displacement.norm() / 5.0 - 1.0;
    const double dt = wrap_angle(direction(m.displacement) - direction(route));
    stretch += std::abs(ds) / n;
    orientation += std::abs(dt) / n;
    product += ds * dt / n;
  }
  const double tolerance = 4.0 * std::sqrt(pi / 2.0 - 1.0) / std::sqrt(n);
  EXPECT_NEAR(stretch, 0.05, tolerance * 0.05);
  EXPECT_NEAR(orientation, 0.03, tolerance * 0.03);
  EXPECT_NEAR(product, 0.0, 4.0 * pi / 2.0 * 0.05 * 0.03 / std::sqrt(n)) << "independent";
}

TEST(RouteRobot, CovarianceIsThatOfTheMeasuredRoute) {
  std::mt19937_64 random(22);
  const RouteErrors errors{0.05, 0.03};
  for (int k = 0; k < 20; ++k) {
    const Vector2 route(std::cos(k), 2.0 * std::sin(k) + 0.1);
    const MeasuredRoute m = measure_route(route, errors, random);
    const Vector2 along = m.displacement.normalized();
    const Vector2 across = quarter_turn(along);
    const double square = m.displacement.squaredNorm() * pi / 2.0;
    EXPECT_NEAR(along.dot(m.covariance * along), square * 0.05 * 0.05, 1e-14);
    EXPECT_NEAR(across.dot(m.covariance * across), square * 0.03 * 0.03, 1e-14);
    EXPECT_NEAR(along.dot(m.covariance * across), 0.0, 1e-14);
  }
}

TEST(RouteRobot, WithoutErrorsMeasuresTheTruth) {
  std::mt19937_64 random(23);
  const MeasuredRoute m = measure_route({-3.0, 4.0}, {0.0, 0.0}, random);
  EXPECT_NEAR((m.displacement - Vector2(-3.0, 4.0)).norm(), 0.0, 1e-14);
  EXPECT_EQ(m.covariance, Matrix2::Zero());
  EXPECT_THROW((void)measure_route({1.0, 0.0}, {-0.1, 0.0}, random), std::invalid_argument);
}

/// Running sums of one route's measurements, in the direction from its lower landmark.
struct Sums {
  int count = 0;
  double stretch = 0.0;      ///< of errors, as a fraction
  double orientation = 0.0;  ///< of errors, rad
};

struct MeanErrors {
  double sigma = 0.0;
  double rho = 0.0;
};

MeanErrors mean_errors(const std::map<std::pair<int, int>, Sums>& routes) {
  MeanErrors mean;
  for (const auto& [route, sums] : routes) {
    mean.sigma += std::abs(sums.stretch / sums.count) / static_cast<double>(routes.size());
    mean.rho += std::abs(sums.orientation / sums.count) / static_cast<double>(routes.size());
  }
  return mean;
}

TEST(RouteRobot, AveragesOverEulerWalksFollowTheReferenceCurve) {
  // Both are means over seeds; 4 combined standard errors, those of the reference for its 24 seeds
  // and the same over sqrt(10) for the 240 here. 20 tours x 2 errors are compared.
  const nlohmann::json curve = testing::reference("elastic_curves.json")["methods"]["wavg"];
  const Mesh mesh = even_mesh({6, 6}, 1.0);
  constexpr int seeds = 240;
  constexpr std::size_t tours = 20;
  std::vector<MeanErrors> mean(tours);
  for (int seed = 0; seed < seeds; ++seed) {
    std::mt19937_64 random(1000U + static_cast<unsigned>(seed));
    std::map<std::pair<int, int>, Sums> routes;
    for (std::size_t tour = 0; tour < tours; ++tour) {
      const std::vector<int> walk = euler_walk(mesh, random);
      for (std::size_t k = 1; k < walk.size(); ++k) {
        const Vector2 truth = mesh.displacement(walk[k - 1], walk[k]);
        const MeasuredRoute m = measure_route(truth, {0.05, 0.03}, random);
        Sums& sums = routes[std::minmax(walk[k - 1], walk[k])];
        ++sums.count;
        sums.stretch += m.displacement.norm() / truth.norm() - 1.0;
        sums.orientation += wrap_angle(direction(m.displacement) - direction(truth));
      }
      const MeanErrors errors = mean_errors(routes);
      mean[tour].sigma += errors.sigma / seeds;
      mean[tour].rho += errors.rho / seeds;
    }
  }
  const double combined = 4.0 * std::sqrt(1.0 + 1.0 / 10.0);
  for (std::size_t tour = 0; tour < tours; ++tour) {
    EXPECT_NEAR(mean[tour].sigma, curve["sigma"][tour].get<double>(),
                combined * curve["sigma_se"][tour].get<double>());
    EXPECT_NEAR(mean[tour].rho, curve["rho"][tour].get<double>(),
                combined * curve["rho_se"][tour].get<double>());
  }
}

}  // namespace
}  // namespace trussmap::route_robot_test
