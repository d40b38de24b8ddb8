// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "validation/arrival_rise.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::arrival_rise_test {
using namespace validation;
namespace {

/// Legs by their numbers, with so many metres between prediction and truth.
HeldOut held_out(const std::vector<std::pair<std::size_t, double>>& errors) {
  HeldOut result;
  for (const auto& [leg, error] : errors) {
    LegPrediction one;
    one.leg = leg;
    one.arrival_error = {0.6 * error, -0.8 * error};
    result.legs.push_back(one);
  }
  return result;
}

/// By hand: squares rise by 0.03, -0.01 and 0.04, whose mean is 0.02 and whose scatter is
/// sqrt(0.0014/2): 0.02/(sqrt(0.0007)/sqrt(3)) = 1.3093.
TEST(ArrivalRise, IsTheMeanRiseOverItsStandardError) {
  const HeldOut before = held_out({{3, 0.1}, {4, 0.2}, {9, 0.3}});
  const HeldOut after =
      held_out({{9, std::sqrt(0.13)}, {3, std::sqrt(0.04)}, {4, std::sqrt(0.03)}});
  EXPECT_NEAR(rise_in_sds(before, after), 1.3093073414159542, 1e-12);
  EXPECT_NEAR(rise_in_sds(after, before), -1.3093073414159542, 1e-12);
}

TEST(ArrivalRise, AsksTheLegsThatBothHave) {
  const HeldOut before = held_out({{1, 5.0}, {3, 0.1}, {4, 0.2}, {9, 0.3}});
  const HeldOut after =
      held_out({{3, std::sqrt(0.04)}, {4, std::sqrt(0.03)}, {7, 9.0}, {9, std::sqrt(0.13)}});
  EXPECT_NEAR(rise_in_sds(before, after), 1.3093073414159542, 1e-12);
}

TEST(ArrivalRise, OfOneLegOrOfLegsThatRiseAlikeNothingIsChance) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(rise_in_sds(held_out({{1, 0.5}}), held_out({{1, 1.0}})), infinity);
  EXPECT_EQ(rise_in_sds(held_out({{1, 0.5}}), held_out({{2, 1.0}})), infinity);
  EXPECT_EQ(rise_in_sds(held_out({{1, 0.0}, {2, 0.0}}), held_out({{1, 5.0}, {2, 5.0}})), infinity);
}

}  // namespace
}  // namespace trussmap::arrival_rise_test
