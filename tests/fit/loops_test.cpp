// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Poses seen from one another: drives that nothing else ties together.
#include "fit/placed_drives.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <numbers>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::loops_test {
namespace {

using testing::expect_right;
using testing::fit_statistics;
using testing::FitStatistics;
using testing::is_mean_of_right_ones;
using testing::path_error;
using testing::placed_drive;
using testing::PlacedDrive;
using testing::PlacedOptions;

struct LoopNoise {
  double sd = 0.05;          ///< m
  double sd_heading = 0.01;  ///< rad
};

/// Between each stop and those at the same landmark before it, whatever its heading.
PlacedDrive looped_drive(PlacedOptions options, const LoopNoise& noise, std::uint64_t seed) {
  options.tours = 3;
  PlacedDrive drive = placed_drive(options, seed);
  std::mt19937_64 random(seed + 1000);
  std::normal_distribution<double> normal;
  const std::vector<TrueStop>& stops = drive.motion.stops;
  for (std::size_t b = 0; b < stops.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (stops[a].landmark != stops[b].landmark) continue;
      const Pose step = relative(stops[a].pose, stops[b].pose);
      drive.recording.loops.push_back(
          {stops[a].t, stops[b].t, step.x + noise.sd * normal(random),
           step.y + noise.sd * normal(random),
           wrap_angle(step.heading + noise.sd_heading * normal(random))});
    }
  }
  return drive;
}

/// Between places that have nothing to do with each other; returns their times.
std::set<std::pair<double, double>> add_wrong_loops(PlacedDrive& drive, std::size_t count,
                                                    std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const std::vector<TrueStop>& stops = drive.motion.stops;
  std::uniform_int_distribution<std::size_t> any(0, stops.size() - 1);
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi);
  std::set<std::pair<double, double>> wrong;
  while (wrong.size() < count) {
    const TrueStop& a = stops[any(random)];
    const TrueStop& b = stops[any(random)];
    if ((a.pose.position() - b.pose.position()).norm() < 3.0) continue;
    if (!wrong.insert({a.t, b.t}).second) continue;
    drive.recording.loops.push_back({a.t, b.t, 0.1, -0.1, angle(random)});
  }
  return wrong;
}

FitOptions gated() {
  FitOptions options;
  options.gate = 16.0;
  return options;
}

TEST(Loops, ExactOnesLeaveNoError) {
  for (const bool compass : {false, true}) {
    PlacedOptions options;
    options.noise = false;
    options.compass = compass;
    const PlacedDrive drive = looped_drive(options, {0.0, 0.0}, 3);
    const ModelFit fit = fit_model({drive.recording}, drive.model);
    EXPECT_LT(fit.chi2, 1e-6);
    EXPECT_TRUE(fit.landmarks.empty());
    // The first pose is the map's frame; a compass gives its direction.
    EXPECT_LT(path_error(drive, fit), 1e-5);
    const PoseEstimate first = adjusted_poses(fit).front().estimate;
    const Matrix2 place = first.covariance.topLeftCorner(2, 2);
    EXPECT_LT(place.norm(), 1e-12);
  }
}

/// 30 drives, seeds 50 to 79.
TEST(Loops, ChiSquareIsThatOfTheNoise) {
  constexpr int kDrives = 30;
  double mean = 0.0;
  int dof = 0;
  for (int k = 0; k < kDrives; ++k) {
    PlacedOptions options;
    options.compass = k % 2 == 0;
    const PlacedDrive drive = looped_drive(options, {}, 50 + static_cast<std::uint64_t>(k));
    const ModelFit fit = fit_model({drive.recording}, drive.model);
    mean += fit.chi2 / fit.dof / kDrives;
    dof = dof == 0 ? fit.dof : std::min(dof, fit.dof);
  }
  EXPECT_TRUE(is_mean_of_right_ones(mean, kDrives, dof)) << mean;
}

