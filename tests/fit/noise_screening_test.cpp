// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/noise_screening.hpp"

#include "estimation/simulated_recordings.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace trussmap::noise_screening_test {
using namespace fitting;
using namespace estimation;
namespace {

std::vector<ScreenedNoise> screened(const DrivenRecording& recording, const Model& model) {
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
  MotionRows& drive = world.recording.drive;
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

/// tr(PVPV) of a white source by dense algebra, V what it adds per unit of variance and P free of
/// all unknowns: q rises by so much per unit of variance, and has twice that as its variance.
double rise_per_variance(const NoiseReml& reml, const NoiseComponent& source) {
  const RecordingSystem& system = reml.system();
  const Eigen::Index nodes = system.normal_equations().unknowns();
  Eigen::MatrixXd columns(system.rows(), nodes + system.border().cols() + reml.nuisance().cols());
  columns << system.times(Eigen::MatrixXd::Identity(nodes, nodes)), system.border(),
      reml.nuisance();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(columns);
  const Eigen::MatrixXd Q =
      factor.householderQ() * Eigen::MatrixXd::Identity(system.rows(), factor.rank());
  Eigen::MatrixXd V = Eigen::MatrixXd::Zero(system.rows(), system.rows());
  const std::vector<Matrix4> units = reml.unit_covariances(source);
  for (std::size_t k = 0; k < units.size(); ++k) {
    const Measurement& one = reml.problem().measurements[k];
    const Matrix4 white = one.whitener * units[k] * one.whitener.transpose();
    if (reml.left_out(k)) continue;
    V.block(system.first_row(k), system.first_row(k), one.rows, one.rows) =
        white.topLeftCorner(one.rows, one.rows);
  }
  const Eigen::MatrixXd PV = V - Q * (Q.transpose() * V);
  return PV.cwiseProduct(PV.transpose()).sum();
}

/// What q is above its mean, over what a unit of variance makes of it, is the first guess's square;
/// over its own sd it is z. Worlds of seeds 1 to 3 whose model states too little noise.
TEST(NoiseScreening, TheFirstGuessIsWhereTheScoreIsExpected) {
  double sum = 0.0;
  double count = 0.0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    testing::SimulatedRecording world = testing::simulate_recording({true, true, true, 2}, seed);
    Noise& noise = world.model.noise;
    for (double* one : {&noise.left, &noise.right, &noise.compass, &noise.range, &noise.bearing}) {
      *one *= 0.7;
    }
    const FitState fit = fit_recordings({world.recording}, world.model);
    NoiseReml reml(fit, noise);
    const std::vector<NoiseComponent> white = white_components(fit, noise);
    NoiseReml::Sizes sizes;
    for (const NoiseComponent& one : white) {
      sizes.sd.push_back(size_in(noise, one));
      sizes.length.push_back(0.0);
    }
    reml.choose(white);
    static_cast<void>(reml.minus_two_log(sizes));
    for (const ScreenedNoise& one : screened_noise(fit, reml, white, {})) {
      if (one.z < 2.0) continue;
      const double rise = rise_per_variance(reml, one.component);
      const double variance = std::pow(2.0 * one.z / (one.sd * one.sd), 2);
      // The variance of 96 draws has a standard error of 14 %.
      EXPECT_NEAR(std::log(variance / (2.0 * rise)), 0.0, 0.45) << one.component.name;
      sum += std::log(variance / (2.0 * rise));
      count += 1.0;
    }
  }
  ASSERT_GE(count, 6.0);
  EXPECT_NEAR(sum / count, 0.0, 0.15);
}

}  // namespace
}  // namespace trussmap::noise_screening_test
