// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
// Estimated noise against what the simulator made, and the budget against closed forms.
#include "trussmap/noise_fit.hpp"

#include "driven.hpp"
#include "estimation/simulated_recordings.hpp"
#include "trussmap/diagnose.hpp"

#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace trussmap::noise_fit_test {
namespace {

/// Tours whose noise is not what the model states; the nominal model goes with it.
struct RoughRecording {
  DrivenRecording recording;
  TrueMotion motion;
  Model model;
};

RoughRecording rough_recording(const std::string& kinds, std::uint64_t seed) {
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0, 12.0}, {0.0, 3.0, 7.0, 12.0});
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, 3, random);
  WheeledRobot robot;
  if (!kinds.empty()) robot.rough = parse_rough(kinds);
  SimulatedDrive drive = simulate_drive(mesh, tours.walk, {}, robot, seed);
  return {testing::driven(drive.recording), std::move(drive.motion), {}};
}

FittedNoise noise_of(const RoughRecording& rough) {
  return fit_model_and_noise({rough.recording}, rough.model).noise;
}

const NoiseSource& source_of(const FittedNoise& noise, const std::string& name) {
  for (const NoiseSource& one : noise.sources) {
    if (one.name == name) return one;
  }
  throw std::runtime_error("no source " + name);
}

/// Found within four standard errors: one run in 16 000 is not.
void expect_found(const FittedNoise& noise, const std::string& name, double sd, double most_error) {
  const NoiseSource& source = source_of(noise, name);
  EXPECT_NEAR(source.sd, sd, 4.0 * source.sd_error) << name;
  EXPECT_LT(source.sd_error, most_error) << name;
}

bool lasts(const FittedNoise& noise) {
  return std::any_of(noise.sources.begin(), noise.sources.end(),
                     [](const NoiseSource& one) { return one.lasts; });
}

// Nothing is named in a recording that is as stated but by chance, of which there is 2 % for a
// process: three and more of 20 happen once in 1400 runs.
TEST(FitNoise, LeavesWhiteNoiseAsItIsStated) {
  int named = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const FittedNoise noise = noise_of(rough_recording("", seed));
    named += lasts(noise) ? 1 : 0;
    if (noise.changed()) continue;
    EXPECT_EQ(noise.noise, Noise()) << seed;
    EXPECT_EQ(noise.gain, 0.0) << seed;
  }
  EXPECT_LE(named, 2);
}

TEST(FitNoise, FindsWhiteNoiseTwiceAsLarge) {
  const FittedNoise noise = noise_of(rough_recording("half", 3));
  ASSERT_TRUE(noise.changed());
  expect_found(noise, "wheels", 0.006, 0.001);
  expect_found(noise, "compass", 0.04, 0.002);
  EXPECT_EQ(noise.noise.compass, source_of(noise, "compass").sd);
  EXPECT_FALSE(lasts(noise));
}

TEST(FitNoise, FindsCompassErrorsThatLast) {
  const FittedNoise noise = noise_of(rough_recording("haze", 4));
  const NoiseSource& lasting = source_of(noise, "compass, correlated in t");
  EXPECT_NEAR(lasting.sd, 0.02, 4.0 * lasting.sd_error);
  EXPECT_NEAR(lasting.process.length, 2.0, 4.0 * lasting.length_error);
  EXPECT_LT(lasting.length_error, 0.6);
  // Nothing of it is white.
  EXPECT_LT(source_of(noise, "compass").sd, 0.002);
  EXPECT_LT(lasting.p_value, 1e-10);
  ASSERT_EQ(noise.noise.processes.size(), 1U);
  EXPECT_EQ(noise.noise.processes.front().channel, Channel::compass);
}

TEST(FitNoise, FindsTravelErrorsOfLegs) {
  const FittedNoise noise = noise_of(rough_recording("floor", 5));
  expect_found(noise, "travel, per leg", 0.004, 0.001);
}

// Truth with errors ten and six times as large as stated, independent from row to row: no noise of
// the wheels stands in for them.
TEST(FitNoise, FindsTheTruthsOwnNoise) {
  RoughRecording one = rough_recording("", 7);
  one.recording.sightings.clear();
  one.recording.survey.clear();
  one.recording.drive.heading.clear();
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (std::size_t row = 19; row < one.motion.rows.size(); row += 20) {
    const Pose& pose = one.motion.rows[row].pose;
    one.recording.truth.push_back({one.recording.drive.t[row], pose.x + 0.02 * normal(random),
                                   pose.y + 0.02 * normal(random),
                                   pose.heading + 0.03 * normal(random)});
  }
  const FittedNoise noise = noise_of(one);
  expect_found(noise, "truth", 0.02, 0.002);
  expect_found(noise, "truth_heading", 0.03, 0.003);
  const NoiseSource& wheels = source_of(noise, "wheels");
  EXPECT_NEAR(wheels.sd, 0.003, 4.0 * wheels.sd_error);
}

// A wheelbase 3 % off looks like turning errors; beside the effect, or with it in the model, the
// noise is as stated.
TEST(FitNoise, BesideAMissingEffectIsAsStated) {
  RoughRecording one = rough_recording("", 6);
  one.model.robot.wheelbase *= 1.03;
  testing::retake(one.recording.drive, one.model.robot.wheelbase);
  const Diagnosis diagnosis = diagnose({one.recording}, one.model);
  ASSERT_EQ(diagnosis.verdict, Diagnosis::Verdict::missing);
  EXPECT_EQ(diagnosis.missing, "wheelbase");
  ASSERT_TRUE(diagnosis.under);
  EXPECT_FALSE(diagnosis.under->noise.changed());
}

