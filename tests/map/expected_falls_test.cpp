// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a drive is expected to take out of a map's uncertainty, beside what it does take out.
#include "geometry/index.hpp"
#include "trussmap/map_builder.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace trussmap::expected_falls_test {
namespace {

/// Nine landmarks, uneven lines; neighbours are joined.
std::vector<Vector2> places() {
  std::vector<Vector2> at;
  for (const double x : {0.0, 3.0, 8.0}) {
    for (const double y : {0.0, 5.0, 7.0}) at.emplace_back(x, y);
  }
  return at;
}

std::string name(int k) {
  return "L" + std::to_string(k);
}

/// Every route but 4-7 at least once, some often.
const std::vector<int> kWalk{0, 1, 2, 5, 4, 1, 0, 3, 4, 5, 8, 7, 6, 3, 4, 1, 2, 5, 4, 3, 0, 1};

double summed(const std::vector<Matrix2>& covariances) {
  double sum = 0.0;
  for (const Matrix2& C : covariances) sum += C.trace();
  return sum;
}

MapBuilder mapped_in_map_axes(const MapBuilderOptions& options) {
  std::mt19937_64 random(71);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> sd(0.02, 0.1);
  const std::vector<Vector2> at = places();
  MapBuilder builder(options);
  builder.start(name(kWalk.front()));
  for (std::size_t n = 1; n < kWalk.size(); ++n) {
    const Matrix2 R = rotation(normal(random));
    const Vector2 sds(sd(random), sd(random));
    const Vector2 error = sds.cwiseProduct(Vector2(normal(random), normal(random)));
    builder.arrive(name(kWalk[n]), Traversal{at[idx(kWalk[n])] - at[idx(kWalk[n - 1])] + R * error,
                                             R * sds.cwiseAbs2().asDiagonal() * R.transpose()});
  }
  return builder;
}

TEST(ExpectedFalls, OfRoutesInMapAxesAreWhatDrivingThemOnceMoreTakesOut) {
  for (const Method method : {Method::gauss_markov, Method::elastic}) {
    MapBuilderOptions options;
    options.method = method;
    const MapBuilder before = mapped_in_map_axes(options);
    const LandmarkGraph map = before.map();
    std::vector<std::vector<int>> ways;
    for (int number = 0; number < map.routes(); ++number) {
      ways.push_back({map.route(number).source, map.route(number).target});
    }
    const auto along = [&map](std::initializer_list<int> landmarks) {
      std::vector<int> way;
      for (const int k : landmarks) way.push_back(*map.find(name(k)));
      return way;
    };
    ways.push_back(along({1, 4, 5, 8}));
    ways.push_back(along({3, 4, 3, 4}));
    const std::vector<double> falls = before.expected_falls(ways);
    const double sum = summed(before.covariances());
    for (std::size_t w = 0; w < ways.size(); ++w) {
      MapBuilder after = mapped_in_map_axes(options);
      for (std::size_t n = 1; n < ways[w].size(); ++n) {
        const int a = ways[w][n - 1];
        const int b = ways[w][n];
        after.start(map.landmark(a).name);
        after.arrive(map.landmark(b).name,
                     Traversal{after.position(b) - after.position(a),
                               map.route(*map.route_between(a, b)).covariance});
      }
      EXPECT_NEAR(falls[w], sum - summed(after.covariances()), 1e-9 * sum) << w;
      EXPECT_GT(falls[w], 1e-3 * sum);
    }
  }
}

constexpr double kAlong = 0.02;    // m, of every leg
constexpr double kAcross = 0.03;   // m
constexpr double kTurn = 0.05;     // rad, at its end
constexpr double kCompass = 0.04;  // rad

/// All that an exact robot's legs measure, with gradients by differences, in dense matrices.
class DenseMap {
 public:
  explicit DenseMap(bool compass) : compass_(compass), at_(places()) {}

  void drive(int to) {
    const double of_alpha = std::pow(kAcross / (at_[idx(to)] - at_[idx(here_)]).norm(), 2);
    const int from = here_;
    add([=](const Positions& p) { return (p[idx(to)] - p[idx(from)]).norm(); }, kAlong * kAlong);
    if (compass_ || before_ < 0) {
      add([=](const Positions& p) { return direction(p[idx(to)] - p[idx(from)]); },
          of_alpha + (compass_ ? kCompass * kCompass : 0.0));
    }
    if (before_ >= 0 && before_ != to) drive_corner(to, of_alpha);
    before_ = here_;
    here_ = to;
  }

  /// m^2, of all landmarks; without a compass after the best rotation and translation.
  [[nodiscard]] double summed_variance() const {
    const Eigen::Index size = information_.rows();
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(size, size);
    P.bottomRightCorner(size - 2, size - 2) =
        information_.bottomRightCorner(size - 2, size - 2).inverse();
    if (compass_) return P.trace();
    Eigen::MatrixXd rigid(size, 3);
    for (std::size_t k = 0; k < at_.size(); ++k) {
      rigid.middleRows<2>(2 * static_cast<Eigen::Index>(k)) << Matrix2::Identity(),
          quarter_turn(at_[k]);
    }
    const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(size, size) -
                                 rigid * (rigid.transpose() * rigid).inverse() * rigid.transpose();
    return (rest * P * rest.transpose()).trace();
  }

