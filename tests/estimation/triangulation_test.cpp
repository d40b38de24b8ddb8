// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Landmarks by bearings alone: against a fine grid, where they tell nothing, and whole recordings.
#include "estimation/triangulation.hpp"

#include "estimation/simulated_recordings.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/survey_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::triangulation_test {
using namespace estimation;
namespace {

std::vector<Vector2> line(const Vector2& from, const Vector2& to, int count) {
  std::vector<Vector2> path;
  for (int k = 0; k < count; ++k) path.push_back(from + (to - from) * k / (count - 1.0));
  return path;
}

std::vector<DirectionReading> sights(const Vector2& landmark, const std::vector<Vector2>& path,
                                     double noise, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, noise);
  std::vector<DirectionReading> readings;
  for (const Vector2& q : path) {
    readings.push_back({q, direction(landmark - q) + normal(random), noise});
  }
  return readings;
}

/// Of squares up to two standard deviations, and linear from there.
double sum_at(const std::vector<DirectionReading>& readings, const Vector2& p) {
  double sum = 0.0;
  for (const DirectionReading& one : readings) {
    const Vector2 way = p - one.from;
    const double off = std::atan2(way.y(), way.x()) - one.direction;
    const double z = std::abs(std::remainder(off, 2.0 * M_PI)) / one.sd;
    sum += z <= 2.0 ? z * z : 4.0 * z - 4.0;
  }
  return sum;
}

/// Seed 51.
TEST(Triangulation, IsTheBestPlaceThereIs) {
  std::mt19937_64 random(51);
  std::uniform_real_distribution<double> anywhere(-20.0, 20.0);
  std::vector<Vector2> path = line({0.0, 0.0}, {15.0, 2.0}, 40);
  for (const Vector2& q : line({15.0, 2.0}, {10.0, 14.0}, 30)) path.push_back(q);
  for (int round = 0; round < 20; ++round) {
    const Vector2 landmark(anywhere(random), anywhere(random));
    const auto readings = sights(landmark, path, 0.01, random);
    const auto found = triangulate(readings);
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->certain) << landmark.transpose();
    double least = sum_at(readings, landmark);
    for (int i = -40; i <= 40; ++i) {
      for (int j = -40; j <= 40; ++j) {
        least = std::min(least, sum_at(readings, landmark + 0.02 * Vector2(i, j)));
      }
    }
    EXPECT_LE(sum_at(readings, found->place), least + 1e-6);
  }
}

/// Seed 52.
TEST(Triangulation, StraightAtItTellsNoDistance) {
  std::mt19937_64 random(52);
  const auto found =
      triangulate(sights({20.0, 0.0}, line({0.0, 0.0}, {5.0, 0.0}, 40), 0.02, random));
  EXPECT_TRUE(!found || !found->certain);
  EXPECT_FALSE(triangulate({{{0.0, 0.0}, 1.0, 0.1}}));
}

/// What a robot with a range sensor records, its ranges taken away; it stands on no landmark.
DrivenRecording bearings_alone(std::uint64_t seed, bool compass) {
  DrivenRecording recording =
      testing::simulate_recording({.compass = compass, .range_sensor = true}, seed).recording;
  std::erase_if(recording.sightings, [](const Sighting& one) { return one.standing(); });
  for (Sighting& one : recording.sightings) one.range = kAbsent;
  return recording;
}

/// Maps are as good as their standard errors say, chi^2 is as large as there are degrees of
/// freedom. Seeds 1 to 8.
TEST(BearingsAlone, MakeAMap) {
  double chi2 = 0.0;
  double dof = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const DrivenRecording recording = bearings_alone(seed, seed % 2 == 0);
    const BuiltMap built = build_map({recording}, Model());
    ASSERT_TRUE(built.on_survey);
    EXPECT_EQ(built.legs, 0);
    EXPECT_LE(built.on_survey->comparison.rigid.rms, 4.0 * built.quality.median_sd) << seed;
    chi2 += built.fit.chi2;
    dof += built.fit.dof;
  }
  EXPECT_NEAR(chi2 / dof, 1.0, 4.0 * std::sqrt(2.0 / dof));
}

/// A camera that looks aside, seen by bearings alone; the landmarks are surveyed.
TEST(BearingsAlone, ShowAnOffsetOfTheirOwn) {
  for (const std::uint64_t seed : {11U, 12U, 13U}) {
    DrivenRecording recording = bearings_alone(seed, true);
    for (Sighting& one : recording.sightings) one.bearing = wrap_angle(one.bearing + 0.05);
    Model model;
    model.effects = {catalogue_effect("bearing offset")};
    const EffectEstimate found = fit_model({recording}, model).effects.front();
    ASSERT_TRUE(found.not_fitted.empty());
    EXPECT_NEAR(found.effect.coefficients[0], 0.05, 4.0 * found.sd[0]);
    EXPECT_LT(found.sd[0], 0.01);
  }
}

/// Beside landmarks that the robot stands on.
TEST(BearingsAlone, GoWithOtherSightings) {
  double chi2 = 0.0;
  double dof = 0.0;
  for (std::uint64_t seed = 21; seed <= 26; ++seed) {
    DrivenRecording recording = testing::simulate_recording({.range_sensor = true}, seed).recording;
    for (std::size_t k = 0; k < recording.sightings.size(); k += 2) {
      if (!recording.sightings[k].standing()) recording.sightings[k].range = kAbsent;
    }
    const ModelFit fit = fit_model({recording}, Model());
    chi2 += fit.chi2;
    dof += fit.dof;
  }
  EXPECT_NEAR(chi2 / dof, 1.0, 4.0 * std::sqrt(2.0 / dof));
}

}  // namespace
}  // namespace trussmap::triangulation_test
