// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Maps from recordings of a robot with known faults, built with and without the model of them.
#include "odometry/effect_correction.hpp"

#include "driven.hpp"
#include "shared_data.hpp"
#include "simulation/wheeled_robot.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/survey_comparison.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace trussmap::effect_correction_test {
namespace {

DrivenRecording drive_about(bool compass) {
  const Mesh mesh = even_mesh({4, 4}, 5.0);
  auto random = random_stream(3, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, 2, random);
  WheeledRobot robot;
  robot.compass = compass;
  DrivenRecording recording =
      testing::driven(simulate_drive(mesh, tours.walk, {}, robot, 3).recording);
  recording.survey = simulation::survey(mesh, 1e-6, 3);
  return recording;
}

/// Of dead reckoning: a map has the commonest faults estimated beside it.
double error_of(const std::vector<DrivenRecording>& recordings) {
  const BuiltMap built = build_map(recordings, Model{});
  return survey_rms(built.dead_reckoned, recordings.front().survey, {});
}

/// A wheelbase 3 % larger than believed, a right wheel 0.3 % larger: what the wheels show is less
/// of both.
TEST(EffectCorrection, RestoresTheRecordOfTheSoundRobot) {
  const DrivenRecording sound = drive_about(false);
  DrivenRecording faulty = sound;
  for (std::size_t row = 0; row < faulty.drive.rows(); ++row) {
    const double middle = 0.5 * (sound.drive.pair.left[row] + sound.drive.pair.right[row]);
    const double half = 0.5 * (sound.drive.pair.right[row] - sound.drive.pair.left[row]) * 1.03;
    faulty.drive.pair.left[row] = (middle - half) / (1.0 - 0.0015);
    faulty.drive.pair.right[row] = (middle + half) / (1.0 + 0.0015);
  }
  testing::retake(faulty.drive);
  Model model;
  model.effects.push_back(catalogue_effect("wheel diameter ratio", {0.003}));
  model.effects.push_back(catalogue_effect("wheelbase", {1.0 / 1.03 - 1.0}));
  const std::vector<DrivenRecording> corrected = odometry::without_effects({faulty}, model);
  for (std::size_t row = 0; row < sound.drive.rows(); ++row) {
    EXPECT_NEAR(corrected[0].drive.pair.left[row], sound.drive.pair.left[row], 1e-12);
    EXPECT_NEAR(corrected[0].drive.pair.right[row], sound.drive.pair.right[row], 1e-12);
    EXPECT_NEAR(corrected[0].drive.forward[row], sound.drive.forward[row], 1e-12);
    EXPECT_NEAR(corrected[0].drive.turn[row], sound.drive.turn[row], 1e-12);
  }
  EXPECT_GT(error_of({faulty}), 1.5 * error_of({sound}));
}

/// The practice recording with the compass's hard iron: with its answer as a model dead reckoning
/// is better than without.
TEST(EffectCorrection, TheAnswerOfAPracticeRecordingImprovesItsReckoning) {
  TRUSSMAP_NEEDS_SHARED("data/hidden/b");
  const DrivenRecording recording =
      testing::driven(read_recording(testing::shared("data/hidden/b")));
  Model model;
  model.effects.push_back(catalogue_effect("hard iron", {0.0305937, -0.0257687}));
  EXPECT_LT(error_of(odometry::without_effects({recording}, model)), 0.7 * error_of({recording}));
}

}  // namespace
}  // namespace trussmap::effect_correction_test
