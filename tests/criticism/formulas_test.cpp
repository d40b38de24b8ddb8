// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
// Effects that no catalogue has: what their formulas come out as.
#include "criticism/formulas.hpp"

#include "criticism/score_test.hpp"
#include "driven.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/simulated_recording.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

namespace trussmap::formulas_test {
namespace {

/// Seeds are those of the meshes, walks and noise.
SimulatedRecording drawn(std::uint64_t seed, const std::vector<Effect>& effects) {
  SimulationSettings settings;
  settings.mesh = "4x4";
  settings.uneven = true;
  settings.rests = true;
  settings.seed = seed;
  return simulate(settings, effects);
}

Diagnosis diagnosed(const SimulatedRecording& world) {
  DiagnoseOptions options;
  options.estimate_noise = false;
  return diagnose({testing::driven(world.drive.recording)}, world.model, options);
}

Effect hidden(Channel channel, const std::vector<Shape>& shapes, std::vector<double> coefficients) {
  return {"hidden", channel, shapes, std::move(coefficients)};
}

/// Of a shape of x and y at a place.
double at(const Shape& shape, const Vector2& place) {
  return shape.values({{"x", {place.x()}}, {"y", {place.y()}}}).front();
}

TEST(Formulas, AreFiniteAndEachIsWrittenOnce) {
  const SimulatedRecording world = drawn(3, {});
  const ModelFit fit = fit_model({testing::driven(world.drive.recording)}, world.model);
  const criticism::ScoreTest tests(*fit.state);
  const criticism::FormulaGrammar grammar(*fit.state, tests.context());
  for (const Channel channel : {Channel::travel, Channel::turn, Channel::compass}) {
    std::set<std::vector<std::string>> seen;
    for (const criticism::Candidate& one : grammar.of(channel)) {
      EXPECT_TRUE(seen.insert(texts_of(one.effect.shape)).second)
          << one.effect.shape.front().text();
      for (const Shape& shape : one.effect.shape) {
        EXPECT_EQ(Shape(shape.text()), shape);  // can be pasted
        const auto values = tests.context().values(shape, fitting::ShapeContext::Instant::middle);
        for (const double value : values.front()) {
          ASSERT_TRUE(std::isfinite(value)) << shape.text();
        }
      }
    }
    EXPECT_GT(seen.size(), 100U);
  }
  EXPECT_TRUE(grammar.of(Channel::lever).empty());
}

TEST(Formulas, AProductIsNamedAsOne) {
  const SimulatedRecording world =
      drawn(11, {hidden(Channel::turn, {"payload_kg*abs(turn_rate)"}, {-0.004})});
  const Diagnosis result = diagnosed(world);
  ASSERT_EQ(result.verdict, Diagnosis::Verdict::missing);
  const Finding& first = result.findings.front();
  EXPECT_EQ(first.effect.channel, Channel::turn);
  ASSERT_EQ(first.effect.shape.size(), 1U);
  EXPECT_EQ(first.effect.shape.front(), "abs(turn_rate)*payload_kg");
  EXPECT_NEAR(first.effect.coefficients.front(), -0.004, 4.0 * first.sd.front());
}

TEST(Formulas, ADecayHasItsTime) {
  const SimulatedRecording world = drawn(12, {hidden(Channel::turn, {"exp(-t/200)"}, {0.08})});
  const Diagnosis result = diagnosed(world);
  ASSERT_EQ(result.verdict, Diagnosis::Verdict::missing);
  const Finding& first = result.findings.front();
  EXPECT_EQ(first.effect.channel, Channel::turn);
  ASSERT_TRUE(first.effect.shape.front().text().starts_with("exp(-t/"))
      << first.effect.shape.front().text();
  // At t = 200 s it is 1/e: its time by what it says there.
  const double there = first.effect.shape.front().values({{"t", {200.0}}}).front();
  EXPECT_NEAR(-200.0 / std::log(there), 200.0, 60.0);
  // The time was sought, and the size is less certain for it.
  ASSERT_EQ(first.sd_inflation.size(), 1U);
  EXPECT_GT(first.sd_inflation.front(), 1.01);
}

TEST(Formulas, AnEdgeBetweenTwoFloorsIsFoundAtItsAngle) {
  const Vector2 normal(std::cos(0.6), std::sin(0.6));
  const SimulatedRecording world =
      drawn(13, {hidden(Channel::wheels, {"0.8253*x+0.5646*y>10.2"}, {-0.012})});
  const Diagnosis result = diagnosed(world);
  ASSERT_EQ(result.verdict, Diagnosis::Verdict::missing);
  const Effect& found = result.findings.front().effect;
  ASSERT_NE(found.shape.front().text().find(">"), std::string::npos) << found.shape.front().text();
  // On either side of the line, 1.5 m off, wherever landmarks are near.
  for (const Vector2& place : world.mesh.positions) {
    const double beyond = normal.dot(place) - 10.2;
    if (std::abs(beyond) < 1.5) continue;
    EXPECT_EQ(at(found.shape.front(), place), beyond > 0.0 ? 1.0 : 0.0) << place.transpose();
  }
}

TEST(Formulas, AWaveAcrossTheFloorHasItsLength) {
  const double k = 2.0 * std::numbers::pi / 12.0;  // 12 m
  const std::string phase = "(0.6*x+0.8*y)*" + std::to_string(k);
  const SimulatedRecording world =
      drawn(14, {hidden(Channel::creep, {"sin(" + phase + "+0.4)"}, {0.012})});
  const Diagnosis result = diagnosed(world);
  ASSERT_EQ(result.verdict, Diagnosis::Verdict::missing);
  const Finding& first = result.findings.front();
  ASSERT_EQ(first.effect.shape.size(), 2U);
  ASSERT_TRUE(first.effect.shape.front().text().starts_with("sin("));
  // The wave found is the one hidden all over the floor.
  const Shape truth("sin(" + phase + "+0.4)");
  double apart = 0.0;
  double whole = 0.0;
  for (const Vector2& place : world.mesh.positions) {
    const double g = first.effect.coefficients[0] * at(first.effect.shape[0], place) +
                     first.effect.coefficients[1] * at(first.effect.shape[1], place);
    apart += std::pow(g - 0.012 * at(truth, place), 2);
    whole += std::pow(0.012 * at(truth, place), 2);
  }
  EXPECT_LT(std::sqrt(apart / whole), 0.25);
  // The map of the floor shows it, too, and is said to.
  EXPECT_TRUE(std::any_of(
      first.look_alikes.begin(), first.look_alikes.end(),
      [](const LookAlike& one) { return one.effect.name == "creep with a map of the floor"; }));
}

TEST(Formulas, WhatTheCatalogueExplainsStaysWithIt) {
  const SimulatedRecording world = drawn(15, {hidden(Channel::turn, {"1"}, {-0.02})});
  const Diagnosis result = diagnosed(world);
  ASSERT_EQ(result.verdict, Diagnosis::Verdict::missing);
  EXPECT_EQ(result.missing, "wheelbase");
}

}  // namespace
}  // namespace trussmap::formulas_test
