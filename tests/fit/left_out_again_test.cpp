// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
// Sightings left out under a noise that is stated too small, once the noise is known.
#include "driven.hpp"
#include "fit/fit_state.hpp"
#include "trussmap/simulation.hpp"

#include <cstdint>

#include <gtest/gtest.h>

namespace trussmap::left_out_again_test {
namespace {

FitOptions gated() {
  FitOptions options;
  options.gate = 16.0;
  options.most_left_out = 0.12;
  return options;
}

/// Wheels and compass are twice as noisy as the model says; one landmark is misread once.
DrivenRecording noisy_recording(std::uint64_t seed) {
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0, 12.0}, {0.0, 3.0, 7.0, 12.0});
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  WheeledRobot robot;
  robot.rough = parse_rough("half");
  DrivingStyle style;
  style.standing = 0.002;
  DrivenRecording recording = testing::driven(
      simulate_drive(mesh, make_tours(mesh, WalkKind::euler, 5, random).walk, style, robot, seed)
          .recording);
  Sighting& wrong = recording.sightings[recording.sightings.size() / 2];
  wrong.landmark = landmark_name(mesh, wrong.landmark == landmark_name(mesh, 3) ? 12 : 3);
  return recording;
}

TEST(LeftOut, ComesBackUnderTheNoiseThatThereIsButForWhatIsWrong) {
  const std::vector<DrivenRecording> recordings{noisy_recording(2)};
  Model believed;
  believed.noise.sighting = 0.002;
  const ModelFit stated = fit_model(recordings, believed, gated());
  ASSERT_GT(stated.left_out.size(), 4U);  // else this says nothing
  Model truth = believed;
  truth.noise.left *= 2.0;
  truth.noise.right *= 2.0;
  truth.noise.compass *= 2.0;
  const ModelFit again = fitting::refit(recordings, truth, stated);
  EXPECT_EQ(again.left_out.size(), 1U);
  // As if it had been known from the start.
  const ModelFit known = fit_model(recordings, truth, gated());
  EXPECT_EQ(again.left_out, known.left_out);
  EXPECT_NEAR(again.chi2, known.chi2, 1e-6 * known.chi2);
}

}  // namespace
}  // namespace trussmap::left_out_again_test
