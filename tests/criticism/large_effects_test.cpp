// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Effects so large that legs end a tenth of a metre off, on tours of a mesh, against what was
// simulated.
#include "criticism/diagnosis.hpp"
#include "criticism/score_test.hpp"
#include "driven.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/simulated_recording.hpp"
#include "trussmap/workbench.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::large_effects_test {
namespace {

Effect sized(Effect effect, double coefficient) {
  effect.coefficients = {coefficient};
  return effect;
}

/// A wheel that says too little by a share that grows with the square of the speed.
Effect left_with_speed_squared(double coefficient) {
  Effect effect;
  effect.name = "mine";
  effect.channel = Channel::left;
  effect.shape = {Shape("speed^2")};
  return sized(effect, coefficient);
}

SimulatedRecording toured(std::uint64_t seed, const std::vector<Effect>& effects) {
  SimulationSettings settings;
  settings.seed = seed;
  return simulate(settings, effects);
}

std::vector<std::string> missing_in(const Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const Finding* one : found_by(diagnosis)) names.push_back(one->effect.name);
  return names;
}

/// Which alone look like the left wheel's error "with a curve of speed".
struct TwoCauses {
  Effect ticks = sized(catalogue_effect("missed ticks (v0=0.5)"), -0.05);
  Effect scale = sized(catalogue_effect("travel scale"), 0.005);
};

TEST(KnownCauses, ComeBeforeOneOddCurve) {
  const TwoCauses truth;
  const SimulatedRecording one = toured(11, {truth.ticks, truth.scale});
  const Diagnosis result = diagnose({one.drive.recording}, one.model);
  const std::vector<std::string> names = missing_in(result);
  ASSERT_EQ(names.size(), 2U) << ::testing::PrintToString(names);
  EXPECT_EQ(names[0].rfind("missed ticks (v0=", 0), 0U) << names[0];
  EXPECT_EQ(names[1], "travel scale");
  const std::vector<const Finding*> found = found_by(result);
  EXPECT_NEAR(found[0]->effect.shape.front().parameter("speed").value_or(0.0), 0.5, 0.03);
  EXPECT_NEAR(found[0]->joint.at(0), -0.05, 0.006);
  EXPECT_NEAR(found[1]->joint.at(0), 0.005, 4.0 * found[1]->joint_sd.at(0));
}

TEST(KnownCauses, LeaveAFormAloneThatIsTheOnlyCause) {
  const SimulatedRecording one = toured(12, {left_with_speed_squared(0.02)});
  const Diagnosis result = diagnose({one.drive.recording}, one.model);
  EXPECT_EQ(missing_in(result), std::vector<std::string>{"left with speed squared"});
}

TEST(LargeEffects, AtAPlaceLeaveNeitherWrongSightingsNorNoiseThatLasts) {
  const Effect anomaly = sized(catalogue_effect("local magnetic anomaly (x=-1, y=19, r=4)"), -0.14);
  const Effect asymmetry = sized(catalogue_effect("turn asymmetry"), -0.0134);
  const SimulatedRecording one = toured(21, {anomaly, asymmetry});
  DiagnoseOptions options;
  options.fit = gated_fit();
  const Diagnosis result = diagnose({one.drive.recording}, one.model, options);
  const std::vector<const Finding*> found = found_by(result);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0]->effect.name.rfind("local magnetic anomaly (x=", 0), 0U);
  EXPECT_EQ(found[1]->effect.name, "turn asymmetry");
  EXPECT_NEAR(found[0]->joint.at(0), -0.14, 4.0 * found[0]->joint_sd.at(0));
  EXPECT_NEAR(found[1]->joint.at(0), -0.0134, 4.0 * found[1]->joint_sd.at(0));
  EXPECT_GT(found[0]->sd_inflation.at(0), 1.2);  // its place was sought
  // Sightings in the ring contradict the model given, and nothing with what is missing.
  ASSERT_TRUE(result.under);
  ASSERT_FALSE(result.under->fit.left_out.empty());
  EXPECT_FALSE(result.under->noise.changed());
  for (const EventTest& event : result.events) EXPECT_GT(event.p_adjusted, 0.001) << event.name;
  for (const NoiseTest& law : result.noise) EXPECT_GT(law.p_adjusted, 0.001) << law.law;
  ASSERT_EQ(result.warnings.size(), 1U) << ::testing::PrintToString(result.warnings);
  EXPECT_NE(result.warnings[0].find("with what is missing added all of them fit"),
            std::string::npos);
}

