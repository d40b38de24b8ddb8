// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a model says of hidden effects, counted.
#include "trussmap/catalogue.hpp"
#include "trussmap/simulated_recording.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace trussmap::answer_score_test {
namespace {

TEST(AnswerScore, CountsFoundMissedAndFalse) {
  const std::vector<Effect> truth = {catalogue_effect("hard iron", {0.2, -0.1}),
                                     catalogue_effect("slippery patch (x=5, y=5, r=3)", {-0.03}),
                                     catalogue_effect("turn scrub", {-0.04})};
  const std::vector<Effect> model = {
      catalogue_effect("slippery patch (x=5.2, y=4.9, r=3.1)", {-0.028}),
      {"iron of mine", Channel::compass, truth[0].shape, {0.21, -0.1}, false},
      catalogue_effect("wheelbase", {0.01}),
      catalogue_effect("wheel scale", {0.0}),  // says nothing
      {"not fitted", Channel::turn, {"t"}, {}, false}};
  const AnswerScore score =
      score_answer(truth, model, {{0.002}, {0.005, 0.005}, {0.001}, {0.001}, {}});
  EXPECT_EQ(score.found, 2);
  EXPECT_EQ(score.missed, 1);
  EXPECT_EQ(score.false_alarms, 1);
  ASSERT_EQ(score.effects.size(), 4U);
  ASSERT_EQ(score.effects[0].z.size(), 2U);
  EXPECT_NEAR(score.effects[0].z[0], 2.0, 1e-9);
  EXPECT_NEAR(score.effects[0].z[1], 0.0, 1e-9);
  EXPECT_NEAR(score.effects[1].z[0], 1.0, 1e-9);  // at another place
  EXPECT_FALSE(score.effects[2].estimate);
  EXPECT_EQ(score.effects[3].estimate->name, "wheelbase");
}

TEST(AnswerScore, AnEstimateCountsOnce) {
  const Effect scrub = catalogue_effect("turn scrub", {-0.04});
  const AnswerScore score = score_answer({scrub}, {scrub, scrub});
  EXPECT_EQ(score.found, 1);
  EXPECT_EQ(score.false_alarms, 1);
  EXPECT_TRUE(std::isnan(score.effects[0].z[0]));  // no standard error
}

}  // namespace
}  // namespace trussmap::answer_score_test
