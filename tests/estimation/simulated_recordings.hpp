// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recordings with a known truth, for the tests of the adjustment.
#pragma once

#include "driven.hpp"
#include "estimation/recording_adjustment.hpp"
#include "trussmap/simulation.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace trussmap::testing {

/// What the robot has.
struct Equipment {
  bool compass = true;
  bool survey = true;
  bool range_sensor = false;
  int tours = 2;
};

struct SimulatedRecording {
  DrivenRecording recording;
  Recording read;                        ///< the same, as it is read
  Model model;                           ///< the true one
  std::map<std::string, Vector2> truth;  ///< landmarks in the frame that the adjustment uses
};

/// Tours of a mesh with unequal distances.
inline SimulatedRecording simulate_recording(const Equipment& equipment, std::uint64_t seed) {
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0, 12.0}, {0.0, 3.0, 7.0, 12.0});
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, equipment.tours, random);
  WheeledRobot robot;
  robot.compass = equipment.compass;
  robot.range_sensor = equipment.range_sensor;
  SimulatedDrive drive = simulate_drive(mesh, tours.walk, {}, robot, seed);
  if (!equipment.survey) drive.recording.survey.clear();
  SimulatedRecording result;
  result.recording = driven(drive.recording);
  result.read = std::move(drive.recording);
  for (int k = 0; k < mesh.landmarks(); ++k) {
    result.truth[landmark_name(mesh, k)] = mesh.positions[idx(k)];
  }
  // The robot starts at v0 = (0, 0), the first landmark, with true heading 0: the map frame of the
  // survey, of the compass, and of the first pose all at once.
  return result;
}

/// The simulator's robot without noise, weighed as if it had some.
inline SimulatedRecording simulate_exactly(const Equipment& equipment, std::uint64_t seed) {
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0}, {0.0, 3.0, 7.0});
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, equipment.tours, random);
  WheeledRobot robot;
  robot.compass = equipment.compass;
  robot.range_sensor = equipment.range_sensor;
  robot.noise = kNoiseFree;
  DrivingStyle style;
  style.standing = 0.0;
  SimulatedDrive drive = simulate_drive(mesh, tours.walk, style, robot, seed);
  if (!equipment.survey) drive.recording.survey.clear();
  SimulatedRecording result;
  result.recording = driven(drive.recording);
  result.read = std::move(drive.recording);
  for (int k = 0; k < mesh.landmarks(); ++k) {
    result.truth[landmark_name(mesh, k)] = mesh.positions[idx(k)];
  }
  return result;
}

/// Largest distance of a landmark from where it truly is, m.
inline double largest_error(const estimation::RecordingProblem& problem,
                            const estimation::RecordingState& state,
                            const std::map<std::string, Vector2>& truth) {
  double largest = 0.0;
  for (std::size_t k = 0; k < problem.landmarks.size(); ++k) {
    largest = std::max(largest, (state.landmarks[k] - truth.at(problem.landmarks[k])).norm());
  }
  return largest;
}

}  // namespace trussmap::testing
