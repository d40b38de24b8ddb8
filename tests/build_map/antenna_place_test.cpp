// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A map whose model knows nothing of the antenna of its fixes: the sightings are not to blame.
#include "trussmap/build_map.hpp"
#include "trussmap/simulated_recording.hpp"
#include "trussmap/survey_comparison.hpp"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::antenna_place_test {
namespace {

SimulatedRecording yard(const Mounting& antenna, std::uint64_t seed) {
  SimulationSettings settings;
  settings.mesh = "3x3";
  settings.spacing = 12.0;
  settings.uneven = true;
  settings.tours = 2;
  settings.seed = seed;
  settings.full_turns = 2;
  settings.no_compass = true;
  settings.range_sensor = true;
  settings.reach = 25.0;
  settings.fix_rate = 0.5;
  settings.mounted.antenna = antenna;
  SimulatedRecording made = simulate(settings, {});
  made.model.robot.mounted = {};
  return made;
}

bool names_antenna(const BuiltMap& built) {
  return std::any_of(built.warnings.begin(), built.warnings.end(), [](const std::string& one) {
    return one.find("antenna") != std::string::npos;
  });
}

class UnknownAntenna : public ::testing::TestWithParam<double> {};

TEST_P(UnknownAntenna, IsNamedAndCostsNoSighting) {
  const SimulatedRecording made = yard({GetParam(), 0.2, 0.0}, 1);
  const BuiltMap built = build_map({made.drive.recording}, made.model);
  EXPECT_TRUE(names_antenna(built));
  EXPECT_TRUE(built.rejected.empty());
  EXPECT_LT(survey_rms(positions_of(built.map), made.drive.recording.survey, {}), 0.05);
  EXPECT_LT(built.quality.dispersion, 1.2);
  Model stated = made.model;
  stated.robot.mounted.antenna = Mounting{GetParam(), 0.2, 0.0};
  EXPECT_FALSE(names_antenna(build_map({made.drive.recording}, stated)));
}

INSTANTIATE_TEST_SUITE_P(Places, UnknownAntenna, ::testing::Values(0.4, 3.75));

TEST(KnownAntenna, OverTheAxleIsNotNamed) {
  for (std::uint64_t seed = 2; seed < 7; ++seed) {
    const SimulatedRecording made = yard({}, seed);
    EXPECT_FALSE(names_antenna(build_map({made.drive.recording}, made.model))) << seed;
  }
}

}  // namespace
}  // namespace trussmap::antenna_place_test
