// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/catalogue.hpp"
#include "trussmap/wording.hpp"

#include <gtest/gtest.h>

namespace trussmap::separating_drives_test {
namespace {

constexpr const char* kApart =
    "stand for some minutes between tours, and drive fast and slow ones: time, distance and ";

TEST(SeparatingDrive, TakesTimeApartFromAnyCovariateThatVariesSlowly) {
  const Effect aged = catalogue_effect("tyre drift (t)");
  for (const char* name : {"temperature_C", "battery_V", "t_motor"}) {
    const Effect warmed = catalogue_effect("tyre drift (" + std::string(name) + ")");
    const std::string expected = std::string(kApart) + name + " then go apart";
    EXPECT_EQ(separating_drive(aged, warmed, {name}), expected);
    EXPECT_EQ(separating_drive(warmed, aged, {"lights_on", name}), expected);
  }
}

TEST(SeparatingDrive, TakesTimeApartFromDistance) {
  EXPECT_EQ(separating_drive(catalogue_effect("tyre drift (t)"),
                             catalogue_effect("tyre drift (distance)"), {"battery_V"}),
            std::string(kApart) + "temperature then go apart");
}

TEST(SeparatingDrive, HasItsOwnAdviceWhereNothingGoesWithTime) {
  const Effect wheelbase = catalogue_effect("wheelbase");
  EXPECT_NE(separating_drive(wheelbase, catalogue_effect("twist per spin"), {"battery_V"})
                .find("turn on the spot"),
            std::string::npos);
  // Two covariates of a slow kind: nothing about time.
  EXPECT_EQ(separating_drive(catalogue_effect("compass disturbance (a)"),
                             catalogue_effect("load on both wheels (b)"), {"a", "b"})
                .find("stand for some minutes"),
            std::string::npos);
}

TEST(SeparatingDrive, WheelsTurnTheRobotTooAndTravelDoesNot) {
  const Effect slip = catalogue_effect("slip with speed");
  Effect both = slip;
  both.name = "wheels with speed";
  both.channel = Channel::wheels;
  for (const std::string& drive :
       {separating_drive(slip, both, {}), separating_drive(both, slip, {})}) {
    EXPECT_NE(drive.find("turn on the spot by two full turns each way"), std::string::npos)
        << drive;
  }
}

TEST(SeparatingDrive, AsksNothingToVaryApartFromItself) {
  const std::string drive = separating_drive(catalogue_effect("compass disturbance (load)"),
                                             catalogue_effect("load on both wheels (load)"), {});
  EXPECT_EQ(drive.find("independently"), std::string::npos) << drive;
  EXPECT_NE(drive.find("compass"), std::string::npos) << drive;
  // Constants go with nothing that could vary.
  EXPECT_EQ(separating_drive(catalogue_effect("range scale"), catalogue_effect("travel scale"), {})
                .find("both go with"),
            std::string::npos);
}

}  // namespace
}  // namespace trussmap::separating_drives_test