 private:
  using Positions = std::vector<Vector2>;

  void drive_corner(int to, double of_alpha) {
    const int i = before_;
    const int j = here_;
    const double of_beta =
        std::pow(kAcross / (at_[idx(j)] - at_[idx(i)]).norm(), 2) + kTurn * kTurn;
    const std::array<int, 3> which{std::min(i, to), j, std::max(i, to)};
    double variance = of_beta + of_alpha;
    if (learns_) corners_[which] = variance;
    if (!corners_.contains(which)) {  // never driven: as corners are on average
      variance = 0.0;
      for (const auto& [one, its_variance] : corners_) {
        variance += its_variance / static_cast<double>(corners_.size());
      }
    }
    add(
        [=](const Positions& p) {
          return wrap_angle(direction(p[idx(to)] - p[idx(j)]) - direction(p[idx(j)] - p[idx(i)]));
        },
        variance);
  }

  void add(const std::function<double(const Positions&)>& number, double variance) {
    constexpr double kStep = 1e-5;
    const auto size = 2 * static_cast<Eigen::Index>(at_.size());
    if (information_.size() == 0) information_ = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd gradient(size);
    for (Eigen::Index n = 0; n < size; ++n) {
      Positions on = at_;
      Positions back = at_;
      on[idx(n / 2)][n % 2] += kStep;
      back[idx(n / 2)][n % 2] -= kStep;
      gradient[n] = wrap_angle(number(on) - number(back)) / (2.0 * kStep);
    }
    information_ += gradient * gradient.transpose() / variance;
  }

 public:
  bool learns_ = true;  ///< corners that are driven now are known later

 private:
  bool compass_;
  Positions at_;
  Eigen::MatrixXd information_;
  std::map<std::array<int, 3>, double> corners_;
  int here_ = kWalk.front();
  int before_ = -1;
};

class ExpectedFallsOfARobot : public ::testing::TestWithParam<bool> {};

TEST_P(ExpectedFallsOfARobot, AreThoseOfLengthsCornersAndDirections) {
  const bool compass = GetParam();
  const std::vector<Vector2> at = places();
  MapBuilder builder;
  DenseMap dense(compass);
  // Its first way leads along +y: without a compass that is heading 0.
  double heading = compass ? 0.0 : direction(at[1] - at[0]);
  const double axes = heading;
  builder.start(name(kWalk.front()));
  for (std::size_t n = 1; n < kWalk.size(); ++n) {
    const Vector2 way = at[idx(kWalk[n])] - at[idx(kWalk[n - 1])];
    const double turn = wrap_angle(direction(way) - heading);
    if (compass) builder.compass(heading, kCompass);
    Motion motion;
    const Vector2 d = rotation(-heading) * way;
    motion.displacement = {d.x(), d.y(), turn};
    const Matrix2 R = rotation(turn);
    motion.covariance.topLeftCorner<2, 2>() =
        R * Vector2(kAlong * kAlong, kAcross * kAcross).asDiagonal() * R.transpose();
    motion.covariance(2, 2) = kTurn * kTurn;
    builder.arrive(name(kWalk[n]), motion);
    dense.drive(kWalk[n]);
    heading += turn;
  }
  const LandmarkGraph map = builder.map();
  for (int k = 0; k < 9; ++k) {
    const Vector2 exact = rotation(-axes) * at[idx(k)];
    ASSERT_LE((map.landmark(*map.find(name(k))).position - exact).norm(), 1e-9);
  }
  // From where it stands; its first corner counts. The last way has corners that are new.
  dense.learns_ = false;
  const std::vector<std::vector<int>> ways{
      {1, 0}, {1, 4}, {1, 2, 5}, {1, 4, 5, 8, 7}, {1, 4, 3, 0, 1, 4}, {1, 2, 1, 4}, {1, 4, 5, 2}};
  std::vector<std::vector<int>> by_number;
  for (const std::vector<int>& way : ways) {
    by_number.emplace_back();
    for (const int k : way) by_number.back().push_back(*map.find(name(k)));
  }
  const std::vector<double> falls = builder.expected_falls(by_number);
  const double before = dense.summed_variance();
  for (std::size_t w = 0; w < ways.size(); ++w) {
    DenseMap after = dense;
    for (std::size_t n = 1; n < ways[w].size(); ++n) after.drive(ways[w][n]);
    EXPECT_NEAR(falls[w], before - after.summed_variance(), 1e-6 * before) << w;
    EXPECT_GT(falls[w], 1e-4 * before);
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutACompass, ExpectedFallsOfARobot, ::testing::Bool());

TEST(ExpectedFalls, AWayThatLeavesTheRoutesIsRefused) {
  const MapBuilder builder = mapped_in_map_axes({});
  const LandmarkGraph map = builder.map();
  const int a = *map.find(name(0));
  const int b = *map.find(name(8));
  EXPECT_THROW(static_cast<void>(builder.expected_falls({{a, b}})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(builder.expected_falls({{a, 99}})), std::invalid_argument);
  EXPECT_EQ(builder.expected_falls({{a}}), std::vector<double>{0.0});
  EXPECT_TRUE(builder.expected_falls({}).empty());
}

}  // namespace
}  // namespace trussmap::expected_falls_test
