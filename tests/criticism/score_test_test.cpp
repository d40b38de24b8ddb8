// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Score tests: what they promise against what a refit finds, and that they keep quiet where nothing
// is missing.
#include "criticism/score_test.hpp"

#include "criticism/data_lacks.hpp"
#include "criticism/noisy_recordings.hpp"
#include "criticism/trends.hpp"
#include "driven.hpp"
#include "estimation/simulated_recordings.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace trussmap::score_test_test {
using namespace criticism;
using namespace fitting;
namespace {

using testing::Equipment;
using testing::simulate_recording;
using testing::SimulatedRecording;

Effect effect_of(Channel channel, const std::vector<Shape>& shape) {
  Effect effect;
  effect.name = name_of(channel);
  effect.channel = channel;
  effect.shape = shape;
  return effect;
}

/// What the recording's wheels would have shown with a wheelbase off by as much.
void widen(DrivenRecording& recording, double wheelbase, double g) {
  for (std::size_t row = 0; row < recording.drive.rows(); ++row) {
    const double path = 0.5 * (recording.drive.pair.left[row] + recording.drive.pair.right[row]);
    const double turn =
        (recording.drive.pair.right[row] - recording.drive.pair.left[row]) / wheelbase / (1.0 + g);
    recording.drive.pair.left[row] = path - 0.5 * wheelbase * turn;
    recording.drive.pair.right[row] = path + 0.5 * wheelbase * turn;
  }
  testing::retake(recording.drive, wheelbase);
}

TEST(ScoreTest, PromisesWhatARefitTakesOffChi2) {
  SimulatedRecording one = simulate_recording({}, 4);  // seed 4
  widen(one.recording, one.model.robot.wheelbase, -0.02);
  const FitState before = fit_recordings({one.recording}, one.model);
  const ScoreTest tests(before);
  for (const Effect& effect :
       {effect_of(Channel::turn, {"1"}), effect_of(Channel::turn, {"abs(turn_rate)"}),
        effect_of(Channel::compass, {"sin(heading)", "cos(heading)"}),
        effect_of(Channel::wheels, {"1"})}) {
    const Score score = tests.test({effect}).front();
    Model model = one.model;
    model.effects = {effect};
    const FitState after = fit_recordings({one.recording}, model);
    const double fallen = before.adjustment.chi2 - after.adjustment.chi2;
    EXPECT_NEAR(score.score, fallen, 0.05 * fallen + 0.5) << name_of(effect.channel);
    for (std::size_t k = 0; k < effect.shape.size(); ++k) {
      EXPECT_NEAR(score.coefficients[k], after.effects[0].effect.coefficients[k],
                  0.05 * std::abs(score.coefficients[k]) + 0.3 * score.sd[k]);
    }
  }
}

// A second of driving at a time: nearly the same for what changes little within it, and the very
// same for a constant.
TEST(ScoreTest, AQuickLookIsNearTheExactOne) {
  SimulatedRecording one = simulate_recording({}, 4);  // seed 4
  widen(one.recording, one.model.robot.wheelbase, -0.02);
  const FitState fit = fit_recordings({one.recording}, one.model);
  const ScoreTest tests(fit);
  const std::string bell = "exp(-((x-4)^2+(y-4)^2)/(2*3^2))";
  const std::vector<Effect> effects{
      effect_of(Channel::turn, {"1"}), effect_of(Channel::lever, {"1"}),
      effect_of(Channel::creep, {bell}), effect_of(Channel::compass, {bell}),
      effect_of(Channel::travel, {"t"})};
  const std::vector<Score> exact = tests.test(effects);
  const std::vector<Score> quick = tests.test(effects, Resolution::quick);
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const bool constant = effects[k].shape.front() == "1";
    const double near = constant ? 1e-9 : 0.02;
    EXPECT_NEAR((exact[k].columns - quick[k].columns).norm() / exact[k].columns.norm(), 0.0, near)
        << name_of(effects[k].channel);
    EXPECT_EQ(exact[k].dof, quick[k].dof);
  }
}

// What shows something is asked exactly, and so is what goes with events, of which a second's
// middle says nothing.
TEST(ScoreTest, ScreeningIsExactWhereItMatters) {
  testing::NoisyDrive world = testing::simulate_world({}, 4);  // seed 4
  widen(world.recordings.front(), world.model.robot.wheelbase, -0.02);
  const FitState fit = fit_recordings(world.recordings, world.model);
  const ScoreTest tests(fit);
  const std::vector<Effect> effects{effect_of(Channel::turn, {"abs(turn_rate)"}),
                                    effect_of(Channel::rotate, {"spins"}),
                                    effect_of(Channel::advance, {"starts"}),
                                    effect_of(Channel::difference, {"acceleration"}),
                                    effect_of(Channel::travel, {"t"}),
                                    effect_of(Channel::creep, {"speed"})};
  const std::vector<Score> exact = tests.test(effects);
  const std::vector<Score> quick = tests.test(effects, Resolution::quick);
  const std::vector<Score> screened = tests.test(effects, Resolution::screening);
  int left_quick = 0;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    EXPECT_EQ(screened[k].dof, exact[k].dof) << name_of(effects[k].channel);
    if (k < 4 || exact[k].p_value < 0.01) {
      EXPECT_DOUBLE_EQ(screened[k].score, exact[k].score) << name_of(effects[k].channel);
    } else if (quick[k].p_value >= 0.05) {
      EXPECT_DOUBLE_EQ(screened[k].score, quick[k].score) << name_of(effects[k].channel);
      EXPECT_GE(exact[k].p_value, 0.01) << name_of(effects[k].channel);
      ++left_quick;
    }
  }
  EXPECT_LT(exact[0].p_value, 1e-6);
  EXPECT_GT(left_quick, 0);
  // A quick look cannot see a spin's first row.
  EXPECT_GT((exact[1].columns - quick[1].columns).norm(), 0.5 * exact[1].columns.norm());
}

