// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Coefficients that change, against what was simulated.
#include "criticism/changing_coefficients.hpp"

#include "criticism/coefficient_course.hpp"
#include "driven.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/simulated_recording.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::changing_coefficients_test {
using namespace criticism;
namespace {

Effect turn(const std::string& name, const std::string& shape, double coefficient) {
  Effect effect;
  effect.name = name;
  effect.channel = Channel::turn;
  effect.shape = {Shape(shape)};
  effect.coefficients = {coefficient};
  return effect;
}

/// Of the mesh that the command drives.
SimulatedRecording toured(std::uint64_t seed, const std::vector<Effect>& effects) {
  SimulationSettings settings;
  settings.seed = seed;
  return simulate(settings, effects);
}

ModelFit fitted(const SimulatedRecording& one) {
  Model model = one.model;
  model.effects = {catalogue_effect("wheelbase")};
  return fit_model({one.drive.recording}, model);
}

double middle_of(const SimulatedRecording& one) {
  const std::vector<double>& t = one.drive.recording.drive.t;
  return 0.5 * (t.front() + t.back());
}

TEST(ChangingCoefficients, AConstantOneDoesNot) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    const ModelFit fit = fitted(toured(seed, {turn("wheelbase", "1", 0.01)}));
    EXPECT_TRUE(changing_coefficients(*fit.state, ScoreTest(*fit.state), 0.001).empty()) << seed;
  }
}

TEST(ChangingCoefficients, AStepIsToldWithItsMomentAndSizes) {
  const double t = middle_of(toured(21, {}));
  const ModelFit fit = fitted(toured(
      21, {turn("wheelbase", "1", 0.01), turn("later", "(t>" + std::to_string(t) + ")", 0.02)}));
  const std::vector<ChangingCoefficient> found =
      changing_coefficients(*fit.state, ScoreTest(*fit.state));
  ASSERT_EQ(found.size(), 1U);
  const ChangingCoefficient& one = found.front();
  EXPECT_EQ(one.effect.name, "wheelbase");
  EXPECT_EQ(one.form, ChangingCoefficient::Form::step);
  EXPECT_LE(one.earliest, t + 1.0);
  EXPECT_GE(one.latest, t - 1.0);
  EXPECT_NEAR(one.before, 0.01, 4.0 * one.before_sd);
  EXPECT_NEAR(one.after, 0.03, 4.0 * one.after_sd);
  EXPECT_LT(one.before_sd, 0.003);
  EXPECT_FALSE(one.between);
  EXPECT_NE(in_words(one).find("before, the wheelbase is"), std::string::npos) << in_words(one);
}

TEST(ChangingCoefficients, ASlowWaveIsAWalkWithinItsBand) {
  const double middle = middle_of(toured(31, {}));
  const std::string wave = "sin(" + std::to_string(3.0 / middle) + "*t)";
  const ModelFit fit = fitted(toured(31, {turn("wheelbase", "1", 0.01), turn("wave", wave, 0.02)}));
  const std::vector<ChangingCoefficient> found =
      changing_coefficients(*fit.state, ScoreTest(*fit.state));
  ASSERT_EQ(found.size(), 1U);
  const ChangingCoefficient& one = found.front();
  EXPECT_EQ(one.form, ChangingCoefficient::Form::walk);
  int within = 0;
  for (const CoursePart& part : one.course) {
    const double truth = 0.01 + 0.02 * std::sin(3.0 / middle * 0.5 * (part.from + part.until));
    within += std::abs(part.value - truth) < 2.5 * part.sd ? 1 : 0;
  }
  EXPECT_GE(within, static_cast<int>(one.course.size()) * 9 / 10);
}

TEST(ChangingCoefficients, WhatTheyGoWithIsNamed) {
  const SimulatedRecording one =
      toured(41, {turn("wheelbase", "1", 0.01), turn("warm", "temperature_C-20", 0.004)});
  const ModelFit fit = fitted(one);
  const std::vector<ChangingCoefficient> found =
      changing_coefficients(*fit.state, ScoreTest(*fit.state));
  ASSERT_EQ(found.size(), 1U);
  ASSERT_FALSE(found.front().goes_with.empty());
  EXPECT_EQ(found.front().goes_with.front(), "temperature_C");
}

/// G and s of the parts against columns of the effect that are on for one part each.
TEST(CoefficientCourse, IsThatOfAnEffectPerPart) {
  const SimulatedRecording one = toured(51, {turn("wheelbase", "1", 0.01)});
  const ModelFit fit = fitted(one);
  const ScoreTest tests(*fit.state);
  const std::optional<CoefficientCourse> course = course_of(0, *fit.state, tests);
  ASSERT_TRUE(course);
  // All parts together are the effect itself, of which the fit has left nothing.
  const Score whole = ScoreTest(*fit.state)
                          .lacking(0, fit.model.effects)
                          .test({catalogue_effect("wheelbase")})
                          .front();
  EXPECT_NEAR(course->G.sum() / whole.information.front(), 1.0, 1e-6);
  EXPECT_NEAR(course->s.sum(), 0.0, 1e-3 * std::sqrt(course->G.sum()));
  const CoefficientCourse about = about_constant(*course);
  EXPECT_NEAR((about.G * Eigen::VectorXd::Ones(about.s.size())).norm(), 0.0, 1e-6 * about.G.norm());
}

TEST(ChangingCoefficients, ADiagnosisObjectsToAModelThatHasOne) {
  const double t = middle_of(toured(61, {}));
  const SimulatedRecording one = toured(
      61, {turn("wheelbase", "1", 0.01), turn("later", "(t>" + std::to_string(t) + ")", 0.02)});
  Model model = one.model;
  model.effects = {catalogue_effect("wheelbase")};
  const Diagnosis result = diagnose({one.drive.recording}, model);
  EXPECT_NE(result.verdict, Diagnosis::Verdict::nothing_missing);
}

}  // namespace
}  // namespace trussmap::changing_coefficients_test
