// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
// Recordings drawn anew, against the fit that they come from.
#include "fit/replicated_recording.hpp"

#include "driven.hpp"
#include "estimation/simulated_recordings.hpp"
#include "fit/noise_reml.hpp"
#include "trussmap/catalogue.hpp"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::replicated_recording_test {
using namespace fitting;
namespace {

struct Fitted {
  std::vector<DrivenRecording> recordings;
  FitState state;
};

Effect known(const char* name, double coefficient) {
  Effect effect = catalogue_effect(name);
  effect.coefficients = {coefficient};
  return effect;
}

/// With a range sensor, effects of wheels, compass and views, one with the speed.
Fitted fitted(std::uint64_t seed, const Noise& noise = {}) {
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0}, {0.0, 3.0, 7.0});
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  WheeledRobot robot;
  robot.range_sensor = true;
  SimulatedEffects acting;
  acting.effects = {known("wheelbase", 0.02), known("slip with speed", -0.01),
                    known("range bias", 0.1)};
  DrivingStyle style;
  style.rest_share = 0.3;
  DrivenRecording recording =
      testing::driven(simulate_drive(mesh, make_tours(mesh, WalkKind::euler, 2, random).walk, style,
                                     robot, seed, acting)
                          .recording);
  Model model;
  model.noise = noise;
  model.effects = acting.effects;
  for (Effect& one : model.effects) one.coefficients.clear();
  std::vector<DrivenRecording> recordings{std::move(recording)};
  FitState state = fit_recordings(recordings, model);
  return {std::move(recordings), std::move(state)};
}

/// Under the same model, coefficients free.
FitState again(const std::vector<DrivenRecording>& recordings, const FitState& fit) {
  Model model = fit.model;
  for (Effect& one : model.effects) one.coefficients.clear();
  return fit_recordings(recordings, model);
}

TEST(ReplicatedRecording, WithoutNoiseTheFitIsExact) {
  Fitted world = fitted(1);
  const Noise stated = world.state.model.noise;
  world.state.model.noise = silent_noise();
  const std::vector<DrivenRecording> drawn = replicated(world.recordings, world.state, 1);
  world.state.model.noise = stated;
  const FitState fit = again(drawn, world.state);
  EXPECT_LT(fit.adjustment.chi2, 1e-4);
  for (std::size_t k = 0; k < fit.model.effects.size(); ++k) {
    EXPECT_NEAR(fit.model.effects[k].coefficients[0], world.state.model.effects[k].coefficients[0],
                1e-6)
        << fit.model.effects[k].name;
  }
  ASSERT_EQ(drawn[0].sightings.size(), world.recordings[0].sightings.size());
  EXPECT_EQ(drawn[0].drive.t, world.recordings[0].drive.t);
}

// chi^2 has the mean dof and the variance 2 dof: four standard errors, one run in 16 000.
TEST(ReplicatedRecording, ChiSquareIsAsTheModelHasIt) {
  Noise noise;
  noise.heading_per_s = 0.003;
  noise.travel_per_s = 0.003;
  noise.processes = {
      {Channel::compass, ProcessKind::correlated_in_t, 0.03, 2.0, 0.0, 0},
      {Channel::travel, ProcessKind::per_leg, 0.005, 0.0, 0.0, 0},
      {Channel::bearing, ProcessKind::per_pass, 0.03, 0.0, 0.0, 0},
      {Channel::difference, ProcessKind::correlated_in_distance, 0.006, 1.0, 0.0, 0}};
  const Fitted world = fitted(2, noise);
  double sum = 0.0;
  double dof = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const FitState fit = again(replicated(world.recordings, world.state, seed), world.state);
    sum += fit.adjustment.chi2;
    dof += fit.adjustment.dof;
  }
  EXPECT_NEAR(sum, dof, 4.0 * std::sqrt(2.0 * dof));
}

TEST(ReplicatedRecording, TheSeedDecides) {
  const Fitted world = fitted(3);
  const auto first = replicated(world.recordings, world.state, 7);
  const auto second = replicated(world.recordings, world.state, 7);
  const auto other = replicated(world.recordings, world.state, 8);
  EXPECT_EQ(first[0].drive.pair.left, second[0].drive.pair.left);
  EXPECT_EQ(first[0].drive.turn, second[0].drive.turn);
  EXPECT_NE(first[0].drive.pair.left, other[0].drive.pair.left);
  for (std::size_t row = 0; row < first[0].drive.rows(); ++row) {  // the wheels' own motion
    const auto [left, right] = first[0].drive.pair.at(row);
    ASSERT_NEAR(first[0].drive.forward[row], (left + right) / 2.0, 1e-12);
    ASSERT_NEAR(first[0].drive.turn[row], (right - left) / Robot().wheelbase, 1e-12);
  }
}

TEST(ReplicatedRecording, SaysWhatItCannotDraw) {
  Fitted world = fitted(4);
  world.state.model.noise.processes = {{Channel::creep, ProcessKind::per_leg, 0.01, 0.0, 0.0, 0}};
  EXPECT_THROW(static_cast<void>(replicated(world.recordings, world.state, 1)),
               std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::replicated_recording_test
