// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A robot that turns about one wheel, and one whose encoder has lost its counts: what the wheels
// record is the same.
#include "trussmap/check.hpp"
#include "trussmap/planar.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::still_wheels_test {
namespace {

constexpr double kRow = 0.1;    // s
constexpr double kBase = 0.34;  // m
constexpr double kSpeed = 0.5;  // m/s of the wheel that drives

enum class Wheel { turns_about_it, lost };

struct Shown {
  std::string by;
  bool compass = false;
  bool gyro = false;
  bool truth = false;
  bool bearings = false;
};

/// 4 m ahead, six turns to the left, 4 m ahead; the left wheel stands still in the middle. Where it
/// has lost its counts the robot has driven on in a straight line. Noise: seed 7.
Recording drive(const Shown& shown, Wheel wheel, bool ahead_as_well = true) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.name = "pivot";
  Pose at;
  const Vector2 pole(1.0, 5.0);
  const double turn = kSpeed * kRow / kBase;
  const int ahead = ahead_as_well ? 80 : 0;
  const int turns = static_cast<int>(std::ceil(12.0 * std::numbers::pi / turn));
  for (int row = 0; row < 2 * ahead + turns; ++row) {
    const bool pivots = row >= ahead && row < ahead + turns;
    const double t = kRow * (row + 1);
    recording.drive.t.push_back(t);
    recording.drive.left.push_back(pivots ? 0.0 : kSpeed * kRow);
    recording.drive.right.push_back(kSpeed * kRow);
    const double turned = pivots && wheel == Wheel::turns_about_it ? turn : 0.0;
    const double way = turned > 0.0 ? 0.5 * kSpeed * kRow : kSpeed * kRow;
    at.x += way * std::cos(at.heading + 0.5 * turned);
    at.y += way * std::sin(at.heading + 0.5 * turned);
    at.heading += turned;
    if (shown.compass) {
      recording.drive.heading.push_back(wrap_angle(at.heading + 0.02 * normal(random)));
    }
    if (shown.gyro) recording.drive.yaw_rate.push_back(turned / kRow + 0.01 * normal(random));
    if (shown.truth && row % 5 == 0) {
      recording.truth.push_back({t, at.x + 0.01 * normal(random), at.y, wrap_angle(at.heading)});
    }
    if (row % 7 != 0) continue;
    const Vector2 offset = pole - at.position();
    Sighting seen;
    seen.t = t;
    seen.landmark = "pole";
    seen.range = offset.norm() + 0.02 * normal(random);
    if (shown.bearings) {
      seen.bearing = wrap_angle(direction(offset) - at.heading + 0.02 * normal(random));
    }
    recording.sightings.push_back(seen);
  }
  return recording;
}

std::string still_wheel_in(const Recording& recording, const Model* model) {
  for (const CheckFinding& one : check_recordings({recording}, model, "model.toml")) {
    if (one.kind == "still wheel") return one.column;
  }
  return "";
}

TEST(CheckStillWheels, ATurnAboutOneWheelIsShownByWhatTurns) {
  Model model;
  model.robot.wheelbase = kBase;
  Model wide = model;
  wide.robot.wheelbase = 0.30;
  for (const Shown& shown :
       {Shown{"compass", true}, Shown{"gyro", false, true}, Shown{"truth", false, false, true},
        Shown{"bearings", false, false, false, true}, Shown{"all", true, true, true, true}}) {
    for (const bool ahead : {true, false}) {
      const Recording turned = drive(shown, Wheel::turns_about_it, ahead);
      EXPECT_EQ(still_wheel_in(turned, &model), "") << shown.by << ahead;
      EXPECT_EQ(still_wheel_in(turned, &wide), "") << shown.by << ahead;
      EXPECT_EQ(still_wheel_in(drive(shown, Wheel::lost, ahead), &model), "left")
          << shown.by << ahead;
    }
  }
}

TEST(CheckStillWheels, WithoutEvidenceOfATurnItIsFound) {
  Model model;
  model.robot.wheelbase = kBase;
  for (const bool ahead : {true, false}) {
    EXPECT_EQ(still_wheel_in(drive({"nothing"}, Wheel::turns_about_it, ahead), &model), "left");
  }
}

/// Of two that contradict each other one is wrong: that is worth a look.
TEST(CheckStillWheels, WhatContradictsTheTurnCountsMore) {
  Model model;
  model.robot.wheelbase = kBase;
  Recording turned = drive({"compass and truth", true, false, true}, Wheel::turns_about_it);
  for (TruthRow& row : turned.truth) row.heading = 0.0;
  EXPECT_EQ(still_wheel_in(turned, &model), "left");
}

/// Where the counts come back for a turn, and the wheel has stood still for long before.
TEST(CheckStillWheels, AnotherStretchThatIsATurnHidesNoneThatIsNot) {
  Model model;
  model.robot.wheelbase = kBase;
  const Shown shown{"compass", true};
  Recording both = drive(shown, Wheel::turns_about_it);
  const Recording lost = drive(shown, Wheel::lost);
  const double end = both.drive.t.back();
  for (std::size_t row = 0; row < lost.drive.rows(); ++row) {
    both.drive.t.push_back(end + lost.drive.t[row]);
    both.drive.left.push_back(lost.drive.left[row]);
    both.drive.right.push_back(lost.drive.right[row]);
    both.drive.heading.push_back(lost.drive.heading[row]);
  }
  EXPECT_EQ(still_wheel_in(both, &model), "left");
}

}  // namespace
}  // namespace trussmap::still_wheels_test
