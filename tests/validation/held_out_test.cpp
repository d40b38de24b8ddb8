// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/held_out.hpp"

#include "criticism/disturbances.hpp"
#include "criticism/score_test.hpp"
#include "driven.hpp"
#include "estimation/recording_problem.hpp"
#include "fit/placed_drives.hpp"
#include "trussmap/catalogue.hpp"
#include "validation/held_out_legs.hpp"
#include "validation/leg_spans.hpp"

#include <cmath>
#include <cstdint>
#include <set>

#include <gtest/gtest.h>

namespace trussmap::held_out_test {
using namespace fitting;
using namespace validation;
namespace {

using testing::Disturbance;
using testing::disturbed_cases;
using testing::DisturbedCase;
using testing::invert;
using testing::inverted_model;
using testing::InvertedOptions;
using testing::InvertedRecording;

DisturbedCase case_of(const std::string& name) {
  for (const DisturbedCase& one : disturbed_cases()) {
    if (one.effect == name) return one;
  }
  throw std::runtime_error(name);
}

HeldOut predicted(const std::vector<DrivenRecording>& recordings, const Model& model,
                  const FitOptions& options = {}, const LegOptions& legs = {}) {
  return predict_held_out(recordings, fit_model(recordings, model, options), legs);
}

std::vector<LegSpan> spans(const std::vector<DrivenRecording>& recordings,
                           const LegOptions& options) {
  return leg_spans(recordings, estimation::make_problem(recordings, inverted_model()), options);
}

/// Truth rows at the end of every `every`-th row, and no sightings.
DrivenRecording with_truth_alone(const InvertedRecording& simulated, std::size_t every) {
  DrivenRecording recording = simulated.recording;
  recording.sightings.clear();
  recording.survey.clear();
  for (std::size_t row = every; row < simulated.places.size(); row += every) {
    recording.truth.push_back({recording.drive.t[row], simulated.places[row].real(),
                               simulated.places[row].imag(), simulated.headings[row]});
  }
  return recording;
}

TEST(HeldOut, WhichLegsDependsOnTheirNumberAndTheShareAlone) {
  const InvertedRecording one = invert({}, {}, 51);
  const InvertedRecording other = invert({}, {}, 52);
  std::vector<LegSpan> legs = spans({one.recording, other.recording}, {});
  ASSERT_GT(legs.size(), 60U);
  std::vector<std::size_t> blocks;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    EXPECT_EQ(legs[k].held_out, legs[k / 5 * 5].held_out) << k;  // whole blocks of five
    if (k % 5 == 0 && legs[k].held_out) blocks.push_back(k / 5);
  }
  EXPECT_EQ(blocks[0], 3U);
  EXPECT_EQ(blocks[1], 6U);
  EXPECT_EQ(blocks[2], 9U);
  EXPECT_EQ(blocks[3], 13U);
  const std::vector<LegSpan> others = spans({other.recording, one.recording}, {});
  for (std::size_t k = 0; k < std::min(legs.size(), others.size()); ++k) {
    EXPECT_EQ(legs[k].held_out, others[k].held_out) << k;
  }
  LegOptions options;
  for (const double share : {0.0, 0.1, 0.25, 0.5, 0.9}) {
    options.share = share;
    std::size_t held_out = 0;
    legs = spans({one.recording, other.recording}, options);
    for (const LegSpan& leg : legs) held_out += leg.held_out ? 1 : 0;
    EXPECT_NEAR(static_cast<double>(held_out), share * static_cast<double>(legs.size()), 5.0)
        << share;
  }
}

TEST(HeldOut, LegsRunFromReferenceToReference) {
  const InvertedRecording simulated = invert({}, {}, 53);
  const std::vector<DrivenRecording> recordings = {simulated.recording};
  const estimation::RecordingProblem problem =
      estimation::make_problem(recordings, inverted_model());
  const std::vector<LegSpan> legs = leg_spans(recordings, problem);
  // One standing sighting per stop, each of another landmark than the one before.
  ASSERT_EQ(legs.size() + 1, simulated.recording.sightings.size());
  for (std::size_t k = 0; k < legs.size(); ++k) {
    EXPECT_EQ(legs[k].time.from, simulated.recording.sightings[k].t);
    EXPECT_EQ(legs[k].time.to, simulated.recording.sightings[k + 1].t);
    EXPECT_EQ(problem.measurements[legs[k].from].source, k);
    EXPECT_EQ(problem.measurements[legs[k].to].source, k + 1);
  }
}

TEST(HeldOut, AnExactRecordingIsPredictedExactlyUnderEachEffect) {
  for (const DisturbedCase& one : disturbed_cases()) {
    const InvertedRecording simulated = invert(one.disturbance, one.options, 54);
    const HeldOut result =
        predicted({simulated.recording}, inverted_model({catalogue_effect(one.effect)}));
    EXPECT_GT(result.legs.size(), 5U) << one.effect;
    EXPECT_LT(result.arrival_rms, 1e-5) << one.effect;
    EXPECT_LT(result.stretch_error, 1e-5) << one.effect;
    EXPECT_LT(result.orientation_error, 1e-5) << one.effect;
    const HeldOut without = predicted({simulated.recording}, inverted_model());
    EXPECT_GT(without.arrival_rms, 100.0 * result.arrival_rms) << one.effect;
  }
}

TEST(HeldOut, SurveyAndCompassAreNotNeeded) {
  const DisturbedCase one = case_of("wheelbase");
  for (const bool survey : {true, false}) {
    for (const bool compass : {true, false}) {
      InvertedOptions options;
      options.survey = survey;
      options.compass = compass;
      const InvertedRecording simulated = invert(one.disturbance, options, 55);
      const HeldOut result =
          predicted({simulated.recording}, inverted_model({catalogue_effect(one.effect)}));
      EXPECT_GT(result.legs.size(), 5U);
      EXPECT_LT(result.arrival_rms, 1e-5) << survey << compass;
    }
  }
}

TEST(HeldOut, FiguresAreTheMeansOverTheLegs) {
  InvertedOptions options;
  options.noisy = true;
  const InvertedRecording simulated = invert({}, options, 56);
  const HeldOut result = predicted({simulated.recording}, inverted_model());
  double squares = 0.0;
  double stretch = 0.0;
  double orientation = 0.0;
  for (const LegPrediction& leg : result.legs) {
    EXPECT_TRUE(leg.has_chord);
    EXPECT_NE(leg.from, leg.to);
    squares += leg.arrival_error.squaredNorm();
    stretch += leg.stretch_error;
    orientation += leg.orientation_error;
  }
  const auto count = static_cast<double>(result.legs.size());
  EXPECT_NEAR(result.arrival_rms, std::sqrt(squares / count), 1e-12);
  EXPECT_NEAR(result.stretch_error, stretch / count, 1e-12);
  EXPECT_NEAR(result.orientation_error, orientation / count, 1e-12);
}

/// Spoils all rows and sightings strictly inside a block of held-out legs whose sightings are
/// stamped this late.
DrivenRecording spoiled(DrivenRecording recording, const std::vector<LegSpan>& legs,
                        std::size_t first, double late = 0.0) {
  const double from = legs[first].time.from;
  const double to = legs[first + 4].time.to;
  for (std::size_t row = 0; row < recording.drive.rows(); ++row) {
    const double t = recording.drive.t[row];
    if (t <= from + 1e-9 || t > to - late + 1e-9) continue;
    recording.drive.pair.left[row] *= 1.03;
    recording.drive.pair.right[row] *= 0.99;
    if (recording.drive.has_compass()) {
      recording.drive.heading[row] = std::remainder(recording.drive.heading[row] + 0.1, 2.0 * M_PI);
    }
  }
  testing::retake(recording.drive, testing::kInvertedWheelbase);
  for (Sighting& sighting : recording.sightings) {
    if (sighting.t <= from + 1e-9 || sighting.t >= to - 1e-9) continue;
    if (!sighting.standing()) sighting.range += 0.2;
  }
  return recording;
}

/// Held-out legs before time t.
std::map<double, Vector2> errors_until(const HeldOut& result, double t) {
  std::map<double, Vector2> errors;
  for (const LegPrediction& leg : result.legs) {
    if (leg.t <= t) errors[leg.t] = leg.arrival_error;
  }
  return errors;
}

TEST(HeldOut, NothingLeaksFromHeldOutLegs) {
  // What happens in a held-out block must not change what is predicted of the blocks before it:
  // that depends on the training's landmarks and coefficients alone.
  for (const std::string name :
       {"wheelbase", "hard iron", "cross-slope creep", "bearing offset", "sighting delay"}) {
    DisturbedCase one = case_of(name);
    one.options.noisy = true;
    const DrivenRecording clean = invert(one.disturbance, one.options, 57).recording;
    const std::vector<LegSpan> legs = spans({clean}, {});
    std::size_t block = 0;
    for (std::size_t k = 0; k + 5 < legs.size(); k += 5) {
      if (legs[k].held_out) block = k;
    }
    ASSERT_GT(block, 25U);
    const DrivenRecording bad = spoiled(clean, legs, block, name == "sighting delay" ? 0.5 : 0.0);
    const Model model = inverted_model({catalogue_effect(name)});
    const double until = legs[block].time.from - 1.0;
    const auto expected = errors_until(predicted({clean}, model), until);
    const auto found = errors_until(predicted({bad}, model), until);
    ASSERT_EQ(expected.size(), found.size()) << name;
    ASSERT_GE(expected.size(), 5U) << name;
    double worst = 0.0;
    for (auto a = expected.begin(), b = found.begin(); a != expected.end(); ++a, ++b) {
      worst = std::max(worst, (a->second - b->second).norm());
    }
    // Where delays are fitted anew, to what the fit calls settled.
    EXPECT_LT(worst, name == "sighting delay" ? 1e-4 : 1e-8) << name;
    // That it is bad shows in the fit of all legs.
    EXPECT_GT(fit_recordings({bad}, model).adjustment.chi2,
              1.2 * fit_recordings({clean}, model).adjustment.chi2)
        << name;
  }
}

/// A robot without compass that stands on its tags knows its heading at each by a good yaw: seeds
/// 60 to 64.
TEST(HeldOut, YawsTellTheHeadingAtALegsStart) {
  double with = 0.0;
  double without = 0.0;
  for (std::uint64_t seed = 60; seed < 65; ++seed) {
    testing::PlacedOptions options;
    options.markers = options.landmarks = true;
    options.yaw_sd = 0.002;
    options.tours = 3;
    testing::PlacedDrive drive = testing::placed_drive(options, seed);
    with += std::pow(predicted({testing::driven(drive.recording)}, drive.model).arrival_rms, 2);
    for (Sighting& one : drive.recording.sightings) one.yaw = kAbsent;
    without += std::pow(predicted({testing::driven(drive.recording)}, drive.model).arrival_rms, 2);
  }
  EXPECT_LT(with, 0.8 * without);
}

/// A drive without noise whose yaws err: what their effect would move the predictions by, to first
/// order and with the landmarks' shifts of the fit to all legs, takes most of the error away.
TEST(HeldOut, SlopesOfAYawEffectTakeItsErrorAway) {
  for (const auto& [shape, g] : {std::pair{"t", 1e-4}, std::pair{"sin(heading)", 1e-2}}) {
    testing::PlacedOptions options;
    options.markers = options.landmarks = true;
    options.noise = false;
    options.tours = 3;
    options.effects = {{"turned", Channel::sighting_yaw, {shape}, {g}, false}};
    const testing::PlacedDrive drive = testing::placed_drive(options, 66);
    const FitState fit = fit_recordings({testing::driven(drive.recording)}, drive.model);
    const std::vector<DrivenRecording> recordings{testing::driven(drive.recording)};
    const HeldOutLegs legs(recordings, fit, FitterOptions());
    ASSERT_GT(legs.metrics().legs.size(), 5U);
    Effect open = options.effects.front();
    open.coefficients.clear();
    const criticism::ScoreTest test(fit);
    const criticism::Score score = test.test({open}).front();
    ASSERT_EQ(score.dof, 1);
    const Eigen::VectorXd change = g * legs.slopes(open, score.columns, score.landmarks).col(0);
    const double before = legs.metrics().arrival_rms;
    EXPECT_LT(legs.moved(change).arrival_rms, 0.5 * before) << shape;
    EXPECT_GT(legs.moved(-change).arrival_rms, 1.5 * before) << shape;
  }
}

TEST(HeldOut, TheTrainingItselfKnowsNothingOfThem) {
  DisturbedCase one = case_of("wheelbase");
  one.options.noisy = true;
  const DrivenRecording clean = invert(one.disturbance, one.options, 58).recording;
  const std::vector<LegSpan> legs = spans({clean}, {});
  FitterOptions options;
  options.problem.left_out.resize(1);
  std::size_t block = 0;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    if (!legs[k].held_out) continue;
    options.problem.left_out[0].push_back(legs[k].time);
    if (k % 5 == 0 && k + 5 < legs.size()) block = k;
  }
  // Spans as they are joined: the sightings between two held-out legs are left out with them.
  std::vector<TimeSpan> joined;
  for (const TimeSpan& span : options.problem.left_out[0]) {
    if (!joined.empty() && joined.back().to == span.from) {
      joined.back().to = span.to;
    } else {
      joined.push_back(span);
    }
  }
  options.problem.left_out[0] = joined;
  const Model model = inverted_model({catalogue_effect(one.effect)});
  const FitState a = fit_recordings({clean}, model, options);
  const FitState b = fit_recordings({spoiled(clean, legs, block)}, model, options);
  EXPECT_EQ(a.adjustment.dof, b.adjustment.dof);
  // Rounding decides which of them needs a round more.
  EXPECT_NEAR(a.adjustment.chi2, b.adjustment.chi2, 1e-6);
  EXPECT_NEAR(a.effects[0].effect.coefficients[0], b.effects[0].effect.coefficients[0], 1e-9);
  const auto places = landmark_places(b);
  for (const auto& [name, place] : landmark_places(a)) {
    EXPECT_LT((place - places.at(name)).norm(), 1e-9) << name;
  }
}

