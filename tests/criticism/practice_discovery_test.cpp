// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Discoveries on recordings whose answers are known.
#include "shared_data.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::practice_discovery_test {
namespace {

Discovery discovered(const std::string& below) {
  const std::filesystem::path folder = testing::shared(below);
  const Model model = read_model(folder / "model.toml");
  return discover({with_wheels(read_recording(folder), model.robot)}, model);
}

struct Found {
  double coefficient = kAbsent;
  double sd = kAbsent;
};

Found found(const Discovery& discovery, Channel channel) {
  for (const auto& one : discovery.found.effects) {
    if (one.effect.channel == channel) return {one.effect.coefficients.front(), one.sd.front()};
  }
  return {};
}

// Its dead reckoning looks worse beside its own path than the stated model's beside that model's.
TEST(SlowPracticeDiscovery, ALoadOnOneWheelIsTaken) {
  TRUSSMAP_NEEDS_SHARED("data/hidden");
  const Discovery discovery = discovered("data/hidden/k");
  EXPECT_TRUE(discovery.consistent);
  ASSERT_EQ(discovery.found.effects.size(), 1U);
  const Found load = found(discovery, Channel::left);
  EXPECT_NEAR(load.coefficient, 0.000285, 3.0 * load.sd);
}

// A compass offset or a creep, and the wheels' scale, which explains more than any loss in arcs.
TEST(SlowPracticeDiscovery, OfCommonErrorsTheOneThatExplainsMostIsTaken) {
  TRUSSMAP_NEEDS_SHARED("data/hidden");
  const Discovery discovery = discovered("data/hidden/l");
  EXPECT_TRUE(discovery.consistent);
  EXPECT_EQ(discovery.found.effects.size(), 2U);
  EXPECT_TRUE(std::isfinite(found(discovery, Channel::creep).coefficient) ||
              std::isfinite(found(discovery, Channel::compass).coefficient));
  EXPECT_NEAR(found(discovery, Channel::travel).coefficient, 0.0092, 0.0006);
}

// Mecanum wheels under motion capture whose rows are stamped unevenly. By hand: wheels 7 % larger,
// the truth turned by 2.2 degrees; turning 10 % more by a regression of the headings' changes over
// 3 s.
TEST(SlowPracticeDiscovery, UnevenStampsOfTruthAreNoErrorsOfTurning) {
  TRUSSMAP_NEEDS_SHARED("data/polimi-mecanum");
  const Discovery discovery = discovered("data/polimi-mecanum/bag2");
  const Found travel = found(discovery, Channel::travel);
  const Found turn = found(discovery, Channel::turn);
  const Found truth = found(discovery, Channel::truth_heading);
  EXPECT_NEAR(travel.coefficient, 0.07, 0.01);
  EXPECT_NEAR(turn.coefficient, 0.105, 3.0 * std::hypot(turn.sd, 0.01));
  EXPECT_LT(turn.sd, 0.012);
  EXPECT_NEAR(truth.coefficient, -0.0384, 0.01);
}

}  // namespace
}  // namespace trussmap::practice_discovery_test
