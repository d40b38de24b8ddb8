// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Simulated drives to whose wheels something is added afterwards: noise by a law that the model
// does not state, or a bump. Legs differ in length, speed and rests.
#pragma once

#include "driven.hpp"
#include "trussmap/model.hpp"
#include "trussmap/simulation.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace trussmap::testing {

struct NoisyWorld {
  bool compass = true;
  bool survey = true;
  bool range_sensor = false;
  int tours = 2;  ///< of some 28 legs
  int sessions = 1;
};

struct NoisyDrive {
  std::vector<DrivenRecording> recordings;
  std::vector<TrueMotion> motions;
  Mesh mesh;
  Model model;
};

/// With the noise that the model states.
inline NoisyDrive simulate_world(const NoisyWorld& world, std::uint64_t seed) {
  NoisyDrive result;
  result.mesh = mesh_of_lines({0.0, 4.0, 9.0, 12.0}, {0.0, 3.0, 7.0, 12.0});
  DrivingStyle style;
  style.rest_share = 0.3;
  WheeledRobot robot;
  robot.compass = world.compass;
  robot.range_sensor = world.range_sensor;
  for (int session = 0; session < world.sessions; ++session) {
    const std::uint64_t own = seed * 16 + static_cast<std::uint64_t>(session);
    std::mt19937_64 random = random_stream(own, Stream::walk);
    const Tours tours = make_tours(result.mesh, WalkKind::euler, world.tours, random);
    SimulatedDrive drive = simulate_drive(result.mesh, tours.walk, style, robot, own);
    if (!world.survey || session > 0) drive.recording.survey.clear();
    drive.recording.name = "run " + std::to_string(session + 1);
    result.recordings.push_back(testing::driven(drive.recording));
    result.motions.push_back(std::move(drive.motion));
  }
  return result;
}

/// What a row's wheels have driven too much.
inline void add_to_row(MotionRows& drive, std::size_t row, double travel, double turn,
                       double wheelbase) {
  drive.pair.left[row] += travel - 0.5 * wheelbase * turn;
  drive.pair.right[row] += travel + 0.5 * wheelbase * turn;
  retake(drive, wheelbase);
}

/// Rows in which a drive or a turn on the spot begins.
inline std::vector<std::size_t> beginnings(const TrueMotion& motion, Activity activity) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < motion.rows.size(); ++row) {
    if (motion.rows[row].activity != activity) continue;
    if (row == 0 || motion.rows[row - 1].activity != activity) rows.push_back(row);
  }
  return rows;
}

/// Adds noise of one law ("per metre", "per second", "per start", "per spin"; any other: none), so
/// much that a typical leg's spread, of both wheels or (per start) of travel, (per spin) of
/// heading, is `factor` times what the model says.
inline void add_noise(NoisyDrive& world, const std::string& law, double factor,
                      std::uint64_t seed) {
  std::mt19937_64 random = random_stream(seed, Stream::hidden);
  std::normal_distribution<double> normal;
  const double wheelbase = world.model.robot.wheelbase;
  for (std::size_t s = 0; s < world.recordings.size(); ++s) {
    MotionRows& drive = world.recordings[s].drive;
    const TrueMotion& motion = world.motions[s];
    const auto legs = static_cast<double>(motion.stops.size() - 1);
    double path = 0.0;
    for (const TrueRow& row : motion.rows) path += std::abs(row.speed) * row.duration;
    const double k2 = world.model.noise.left * world.model.noise.left;
    const double more = (factor * factor - 1.0) * k2 * path / legs;  // of a wheel, per leg
    for (std::size_t row = 0; row < motion.rows.size(); ++row) {
      const TrueRow& one = motion.rows[row];
      double left = 0.0;
      double right = 0.0;
      if (law == "per metre") {
        left = (factor * factor - 1.0) * k2 * std::abs(drive.pair.left[row]);
        right = (factor * factor - 1.0) * k2 * std::abs(drive.pair.right[row]);
      } else if (law == "per second") {
        left = right = more * legs * one.duration / motion.rows.back().t;
      }
      drive.pair.left[row] += std::sqrt(left) * normal(random);
      drive.pair.right[row] += std::sqrt(right) * normal(random);
    }
    retake(drive, wheelbase);
    if (law == "per start") {
      for (const std::size_t row : beginnings(motion, Activity::drive)) {
        add_to_row(drive, row, std::sqrt(0.5 * more) * normal(random), 0.0, wheelbase);
      }
    }
    if (law == "per spin") {
      for (const std::size_t row : beginnings(motion, Activity::spin)) {
        add_to_row(drive, row, 0.0, std::sqrt(2.0 * more) / wheelbase * normal(random), wheelbase);
      }
    }
  }
}

}  // namespace trussmap::testing
