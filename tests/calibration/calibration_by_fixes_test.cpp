// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Wheels calibrated by fixes alone, of an antenna that is not over the axle and stamps late.
#include "fit/placed_drives.hpp"
#include "shared_data.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

namespace trussmap::calibration_by_fixes_test {
namespace {

/// g of the wheelbase, of the wheels' ratio and of their scale.
struct Wheels {
  double turn = 0.02, difference = -0.01, scale = 0.03;
};

/// Two tours with two fixes a second.
testing::PlacedDrive fixed_drive(const Wheels& truth, std::uint64_t seed) {
  testing::PlacedOptions options;
  options.fix_rate = 2.0;
  options.tours = 2;
  options.effects = {catalogue_effect("antenna ahead of the axle", {0.25}),
                     catalogue_effect("antenna beside the axle", {-0.1}),
                     catalogue_effect("fix delay", {0.3}),
                     catalogue_effect("wheelbase", {truth.turn}),
                     catalogue_effect("wheel diameter ratio", {truth.difference}),
                     catalogue_effect("wheel scale", {truth.scale})};
  return testing::placed_drive(options, seed);
}

/// How far off an estimate is, in its standard errors.
double off(const std::optional<Calibrated>& one, double truth) {
  return one ? (one->value - truth) / one->sd : std::nan("");
}

/// Seeds 1 to 6.
TEST(CalibrationByFixes, FindsWheelsAntennaAndDelay) {
  double squares = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Wheels truth;
    const testing::PlacedDrive drive = fixed_drive(truth, seed);
    const WheelCalibration found = calibrate_wheels({drive.recording}, drive.model);
    EXPECT_TRUE(found.settled);
    EXPECT_NEAR(found.fixes.ahead, 0.25, 0.05);
    EXPECT_NEAR(found.fixes.left, -0.1, 0.05);
    EXPECT_NEAR(found.fixes.late.at(0), 0.3, 0.1);
    for (const double one :
         {off(found.wheelbase_ratio, 1.0 / (1.0 + truth.turn)),
          off(found.diameter_ratio, (2.0 + truth.difference) / (2.0 - truth.difference)),
          off(found.scale, 1.0 + truth.scale)}) {
      EXPECT_LT(std::abs(one), 4.0) << seed;
      squares += one * one;
      ++count;
    }
  }
  EXPECT_NEAR(squares / count, 1.0, 4.0 * std::sqrt(2.0 / count));
}

/// Seed 1.
TEST(SlowCalibrationByFixes, FindsWhatIsWrongByAFactor) {
  for (const Wheels& truth :
       {Wheels{1.0, 0.0, 0.0}, Wheels{-0.5, 0.0, 0.0}, Wheels{0.0, 0.667, 0.0},
        Wheels{0.0, 0.0, 1.0}, Wheels{0.0, 0.0, -0.5}}) {
    const testing::PlacedDrive drive = fixed_drive(truth, 1);
    const WheelCalibration found = calibrate_wheels({drive.recording}, drive.model);
    EXPECT_LT(std::abs(off(found.wheelbase_ratio, 1.0 / (1.0 + truth.turn))), 4.0);
    EXPECT_LT(
        std::abs(off(found.diameter_ratio, (2.0 + truth.difference) / (2.0 - truth.difference))),
        4.0);
    EXPECT_LT(std::abs(off(found.scale, 1.0 + truth.scale)), 4.0);
  }
}

/// By hand, of the whole drive: a wheelbase 14 to 18 % larger, E_d from 0.994 to 0.998.
TEST(CalibrationByFixes, FindsASmallRobotsWheelbaseFromEachHalf) {
  TRUSSMAP_NEEDS_SHARED("data/lego-overhead");
  const std::filesystem::path folder = testing::shared("data/lego-overhead");
  for (const char* part : {"rec", "first_half", "second_half"}) {
    const std::vector<Recording> recordings = {read_recording(folder / part)};
    const Model model = read_model(folder / "rec" / "model.toml");
    const WheelCalibration found = calibrate_wheels(recordings, model);
    EXPECT_LT(std::abs(off(found.wheelbase_ratio, 1.16)), 3.0) << part;
    EXPECT_LT(std::abs(off(found.diameter_ratio, 0.996)), 3.0) << part;
    EXPECT_LT(found.wheelbase_ratio->sd, 0.1) << part;
  }
}

}  // namespace
}  // namespace trussmap::calibration_by_fixes_test
