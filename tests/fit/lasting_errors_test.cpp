// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Sightings whose errors last from frame to frame.
#include "driven.hpp"
#include "fit/effect_columns.hpp"
#include "trussmap/fit_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::lasting_errors_test {
using namespace fitting;
namespace {

/// Now faster, now slower: of a steady circle a delay would turn the map, and no more. rad
double swing_at(double t) {
  return t / 6.0 + 0.1 * std::sin(t);
}

/// A robot that goes round in a circle of 3 m, some 0.5 m/s, and sees four landmarks ten times a
/// second, with errors that forget themselves within `memory` (s; 0: at once).
DrivenRecording circling(double memory, std::uint64_t seed) {
  constexpr double kRow = 0.1;
  constexpr double kBase = 0.3;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  DrivenRecording recording;
  const std::vector<Vector2> landmarks{{6.0, 0.0}, {0.0, 6.0}, {-6.0, 0.0}, {0.0, -6.0}};
  std::vector<Vector2> error(landmarks.size());
  for (Vector2& one : error) one = {normal(random), normal(random)};
  const double keep = memory > 0.0 ? std::exp(-kRow / memory) : 0.0;
  for (int row = 1; row <= 1200; ++row) {
    const double t = kRow * row;
    const double swing = swing_at(t);
    const double way = 3.0 * (swing - swing_at(t - kRow));
    recording.drive.t.push_back(t);
    testing::add_travels(recording.drive, way * (1.0 - 0.5 * kBase / 3.0),
                         way * (1.0 + 0.5 * kBase / 3.0), kBase);
    const Vector2 place(3.0 * std::cos(swing), 3.0 * std::sin(swing));
    const double heading = swing + 0.5 * std::numbers::pi;
    for (std::size_t k = 0; k < landmarks.size(); ++k) {
      error[k] =
          keep * error[k] + std::sqrt(1.0 - keep * keep) * Vector2(normal(random), normal(random));
      const Vector2 offset = landmarks[k] - place;
      Sighting seen;
      seen.t = t;
      seen.landmark = std::string(1, static_cast<char>('a' + k));
      seen.range = offset.norm() + 0.05 * error[k].x();
      seen.bearing = wrap_angle(direction(offset) - heading + 0.02 * error[k].y());
      recording.sightings.push_back(seen);
    }
  }
  return recording;
}

Model model_of_circling() {
  Model model;
  model.robot.wheelbase = 0.3;
  model.noise.range = 0.05;
  model.noise.bearing = 0.02;
  return model;
}

TEST(LastingErrors, AreFoundAsLongAsTheyLast) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const DrivenRecording recording = circling(1.5, seed);
    ASSERT_TRUE(has_dense_frames({recording}));
    const LastingErrors found = lasting_errors(fit_model({recording}, model_of_circling()));
    // exp(-t/1.5) passes 0.3 at 1.8 s; the fit takes some of it for motion.
    EXPECT_GE(found.lasts, 1.0) << seed;
    EXPECT_LE(found.lasts, 3.0) << seed;
  }
}

TEST(LastingErrors, OfIndependentErrorsThereAreNone) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    EXPECT_EQ(lasting_errors(fit_model({circling(0.0, seed)}, model_of_circling())).lasts, 0.0);
  }
}

TEST(LastingErrors, ThinnedFramesAreWholeAndSoFarApart) {
  const DrivenRecording recording = circling(0.0, 4);
  const std::vector<DrivenRecording> thinned = thinned_frames({recording}, 2.0);
  ASSERT_EQ(thinned.size(), 1U);
  EXPECT_EQ(thinned.front().drive.rows(), recording.drive.rows());
  const std::vector<Sighting>& left = thinned.front().sightings;
  ASSERT_GT(left.size(), 100U);
  EXPECT_EQ(left.size() % 4, 0U);
  for (std::size_t k = 0; k < left.size(); ++k) {
    if (k % 4 != 0) {
      EXPECT_EQ(left[k].t, left[k - 1].t);
    } else if (k > 0) {
      EXPECT_NEAR(left[k].t - left[k - 1].t, 2.0, 0.11);
    }
  }
}

