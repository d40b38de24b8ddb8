// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Results made up so that a page could contradict itself.
#include "report/result_rows.hpp"

#include "report/diagnosis_tables.hpp"
#include "report/large_pages.hpp"
#include "report/noise_verdict.hpp"
#include "report/rivals.hpp"
#include "report/robot_off.hpp"
#include "trussmap/texts.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::result_rows_test {
using namespace report;
namespace {

const std::vector<std::string> kQuestions{
    "What is missing?",       "How large?",      "How sure?", "How far off is the robot?",
    "What else could it be?", "What to do next?"};

std::string answers_to(const Page& page, const std::string& question) {
  std::string text;
  for (const PageAnswer& one : page.content().answers) {
    if (one.question == question) text += one.answer + "\n";
  }
  return text;
}

bool says(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

/// Legs that end so far off where noise lets one expect `expected`.
HeldOut legs_off(const std::vector<double>& metres, double expected) {
  HeldOut legs;
  double squares = 0.0;
  for (std::size_t k = 0; k < metres.size(); ++k) {
    LegPrediction leg;
    leg.leg = k;
    leg.arrival_error = {metres[k], 0.0};
    leg.expected_error = expected;
    squares += metres[k] * metres[k];
    legs.legs.push_back(leg);
  }
  legs.arrival_rms = std::sqrt(squares / static_cast<double>(metres.size()));
  legs.expected_rms = expected;
  return legs;
}

ModelEvidence model_with(const HeldOut& legs, bool consistent) {
  ModelEvidence model = testing::large_model(40);
  model.comparison.objection = consistent ? Objection::none : Objection::chi2;
  model.comparison.held_out = legs;
  model.comparison.sources = {{"wheels", 1.0, 0.1, 100.0}};
  return model;
}

Finding finding(const std::string& name, Channel channel, const char* shape, double leaves) {
  Finding one;
  one.effect = {name, channel, {shape}, {0.03}};
  one.sd = {0.001};
  one.held_out.arrival_rms = leaves;
  return one;
}

EffectEvidence evidence_of(const Finding& one) {
  EffectEvidence evidence;
  evidence.estimate = {one.effect, one.sd, {}};
  evidence.response = testing::large_effect().response;
  evidence.range = {0.0, 0.03};
  return evidence;
}

/// The wheelbase is missing: legs end 200 mm off, with it 20.
struct Case {
  Diagnosis diagnosis;
  DiagnosisEvidence evidence;

  Page page() {
    evidence.sizes.resize(diagnosis.findings.size());
    return diagnosis_page(diagnosis, evidence, "a recording");
  }
};

Case wheelbase_missing() {
  Case one;
  Diagnosis& diagnosis = one.diagnosis;
  diagnosis.verdict = Diagnosis::Verdict::missing;
  diagnosis.missing = "wheelbase";
  diagnosis.p_value = 1e-30;
  diagnosis.tried = 900;
  diagnosis.held_out = legs_off(std::vector<double>(20, 0.2), 0.02);
  diagnosis.findings = {finding("wheelbase", Channel::turn, "1", 0.020)};
  diagnosis.findings.front().status = Status::missing;
  one.evidence.given = model_with(diagnosis.held_out, false);
  one.evidence.with = model_with(legs_off(std::vector<double>(20, 0.02), 0.02), true);
  one.evidence.effects = {evidence_of(diagnosis.findings.front())};
  return one;
}

Case nothing_missing() {
  Case one;
  one.diagnosis.tried = 900;
  one.diagnosis.held_out = legs_off(std::vector<double>(20, 0.02), 0.02);
  one.evidence.given = model_with(one.diagnosis.held_out, true);
  return one;
}

std::shared_ptr<const FitWithNoise> noise_of(double stated, double found) {
  auto under = std::make_shared<FitWithNoise>();
  NoiseSource wheels;
  wheels.name = "wheels";
  wheels.unit = "m^1/2";
  wheels.stated = stated;
  wheels.sd = found;
  under->noise.sources = {wheels};
  under->noise.gain = 12.0;
  return under;
}

TEST(ResultRows, AreTheSameSixOnEveryPage) {
  const ModelEvidence model = model_with(legs_off({0.02, 0.03}, 0.02), true);
  const std::vector<Page> pages{testing::large_comparison_page(40),
                                testing::large_diagnosis_page(40),
                                testing::large_discovery_page(40),
                                fit_page({model, model, {testing::large_effect()}}, "a recording"),
                                nothing_missing().page(),
                                comparison_page({model, {}}, "a recording")};
  for (const Page& page : pages) {
    std::vector<std::string> questions;
    for (const PageAnswer& one : page.content().answers) {
      EXPECT_FALSE(one.answer.empty());
      if (questions.empty() || questions.back() != one.question) questions.push_back(one.question);
    }
    EXPECT_EQ(questions, kQuestions) << page.content().command;
    EXPECT_TRUE(page.content().facts.empty()) << page.content().command;
  }
}

TEST(ResultRows, WhatIsUnknownIsSaid) {
  const std::vector<PageAnswer> answers = answers_of({.large = {"", "much"}});
  ASSERT_EQ(answers.size(), 6U);
  EXPECT_EQ(answers[0].answer, "Unknown.");
  EXPECT_EQ(answers[1].answer, "much");
}

TEST(ResultRows, RivalsThatCannotBeToldApartAreAllInTheHeadline) {
  Case one = wheelbase_missing();
  for (const char* name : {"turn asymmetry", "turn scrub", "spin loss"}) {
    one.diagnosis.findings.front().look_alikes.push_back({{name, Channel::turn, {"1"}, {}}, 0.99});
  }
  const std::string verdict = one.page().content().verdict;
  EXPECT_TRUE(says(verdict, "wheelbase (")) << verdict;
  for (const char* name : {", or turn asymmetry", ", or turn scrub", ", or spin loss"}) {
    EXPECT_TRUE(says(verdict, name)) << verdict;
  }
}

TEST(ResultRows, EffectsThatAreHardlySeenAreCountedInTheHeadline) {
  const std::vector<EffectEvidence> lag_and{
      evidence_of(finding("compass lag", Channel::compass, "turn_rate", 0.02)),
      evidence_of(finding("wheel scale", Channel::wheels, "1", 0.02))};
  std::vector<EffectEvidence> faint = lag_and;
  faint[1].estimate.sd = {0.02};
  const std::vector<std::vector<LookAlike>> alike{
      {}, {{{"travel scale", Channel::travel, {"1"}, {}}, 0.99}}};
  EXPECT_EQ(named_with_rivals(lag_and, alike),
            "compass lag (30 ms); and wheel scale (3 %), or travel scale");
  EXPECT_EQ(named_with_rivals(faint, alike), "compass lag (30 ms); and 1 hardly seen beside it");
}

TEST(ResultRows, NothingElseIsNotSaidAboveRivalsWithinAMillimetre) {
  Case one = wheelbase_missing();
  one.diagnosis.findings.push_back(finding("turn scrub", Channel::turn, "abs(turn_rate)", 0.0208));
  one.diagnosis.findings.push_back(finding("spin loss", Channel::turn, "spin_angle", 0.0193));
  one.diagnosis.findings.push_back(finding("slope", Channel::travel, "heading", 0.0215));
  one.diagnosis.findings[0].score = 100.0;
  one.diagnosis.findings[1].score = 88.0;
  one.diagnosis.findings[2].score = 70.0;
  const std::string otherwise = answers_to(one.page(), "What else could it be?");
  EXPECT_TRUE(says(otherwise, "turn scrub (20.8 mm; chi\u00b2 12 behind)")) << otherwise;
  EXPECT_TRUE(says(otherwise, "spin loss (19.3 mm; chi\u00b2 30 behind)")) << otherwise;
  EXPECT_FALSE(says(otherwise, "slope")) << otherwise;
  EXPECT_FALSE(says(otherwise, "Nothing else")) << otherwise;
  const std::string alone = answers_to(wheelbase_missing().page(), "What else could it be?");
  EXPECT_TRUE(says(alone, "Nothing else")) << alone;
}

TEST(ResultRows, WhereLittleIsGainedNotEverythingIsARival) {
  Case one = wheelbase_missing();
  one.diagnosis.held_out = legs_off(std::vector<double>(20, 0.0205), 0.02);
  one.diagnosis.findings.push_back(finding("slope", Channel::travel, "heading", 0.0205));
  EXPECT_TRUE(near_rivals(one.diagnosis, one.diagnosis.findings.front()).empty());
}

/// The verdict of the parts table on the wheels.
std::string verdict_on_wheels(double found, double seen_from) {
  Case one = nothing_missing();
  Finding ratio = finding("wheel diameter ratio", Channel::difference, "1", 0.02);
  ratio.status = Status::absent;
  one.diagnosis.findings = {ratio};
  const PageTable table =
      parts_table({one.diagnosis, {{{0.0, found}, seen_from}}}, std::vector<EffectEvidence>{});
  const auto row = std::find_if(table.rows.begin(), table.rows.end(), [](const auto& cells) {
    return cells.size() > 2 && cells[2] == "wheel diameter ratio";
  });
  return row == table.rows.end() ? "" : (*row)[1];
}

TEST(ResultRows, ItWouldHaveBeenSeenIsSaidOfWhatIsSmallerThanCanBeSeenAlone) {
  EXPECT_TRUE(says(verdict_on_wheels(0.001, 0.002), "it would have been seen"));
  EXPECT_FALSE(says(verdict_on_wheels(0.003, 0.002), "would have been seen"));
  EXPECT_FALSE(says(verdict_on_wheels(0.003, 0.0), "would have been seen"));
}

TEST(ResultRows, AsGoodAsNoiseAllowsStandsBesideNoRedNoise) {
  Case one = nothing_missing();
  for (const double found : {0.00279, 0.00321, 0.0061}) {
    one.diagnosis.under = noise_of(0.003, found);
    const Page page = one.page();
    const bool good = says(page.content().verdict, "as good as this robot's noise allows");
    const PageTable table = noise_table(one.diagnosis);
    const bool red = std::count(table.tones.begin(), table.tones.end(), Tone::bad) > 0;
    EXPECT_NE(good, red) << found << ": " << page.content().verdict;
    EXPECT_EQ(page.content().tone == Tone::bad, red) << found;
  }
}

TEST(ResultRows, WrongNoiseIsTheHeadlineWithStatedFoundAndGain) {
  Case one = nothing_missing();
  one.diagnosis.under = noise_of(0.003, 0.006);
  one.evidence.as_stated = legs_off(std::vector<double>(20, 0.021), 0.01);
  const Page page = one.page();
  const std::string verdict = page.content().verdict;
  EXPECT_TRUE(verdict.starts_with("The noise is not as the model states it: wheels 6")) << verdict;
  EXPECT_TRUE(says(verdict, "not 3 as stated")) << verdict;
  const std::string off = answers_to(page, "How far off is the robot?");
  EXPECT_TRUE(says(off, "legs end 20 mm off, and 20 mm is expected")) << off;
  EXPECT_TRUE(says(off, "21 mm off, and 10 mm was expected")) << off;
  EXPECT_FALSE(says(answers_to(page, "What else could it be?"), "noise")) << off;
}

TEST(ResultRows, NoiseThatTookUpWhatIsMissingIsNoFloor) {
  Case one = wheelbase_missing();
  one.diagnosis.under = noise_of(0.003, 0.009);
  one.evidence.given.comparison.held_out.expected_rms = 0.09;
  one.evidence.with->comparison.held_out.expected_rms = 0.09;
  one.evidence.as_stated = legs_off(std::vector<double>(20, 0.2), 0.02);
  EXPECT_DOUBLE_EQ(noise_floor(one.diagnosis, one.evidence), 0.02);
  const std::string off = answers_to(one.page(), "How far off is the robot?");
  EXPECT_TRUE(says(off, "as good as its noise allows (2 cm)")) << off;
  // Legs that end far nearer than expected speak of too much noise, not of a good model.
  EXPECT_FALSE(as_good_as_noise(legs_off(std::vector<double>(20, 0.02), 0.09)));
}

/// Slip with speed is missing, by so much of the way per m/s.
Case slip_missing(double slip) {
  Case one = wheelbase_missing();
  Finding& found = one.diagnosis.findings.front();
  found.effect = {"slip with speed", Channel::travel, {"speed"}, {slip}};
  one.diagnosis.missing = found.effect.name;
  one.diagnosis.under = std::make_shared<const FitWithNoise>();
  one.evidence.effects = {evidence_of(found)};
  return one;
}

TEST(ResultRows, WhatHasNotItsUsualSignIsNotPutDownToTheUsualCause) {
  Case loses = slip_missing(-0.008);
  Case gains = slip_missing(0.008);
  EXPECT_FALSE(says(diagnosis_text(loses.diagnosis, {}, 5), "not its usual sign"));
  EXPECT_TRUE(says(diagnosis_text(gains.diagnosis, {}, 5), "not its usual sign: The faster"));
  const std::string cause = "tyres that slip more when fast";
  EXPECT_TRUE(says(answers_to(loses.page(), "What is missing?"), cause));
  EXPECT_FALSE(says(answers_to(gains.page(), "What is missing?"), cause));
  EXPECT_TRUE(says(answers_to(gains.page(), "What is missing?"), "so it is none"));
  EXPECT_TRUE(says(answers_to(loses.page(), "What to do next?"), "Against slip with speed"));
  EXPECT_FALSE(says(answers_to(gains.page(), "What to do next?"), "Against slip with speed"));
}

TEST(ResultRows, NoiseIsAsStatedOnlyBesideWhatIsMissing) {
  Case one = slip_missing(-0.008);
  EXPECT_TRUE(says(diagnosis_text(one.diagnosis, {}, 5), "Beside what is missing, noise is as"));
  one.diagnosis.missing.clear();
  EXPECT_TRUE(says(diagnosis_text(one.diagnosis, {}, 5), "\nNoise is as the model states it."));
}

TEST(ResultRows, NoDriveIsAdvisedForWhatIsRuledOut) {
  Diagnosis diagnosis;
  DataLack spins;
  spins.what = Lack::spin_rates;  // wheelbase and turn scrub look alike
  DataLack rests;
  rests.what = Lack::rests;  // heading drift looks like unequal wheels
  diagnosis.lacks = {spins, rests};
  for (const char* name : {"wheelbase", "turn scrub"}) {
    diagnosis.findings.push_back(finding(name, Channel::turn, "1", 0.02));
    diagnosis.findings.back().status = Status::absent;
  }
  ASSERT_TRUE(lack_to_mend(diagnosis).has_value());
  EXPECT_EQ(lack_to_mend(diagnosis)->what, Lack::rests);
  diagnosis.findings.front().status = Status::cannot_tell;
  EXPECT_EQ(lack_to_mend(diagnosis)->what, Lack::spin_rates);
}

TEST(ResultRows, ALocalGainIsSaidToBeOne) {
  std::vector<double> before(10, 0.010);
  std::vector<double> after(10, 0.0101);
  before[4] = 0.195;
  after[4] = 0.034;
  const auto gain = local_gain(legs_off(before, 0.01), legs_off(after, 0.01));
  ASSERT_TRUE(gain.has_value());
  EXPECT_EQ(gain_in_words(*gain), "9 of 10 legs unchanged, the worst 195 \u2192 34 mm");
  const std::vector<double> far(10, 0.2);
  const std::vector<double> near(10, 0.02);
  EXPECT_FALSE(local_gain(legs_off(far, 0.01), legs_off(near, 0.01)).has_value());
  EXPECT_FALSE(local_gain(legs_off(after, 0.01), legs_off(before, 0.01)).has_value());
}

TEST(ResultRows, DeadReckoningIsTheLongestThatBothModelsHave) {
  Case one = wheelbase_missing();
  one.evidence.given.reckoned = {{10.0, 0.1}, {30.0, 0.6}, {100.0, 3.0}};
  one.evidence.with->reckoned = {{10.0, 0.01}, {30.0, 0.06}};
  const std::string off = answers_to(one.page(), "How far off is the robot?");
  EXPECT_TRUE(says(off, "After 30 s of dead reckoning: 60 cm as given, 6 cm with wheelbase"))
      << off;
  const std::string none = answers_to(wheelbase_missing().page(), "How far off is the robot?");
  EXPECT_TRUE(says(none, "After a tour: unknown")) << none;
}

TEST(ResultRows, TrendsThatAreNoneHaveNoChart) {
  std::vector<TrendEvidence> trends = testing::large_trends();
  for (TrendEvidence& one : trends) one.trend.p_adjusted = 0.05;
  trends.front().trend.p_adjusted = 0.04;
  const Page page =
      comparison_page({model_with(legs_off({0.02, 0.03}, 0.02), false), trends}, "a recording");
  std::set<std::string> ids;
  for (const plot::Chart* chart : charts_of(page.content())) ids.insert(chart->id);
  EXPECT_TRUE(ids.contains("trend-1"));
  EXPECT_FALSE(ids.contains("trend-2"));
}

}  // namespace
}  // namespace trussmap::result_rows_test
