// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A recording that became a bag becomes the same recording again by the map that comes with it.
#include "driven.hpp"
#include "estimation/simulated_recordings.hpp"
#include "scratch_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/log_files.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::bag_round_trip_test {
namespace {

using testing::ScratchFolder;

LogRecording there_and_back(const Recording& recording, const Model& model) {
  const ScratchFolder scratch;
  const Bag bag = format_recording_bag(recording, model);
  return read_log_recording(scratch.write("a.mcap", bag.bytes), scratch.write("a.toml", bag.map));
}

void expect_same_columns(const std::vector<double>& a, const std::vector<double>& b, double within,
                         const char* what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (std::size_t row = 0; row < a.size(); ++row) {
    EXPECT_EQ(std::isnan(a[row]), std::isnan(b[row])) << what << ' ' << row;
    if (std::isnan(a[row])) continue;
    EXPECT_NEAR(a[row], b[row], within) << what << ' ' << row;
  }
}

void expect_near_or_absent(double a, double b, double within) {
  EXPECT_EQ(std::isnan(a), std::isnan(b));
  if (std::isnan(a)) return;
  EXPECT_NEAR(a, b, within);
}

/// What a bag holds of both. Angles of wheels are differences of sums, ranges alone single
/// precision.
void expect_same(const DrivenRecording& a, const DrivenRecording& b) {
  EXPECT_EQ(a.drive.t, b.drive.t);
  expect_same_columns(a.drive.forward, b.drive.forward, 1e-12, "forward");
  expect_same_columns(a.drive.turn, b.drive.turn, 1e-12, "turn");
  expect_same_columns(a.drive.pair.left, b.drive.pair.left, 1e-12, "left");
  expect_same_columns(a.drive.heading, b.drive.heading, 1e-12, "heading");
  ASSERT_EQ(a.sightings.size(), b.sightings.size());
  for (std::size_t k = 0; k < a.sightings.size(); ++k) {
    const Sighting& one = a.sightings[k];
    // Those of a time may come in another order.
    const auto same = std::find_if(b.sightings.begin(), b.sightings.end(), [&](const Sighting& s) {
      return s.t == one.t && s.landmark == one.landmark;
    });
    ASSERT_NE(same, b.sightings.end()) << one.landmark << " at " << one.t;
    const bool alone = std::isnan(one.bearing);
    expect_near_or_absent(one.range, same->range, alone ? 1e-6 : 1e-12);
    expect_near_or_absent(one.bearing, same->bearing, 1e-12);
    if (one.standing()) continue;
    expect_near_or_absent(one.yaw, same->yaw, 1e-12);
  }
  ASSERT_EQ(a.truth.size(), b.truth.size());
  for (std::size_t k = 0; k < a.truth.size(); ++k) {
    EXPECT_EQ(a.truth[k].t, b.truth[k].t);
    EXPECT_EQ(a.truth[k].x, b.truth[k].x);
    EXPECT_NEAR(wrap_angle(a.truth[k].heading - b.truth[k].heading), 0.0, 1e-12);
  }
  ASSERT_EQ(a.fixes.size(), b.fixes.size());
  for (std::size_t k = 0; k < a.fixes.size(); ++k) {
    EXPECT_EQ(a.fixes[k].t, b.fixes[k].t);
    EXPECT_EQ(a.fixes[k].y, b.fixes[k].y);
  }
  ASSERT_EQ(a.survey.size(), b.survey.size());
  const auto by_name = [](const SurveyPoint& p, const SurveyPoint& q) {
    return p.landmark < q.landmark;
  };
  std::vector<SurveyPoint> p = a.survey;
  std::vector<SurveyPoint> q = b.survey;
  std::sort(p.begin(), p.end(), by_name);
  std::sort(q.begin(), q.end(), by_name);
  for (std::size_t k = 0; k < p.size(); ++k) {
    EXPECT_EQ(p[k].landmark, q[k].landmark);
    EXPECT_EQ(p[k].x, q[k].x);
    expect_near_or_absent(p[k].heading, q[k].heading, 0.0);
  }
}

TEST(BagRoundTrip, ASimulatedDriveIsTheSame) {
  testing::Equipment equipment;
  equipment.range_sensor = true;
  const testing::SimulatedRecording world = testing::simulate_recording(equipment, 1);
  const LogRecording back = there_and_back(world.read, world.model);
  expect_same(world.recording, testing::driven(back.recording));
  EXPECT_EQ(back.model.robot.wheelbase, world.model.robot.wheelbase);
  EXPECT_EQ(back.model.noise, world.model.noise);
  ASSERT_EQ(back.recording.drive.covariates.size(), world.recording.drive.covariates.size());
}

/// A tricycle with tags, radios, fixes, truth, a compass that is silent at times, and a gyro.
Recording tricycle() {
  Recording recording;
  recording.name = "tricycle";
  Drive& drive = recording.drive;
  std::vector<double> wheel;
  std::vector<double> steer;
  for (std::size_t row = 0; row < 50; ++row) {
    const double k = static_cast<double>(row);
    drive.t.push_back((k + 1.0) / 10.0);
    wheel.push_back(0.03 + 0.01 * std::sin(k));
    steer.push_back(0.5 * std::sin(0.1 * k));
    drive.heading.push_back(row % 5 == 2 ? kAbsent : std::cos(0.2 * k));
    drive.yaw_rate.push_back(0.1 * std::sin(0.3 * k));
  }
  drive.covariates = {{"front", wheel}, {"steer", steer}, {"load", std::vector(50, 2.5)}};
  recording.sightings = {{0.5, "tag \"5\"", 2.0, -0.7, 1.25},
                         {0.5, "6", 3.5, 2.0, -2.0},
                         {1.0, "radio 1", 12.3, kAbsent},
                         {1.0, "radio_1", 7.5, kAbsent},
                         {1.5, "6", kAbsent, kAbsent}};
  recording.survey = {{"tag \"5\"", 1.0, 2.0, kAbsent, 0.25}, {"6", -1e-7, 3.0}};
  recording.truth = {{0.25, 1.0, 2.0, 3.0}, {1.25, -1.0, 0.5, -2.0}};
  recording.fixes = {{0.375, 100.125, -7.5}, {0.5, 101.0, -8.0}};
  return recording;
}

Model tricycle_model() {
  Model model;
  model.robot.drive = DriveKind::tricycle;
  model.robot.length = 1.5;
  model.robot.columns = {"front", "steer"};
  return model;
}

TEST(BagRoundTrip, ATricycleIsTheSame) {
  const Model model = tricycle_model();
  const DrivenRecording there = with_wheels(tricycle(), model.robot);
  const DrivenRecording back =
      with_wheels(there_and_back(tricycle(), model).recording, model.robot);
  expect_same(there, back);
  ASSERT_EQ(back.drive.wheels.size(), 2U);
  expect_same_columns(there.drive.wheels[0].reading, back.drive.wheels[0].reading, 1e-12, "wheel");
  expect_same_columns(there.drive.wheels[1].reading, back.drive.wheels[1].reading, 1e-12, "steer");
  // A mean rate is held since the message before: before the first there is none.
  ASSERT_EQ(back.drive.yaw_rate.size(), there.drive.yaw_rate.size());
  for (std::size_t row = 1; row < 50; ++row) {
    EXPECT_NEAR(back.drive.yaw_rate[row], there.drive.yaw_rate[row], 1e-9);
  }
}

TEST(BagRoundTrip, LandmarksSeenWithoutYawHaveNone) {
  const Model model = tricycle_model();
  Recording there = tricycle();
  for (Sighting& one : there.sightings) one.yaw = kAbsent;
  expect_same(with_wheels(there, model.robot),
              with_wheels(there_and_back(there, model).recording, model.robot));
}

TEST(BagRoundTrip, AnImuWithoutTheReadingIsRefused) {
  const ScratchFolder scratch;
  const Model model = tricycle_model();
  Recording there = tricycle();
  there.drive.heading.clear();
  const Bag bag = format_recording_bag(there, model);
  const auto log = scratch.write("a.mcap", bag.bytes);
  const auto map = scratch.write(
      "a.toml",
      bag.map + "\n[heading]\nfield = \"/imu/data/orientation\"\nunit = \"quaternion\"\n");
  EXPECT_THROW(static_cast<void>(read_log_recording(log, map)), InputError);
}

}  // namespace
}  // namespace trussmap::bag_round_trip_test
