// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Drives of the simulated robot that stands on no landmark: fixes, loops, or landmarks seen by
// ranges or bearings alone tie it to a place. What fits of many of them come to.
#pragma once

#include "estimation/simulated_recordings.hpp"
#include "fit/fit_state.hpp"
#include "trussmap/fit_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::testing {

struct PlacedOptions {
  bool compass = false;
  bool noise = true;
  double fix_rate = 0.0;  ///< Hz
  double fix_sd = 0.05;   ///< m
  bool landmarks = false;
  bool loops = false;
  bool markers = false;  ///< surveyed, each sighting with a yaw
  double yaw_sd = 0.02;  ///< rad
  /// Of surveyed landmarks that it does not stand on; nothing: it sees none.
  std::optional<SensorParts> sees = std::nullopt;
  std::vector<Effect> effects = {};
  int tours = 1;
};

struct PlacedDrive {
  Recording recording;
  TrueMotion motion;
  Model model;  ///< nominal, its noise as it was drawn
};

inline PlacedDrive placed_drive(const PlacedOptions& options, std::uint64_t seed) {
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0}, {0.0, 3.0, 7.0});
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, options.tours, random);
  WheeledRobot robot;
  robot.compass = options.compass;
  robot.fix_rate = options.fix_rate;
  robot.noise.fix = options.fix_sd;
  robot.loops = options.loops;
  robot.markers = options.markers;
  robot.noise.yaw = options.yaw_sd;
  robot.range_sensor = options.sees.has_value();
  robot.sensor_parts = options.sees.value_or(SensorParts::both);
  DrivingStyle style;
  if (!options.noise) {
    robot.noise = kNoiseFree;
    style.standing = 0.0;
  }
  SimulatedDrive drive =
      simulate_drive(mesh, tours.walk, style, robot, seed, SimulatedEffects{options.effects});
  PlacedDrive result;
  result.recording = std::move(drive.recording);
  result.motion = std::move(drive.motion);
  if (!options.sees && !options.markers) result.recording.survey.clear();
  if (!options.landmarks) {
    std::erase_if(result.recording.sightings, [](const Sighting& one) { return one.standing(); });
  }
  result.model.noise.fix = options.fix_sd;
  result.model.noise.yaw = options.yaw_sd;
  return result;
}

/// Root mean square distance of a fit's poses from the true ones, at the ends of rows, after
/// `first` (where the map has the true start) moves the truth there; m.
inline double path_error(const PlacedDrive& drive, const ModelFit& fit, const Pose& first = {}) {
  double squares = 0.0;
  const std::vector<TimedPose> poses = adjusted_poses(fit);
  for (std::size_t row = 0; row < drive.motion.rows.size(); ++row) {
    const Pose truth = compose(first, relative(drive.motion.start, drive.motion.rows[row].pose));
    squares += (poses[row + 1].estimate.pose.position() - truth.position()).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(drive.motion.rows.size()));
}

/// What many fits say of their noise and of themselves.
struct FitStatistics {
  double mean = 0.0;  ///< chi^2/dof
  int dof = 0;        ///< the least
  int inside = 0;     ///< 95 % intervals that hold the truth
  int intervals = 0;
};

/// Fits the model, whose effects have the true coefficients, from none; takes what it finds in, as
/// one of `drives`.
inline void add_fit(FitStatistics& found, const Recording& recording, Model model, int drives) {
  std::vector<Effect> truth = model.effects;
  for (Effect& effect : model.effects) effect.coefficients.assign(effect.shape.size(), 0.0);
  const ModelFit fit = fit_model({recording}, model);
  found.mean += fit.chi2 / fit.dof / drives;
  found.dof = found.dof == 0 ? fit.dof : std::min(found.dof, fit.dof);
  for (std::size_t e = 0; e < truth.size(); ++e) {
    const double off = fit.effects[e].effect.coefficients[0] - truth[e].coefficients[0];
    if (std::abs(off) < 1.96 * fit.effects[e].sd[0]) ++found.inside;
    ++found.intervals;
  }
}

/// With a compass, without, with, ...; each has a seed of its own from the first on, and its model
/// the effects that act.
inline FitStatistics fit_statistics(PlacedOptions options, int drives, std::uint64_t first_seed) {
  FitStatistics found;
  for (int k = 0; k < drives; ++k) {
    options.compass = k % 2 == 0;
    const PlacedDrive drive = placed_drive(options, first_seed + static_cast<std::uint64_t>(k));
    Model model = drive.model;
    model.effects = options.effects;
    add_fit(found, drive.recording, model, drives);
  }
  return found;
}

/// 95 % of the intervals within four standard deviations of chance.
inline bool hold_the_truth(const FitStatistics& found) {
  const double n = found.intervals;
  return std::abs(found.inside / n - 0.95) < 4.0 * std::sqrt(0.95 * 0.05 / n);
}

/// Within so many standard deviations of its mean, a mean of independent chi^2/dof.
inline bool is_mean_of_right_ones(double mean, int count, int dof, double sds = 4.0) {
  return std::abs(mean - 1.0) < sds * std::sqrt(2.0 / dof / count);
}

/// Both, of so many drives.
inline void expect_right(const FitStatistics& found, int drives) {
  ::testing::Test::RecordProperty("mean", std::to_string(found.mean));
  ::testing::Test::RecordProperty("inside", found.inside);
  EXPECT_TRUE(is_mean_of_right_ones(found.mean, drives, found.dof)) << found.mean;
  EXPECT_TRUE(hold_the_truth(found)) << found.inside << " of " << found.intervals;
}

}  // namespace trussmap::testing