TEST(LargeEffects, AtAPlaceAreTheTrendThatIsShownFirst) {
  const SimulatedRecording one =
      toured(22, {sized(catalogue_effect("local magnetic anomaly (x=12, y=12, r=4)"), -0.1)});
  const ModelFit fit = fit_model({one.drive.recording}, one.model);
  const ComparisonEvidence evidence = evidence_of(fit, compare({one.drive.recording}, fit));
  ASSERT_FALSE(evidence.trends.empty());
  const Response& response = evidence.trends.front().response;
  EXPECT_EQ(response.variable, kPlace);
  EXPECT_EQ(response.channel, Channel::compass);
  // Near the place the compass reads too little, far off it is right.
  EXPECT_LT(response.bins.front().estimate, -4.0 * response.bins.front().sd);
  EXPECT_LT(std::abs(response.bins.back().estimate), 0.02);
  EXPECT_TRUE(response.curve.empty());
}

TEST(LargeEffects, ThatAreTheSameToFirstOrderAreToldApartByTheirFits) {
  // A robot that drives askew gets a little less far than its wheels say; one whose compass is
  // mounted askew does not.
  const SimulatedRecording one = toured(104, {sized(catalogue_effect("constant creep"), -0.03)});
  const Discovery result = discover({one.drive.recording}, one.model);
  ASSERT_EQ(result.found.model.effects.size(), 1U);
  EXPECT_EQ(result.found.model.effects[0].name, "constant creep");
  const std::vector<LookAlike>& rivals = result.steps.at(1).look_alikes;
  const auto named = [&rivals](const std::string& name) {
    return std::find_if(rivals.begin(), rivals.end(),
                        [&name](const LookAlike& rival) { return rival.effect.name == name; });
  };
  EXPECT_EQ(named("constant creep"), rivals.end());
  ASSERT_NE(named("compass offset"), rivals.end());
  EXPECT_TRUE(named("compass offset")->told_apart());
}

TEST(LargeEffects, AreForetoldAsTheFitThenFindsThem) {
  // chi^2 per degree of freedom of about 7 without it.
  const SimulatedRecording one = toured(12, {left_with_speed_squared(0.02)});
  const ModelFit without = fit_model({one.drive.recording}, one.model);
  ASSERT_GT(without.chi2, 4.0 * without.dof);
  Effect mine = left_with_speed_squared(0.0);
  mine.coefficients.clear();
  const criticism::Score score = criticism::ScoreTest(*without.state).test({mine}).front();
  Model model = one.model;
  model.effects = {mine};
  const ModelFit with = fitting::refit({testing::driven(one.drive.recording)}, model, without);
  EXPECT_NEAR(score.score, without.chi2 - with.chi2, 0.01 * (without.chi2 - with.chi2));
  EXPECT_NEAR(score.coefficients.at(0), 0.02, 0.001);
}

TEST(LargeEffects, PassForNoNoiseThatLasts) {
  const SimulatedRecording one = toured(13, {left_with_speed_squared(0.02)});
  const Diagnosis result = diagnose({one.drive.recording}, one.model);
  EXPECT_EQ(missing_in(result), std::vector<std::string>{"left with speed squared"});
  ASSERT_TRUE(result.under);
  for (const NoiseProcess& process : result.under->noise.noise.processes) {
    EXPECT_NE(process.channel, Channel::left);
    EXPECT_NE(process.channel, Channel::difference);
  }
  EXPECT_LT(result.under->noise.noise.left, 1.2 * one.model.noise.left);
}

TEST(LargeEffects, AreShownOnTheirCurve) {
  const TwoCauses truth;
  const SimulatedRecording one = toured(11, {truth.ticks, truth.scale});
  Model model = one.model;
  for (Effect effect : {truth.ticks, truth.scale}) {
    effect.coefficients.clear();
    model.effects.push_back(effect);
  }
  const TriedModel tried(std::make_shared<const std::vector<DrivenRecording>>(
                             std::vector{testing::driven(one.drive.recording)}),
                         model);
  const Response shown = tried.shown(0).response;
  ASSERT_GT(shown.bins.size(), 6U);
  int far = 0;
  for (const ResponseBin& bin : shown.bins) {
    // A bin across the threshold has a mean of both sides.
    if (bin.low < 0.5 && bin.high > 0.5) continue;
    const double g = -0.05 * std::max(0.0, bin.at - 0.5);
    far += std::abs(bin.estimate - g) > 3.0 * bin.sd ? 1 : 0;
  }
  EXPECT_EQ(far, 0);
}

}  // namespace
}  // namespace trussmap::large_effects_test