TEST(HeldOut, TheRightModelPredictsBetterThanTheWrongOne) {
  for (const std::string name : {"wheelbase", "wheel diameter ratio", "cross-slope creep"}) {
    DisturbedCase one = case_of(name);
    one.options.noisy = true;
    one.options.compass = false;
    const DrivenRecording recording = invert(one.disturbance, one.options, 59).recording;
    const HeldOut right = predicted({recording}, inverted_model({catalogue_effect(name)}));
    const HeldOut wrong = predicted({recording}, inverted_model());
    ASSERT_EQ(right.legs.size(), wrong.legs.size());
    EXPECT_GT(wrong.arrival_rms, 1.2 * right.arrival_rms) << name;
    // What chance makes it: 2.5 m of legs, sd 5 to 10 mm along, more across.
    EXPECT_GT(right.arrival_rms, 0.005) << name;
    EXPECT_LT(right.arrival_rms, 0.1) << name;
  }
}

TEST(HeldOut, ExpectedErrorsAreAsLargeAsThoseOfTheRightModel) {
  double measured = 0.0, expected = 0.0;
  for (const std::uint64_t seed : {71, 72, 73, 74, 75, 76, 77, 78}) {
    DisturbedCase one = case_of("wheelbase");
    one.options.noisy = true;
    const DrivenRecording recording = invert(one.disturbance, one.options, seed).recording;
    const HeldOut held_out =
        predicted({recording}, inverted_model({catalogue_effect("wheelbase")}));
    double squares = 0.0;
    for (const LegPrediction& leg : held_out.legs) {
      measured += leg.arrival_error.squaredNorm();
      squares += std::pow(leg.expected_error, 2);
    }
    const auto legs = static_cast<double>(held_out.legs.size());
    ASSERT_GT(legs, 0.0);
    EXPECT_NEAR(held_out.expected_rms, std::sqrt(squares / legs), 1e-12);
    expected += squares;
  }
  // Some 80 legs, an error of one leading component each: the ratio of the sums has an sd of
  // (2/80)^(1/2) = 0.16.
  EXPECT_NEAR(measured / expected, 1.0, 0.4);
}

