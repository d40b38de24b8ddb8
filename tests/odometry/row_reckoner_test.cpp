// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "odometry/row_reckoner.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace trussmap::row_reckoner_test {
using namespace odometry;
namespace {

Noise hazy(ProcessKind process, double length) {
  Noise noise;
  noise.compass = 0.001;
  NoiseProcess one;
  one.channel = Channel::compass;
  one.process = process;
  one.sd = 0.02;
  one.length = length;
  noise.processes = {one};
  return noise;
}

// The mean of n readings whose errors have the covariance sd^2 phi^|i - j|, summed term by term,
// against white readings: the same but for the ends, a share of 2 phi/(n (1 - phi)) at most.
TEST(WhiteEquivalent, LeavesTheMeanOfManyReadingsAsUncertain) {
  constexpr int kReadings = 4000;
  constexpr double kRow = 0.1;
  constexpr double kLength = 2.0;
  double sum = 0.0;
  for (int lag = 1; lag < kReadings; ++lag) {
    sum += 2.0 * (kReadings - lag) * std::exp(-lag * kRow / kLength);
  }
  const double of_mean = 0.02 * 0.02 * (kReadings + sum) / (1.0 * kReadings * kReadings);
  const Noise noise = hazy(ProcessKind::correlated_in_t, kLength);
  const double white = white_equivalent(noise, kRow, 0.05) - 0.001 * 0.001;
  const double phi = std::exp(-kRow / kLength);
  EXPECT_NEAR(white / kReadings, of_mean, of_mean * 2.0 * phi / (kReadings * (1.0 - phi)));
}

TEST(WhiteEquivalent, TakesEachProcessByItsOwnLag) {
  const Noise by_way = hazy(ProcessKind::correlated_in_distance, 0.5);
  EXPECT_LT(white_equivalent(by_way, 0.1, 1.0), white_equivalent(by_way, 0.1, 0.1));
  // What stays is never averaged, what is white at once; a robot at rest learns little.
  EXPECT_GT(white_equivalent(by_way, 0.1, 0.0), 0.5);
  EXPECT_GT(white_equivalent(hazy(ProcessKind::per_session, 0.0), 0.1, 0.1), 0.5);
  EXPECT_DOUBLE_EQ(white_equivalent(hazy(ProcessKind::white, 0.0), 0.1, 0.1),
                   0.001 * 0.001 + 0.02 * 0.02);
  EXPECT_DOUBLE_EQ(reading_variance(by_way), 0.001 * 0.001 + 0.02 * 0.02);
  EXPECT_DOUBLE_EQ(white_equivalent(Noise(), 0.1, 0.1), 0.02 * 0.02);
}

}  // namespace
}  // namespace trussmap::row_reckoner_test
