// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Landmarks that are seen by ranges alone or by bearings alone, never stood on: what a fit says of
// its own errors, over many drives.
#include "fit/placed_drives.hpp"
#include "trussmap/catalogue.hpp"

#include <cstdint>

#include <gtest/gtest.h>

namespace trussmap::seen_in_parts_test {
namespace {

using testing::expect_right;

/// Two tours; an effect of the sensor and one of the wheels.
testing::FitStatistics statistics(SensorParts parts, int drives, std::uint64_t first_seed) {
  testing::PlacedOptions options;
  options.sees = parts;
  options.tours = 2;
  options.effects = {parts == SensorParts::range_alone ? catalogue_effect("range bias", {0.08})
                                                       : catalogue_effect("bearing offset", {0.03}),
                     catalogue_effect("wheelbase", {0.02})};
  return testing::fit_statistics(options, drives, first_seed);
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
}  // namespace trussmap::seen_in_parts_test