/// One of each span, whole, and never one that tells less than another of it.
TEST(RichestFrames, AreTheFullestAndThoseOfWhatIsRarelySeen) {
  DrivenRecording recording = circling(0.0, 4);
  const auto see = [&](std::size_t frame, const std::string& landmark) {
    Sighting more = recording.sightings[4 * frame];
    more.landmark = landmark;
    recording.sightings.push_back(more);
  };
  for (std::size_t frame = 3; frame < 1200; frame += 10) see(frame, "often");
  see(127, "once");
  Sighting on;
  on.t = 55.55;
  on.landmark = "stood on";
  recording.sightings.push_back(on);
  std::stable_sort(recording.sightings.begin(), recording.sightings.end(),
                   [](const Sighting& a, const Sighting& b) { return a.t < b.t; });
  const std::vector<DrivenRecording> rich = richest_frames({recording}, 0.9999);
  ASSERT_EQ(rich.size(), 1U);
  const std::vector<Sighting>& left = rich.front().sightings;
  const auto count = [&left](const std::string& landmark) {
    return std::count_if(left.begin(), left.end(),
                         [&](const Sighting& one) { return one.landmark == landmark; });
  };
  EXPECT_EQ(count("a"), 120);  // spans of a little less than 1 s in 119.9 s
  EXPECT_EQ(count("b"), 120);
  EXPECT_GE(count("often"), 119);  // but where `once` was seen
  EXPECT_EQ(count("once"), 1);
  EXPECT_EQ(count("stood on"), 1);
  EXPECT_EQ(richest_frames({recording}, 0.01).front().sightings.size(), recording.sightings.size());
}

/// A delay moves the first frames out of the drive; the last, which are nonsense, stay left out.
TEST(FitWithADelay, KeepsWhatIsLeftOutApartWhereSightingsLeaveTheDrive) {
  DrivenRecording recording = circling(0.0, 5);
  for (Sighting& one : recording.sightings) one.t += 0.35;
  std::erase_if(recording.sightings,
                [&recording](const Sighting& one) { return one.t > recording.drive.t.back(); });
  std::vector<Sighting> early(recording.sightings.begin(), recording.sightings.begin() + 12);
  for (std::size_t k = 0; k < early.size(); ++k) early[k].t = 0.02 * static_cast<double>(k + 1);
  recording.sightings.insert(recording.sightings.begin(), early.begin(), early.end());
  for (std::size_t k = recording.sightings.size() - 3; k < recording.sightings.size(); ++k) {
    recording.sightings[k].range += 3.0;
  }
  Model model = model_of_circling();
  Effect delay;
  delay.name = "sighting delay";
  delay.channel = Channel::delay;
  delay.shape = {"1"};
  model.effects = {delay};
  FitOptions options;
  options.gate = 16.0;
  const ModelFit fit = fit_model({recording}, model, options);
  EXPECT_TRUE(fit.settled);
  EXPECT_NEAR(fit.effects.front().effect.coefficients.front(), 0.35, 0.03);
  EXPECT_GE(fit.left_out.size(), 3U);
  EXPECT_LE(fit.left_out.size(), 25U);
}

TEST(LargestButForSpikes, IsTheLargestWhereNoneStandsOut) {
  EXPECT_EQ(largest_but_for_spikes({}), 0.0);
  EXPECT_EQ(largest_but_for_spikes({0.0, 0.0}), 0.0);
  EXPECT_EQ(largest_but_for_spikes({1.0, -1.0, 0.0, 1.0}), 1.0);
  std::vector<double> ramp;
  for (int k = 0; k <= 100; ++k) ramp.push_back(-0.01 * k);
  EXPECT_NEAR(largest_but_for_spikes(ramp), 1.0, 0.05);
  std::vector<double> spike(10000, 0.01);
  spike[77] = 4.0;
  EXPECT_NEAR(largest_but_for_spikes(spike), 0.01, 0.002);
}

}  // namespace
}  // namespace trussmap::lasting_errors_test
