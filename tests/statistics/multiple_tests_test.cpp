// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "statistics/multiple_tests.hpp"

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::multiple_tests_test {
using namespace statistics;
namespace {

TEST(MultipleTests, HolmAsInHisPaper) {
  // Worked by hand: 4 x 0.005, 3 x 0.01, then 2 x 0.03, and no smaller for 0.04.
  const std::vector<double> adjusted = holm({0.01, 0.04, 0.03, 0.005});
  const std::vector<double> expected = {0.03, 0.06, 0.06, 0.02};
  ASSERT_EQ(adjusted.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(adjusted[k], expected[k], 1e-15);
}

TEST(MultipleTests, BonferroniIsNeverMoreThanCertain) {
  EXPECT_DOUBLE_EQ(bonferroni(0.01, 3.0), 0.03);
  EXPECT_DOUBLE_EQ(bonferroni(0.5, 3.0), 1.0);
}

TEST(MultipleTests, AFamilyCountsForAllItsMembers) {
  // The best of ten, beside one by itself: as if the other nine had been listed with p = 1.
  const std::vector<double> families = holm({0.002, 0.03}, {10, 1}, 11.0);
  std::vector<double> all(11, 1.0);
  all[0] = 0.002;
  EXPECT_DOUBLE_EQ(families[0], holm(all)[0]);
  EXPECT_DOUBLE_EQ(families[1], 0.03);
  // One test more that has no p-value here.
  EXPECT_DOUBLE_EQ(holm({0.002}, {1}, 12.0)[0], 0.024);
}

TEST(MultipleTests, FalseAlarmsStayBelowTheLevel) {
  constexpr int kRuns = 20000;
  constexpr double kLevel = 0.05;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform;
  int alarms = 0;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<double> p(30);
    for (double& one : p) one = uniform(random);
    const std::vector<double> adjusted = holm(p);
    alarms += *std::min_element(adjusted.begin(), adjusted.end()) < kLevel ? 1 : 0;
  }
  // At most 5 % and 3 sds of a count: sqrt(0.05 0.95 20000) = 31.
  EXPECT_LE(alarms, 1000 + 93);
  EXPECT_GE(alarms, 1000 - 25 - 93);  // independent tests: 1 - (1 - 0.05/30)^30 = 4.88 %
}

}  // namespace
}  // namespace trussmap::multiple_tests_test