TEST(ScoreTest, ManyAtOnceAreTheSameAsOneByOne) {
  const SimulatedRecording one = simulate_recording({}, 5);
  const FitState fit = fit_recordings({one.recording}, one.model);
  const ScoreTest tests(fit);
  std::vector<Effect> effects;
  for (const Channel channel : {Channel::turn, Channel::travel, Channel::difference, Channel::creep,
                                Channel::lever, Channel::drift}) {
    effects.push_back(effect_of(channel, {"1"}));
    effects.push_back(effect_of(channel, {"sin(heading)", "cos(heading)"}));
  }
  const std::vector<Score> joint = tests.test(effects);
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const Score alone = tests.test({effects[k]}).front();
    EXPECT_NEAR(alone.score, joint[k].score, 1e-9 * (1.0 + alone.score));
    EXPECT_EQ(alone.dof, joint[k].dof);
  }
}

TEST(ScoreTest, WhereNothingIsMissingPValuesAreUniform) {
  // Kolmogorov and Smirnov at 1 %; seeds 1 ... 80, with survey and compass.
  std::vector<std::vector<double>> p_values(4);
  constexpr int kSeeds = 80;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const SimulatedRecording one = simulate_recording({}, seed);
    const FitState fit = fit_recordings({one.recording}, one.model);
    const std::vector<Score> scores =
        ScoreTest(fit).test({effect_of(Channel::turn, {"1"}), effect_of(Channel::wheels, {"1"}),
                             effect_of(Channel::travel, {"abs(speed)"}),
                             effect_of(Channel::compass, {"sin(heading)", "cos(heading)"})});
    for (std::size_t k = 0; k < scores.size(); ++k) p_values[k].push_back(scores[k].p_value);
  }
  for (std::vector<double>& sorted : p_values) {
    std::sort(sorted.begin(), sorted.end());
    double distance = 0.0;
    for (std::size_t k = 0; k < sorted.size(); ++k) {
      const double below = static_cast<double>(k) / kSeeds;
      distance = std::max({distance, sorted[k] - below, below + 1.0 / kSeeds - sorted[k]});
    }
    EXPECT_LT(distance, 1.628 / std::sqrt(kSeeds));
  }
}

TEST(ScoreTest, ASmallerMapIsNoEvidenceOfAScale) {
  // Without a survey nothing shows the scale, but a smaller map has smaller residuals.
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SimulatedRecording one = simulate_recording({seed % 2 == 0, false, false}, seed);
    const FitState fit = fit_recordings({one.recording}, one.model);
    for (const Score& score : ScoreTest(fit).test(
             {effect_of(Channel::travel, {"1"}), effect_of(Channel::wheels, {"1"})})) {
      EXPECT_TRUE(score.dof == 0 || score.p_value > 1e-4) << "seed " << seed;
    }
  }
}

TEST(ScoreTest, WhatTheModelHasIsNotFoundAgain) {
  SimulatedRecording one = simulate_recording({}, 6);
  widen(one.recording, one.model.robot.wheelbase, -0.02);
  one.model.effects = {effect_of(Channel::turn, {"1"})};
  const FitState fit = fit_recordings({one.recording}, one.model);
  EXPECT_EQ(ScoreTest(fit).test({effect_of(Channel::turn, {"1"})}).front().dof, 0);
}

TEST(Comparison, AnUnderstatedSourceIsRecognised) {
  SimulatedRecording one = simulate_recording({}, 8);
  one.model.noise.sighting /= 3.0;
  // A wrong weight lets some of its error into the others' residuals, but not most of it.
  for (const SourceCalibration& source : compare({one.recording}, one.model).sources) {
    if (source.source == "sighting") {
      EXPECT_NEAR(source.factor, 3.0, 4.0 * source.sd);
    } else {
      EXPECT_NEAR(source.factor, 1.0, 0.5) << source.source;
    }
  }
}

TEST(Comparison, ChiSquareOfLegsRoutesAndLandmarksIsTheWhole) {
  const SimulatedRecording one = simulate_recording({}, 9);
  const Comparison found = compare({one.recording}, one.model);
  double legs = 0.0;
  double routes = 0.0;
  double landmarks = 0.0;
  for (const LegMisfit& leg : found.worst) legs += leg.chi2;
  for (const RouteMisfit& route : found.routes) routes += route.chi2;
  for (const LandmarkMisfit& landmark : found.worst_landmarks) landmarks += landmark.chi2;
  EXPECT_NEAR(legs, routes, 1e-9 * legs);
  EXPECT_NEAR(legs + landmarks, found.chi2, 1e-6 * found.chi2);
}

}  // namespace
}  // namespace trussmap::score_test_test