// Errors that last name nothing that is not there; as stated the noise does not allow them.
TEST(FitNoise, KeepsADiagnosisHonest) {
  const RoughRecording one = rough_recording("haze,half", 7);
  DiagnoseOptions as_stated;
  as_stated.estimate_noise = false;
  EXPECT_NE(diagnose({one.recording}, one.model, as_stated).verdict,
            Diagnosis::Verdict::nothing_missing);
  EXPECT_EQ(diagnose({one.recording}, one.model).verdict, Diagnosis::Verdict::nothing_missing);
}

// ----------------------------------------

DrivenRecording straight_drive(double seconds, double speed) {
  DrivenRecording recording;
  recording.name = "straight";
  constexpr double kRow = 0.1;
  const auto rows = static_cast<std::size_t>(std::lround(seconds / kRow));
  for (std::size_t row = 0; row < rows; ++row) {
    recording.drive.t.push_back(kRow * static_cast<double>(row + 1));
    testing::add_travels(recording.drive, kRow * speed, kRow * speed);
  }
  return recording;
}

const NoiseBudget& only(const std::vector<NoiseBudget>& budgets) {
  EXPECT_EQ(budgets.size(), 1U);
  return budgets.front();
}

// Chong & Kleeman's straight: along k^2 d/2, heading 2 k^2 d/B^2, which swings the end by
// 2 k^2 d^3/(3 B^2) to the side. Rows of 0.1 s make the sum of squares larger by 1/n at most.
TEST(NoiseBudgets, AgreeWithTheStraightInClosedForm) {
  Model model;
  model.noise = {};
  const DrivenRecording drive = straight_drive(40.0, 0.5);
  const NoiseBudget budget = only(noise_budget({drive}, model, {10.0}));
  const double d = 5.0;
  const double k = 0.003;
  const double B = model.robot.wheelbase;
  const double square = k * k * d / 2.0 + 2.0 * k * k * d * d * d / (3.0 * B * B);
  EXPECT_NEAR(budget.rms, std::sqrt(square), 0.01 * std::sqrt(square));
  ASSERT_EQ(budget.shares.size(), 1U);
  EXPECT_EQ(budget.shares.front().source, "wheels");
  EXPECT_EQ(budget.shares.front().share, 1.0);
}

// Travel misread by the same share all along: sd times the way. A heading drift that lasts: with
// length much longer than the horizon, sd T^2 v/2 to the side.
TEST(NoiseBudgets, ShareByVariance) {
  Model model;
  model.noise.left = model.noise.right = 0.0;
  NoiseProcess travel;
  travel.channel = Channel::travel;
  travel.process = ProcessKind::per_session;
  travel.sd = 0.01;
  NoiseProcess drift;
  drift.channel = Channel::drift;
  drift.process = ProcessKind::correlated_in_t;
  drift.sd = 0.003;
  drift.length = 1e5;
  model.noise.processes = {travel, drift};
  const NoiseBudget budget = only(noise_budget({straight_drive(40.0, 0.5)}, model, {10.0}));
  const double of_travel = std::pow(0.01 * 5.0, 2);
  const double of_drift = std::pow(0.003 * 10.0 * 10.0 * 0.5 / 2.0, 2);
  EXPECT_NEAR(budget.rms, std::sqrt(of_travel + of_drift), 0.01 * budget.rms);
  ASSERT_EQ(budget.shares.size(), 2U);
  EXPECT_EQ(budget.shares[0].source, "drift, correlated in t");
  EXPECT_NEAR(budget.shares[0].share, of_drift / (of_travel + of_drift), 0.01);
  EXPECT_NEAR(budget.shares[0].share + budget.shares[1].share, 1.0, 1e-12);
}

// A travel error of a leg's own: sd times the leg's length at its end, and over four legs the root
// of the sum of squares.
TEST(NoiseBudgets, OfLegsAndOfWhatIsTheirOwn) {
  Model model;
  model.noise.left = model.noise.right = 0.0;
  model.noise.processes = {{Channel::travel, ProcessKind::per_leg, 0.01, 0.0, 0.0, 0}};
  DrivenRecording drive = straight_drive(40.0, 0.5);
  for (const double t : {0.0, 10.0, 20.0, 30.0, 40.0}) drive.sightings.push_back({t, "A"});
  const std::vector<NoiseBudget> budgets = noise_budget({drive}, model, {0.0, 40.0});
  ASSERT_EQ(budgets.size(), 2U);
  EXPECT_EQ(budgets[0].horizon, 0.0);
  EXPECT_EQ(budgets[0].windows, 4);
  EXPECT_NEAR(budgets[0].rms, 0.01 * 5.0, 1e-9);
  EXPECT_EQ(budgets[1].windows, 1);
  EXPECT_NEAR(budgets[1].rms, 2.0 * 0.01 * 5.0, 1e-9);
}

TEST(NoiseBudgets, LeaveOutHorizonsLongerThanTheDrive) {
  EXPECT_TRUE(noise_budget({straight_drive(5.0, 0.5)}, Model(), {10.0}).empty());
  EXPECT_THROW(static_cast<void>(noise_budget({straight_drive(5.0, 0.5)}, Model(), {-1.0})),
               std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::noise_fit_test
