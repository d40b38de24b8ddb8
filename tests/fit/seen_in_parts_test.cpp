// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Landmarks that are seen by ranges alone or by bearings alone, never stood on: what a fit says of
// its own errors, over many drives.
#include "fit/placed_drives.hpp"
#include "trussmap/catalogue.hpp"

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

using testing::add_fit;
using testing::FitStatistics;
using testing::hold_the_truth;
using testing::is_mean_of_right_ones;

/// A drive among surveyed landmarks.
Recording seen_in_parts(SensorParts parts, bool compass, const std::vector<Effect>& effects,
                        std::uint64_t seed) {
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0}, {0.0, 3.0, 7.0});
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, 2, random);
  WheeledRobot robot;
  robot.compass = compass;
  robot.range_sensor = true;
  robot.sensor_parts = parts;
  Recording recording =
      simulate_drive(mesh, tours.walk, {}, robot, seed, SimulatedEffects{effects}).recording;
  std::erase_if(recording.sightings, [](const Sighting& one) { return one.standing(); });
  return recording;
}

/// An effect of the sensor and one of the wheels.
FitStatistics statistics(SensorParts parts, int drives, std::uint64_t first_seed) {
  const Effect of_sensor = parts == SensorParts::range_alone
                               ? catalogue_effect("range bias", {0.08})
                               : catalogue_effect("bearing offset", {0.03});
  Model model;
  model.effects = {of_sensor, catalogue_effect("wheelbase", {0.02})};
  FitStatistics found;
  for (int k = 0; k < drives; ++k) {
    add_fit(
        found,
        seen_in_parts(parts, k % 2 == 0, model.effects, first_seed + static_cast<std::uint64_t>(k)),
        model, drives);
  }
  return found;
}

void expect_right(const FitStatistics& found, int drives) {
  ::testing::Test::RecordProperty("mean", std::to_string(found.mean));
  ::testing::Test::RecordProperty("inside", found.inside);
  EXPECT_TRUE(is_mean_of_right_ones(found.mean, drives, found.dof)) << found.mean;
  EXPECT_TRUE(hold_the_truth(found)) << found.inside << " of " << found.intervals;
}

/// Seeds 100 to 119.
TEST(SeenInParts, ByRangesAlone) {
  expect_right(statistics(SensorParts::range_alone, 20, 100), 20);
}

/// Seeds 200 to 219.
TEST(SeenInParts, ByBearingsAlone) {
  expect_right(statistics(SensorParts::bearing_alone, 20, 200), 20);
}

/// Seeds 3000 to 3499.
TEST(SlowSeenInParts, ByRangesAlone) {
  expect_right(statistics(SensorParts::range_alone, 500, 3000), 500);
}

/// Seeds 4000 to 4499.
TEST(SlowSeenInParts, ByBearingsAlone) {
  expect_right(statistics(SensorParts::bearing_alone, 500, 4000), 500);
}

}  // namespace
}  // namespace trussmap
