// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The map builder's gate: wrong landmarks stay out, systematic errors do not.
#include "map/arrival_gate.hpp"

#include "trussmap/map_builder.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::arrival_gate_test {
namespace {

constexpr int kSide = 5;
constexpr double kSd = 0.05;  // m

Vector2 place(int k) {
  return {4.0 * (k % kSide), 4.0 * (k / kSide)};
}

struct Tour {
  double wrong_share = 0.0;
  double scale = 1.0;  ///< of every leg as measured
  unsigned seed = 1;
};

struct Toured {
  double error = 0.0;  ///< m, largest
  int left_out = 0;    ///< arrivals
  int wrong = 0;
  std::size_t at_last = 0;
};

/// 400 random legs between neighbours.
Toured drive(const Tour& tour, double gate) {
  MapBuilderOptions options;
  options.method = Method::gauss_markov;
  options.gate = gate;
  MapBuilder builder(options);
  std::mt19937_64 random(tour.seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  builder.start("0");
  Toured result;
  int here = 0;
  Traversal leg;  // since the last arrival
  leg.covariance.setZero();
  for (int legs = 0; legs < 400; ++legs) {
    int next = here;
    while (next == here || (place(next) - place(here)).norm() > 4.5) {
      next = std::uniform_int_distribution<int>(0, kSide * kSide - 1)(random);
    }
    leg.displacement +=
        tour.scale * (place(next) - place(here)) + kSd * Vector2(normal(random), normal(random));
    leg.covariance += kSd * kSd * Matrix2::Identity();
    here = next;
    const auto is_here = [&](int k) { return builder.find(std::to_string(k)) == builder.here(); };
    // Names are misread once all landmarks are known.
    const bool misread = legs > 150 && uniform(random) < tour.wrong_share;
    int named = next;
    while (misread && (named == next || is_here(named))) {
      named = std::uniform_int_distribution<int>(0, kSide * kSide - 1)(random);
    }
    if (is_here(named)) continue;  // back where it came from: no leg ends here
    result.wrong += misread ? 1 : 0;
    const Arrival arrival = builder.arrive(std::to_string(named), leg);
    if (arrival.kind == Arrival::Kind::left_out) ++result.left_out;
    leg.displacement.setZero();
    leg.covariance.setZero();
  }
  for (int k = 0; k < kSide * kSide; ++k) {
    const auto landmark = builder.find(std::to_string(k));
    if (!landmark) continue;
    result.error =
        std::max(result.error, (builder.position(*landmark) - tour.scale * place(k)).norm());
  }
  result.at_last = builder.left_out().size();
  return result;
}

TEST(ArrivalGate, WrongLandmarksStayOutAndTheRobotGoesOn) {
  const Toured open = drive({0.03}, std::numeric_limits<double>::infinity());
  const Toured gated = drive({0.03}, kMapGate);
  ASSERT_GT(gated.wrong, 3);
  EXPECT_EQ(gated.left_out, gated.wrong);
  EXPECT_EQ(gated.at_last, static_cast<std::size_t>(gated.wrong));
  EXPECT_LT(gated.error, 0.1);
  EXPECT_GT(open.error, 5.0 * gated.error);
}

TEST(ArrivalGate, WithoutWrongOnesItChangesNothing) {
  const Toured open = drive({}, std::numeric_limits<double>::infinity());
  const Toured gated = drive({}, kMapGate);
  EXPECT_EQ(gated.left_out, 0);
  EXPECT_EQ(gated.error, open.error);
}

/// The noise is forty times what the legs' covariances say: all contradict, none stays out.
TEST(ArrivalGate, WhatContradictsAlikeComesBack) {
  MapBuilderOptions options;
  options.method = Method::gauss_markov;
  MapBuilder gated(options);
  options.gate = std::numeric_limits<double>::infinity();
  MapBuilder open(options);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (MapBuilder* one : {&gated, &open}) one->start("0");
  int back = 0;
  for (int round = 0; round < 30; ++round) {
    for (const char* to : {"1", "2", "3", "0"}) {
      const int k = to[0] - '0';
      const Vector2 corners[] = {{0.0, 0.0}, {4.0, 0.0}, {4.0, 4.0}, {0.0, 4.0}};
      const Vector2 leg =
          corners[k] - corners[(k + 3) % 4] + 0.4 * Vector2(normal(random), normal(random));
      const Traversal traversal{leg, 1e-4 * Matrix2::Identity()};
      // Standing elsewhere after an arrival that was left out, the legs still add up.
      if (gated.here() != *gated.find(std::to_string((k + 3) % 4)) && gated.here() == k) continue;
      back += gated.arrive(to, traversal).back;
      open.arrive(to, traversal);
    }
  }
  EXPECT_GT(back, 0);
  EXPECT_LE(gated.left_out().size(), 2U);
  for (int k = 1; k < 4; ++k) {
    EXPECT_LT((gated.position(k) - open.position(k)).norm(), 0.3) << k;
  }
}

/// s by its definition: eight misfits at least, their median over that of chi^2 with two degrees of
/// freedom (2 log 2), the last fifty, and never below 1.
TEST(ArrivalGate, IsAsMuchWiderAsTheMedianMisfitIsLarger) {
  const double median = 2.0 * std::log(2.0);
  map::ArrivalGate gate(3.0);
  for (int k = 0; k < 7; ++k) {
    gate.remember(16.0 * median);
    EXPECT_EQ(gate.scale(), 1.0);
  }
  gate.remember(1e9);
  EXPECT_NEAR(gate.scale(), 4.0, 1e-12);
  EXPECT_TRUE(gate.lets_in(143.999));
  EXPECT_FALSE(gate.lets_in(144.001));
  for (int k = 0; k < 42; ++k) gate.remember(0.1 * median);
  EXPECT_EQ(gate.scale(), 1.0);
  EXPECT_TRUE(gate.lets_in(8.999));
  EXPECT_FALSE(gate.lets_in(9.001));
  EXPECT_EQ(gate.remembered().front(), 16.0 * median);
  gate.remember(4.0 * median);
  EXPECT_EQ(gate.remembered().size(), 50U);
  EXPECT_EQ(gate.remembered()[6], 1e9);
}

TEST(ArrivalGate, RefusesAGateOfNothing) {
  MapBuilderOptions options;
  options.gate = 0.0;
  EXPECT_THROW(MapBuilder{options}, std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::arrival_gate_test
