// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The workbench on maps/riddle, whose hidden effect is a compass with hard iron.
#include "trussmap/workbench.hpp"

#include "driven.hpp"
#include "estimation/simulated_recordings.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/recording_files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::workbench_test {
namespace {

const std::filesystem::path kRiddle = std::filesystem::path(TRUSSMAP_SOURCE_DIR) / "maps/riddle";

const std::vector<DrivenRecording>& riddle() {
  static const std::vector<DrivenRecording> recordings{testing::driven(read_recording(kRiddle))};
  return recordings;
}

Model riddle_model() {
  return read_model(kRiddle / "model.toml");
}

/// Begun once: tests that make steps take a copy, which shares what is there.
const Workbench& begun() {
  static const Workbench bench(riddle(), riddle_model());
  return bench;
}

std::size_t finding_named(const TriedModel& model, const std::string& name) {
  const std::vector<Finding>& findings = model.diagnosis().findings;
  const auto found = std::find_if(findings.begin(), findings.end(),
                                  [&name](const Finding& one) { return one.effect.name == name; });
  if (found == findings.end()) throw std::runtime_error(name);
  return static_cast<std::size_t>(found - findings.begin());
}

TEST(Workbench, BeginsWithWhatTheCommandsSayOfTheModelGiven) {
  const Diagnosis diagnosis = diagnose(riddle(), riddle_model());
  const TriedModel& now = begun().now();
  EXPECT_EQ(now.diagnosis().missing, diagnosis.missing);
  EXPECT_EQ(now.diagnosis().held_out.arrival_rms, diagnosis.held_out.arrival_rms);
  ASSERT_EQ(now.diagnosis().findings.size(), diagnosis.findings.size());
  ASSERT_EQ(now.sizes().size(), diagnosis.findings.size());
  EXPECT_EQ(now.comparison().held_out.arrival_rms, diagnosis.held_out.arrival_rms);
  EXPECT_EQ(begun().log().steps.size(), 1U);
  EXPECT_EQ(begun().log().steps[0].arrival_rms, diagnosis.held_out.arrival_rms);
}

TEST(Workbench, APreviewIsWhatTheDiagnosisFoundOfTheSameEffect) {
  const TriedModel& now = begun().now();
  for (const std::string name : {"hard iron", "wheelbase", "spin loss"}) {
    const Finding& finding = now.diagnosis().findings[finding_named(now, name)];
    const EffectPreview preview = now.preview(catalogue_effect(name));
    EXPECT_NEAR(preview.score, finding.score, 1e-6 * finding.score) << name;
    EXPECT_EQ(preview.dof, finding.dof);
    ASSERT_TRUE(preview.predicted.has_value());
    EXPECT_NEAR(preview.predicted->arrival_rms, finding.held_out.arrival_rms, 1e-9) << name;
    EXPECT_FALSE(preview.evidence.response.bins.empty()) << name;
  }
}

TEST(Workbench, AnAddedEffectReachesWhatItsPreviewPromised) {
  Workbench bench = begun();
  const double before = bench.now().diagnosis().held_out.arrival_rms;
  bench.add(catalogue_effect("hard iron"));
  const WorkbenchStep& step = bench.log().steps.back();
  EXPECT_EQ(bench.log().at, 1U);
  EXPECT_EQ(step.from, 0U);
  // 0.04 and -0.03 rad were simulated (maps/riddle/README.md); standard errors are 0.6 mrad.
  const std::vector<double>& found = bench.now().fit().effects.at(0).effect.coefficients;
  EXPECT_NEAR(found.at(0), 0.04, 0.002);
  EXPECT_NEAR(found.at(1), -0.03, 0.002);
  ASSERT_TRUE(step.predicted_rms.has_value());
  EXPECT_LT(step.arrival_rms, 0.15 * before);
  EXPECT_NEAR(step.arrival_rms, *step.predicted_rms, 0.02 * before);
  // As good as the noise lets it be: five legs, two values each.
  EXPECT_LT(step.arrival_rms, 2.0 * step.expected_rms);
  // The step is the model before any fit: nothing hangs on the way to it.
  EXPECT_TRUE(step.model.effects.at(0).coefficients.empty());
}

TEST(Workbench, WhatWasAddedTakesFromWhatLooksLikeIt) {
  Workbench bench = begun();
  const auto saves = [&bench](const std::string& name) {
    const TriedModel& now = bench.now();
    return now.diagnosis().held_out.arrival_rms -
           now.diagnosis().findings[finding_named(now, name)].held_out.arrival_rms;
  };
  const double before = saves("cross-slope creep");
  bench.add(catalogue_effect("hard iron"));
  EXPECT_LT(saves("cross-slope creep"), 0.02 * before);
}

TEST(Workbench, AStepReturnedToHasTheSameFiguresToTheLastDigit) {
  Workbench bench = begun();
  bench.add(catalogue_effect("hard iron"));
  const double with = bench.now().diagnosis().held_out.arrival_rms;
  const std::vector<double> found = bench.now().fit().effects.at(0).effect.coefficients;
  bench.add(catalogue_effect("wheelbase"));
  bench.remove(1);
  EXPECT_EQ(bench.log().steps.back().kind, WorkbenchStep::Kind::remove);
  EXPECT_EQ(bench.log().steps.back().effect, "wheelbase");
  EXPECT_EQ(bench.now().diagnosis().held_out.arrival_rms, with);
  bench.go_to(0);
  EXPECT_EQ(bench.now().diagnosis().held_out.arrival_rms,
            begun().now().diagnosis().held_out.arrival_rms);
  // From its log alone, as after a crash.
  WorkbenchLog log = bench.log();
  log.at = 1;
  const Workbench again(riddle(), log);
  EXPECT_EQ(again.now().diagnosis().held_out.arrival_rms, with);
  EXPECT_EQ(again.now().fit().effects.at(0).effect.coefficients, found);
}

TEST(Workbench, TheWayToAStepLeavesOutWhatWasUndone) {
  WorkbenchLog log;
  log.steps.resize(5);
  log.steps[1].from = 0;
  log.steps[2].from = 1;
  log.steps[3].from = 1;
  log.steps[4].from = 3;
  EXPECT_EQ(way_to(log, 4), (std::vector<std::size_t>{0, 1, 3, 4}));
  EXPECT_EQ(way_to(log, 0), (std::vector<std::size_t>{0}));
  EXPECT_THROW(way_to(log, 5), std::out_of_range);
}

TEST(Workbench, ANameIsOfItsStepAloneAndChangesNothingElse) {
  Workbench bench = begun();
  bench.add(catalogue_effect("hard iron"));
  const WorkbenchLog before = bench.log();
  bench.rename(1, "with iron");
  EXPECT_EQ(bench.log().steps[1].label, "with iron");
  EXPECT_EQ(bench.log().steps[0].label, "");
  EXPECT_EQ(bench.log().at, before.at);
  EXPECT_EQ(bench.log().steps[1].arrival_rms, before.steps[1].arrival_rms);
  bench.go_to(0);
  EXPECT_EQ(bench.log().steps[1].label, "with iron");
  // What begins there has no name yet.
  bench.go_to(1);
  bench.remove(0);
  EXPECT_EQ(bench.log().steps[2].label, "");
  EXPECT_THROW(bench.rename(3, "x"), std::out_of_range);
}

TEST(Workbench, AStepThatFailsLeavesAllAsItWas) {
  Workbench bench = begun();
  bench.add(catalogue_effect("hard iron"));
  const double before = bench.now().diagnosis().held_out.arrival_rms;
  EXPECT_THROW(bench.add(catalogue_effect("hard iron")), std::invalid_argument);
  Effect unknown;
  unknown.name = "goes with nothing";
  unknown.shape = {"no_such_column"};
  EXPECT_THROW(bench.add(unknown), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(bench.now().preview(unknown)), std::invalid_argument);
  EXPECT_THROW(bench.remove(3), std::out_of_range);
  EXPECT_THROW(bench.go_to(7), std::out_of_range);
  EXPECT_EQ(bench.log().steps.size(), 2U);
  EXPECT_EQ(bench.log().at, 1U);
  EXPECT_EQ(bench.now().diagnosis().held_out.arrival_rms, before);
}

TEST(Workbench, LogsWithoutAWayAreRefused) {
  EXPECT_THROW(Workbench(riddle(), WorkbenchLog{}), std::invalid_argument);
  WorkbenchLog circle;
  circle.steps.resize(2);
  circle.steps[1].from = 1;
  EXPECT_THROW(Workbench(riddle(), circle), std::invalid_argument);
  WorkbenchLog nowhere;
  nowhere.steps.resize(1);
  nowhere.at = 1;
  EXPECT_THROW(Workbench(riddle(), nowhere), std::invalid_argument);
}

TEST(Workbench, AnEffectOfTheModelIsShownAsTheRecordingsShowItWithoutIt) {
  Workbench bench = begun();
  bench.add(catalogue_effect("hard iron"));
  const EffectEvidence shown = bench.now().shown(0);
  ASSERT_GT(shown.response.bins.size(), 6U);
  // Bins that never saw the effect lie on its curve.
  int far = 0;
  for (const ResponseBin& bin : shown.response.bins) {
    const double g = 0.04 * std::sin(bin.at) - 0.03 * std::cos(bin.at);
    if (std::abs(bin.estimate - g) > 4.0 * bin.sd + 0.005) ++far;
  }
  EXPECT_LE(far, 1);
  EXPECT_THROW(static_cast<void>(bench.now().shown(1)), std::out_of_range);
}

TEST(Workbench, ValuesOfACandidateCanBeMovedAndSnapToTheBest) {
  const TriedModel& now = begun().now();
  const std::vector<Finding>& findings = now.diagnosis().findings;
  std::size_t k = 0;
  while (k < findings.size() && now.parameters(k).empty()) ++k;
  ASSERT_LT(k, findings.size());
  const std::vector<EffectParameter> parameters = now.parameters(k);
  std::vector<double> values;
  for (const EffectParameter& one : parameters) {
    values.push_back(one.parameter.value + one.step);
    EXPECT_LT(one.least, one.most);
    EXPECT_GT(one.step, 0.0);
  }
  const Effect moved = now.moved(k, values);
  EXPECT_FALSE(moved.shape == findings[k].effect.shape);
  const Effect best = now.moved(k, now.best_near(k, values));
  EXPECT_GE(now.preview(best).score, now.preview(moved).score - 1e-9);
  // One alone: the others stay where they were put.
  const std::vector<double> first = now.best_near(k, values, 0);
  const Effect by_first = now.moved(k, first);
  EXPECT_GE(now.preview(by_first).score, now.preview(moved).score - 1e-9);
  for (std::size_t j = 1; j < values.size(); ++j) {
    EXPECT_NEAR(first[j], values[j], 1e-9 + 0.1 * parameters[j].step) << parameters[j].unit;
  }
  EXPECT_NE(parameters[0].unit, "");
  values.push_back(0.0);
  EXPECT_THROW(static_cast<void>(now.moved(k, values)), std::invalid_argument);
}

TEST(Workbench, MoreNoiseSwallowsAnEffectAndLessMakesNoneSurer) {
  const Diagnosis& diagnosis = begun().now().diagnosis();
  const std::size_t iron = finding_named(begun().now(), "hard iron");
  const double believed = p_with_noise(diagnosis, iron, 1.0);
  EXPECT_LT(believed, kSignificance);
  EXPECT_EQ(p_with_noise(diagnosis, iron, 0.5), believed);
  double before = believed;
  for (const double factor : {2.0, 4.0, 8.0, 16.0, 32.0}) {
    const double p = p_with_noise(diagnosis, iron, factor);
    EXPECT_GE(p, before);
    before = p;
  }
  // By hand: two coefficients, so that the chance is exp(-x/2), times the tests.
  const double score = diagnosis.findings[iron].score;
  const double x = score / (20.0 * 20.0);
  EXPECT_NEAR(p_with_noise(diagnosis, iron, 20.0),
              std::min(1.0, std::exp(-0.5 * x) * static_cast<double>(diagnosis.tried)), 1e-9);
  EXPECT_EQ(p_with_noise(diagnosis, iron, 100.0), 1.0);
}

TEST(Workbench, RivalsAreForetoldBeside) {
  const TriedModel& now = begun().now();
  const EffectPreview duel =
      now.preview(catalogue_effect("hard iron"), {catalogue_effect("cross-slope creep")});
  ASSERT_EQ(duel.rivals_predicted.size(), 1U);
  ASSERT_TRUE(duel.rivals_predicted[0].has_value());
  EXPECT_EQ(duel.rivals_predicted[0]->arrival_rms,
            now.preview(catalogue_effect("cross-slope creep")).predicted->arrival_rms);
  ASSERT_EQ(duel.evidence.response.rivals.size(), 1U);
  EXPECT_FALSE(duel.evidence.response.rivals[0].empty());
}

std::vector<std::size_t> free_legs(const TriedModel& model, std::size_t most) {
  std::vector<std::size_t> numbers;
  for (const TriedLeg& leg : model.legs()) {
    if (!leg.held_out && !leg.excluded && numbers.size() < most) numbers.push_back(leg.number);
  }
  return numbers;
}

TEST(Workbench, ItsLegsAreThoseOfTheComparison) {
  const TriedModel& now = begun().now();
  ASSERT_EQ(now.legs().size(), now.comparison().legs);
  std::size_t held_out = 0;
  for (std::size_t k = 0; k < now.legs().size(); ++k) {
    const TriedLeg& leg = now.legs()[k];
    EXPECT_EQ(leg.number, k);
    EXPECT_FALSE(leg.excluded);
    held_out += leg.held_out ? 1 : 0;
    // Where it ends is where its landmark is: the robot stands on it.
    for (const FittedLandmark& landmark : now.map().landmarks) {
      if (landmark.name == leg.to) {
        EXPECT_LT((landmark.position - leg.end).norm(), 0.1);
      }
    }
  }
  EXPECT_EQ(held_out, now.diagnosis().held_out.legs.size());
}

TEST(Workbench, ChoosesLegsByPlaceAndByTime) {
  const TriedModel& now = begun().now();
  const TriedLeg& leg = now.legs()[now.legs().size() / 2];
  const Vector2 middle = 0.5 * (leg.begin + leg.end);
  const Vector2 little(1e-3, 1e-3);
  for (const std::size_t number : legs_in_area(now, middle - little, middle + little)) {
    // The distance of the middle from its straight way, by brute force.
    const TriedLeg& other = now.legs()[number];
    double nearest = 1e300;
    for (int k = 0; k <= 10'000; ++k) {
      const double share = k / 10'000.0;
      nearest =
          std::min(nearest, (other.begin + share * (other.end - other.begin) - middle).norm());
    }
    EXPECT_LT(nearest, 3e-3);
  }
  const auto found = legs_in_area(now, middle + little, middle - little);
  EXPECT_NE(std::find(found.begin(), found.end(), leg.number), found.end());
  EXPECT_EQ(legs_in_area(now, {-1e3, -1e3}, {1e3, 1e3}).size(), now.legs().size());
  EXPECT_TRUE(legs_in_area(now, {1e3, 1e3}, {2e3, 2e3}).empty());
  const double start = now.recordings().front().drive.start();
  EXPECT_EQ(legs_in_time(now, {leg.time.from - start, leg.time.to - start}),
            std::vector<std::size_t>{leg.number});
  EXPECT_EQ(legs_in_time(now, {0.0, 1e9}).size(), now.legs().size());
}

TEST(Workbench, ExcludesLegsAndTakesThemBackIn) {
  Workbench bench = begun();
  const HeldOut before = bench.now().diagnosis().held_out;
  const int dof = bench.now().fit().dof;
  const std::vector<std::size_t> chosen = free_legs(bench.now(), 3);
  bench.exclude(chosen);
  const WorkbenchStep step = bench.log().steps.back();
  EXPECT_EQ(step.kind, WorkbenchStep::Kind::exclude);
  EXPECT_GE(step.excluded_legs, 3U);
  EXPECT_LT(bench.now().fit().dof, dof);
  for (const std::size_t number : chosen) EXPECT_TRUE(bench.now().legs().at(number).excluded);
  for (const TriedLeg& leg : bench.now().legs()) EXPECT_FALSE(leg.held_out && leg.excluded);
  // Nobody fits to the score: the same legs are held out.
  const HeldOut& after = bench.now().diagnosis().held_out;
  ASSERT_EQ(after.legs.size(), before.legs.size());
  for (std::size_t k = 0; k < after.legs.size(); ++k) {
    EXPECT_EQ(after.legs[k].leg, before.legs[k].leg);
  }
  // They can be taken out once.
  EXPECT_THROW(bench.exclude(chosen), std::invalid_argument);
  EXPECT_EQ(bench.log().steps.size(), 2U);
  // Effects are added without them, and what is promised is what comes.
  bench.add(catalogue_effect("hard iron"));
  const WorkbenchStep& added = bench.log().steps.back();
  ASSERT_TRUE(added.predicted_rms.has_value());
  EXPECT_NEAR(added.arrival_rms, *added.predicted_rms, 0.02 * before.arrival_rms);
  EXPECT_EQ(added.excluded_legs, step.excluded_legs);
  bench.go_to(0);
  EXPECT_EQ(bench.now().diagnosis().held_out.arrival_rms, before.arrival_rms);
  bench.go_to(1);
  bench.include_all();
  EXPECT_EQ(bench.log().steps.back().excluded_legs, 0U);
  EXPECT_EQ(bench.now().fit().dof, dof);
  EXPECT_EQ(bench.now().diagnosis().held_out.arrival_rms, before.arrival_rms);
}

TEST(Workbench, HeldOutLegsCannotBeExcluded) {
  Workbench bench = begun();
  std::vector<std::size_t> held_out;
  for (const TriedLeg& leg : bench.now().legs()) {
    if (leg.held_out) held_out.push_back(leg.number);
  }
  ASSERT_FALSE(held_out.empty());
  EXPECT_THROW(bench.exclude(held_out), std::invalid_argument);
  EXPECT_THROW(bench.exclude({}), std::invalid_argument);
  EXPECT_EQ(bench.log().steps.size(), 1U);
}

/// The first recording's compass is right, the second's has iron near it: its legs alone show that.
TEST(Workbench, PointsAreOfTheLegsThatAreChosen) {
  constexpr double kIron = 0.06;  // rad
  const testing::SimulatedRecording right = testing::simulate_recording({true, true, false}, 81);
  testing::SimulatedRecording wrong = testing::simulate_recording({true, true, false}, 82);
  for (double& heading : wrong.recording.drive.heading) heading += kIron * std::sin(heading);
  DiagnoseOptions options;
  options.estimate_noise = false;
  const TriedModel model(std::make_shared<const std::vector<DrivenRecording>>(
                             std::vector<DrivenRecording>{right.recording, wrong.recording}),
                         right.model, options);
  for (const std::size_t recording : {0U, 1U}) {
    std::vector<std::size_t> legs;
    for (const TriedLeg& leg : model.legs()) {
      if (leg.recording == recording) legs.push_back(leg.number);
    }
    const EffectPreview preview = model.preview(catalogue_effect("hard iron"), {}, legs);
    double along = 0.0, squares = 0.0;
    for (const ResponseBin& bin : preview.evidence.response.bins) {
      along += bin.estimate * std::sin(bin.at);
      squares += std::pow(std::sin(bin.at), 2);
    }
    ASSERT_GT(squares, 2.0);
    EXPECT_NEAR(along / squares, recording == 0 ? 0.0 : kIron, 0.015) << recording;
  }
}

TEST(Workbench, SaysWhereWhatWasAddedDidNotHelp) {
  WorkbenchLog log = begun().log();
  log.steps.push_back(log.steps.front());
  log.steps[0].arrival_rms = 0.032;
  WorkbenchStep& added = log.steps[1];
  added.kind = WorkbenchStep::Kind::add;
  added.effect = "load on the left wheel";
  added.predicted_rms = 0.0202;
  added.arrival_rms = 0.0331;
  log.at = 1;
  const std::string said = workbench_json(begun().now(), log, "a robot");
  EXPECT_NE(
      said.find("Adding load on the left wheel did not help: legs end 33 mm off, where 20 mm"),
      std::string::npos);
  added.arrival_rms = 0.0215;  // as promised, or nearly
  EXPECT_EQ(workbench_json(begun().now(), log, "a robot").find("did not help"), std::string::npos);
  added.arrival_rms = 0.025;  // less than promised, and better than before
  EXPECT_EQ(workbench_json(begun().now(), log, "a robot").find("did not help"), std::string::npos);
}

TEST(Workbench, LegsAreMarkedInTimeOverTheWholeHeight) {
  const auto state = nlohmann::json::parse(
      selection_json(begun().now(), begun().log(), free_legs(begun().now(), 2)));
  for (const auto& strip : state.at("strips")) {
    const auto& band = strip.at("layers").at(0);
    ASSERT_EQ(band.at("name"), "chosen");
    const auto& columns = band.at("columns");
    EXPECT_GT(columns.at(2).at("values").at(0).get<double>(),
              columns.at(1).at("values").at(0).get<double>());
  }
}

}  // namespace
}  // namespace trussmap::workbench_test
