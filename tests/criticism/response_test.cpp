// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/response.hpp"

#include "driven.hpp"
#include "fit/fit_state.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::response_test {
using namespace fitting;
using namespace criticism;
namespace {

Effect effect(Channel channel, const std::vector<Shape>& shape,
              const std::vector<double>& coefficients = {}) {
  Effect one;
  one.name = "e";
  one.channel = channel;
  one.shape = shape;
  one.coefficients = coefficients;
  return one;
}

/// The riddle, as its owner believes the robot to be; its compass has 0.04 sin h - 0.03 cos h.
struct Riddle {
  std::vector<DrivenRecording> recordings{
      testing::driven(read_recording(std::string(TRUSSMAP_SOURCE_DIR) + "/maps/riddle"))};
  FitState fit = fit_recordings(
      recordings, read_model(std::string(TRUSSMAP_SOURCE_DIR) + "/maps/riddle/model.toml"));
  ScoreTest tests{fit};
};

TEST(Response, FollowsTheEffectThatIsThere) {
  const Riddle riddle;
  const Effect truth = effect(Channel::compass, {"sin(heading)", "cos(heading)"}, {0.04, -0.03});
  const Response found = response_along("heading", truth, riddle.fit, riddle.tests);
  ASSERT_GE(found.bins.size(), 4U);
  EXPECT_EQ(found.unit, "rad");
  double squares = 0.0;
  for (const ResponseBin& bin : found.bins) {
    const double expected = 0.04 * std::sin(bin.at) - 0.03 * std::cos(bin.at);
    EXPECT_NEAR(bin.estimate, expected, 4.0 * bin.sd) << bin.at;
    squares += std::pow(bin.estimate - expected, 2);
    EXPECT_LT(bin.low, bin.at);
    EXPECT_GT(bin.high, bin.at);
  }
  // The effect's own rms is 0.035.
  EXPECT_LT(std::sqrt(squares / static_cast<double>(found.bins.size())), 0.01);
}

TEST(Response, IsNothingWhereTheModelHasTheEffect) {
  const Riddle riddle;
  Model model = riddle.fit.model;
  model.effects = {effect(Channel::compass, {"sin(heading)", "cos(heading)"})};
  const FitState fit = fit_recordings(riddle.recordings, model);
  const ScoreTest tests(fit);
  const Response left = response_along("heading", effect(Channel::compass, {"1"}), fit, tests);
  ASSERT_GE(left.bins.size(), 4U);
  for (const ResponseBin& bin : left.bins) EXPECT_NEAR(bin.estimate, 0.0, 4.0 * bin.sd) << bin.at;
}

TEST(Response, HasNoBinsWhereTheVariableIsNotThereOrNeverChanges) {
  const Riddle riddle;
  EXPECT_TRUE(response_along("ghosts", effect(Channel::turn, {"1"}), riddle.fit, riddle.tests)
                  .bins.empty());
  EXPECT_TRUE(response_along("session", effect(Channel::turn, {"1"}), riddle.fit, riddle.tests)
                  .bins.empty());
}

TEST(Response, TheCurveIsTheFormula) {
  const Effect hard_iron =
      effect(Channel::compass, {"sin(heading)", "cos(heading)"}, {0.04, -0.03});
  const std::vector<Vector2> curve =
      effect_curve(hard_iron, "heading", 0.0, 2.0 * std::numbers::pi);
  ASSERT_FALSE(curve.empty());
  for (const Vector2& p : curve) {
    EXPECT_NEAR(p.y(), 0.04 * std::sin(p.x()) - 0.03 * std::cos(p.x()), 1e-12);
  }
  EXPECT_DOUBLE_EQ(curve.front().x(), 0.0);
  EXPECT_DOUBLE_EQ(curve.back().x(), 2.0 * std::numbers::pi);
  EXPECT_TRUE(effect_curve(hard_iron, "speed", 0.0, 1.0).empty());
  const std::vector<Vector2> level =
      effect_curve(effect(Channel::turn, {"1"}, {0.02}), "turn_rate", -1.0, 1.0);
  ASSERT_GE(level.size(), 2U);
  for (const Vector2& p : level) EXPECT_DOUBLE_EQ(p.y(), 0.02);
}

TEST(Response, AnEffectIsShownAgainstWhatItSpeaksOf) {
  EXPECT_EQ(natural_variable(effect(Channel::compass, {"sin(heading)", "cos(heading)"})),
            "heading");
  EXPECT_EQ(natural_variable(effect(Channel::wheels, {"payload_kg"})), "payload_kg");
  EXPECT_EQ(natural_variable(effect(Channel::turn, {"1"})), "turn_rate");
  EXPECT_EQ(natural_variable(effect(Channel::travel, {"1"})), "speed");
  EXPECT_EQ(natural_variable(effect(Channel::travel, {"exp(-((x-1)^2+(y-2)^2))"})), "");
}

TEST(FittedMap, HasEveryLandmarkAndAPathOfAsManyPointsAsWanted) {
  const Riddle riddle;
  const FittedMap map = fitted_map(fit_model(riddle.recordings, riddle.fit.model), 100);
  ASSERT_EQ(map.landmarks.size(), riddle.fit.problem.landmarks.size());
  for (const FittedLandmark& one : map.landmarks) {
    ASSERT_TRUE(one.survey) << one.name;
    EXPECT_LT((one.position - *one.survey).norm(), 0.5) << one.name;
  }
  ASSERT_EQ(map.paths.size(), 1U);
  EXPECT_LE(map.paths.front().size(), 102U);
  EXPECT_GE(map.paths.front().size(), 50U);
}

}  // namespace
}  // namespace trussmap::response_test
