// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Drives in which something is known to have happened once: a bump, a landmark moved between two
// sessions, so large that the rest shows it by a given number of standard deviations.
#pragma once

#include "criticism/noisy_recordings.hpp"
#include "criticism/score_test.hpp"
#include "driven.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace trussmap::testing {

struct Bump {
  NoisyDrive world;
  std::string name;  ///< of the leg
};

/// In one row of one leg, one wheel says too much: so many of the standard deviations with which
/// all the rest determines it.
inline Bump bumped(const NoisyWorld& how, double sds, std::uint64_t seed) {
  Bump result{simulate_world(how, seed), {}};
  std::mt19937_64 random(seed + 77);
  const TrueMotion& motion = result.world.motions.front();
  MotionRows& drive = result.world.recordings.front().drive;
  const std::size_t leg = 1 + random() % (motion.stops.size() - 1);
  std::size_t row = 0;
  do {
    row = motion.stops[leg - 1].rows +
          random() % (motion.stops[leg].rows - motion.stops[leg - 1].rows);
  } while (motion.rows[row].activity != Activity::drive);
  const bool left = random() % 2 == 0;
  const double sign = random() % 2 == 0 ? 1.0 : -1.0;
  const fitting::FitState fit =
      fitting::fit_recordings(result.world.recordings, result.world.model);
  const criticism::ScoreTest tests(fit);
  estimation::EffectPattern pattern;
  pattern.drives.emplace_back(drive.rows());
  pattern.drives[0][row].advance = 0.5;
  pattern.drives[0][row].turn = (left ? -1.0 : 1.0) / result.world.model.robot.wheelbase;
  const estimation::EffectParameters border{pattern};
  estimation::RecordingSystem system(fit.problem, border);
  system.linearise(fit.adjustment.state, Eigen::VectorXd::Zero(1));
  const double told = tests.projected(system.border()).norm();
  (left ? drive.pair.left : drive.pair.right)[row] += sign * sds / told;
  retake(drive, result.world.model.robot.wheelbase);
  const auto name = [&](std::size_t stop) {
    return landmark_name(result.world.mesh, motion.stops[stop].landmark);
  };
  char time[40];
  std::snprintf(time, sizeof time, " at t = %.1f s", motion.stops[leg].t);
  result.name = name(leg - 1) + " -> " + name(leg) + time;
  return result;
}

/// Sightings of a landmark in the last session, under another name.
inline std::vector<DrivenRecording> with_another(std::vector<DrivenRecording> recordings,
                                                 const std::string& landmark) {
  for (Sighting& sighting : recordings.back().sightings) {
    if (sighting.landmark == landmark) sighting.landmark += "'";
  }
  return recordings;
}

/// Where it was in the last session, less where it was before, and the covariance of that.
struct Moved {
  Vector2 by;
  Matrix2 covariance;
  double chi2 = 0.0;
};
inline Moved moved_by(const NoisyDrive& world, const std::string& landmark) {
  const fitting::FitState fit =
      fitting::fit_recordings(with_another(world.recordings, landmark), world.model);
  int before = -1;
  int after = -1;
  for (int k = 0; k < fit.problem.landmark_count(); ++k) {
    if (fit.problem.landmarks[idx(k)] == landmark) before = k;
    if (fit.problem.landmarks[idx(k)] == landmark + "'") after = k;
  }
  const Eigen::MatrixXd joint = estimation::joint_covariance(fit.problem, fit.columns.border,
                                                             fit.adjustment, {before, after});
  Moved result;
  result.by =
      fit.adjustment.state.landmarks[idx(after)] - fit.adjustment.state.landmarks[idx(before)];
  const Eigen::Matrix<double, 2, 4> difference =
      (Eigen::Matrix<double, 2, 4>() << -1, 0, 1, 0, 0, -1, 0, 1).finished();
  result.covariance = difference * joint.topLeftCorner<4, 4>() * difference.transpose();
  result.chi2 = fit.adjustment.chi2;
  return result;
}

/// The robot of the last session finds one landmark elsewhere, so many standard deviations away.
inline NoisyDrive with_moved_landmark(double sds, std::uint64_t seed, std::string& landmark) {
  NoisyDrive world = simulate_world({true, true, false, 1, 2}, seed);
  const int which = static_cast<int>(seed % static_cast<std::uint64_t>(world.mesh.landmarks()));
  landmark = landmark_name(world.mesh, which);
  const double angle = static_cast<double>(seed);
  const Vector2 direction(std::cos(angle), std::sin(angle));
  const double sd = std::sqrt(direction.dot(moved_by(world, landmark).covariance * direction));
  Mesh moved = world.mesh;
  moved.positions[idx(which)] += sds * sd * direction;
  // The same walk and the same noise, on the mesh as it is now.
  std::vector<int> walk;
  for (const TrueStop& stop : world.motions.back().stops) walk.push_back(stop.landmark);
  DrivingStyle style;
  style.rest_share = 0.3;
  SimulatedDrive drive = simulate_drive(moved, walk, style, WheeledRobot{}, seed * 16 + 1);
  drive.recording.survey.clear();
  drive.recording.name = world.recordings.back().name;
  world.recordings.back() = testing::driven(drive.recording);
  return world;
}

}  // namespace trussmap::testing
