// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/noise_screening.hpp"

#include "estimation/simulated_recordings.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

std::vector<ScreenedNoise> screened(const Recording& recording, const Model& model) {
  const FitState fit = fit_recordings({recording}, model);
  NoiseReml reml(fit, model.noise);
  const std::vector<NoiseComponent> white = white_components(fit, model.noise);
  NoiseReml::Sizes sizes;
  for (const NoiseComponent& one : white) {
    sizes.sd.push_back(size_in(model.noise, one));
    sizes.length.push_back(0.0);
  }
  reml.choose(white);
  static_cast<void>(reml.minus_two_log(sizes));
  return screened_noise(fit, reml, candidate_components(fit, model.noise), {});
}

/// Scores are standardised: where the noise is as stated they lie about 0. Seeds 1 to 6.
TEST(NoiseScreening, OfRightNoiseScoresLieAboutZero) {
  double sum = 0.0;
  double count = 0.0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const testing::SimulatedRecording world = testing::simulate_recording({}, seed);
    for (const ScreenedNoise& one : screened(world.recording, world.model)) {
      EXPECT_LT(std::abs(one.z), 6.0) << one.component.name;
      sum += one.z;
      count += 1.0;
    }
  }
  EXPECT_LT(std::abs(sum / count), 0.8);
}

/// A compass that errs for 2 s: of all processes one of the compass stands out, at its size.
TEST(NoiseScreening, WhatIsThereStandsOut) {
  testing::SimulatedRecording world = testing::simulate_recording({}, 3);
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  double error = 0.0;
  Drive& drive = world.recording.drive;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double keep = std::exp(-drive.duration(row) / 2.0);
    error = keep * error + 0.06 * std::sqrt(1.0 - keep * keep) * normal(random);
    drive.heading[row] = wrap_angle(drive.heading[row] + error);
  }
  const std::vector<ScreenedNoise> found = screened(world.recording, world.model);
  const auto best =
      std::max_element(found.begin(), found.end(),
                       [](const ScreenedNoise& a, const ScreenedNoise& b) { return a.z < b.z; });
  EXPECT_EQ(best->component.process.channel, Channel::compass);
  EXPECT_GT(best->z, 6.0);
}

}  // namespace
}  // namespace trussmap
