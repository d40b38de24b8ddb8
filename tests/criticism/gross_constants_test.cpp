// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Constants that are wrong by much: named for what they are, sized by a fit, and no noise instead.
#include "criticism/gross_constants.hpp"

#include "driven.hpp"
#include "shared_data.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/simulated_recording.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::gross_constants_test {
using namespace criticism;
namespace {

SimulationSettings small_world(std::uint64_t seed) {
  SimulationSettings settings;
  settings.mesh = "4x4";
  settings.tours = 2;
  settings.seed = seed;
  settings.no_compass = true;
  return settings;
}

ModelFit given(const SimulatedRecording& one) {
  return fit_model({one.drive.recording}, one.model);
}

std::optional<GrossConstants> found_under_a_gate(const SimulatedRecording& one) {
  const std::vector<DrivenRecording> driven{testing::driven(one.drive.recording)};
  return gross_constants(driven, fit_model(driven, one.model, gated_fit()), LegOptions{});
}

/// As of a robot that sees its landmarks from afar alone.
void leave_out_standing(SimulatedRecording& one) {
  std::erase_if(one.drive.recording.sightings,
                [](const Sighting& sighting) { return sighting.standing(); });
}

std::vector<std::string> names_in(const GrossConstants& constants) {
  std::vector<std::string> names;
  const std::vector<Effect>& effects = constants.fit.model.effects;
  for (std::size_t k = constants.first; k < effects.size(); ++k) names.push_back(effects[k].name);
  return names;
}

TEST(GrossConstants, AreNoneWhereNothingIsMissing) {
  const SimulatedRecording one = simulate(small_world(4), {});
  EXPECT_FALSE(gross_constants({testing::driven(one.drive.recording)}, given(one), LegOptions{}));
}

TEST(SlowGrossConstants, AreNoneWhereAnErrorIsSmall) {
  const SimulatedRecording one = simulate(small_world(4), {catalogue_effect("wheelbase", {0.02})});
  EXPECT_FALSE(gross_constants({testing::driven(one.drive.recording)}, given(one), LegOptions{}));
}

TEST(SlowGrossConstants, AreTheRightOnesWithTheRightSizes) {
  for (const auto& [name, g] : {std::pair{"travel scale", 1.0}, std::pair{"wheel scale", 0.25},
                                std::pair{"wheel diameter ratio", 0.1}}) {
    const SimulatedRecording one = simulate(small_world(5), {catalogue_effect(name, {g})});
    const auto found =
        gross_constants({testing::driven(one.drive.recording)}, given(one), LegOptions{});
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(names_in(*found), std::vector<std::string>{name});
    const EffectEstimate& size = found->fit.effects.back();
    EXPECT_NEAR(size.effect.coefficients.at(0), g, 4.0 * size.sd.at(0)) << name;
    EXPECT_GT(found->fit.p_value, 1e-4) << name;
  }
}

TEST(SlowGrossConstants, AWheelOfAnotherSizeIsOneConstant) {
  // Far off, and under a gate: of a wheel a fifth as large, and of one three times as large.
  for (const auto& [channel, g] :
       {std::pair{Channel::left, -0.8}, std::pair{Channel::right, 2.0}}) {
    const SimulatedRecording one = simulate(small_world(6), {Effect{"wheel", channel, {"1"}, {g}}});
    const auto found = found_under_a_gate(one);
    ASSERT_TRUE(found) << g;
    EXPECT_EQ(names_in(*found),
              std::vector<std::string>{channel == Channel::left ? "left wheel" : "right wheel"});
    EXPECT_EQ(found->fit.model.effects.back().channel, channel);
    EXPECT_NEAR(found->fit.model.effects.back().coefficients.at(0), g, 0.01 * (1.0 + g));
  }
}

TEST(SlowGrossConstants, TurningThreeTimesAsMuchAsStatedIsAWheelbase) {
  const SimulatedRecording one = simulate(small_world(33), {catalogue_effect("wheelbase", {2.0})});
  const auto found =
      gross_constants({testing::driven(one.drive.recording)}, given(one), LegOptions{});
  ASSERT_TRUE(found);
  EXPECT_EQ(names_in(*found), std::vector<std::string>{"wheelbase"});
  EXPECT_NEAR(found->fit.model.effects.back().coefficients.at(0), 2.0, 0.03);
}

TEST(SlowGrossConstants, TwoWheelsOfOtherSizesAreNamedEach) {
  const SimulatedRecording one =
      simulate(small_world(36), {Effect{"left", Channel::left, {"1"}, {-0.28}},
                                 Effect{"right", Channel::right, {"1"}, {0.12}}});
  const auto found =
      gross_constants({testing::driven(one.drive.recording)}, given(one), LegOptions{});
  ASSERT_TRUE(found);
  const std::vector<EffectEstimate>& all = found->fit.effects;
  ASSERT_EQ(all.size(), 2U);
  for (const EffectEstimate& wheel : all) {
    const bool left = wheel.effect.channel == Channel::left;
    EXPECT_EQ(wheel.effect.name, left ? "left wheel" : "right wheel");
    EXPECT_NEAR(wheel.effect.coefficients.at(0), left ? -0.28 : 0.12, 4.0 * wheel.sd.at(0));
  }
}

struct WrongSign {
  void (*spoil)(Drive&);
  bool compass;  ///< tells ahead from back
  const char* name;
  const char* words;
};

void negate(std::vector<double>& column) {
  for (double& one : column) one = -one;
}

TEST(SlowGrossConstants, AWrongSignIsSaidToBeOne) {
  for (const WrongSign& wrong :
       {WrongSign{[](Drive& drive) { std::swap(drive.left, drive.right); }, false, "wheelbase",
                  "left and right exchanged"},
        WrongSign{[](Drive& drive) { negate(drive.left); }, false, "left wheel",
                  "left wheel counts back"},
        WrongSign{[](Drive& drive) { negate(drive.right); }, false, "right wheel",
                  "right wheel counts back"},
        WrongSign{[](Drive& drive) { negate(drive.left), negate(drive.right); }, true,
                  "wheel scale", "all wheels count back"}}) {
    SimulationSettings settings = small_world(34);
    settings.no_compass = !wrong.compass;
    SimulatedRecording one = simulate(settings, {});
    const ModelFit right = given(one);
    wrong.spoil(one.drive.recording.drive);
    const auto found =
        gross_constants({testing::driven(one.drive.recording)}, given(one), LegOptions{});
    ASSERT_TRUE(found) << wrong.name;
    EXPECT_EQ(names_in(*found), std::vector<std::string>{wrong.name});
    const EffectEstimate& size = found->fit.effects.back();
    EXPECT_NEAR(size.effect.coefficients.at(0), -2.0, 4.0 * size.sd.at(0)) << wrong.name;
    EXPECT_LT(size.sd.at(0), 0.01);
    // The same drive, but for one coefficient more.
    EXPECT_NEAR(found->fit.chi2, right.chi2, 0.05 * right.chi2) << wrong.name;
    EXPECT_NE(in_words(size.effect, size.sd).find(wrong.words), std::string::npos);
  }
}

/// Of which the gyro says nothing that a fit from the stated signs could go by.
TEST(SlowGrossConstants, AWheelThatCountsBackIsFoundBesideAGyro) {
  for (const Channel wheel : {Channel::left, Channel::right}) {
    SimulationSettings settings = small_world(35);
    settings.gyro = true;
    SimulatedRecording one = simulate(settings, {});
    Drive& drive = one.drive.recording.drive;
    negate(wheel == Channel::left ? drive.left : drive.right);
    const auto found =
        gross_constants({testing::driven(one.drive.recording)}, given(one), LegOptions{});
    ASSERT_TRUE(found);
    const Effect& first = found->fit.model.effects.front();
    EXPECT_EQ(first.channel, wheel);
    EXPECT_NEAR(first.coefficients.at(0), -2.0, 0.01);
    EXPECT_LT(found->fit.chi2, 2.0 * found->fit.dof);
  }
}

/// Neither travel and wheelbase, nor on the verge of what is laid out for its noise.
TEST(SlowGrossConstants, BothWheelsBesideAGyroAreOneConstant) {
  for (const double g : {-0.5, -0.1}) {
    SimulationSettings settings = small_world(g == -0.5 ? 1004 : 1005);
    settings.uneven = true;
    settings.gyro = true;
    (g == -0.5 ? settings.range_sensor : settings.ranges_alone) = true;
    settings.no_survey = g != -0.5;
    const SimulatedRecording one = simulate(settings, {catalogue_effect("wheel scale", {g})});
    const auto found =
        gross_constants({testing::driven(one.drive.recording)}, given(one), LegOptions{});
    ASSERT_TRUE(found) << g;
    EXPECT_EQ(names_in(*found), std::vector<std::string>{"wheel scale"}) << g;
    const EffectEstimate& size = found->fit.effects.back();
    EXPECT_NEAR(size.effect.coefficients.at(0), g, 4.0 * size.sd.at(0)) << g;
    EXPECT_GT(found->fit.p_value, 1e-4) << g;
  }
}

/// No calibration leads anywhere without survey, truth and fixes: turns and returns do.
TEST(SlowGrossConstants, AWheelFiveTimesAsLargeIsFoundByRangesAlone) {
  SimulationSettings settings = small_world(1025);
  settings.uneven = true;
  settings.no_compass = false;
  settings.no_survey = true;
  settings.range_sensor = true;
  SimulatedRecording one = simulate(settings, {Effect{"right", Channel::right, {"1"}, {4.0}}});
  leave_out_standing(one);
  const auto found = found_under_a_gate(one);
  ASSERT_TRUE(found);
  EXPECT_EQ(names_in(*found), std::vector<std::string>{"right wheel"});
  EXPECT_NEAR(found->fit.model.effects.back().coefficients.at(0), 4.0, 0.02);
}

TEST(SlowGrossConstants, AnErrorOfAnotherKindIsFittedByItself) {
  SimulationSettings settings = small_world(9);
  settings.no_compass = false;
  settings.uneven = true;
  settings.full_turns = 4;
  for (const auto& [name, g] :
       {std::pair{"turn asymmetry", 0.25}, std::pair{"twist per spin", 0.2}}) {
    const SimulatedRecording one = simulate(settings, {catalogue_effect(name, {g})});
    const auto found = found_under_a_gate(one);
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(names_in(*found), std::vector<std::string>{name});
    EXPECT_NEAR(found->fit.model.effects.back().coefficients.at(0), g, 0.03 * g);
  }
}

/// Ranges and travels that are off by the same factor fit a smaller map, whose errors are smaller.
TEST(SlowGrossConstants, WhereRangesAloneMeasureADistanceTheyAreTakenAtTheirWord) {
  for (const auto& [effect, name] :
       {std::pair{catalogue_effect("wheel scale", {1.0}), "wheel scale"},
        std::pair{Effect{"wheel", Channel::left, {"1"}, {0.5}}, "left wheel"}}) {
    SimulationSettings settings = small_world(26);
    settings.gyro = true;
    settings.no_survey = true;
    settings.ranges_alone = true;
    const SimulatedRecording one = simulate(settings, {effect});
    const auto found =
        gross_constants({testing::driven(one.drive.recording)}, given(one), LegOptions{});
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(names_in(*found), std::vector<std::string>{name});
    EXPECT_NEAR(found->fit.model.effects.back().coefficients.at(0), effect.coefficients[0], 0.01);
  }
}

/// A robot that backs sees the same ranges: it is taken to go ahead.
TEST(SlowGrossConstants, WhereNothingTellsAheadFromBackTheRobotGoesAhead) {
  SimulationSettings settings = small_world(1281);
  settings.uneven = true;
  settings.gyro = true;
  settings.no_survey = true;
  settings.ranges_alone = true;
  const SimulatedRecording one = simulate(settings, {catalogue_effect("wheelbase", {-0.5})});
  const auto found = found_under_a_gate(one);
  ASSERT_TRUE(found);
  EXPECT_EQ(names_in(*found), std::vector<std::string>{"wheelbase"});
  EXPECT_NEAR(found->fit.model.effects.back().coefficients.at(0), -0.5, 0.01);
}

/// Turns scatter by .14 rad a leg then: the factor 5 is known to a hundredth, which is more than
/// would do for one near 1.
TEST(SlowGrossConstants, ATrackAFifthAsWideIsNamedByASurveyAlone) {
  SimulationSettings settings = small_world(1380);
  settings.uneven = true;
  const SimulatedRecording one = simulate(settings, {catalogue_effect("wheelbase", {4.0})});
  const auto found = found_under_a_gate(one);
  ASSERT_TRUE(found);
  EXPECT_EQ(names_in(*found), std::vector<std::string>{"wheelbase"});
  const EffectEstimate& size = found->fit.effects.back();
  EXPECT_TRUE(size.not_fitted.empty());
  EXPECT_NEAR(size.effect.coefficients.at(0), 4.0, 4.0 * size.sd.at(0));
}

/// A wheel that counts back, seen from a point beside the other one: turning, ratio and places of
/// antenna and sensor say the same by four numbers.
TEST(SlowGrossConstants, AWheelThatCountsBackIsOneConstantBesideFixes) {
  SimulationSettings settings = small_world(1358);
  settings.uneven = true;
  settings.gyro = true;
  settings.no_survey = true;
  settings.range_sensor = true;
  settings.fix_rate = 0.5;
  SimulatedRecording one = simulate(settings, {});
  negate(one.drive.recording.drive.right);
  leave_out_standing(one);
  const auto found = found_under_a_gate(one);
  ASSERT_TRUE(found);
  EXPECT_EQ(names_in(*found), std::vector<std::string>{"right wheel"});
}

TEST(SlowGrossConstants, AskForNoScaleThatNothingMeasures) {
  SimulationSettings settings = small_world(5);
  settings.no_survey = true;
  const SimulatedRecording one = simulate(settings, {catalogue_effect("wheelbase", {-0.2})});
  const auto found =
      gross_constants({testing::driven(one.drive.recording)}, given(one), LegOptions{});
  ASSERT_TRUE(found);
  EXPECT_EQ(names_in(*found), std::vector<std::string>{"wheelbase"});
}

TEST(SlowGrossConstants, ALoadThatLastsForALegIsNoConstant) {
  // Each leg's travel off by 4 % at random: a mean of them is no scale.
  SimulationSettings settings = small_world(6);
  settings.covariates = {"slack"};
  const SimulatedRecording one =
      simulate(settings, {Effect{"slack", Channel::travel, {"slack-0.5"}, {0.08}}});
  EXPECT_FALSE(gross_constants({testing::driven(one.drive.recording)}, given(one), LegOptions{}));
}

TEST(GrossConstants, LeadADiagnosisWithTheirFittedSizes) {
  const SimulatedRecording one = simulate(small_world(7), {catalogue_effect("wheelbase", {-0.2})});
  DiagnoseOptions options;
  options.fit = gated_fit();
  const Diagnosis result = diagnose({one.drive.recording}, one.model, options);
  EXPECT_EQ(result.verdict, Diagnosis::Verdict::missing);
  EXPECT_EQ(result.missing, "wheelbase");
  ASSERT_EQ(found_by(result).size(), 1U);
  const Finding& first = result.findings.front();
  EXPECT_NEAR(first.effect.coefficients.at(0), -0.2, 4.0 * first.sd.at(0));
  EXPECT_LE(first.score, result.chi2);
  EXPECT_LT(result.with_missing.arrival_rms, 0.1 * result.held_out.arrival_rms);
  EXPECT_TRUE(std::none_of(result.events.begin(), result.events.end(),
                           [](const EventTest& event) { return event.p_adjusted < 0.05; }));
}

TEST(SlowGrossConstants, ADiscoveryBeginsWithThem) {
  const SimulatedRecording one = simulate(
      small_world(8),
      {catalogue_effect("wheelbase", {-0.2}), catalogue_effect("wheel diameter ratio", {0.02})});
  DiscoverOptions options;
  options.diagnosis.fit = gated_fit();
  const Discovery result = discover({one.drive.recording}, one.model, options);
  EXPECT_GT(result.found.p_value, 1e-3);
  ASSERT_EQ(result.found.model.effects.size(), 2U);
  for (const EffectEstimate& found : result.found.effects) {
    const double g = found.effect.name == "wheelbase" ? -0.2 : 0.02;
    EXPECT_NEAR(found.effect.coefficients.at(0), g, 4.0 * found.sd.at(0)) << found.effect.name;
  }
  EXPECT_EQ(result.steps.size(), 3U);
  EXPECT_EQ(result.first.verdict, Diagnosis::Verdict::missing);
}

/// Metres off, where no score test about the fit without it means anything.
TEST(SlowGrossConstants, FindASensorFarOffTheAxle) {
  SimulationSettings settings;
  settings.mesh = "3x3";
  settings.spacing = 15.0;
  settings.uneven = true;
  settings.tours = 1;
  settings.seed = 10;
  settings.full_turns = 2;
  settings.no_compass = true;
  settings.speeds = {0.8, 1.5};
  settings.fix_rate = 0.5;
  settings.mounted.antenna = Mounting{3.75, 0.4, 0.0};
  SimulatedRecording one = simulate(settings, {});
  one.model.robot.mounted = {};
  one.drive.recording.sightings.clear();
  one.drive.recording.survey.clear();
  DiagnoseOptions options;
  options.fit = gated_fit();
  const Diagnosis result = diagnose({one.drive.recording}, one.model, options);
  ASSERT_EQ(found_by(result).size(), 2U);
  EXPECT_EQ(result.missing, "antenna ahead of the axle");
  for (const auto& [k, truth] : {std::pair(0, 3.75), std::pair(1, 0.4)}) {
    const Finding& found = result.findings.at(static_cast<std::size_t>(k));
    EXPECT_NEAR(found.effect.coefficients.at(0), truth, 3.0 * found.sd.at(0));
    EXPECT_LT(found.sd.at(0), 0.05);
  }
}

/// The model found starts every later fit where it belongs.
TEST(SlowGrossConstants, AModelThatHasThemIsFittedFromThere) {
  const SimulatedRecording one = simulate(small_world(9), {catalogue_effect("wheelbase", {-0.2})});
  Model model = one.model;
  model.effects = {catalogue_effect("wheelbase", {-0.2})};
  FitOptions as_given;
  as_given.fit_effects = false;
  EXPECT_GT(fit_model({one.drive.recording}, model, as_given).p_value, 1e-4);
}

struct Report {
  const char* folder;
  const char* missing;
  double g;  ///< as its owner found out
};

TEST(SlowReports, AreToldTheConstantThatIsWrong) {
  TRUSSMAP_NEEDS_SHARED("data/reports");
  for (const Report& report :
       {Report{"half-travel", "travel scale", 1.0}, Report{"half-turns", "wheelbase", 1.0},
        Report{"turns-1.4", "wheelbase", 1.0 / 1.4 - 1.0},
        Report{"four-marks-scale", "travel scale", 1.0 / 0.7 - 1.0},
        Report{"dead-wheels", "wheelbase", 12.0 / 13.625 - 1.0},
        Report{"ten-spins", "wheelbase", 0.0061},
        Report{"wheels-exchanged-ranges", "wheelbase", -2.0}}) {
    const std::filesystem::path folder = testing::shared("data/reports") / report.folder;
    const Model model = read_model(folder / "model.toml");
    const FitOptions fit = gated_fit();
    const PreparedRecordings ready =
        prepare_recordings({with_wheels(read_recording(folder), model.robot)}, model, fit);
    DiagnoseOptions options;
    options.fit = fit;
    const Diagnosis result = diagnose(ready.recordings, model, options);
    EXPECT_EQ(result.missing, report.missing) << report.folder;
    if (result.findings.empty()) continue;
    const Finding& first = result.findings.front();
    EXPECT_NEAR(first.effect.coefficients.at(0), report.g, 4.0 * first.sd.at(0)) << report.folder;
    EXPECT_LT(first.sd.at(0), 0.03) << report.folder;
  }
}

}  // namespace
}  // namespace trussmap::gross_constants_test