/// A fifth of them wrong, on wheels of twice the usual noise: the right ones show which.
TEST(Loops, WrongOnesAreLeftOutAndNamed) {
  for (const std::uint64_t seed : {21U, 22U, 23U}) {
    PlacedDrive drive = looped_drive({}, {}, seed);
    const std::size_t right = drive.recording.loops.size();
    const auto wrong = add_wrong_loops(drive, right / 5, seed);
    const ModelFit fit = fit_model({drive.recording}, drive.model, gated());
    std::set<std::pair<double, double>> left_out;
    for (const int k : fit.state->adjustment.left_out) {
      const Loop& one = drive.recording.loops[fit.state->problem.measurements[idx(k)].source];
      left_out.insert({one.t, one.t2});
    }
    for (const auto& one : wrong) EXPECT_TRUE(left_out.contains(one)) << one.first;
    EXPECT_LE(left_out.size(), wrong.size() + 2);
    ASSERT_FALSE(fit.left_out.empty());
    EXPECT_EQ(fit.left_out[0].rfind("loops.csv: loop from t = ", 0), 0U) << fit.left_out[0];
    EXPECT_NE(fit.left_out[0].find(" m off and "), std::string::npos) << fit.left_out[0];
    EXPECT_LT(path_error(drive, fit), 0.2);
  }
}

TEST(Loops, EndNoLegs) {
  PlacedOptions options;
  options.compass = true;
  const PlacedDrive drive = looped_drive(options, {}, 31);
  const Comparison result = compare({drive.recording}, drive.model);
  EXPECT_EQ(result.legs, 0U);
  EXPECT_TRUE(result.held_out.legs.empty());
  EXPECT_TRUE(result.consistent());
}

/// Beside landmarks and fixes they add what they know.
TEST(Loops, GoWithLandmarksAndFixes) {
  PlacedOptions options;
  options.landmarks = true;
  options.fix_rate = 0.5;
  const PlacedDrive drive = looped_drive(options, {}, 32);
  Recording without = drive.recording;
  without.loops.clear();
  const ModelFit less = fit_model({without}, drive.model);
  const ModelFit more = fit_model({drive.recording}, drive.model);
  EXPECT_EQ(more.dof, less.dof + 3 * static_cast<int>(drive.recording.loops.size()));
  EXPECT_LT(std::abs(more.chi2 - more.dof), 5.0 * std::sqrt(2.0 * more.dof));
  EXPECT_LT(path_error(drive, more), 0.05);
}

/// As the simulator draws them; wheels are further apart than believed, or turns misjudged.
FitStatistics statistics(int drives, std::uint64_t first_seed) {
  PlacedOptions options;
  options.loops = true;
  options.tours = 2;
  options.effects = {catalogue_effect("wheelbase", {0.02})};
  return fit_statistics(options, drives, first_seed);
}

/// 30 drives, seeds 400 to 429.
TEST(Loops, TellAnEffectWithinItsError) {
  expect_right(statistics(30, 400), 30);
}

/// 500 drives, seeds 2000 to 2499.
TEST(SlowLoops, ChiSquareAndIntervalsAreThoseOfTheNoise) {
  expect_right(statistics(500, 2000), 500);
}

TEST(Loops, MustLieInTheDrive) {
  PlacedDrive drive = looped_drive({}, {}, 33);
  drive.recording.loops[0].t2 = drive.recording.loops[0].t;
  EXPECT_THROW(static_cast<void>(fit_model({drive.recording}, drive.model)), std::invalid_argument);
  drive.recording.loops[0].t2 = drive.recording.drive.t.back() + 1.0;
  EXPECT_THROW(static_cast<void>(fit_model({drive.recording}, drive.model)), std::invalid_argument);
  drive.recording.loops.clear();
  EXPECT_THROW(static_cast<void>(fit_model({drive.recording}, drive.model)), InputError);
}

}  // namespace
}  // namespace trussmap::loops_test