TEST(HeldOut, LegsBetweenTruthRowsArePredictedToo) {
  const DisturbedCase one = case_of("wheelbase");
  const InvertedRecording simulated = invert(one.disturbance, one.options, 60);
  const DrivenRecording recording = with_truth_alone(simulated, 3);
  const std::vector<LegSpan> legs = spans({recording}, {});
  for (const LegSpan& leg : legs) {
    double driven = 0.0;
    for (std::size_t row = 0; row < recording.drive.rows(); ++row) {
      const double t = recording.drive.t[row];
      if (t <= leg.time.from + 1e-9 || t > leg.time.to + 1e-9) continue;
      driven += std::abs(recording.drive.forward[row]);
    }
    EXPECT_GE(driven, 1.0 - 1e-9);
    EXPECT_LT(driven, 1.6);  // rows of 9 cm, three apart, of which every 25 cm is used
  }
  const HeldOut right = predicted({recording}, inverted_model({catalogue_effect(one.effect)}));
  EXPECT_GT(right.legs.size(), 10U);
  EXPECT_LT(right.arrival_rms, 1e-5);
  EXPECT_TRUE(right.legs[0].from.empty());
  EXPECT_GT(predicted({recording}, inverted_model()).arrival_rms, 1e-3);
}

TEST(HeldOut, ALandmarkOfHeldOutLegsAloneIsPassedOver) {
  for (const bool survey : {true, false}) {
    InvertedOptions options;
    options.survey = survey;
    InvertedRecording simulated = invert({}, options, 61);
    DrivenRecording& recording = simulated.recording;
    const std::vector<LegSpan> legs = spans({recording}, {});
    // The end of the second leg of the first held-out block gets a name of its own.
    ASSERT_TRUE(legs[15].held_out);
    const double t = legs[16].time.to;
    for (Sighting& sighting : recording.sightings) {
      if (sighting.t == t) sighting.landmark = "alone";
    }
    const HeldOut result = predicted({recording}, inverted_model());
    std::set<std::size_t> numbers;
    for (const LegPrediction& leg : result.legs) {
      numbers.insert(leg.leg);
      EXPECT_NE(leg.to, "alone");
      if (leg.from == "alone") {
        EXPECT_FALSE(leg.has_chord);
      }
    }
    EXPECT_FALSE(numbers.contains(16));
    EXPECT_TRUE(numbers.contains(17));  // from there, arrival alone
    EXPECT_LT(result.arrival_rms, 1e-6);
    if (survey) {
      // Surveyed, it is known without being seen.
      recording.survey.push_back({"alone", 0.0, 0.0, kAbsent});
      const auto truth = simulated.places[static_cast<std::size_t>(std::lround(10.0 * t)) - 1];
      recording.survey.back().x = truth.real();
      recording.survey.back().y = truth.imag();
      const HeldOut known = predicted({recording}, inverted_model());
      EXPECT_EQ(known.legs.size(), result.legs.size() + 1);
      EXPECT_LT(known.arrival_rms, 1e-6);
    }
  }
}

TEST(HeldOut, ADriveThatNeverReturnsHasNothingToBePredicted) {
  // Behind the first held-out block nothing is tied to what was before it.
  InvertedOptions options;
  options.survey = options.compass = false;
  DrivenRecording recording = invert({}, options, 63).recording;
  int number = 0;
  for (Sighting& sighting : recording.sightings) {
    sighting.landmark = "once" + std::to_string(number++);
  }
  EXPECT_TRUE(predicted({recording}, inverted_model()).legs.empty());
}

TEST(HeldOut, WithoutAShareNothingIsPredicted) {
  const InvertedRecording simulated = invert({}, {1}, 62);
  LegOptions options;
  options.share = 0.0;
  const HeldOut result = predicted({simulated.recording}, inverted_model(), {}, options);
  EXPECT_TRUE(result.legs.empty());
  EXPECT_EQ(result.arrival_rms, 0.0);
}

}  // namespace
}  // namespace trussmap::held_out_test
