// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Sensors that sit metres off the axle, as on a forklift or a car: what a calibration finds of
// simulated ones lies within three of its standard errors, by truth, fixes, landmarks or scan
// matches alone.
#include "calibration/wheel_calibration.hpp"
#include "drive/steered_motion.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/simulated_recording.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::sensor_places_test {
namespace {

constexpr Mounting kFar{3.75, -0.4, 0.3};

SimulationSettings yard(std::uint64_t seed) {
  SimulationSettings settings;
  settings.mesh = "3x3";
  settings.spacing = 15.0;
  settings.uneven = true;
  settings.tours = 1;
  settings.seed = seed;
  settings.full_turns = 2;
  settings.no_compass = true;
  settings.speeds = {0.8, 1.5};
  return settings;
}

/// The recording, and a model that knows nothing of the sensors' places.
struct Unknowing {
  Recording recording;
  Model model;
};

Unknowing unknowing(const SimulationSettings& settings, const std::vector<Effect>& effects = {}) {
  SimulatedRecording made = simulate(settings, effects);
  made.model.robot.mounted = {};
  return {std::move(made.drive.recording), std::move(made.model)};
}

/// By an antenna far from the axle, and nothing else.
Unknowing known_by_fixes(std::uint64_t seed) {
  SimulationSettings settings = yard(seed);
  settings.fix_rate = 0.5;
  settings.mounted.antenna = kFar;
  Unknowing one = unknowing(settings);
  one.recording.sightings.clear();
  one.recording.survey.clear();
  return one;
}

const CalibratedMounting* mounting_of(const WheelCalibration& found, const std::string& of) {
  const auto at = std::find_if(found.mountings.begin(), found.mountings.end(),
                               [&of](const CalibratedMounting& one) { return one.of == of; });
  return at == found.mountings.end() ? nullptr : &*at;
}

void expect_near(const std::optional<Calibrated>& found, double truth, double surest) {
  ASSERT_TRUE(found.has_value());
  EXPECT_LT(std::abs(found->value - truth), 3.0 * found->sd);
  EXPECT_LT(found->sd, surest);
}

void expect_far_place(const WheelCalibration& found, const std::string& of, bool turned = true) {
  const CalibratedMounting* at = mounting_of(found, of);
  ASSERT_NE(at, nullptr);
  expect_near(at->x, kFar.x, 0.05);
  expect_near(at->y, kFar.y, 0.05);
  if (turned) expect_near(at->yaw, kFar.yaw, 0.01);
  EXPECT_LT(found.chi2 / found.dof, 1.2);
}

/// Every second the pose of a body that is mounted there, to 2 mm and 5 mrad.
std::vector<TruthRow> tracked(const TrueMotion& motion, const Mounting& at, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<TruthRow> truth;
  for (std::size_t k = 9; k < motion.rows.size(); k += 10) {
    const Pose pose = compose(motion.rows[k].pose, {at.x, at.y, at.yaw});
    const double x = pose.x + 0.002 * normal(random);
    const double y = pose.y + 0.002 * normal(random);
    truth.push_back({motion.rows[k].t, x, y, wrap_angle(pose.heading + 0.005 * normal(random))});
  }
  return truth;
}

TEST(SensorPlaces, ThatTheTruthTracksIsFound) {
  const SimulatedRecording made = simulate(yard(1), {});
  Recording recording = made.drive.recording;
  recording.sightings.clear();
  recording.survey.clear();
  recording.truth = tracked(made.drive.motion, kFar, 11);
  const WheelCalibration found = calibrate_wheels({recording}, made.model);
  expect_far_place(found, "tracked");
  EXPECT_NEAR(found.truth.ahead, kFar.x, 0.05);
  ASSERT_TRUE(found.model.robot.mounted.tracked.has_value());
  EXPECT_EQ(found.model.robot.mounted.tracked->x, mounting_of(found, "tracked")->x->value);
}

TEST(SensorPlaces, OfAnAntennaAreFound) {
  const Unknowing one = known_by_fixes(2);
  expect_far_place(calibrate_wheels({one.recording}, one.model), "antenna", false);
}

TEST(SensorPlaces, OfASensorAreFoundByLandmarksAlone) {
  SimulationSettings settings = yard(3);
  settings.range_sensor = true;
  settings.reach = 40.0;
  settings.no_survey = true;
  settings.mounted.sensor = kFar;
  const Unknowing one = unknowing(settings);
  expect_far_place(calibrate_wheels({one.recording}, one.model), "sensor");
}

/// As Censi et al. find them, with wheels that are wrong, and a scanner that looks backwards.
TEST(SensorPlaces, OfAScannerAreFoundByScanMatchesAlone) {
  SimulationSettings settings = yard(4);
  settings.scan_every = 1.0;
  settings.loop_noise = 0.01;
  settings.loop_heading_noise = 0.003;
  settings.mounted.scanner = Mounting{3.75, -0.4, 2.9};
  Unknowing one = unknowing(settings, {catalogue_effect("wheelbase", {0.05}),
                                       catalogue_effect("wheel diameter ratio", {0.01})});
  one.recording.sightings.clear();
  one.recording.survey.clear();
  const WheelCalibration found = calibrate_wheels({one.recording}, one.model);
  const CalibratedMounting* at = mounting_of(found, "scanner");
  ASSERT_NE(at, nullptr);
  expect_near(at->x, 3.75, 0.01);
  expect_near(at->y, -0.4, 0.02);
  expect_near(at->yaw, 2.9, 0.005);
  expect_near(found.wheelbase_ratio, 1.0 / 1.05, 0.003);
  EXPECT_LT(found.chi2 / found.dof, 1.2);
}

class ScannerOf : public ::testing::TestWithParam<std::string> {};

TEST_P(ScannerOf, EveryDriveIsFoundOrSaidToBeUnknown) {
  SimulationSettings settings = yard(5);
  settings.drive = GetParam();
  settings.scan_every = 1.0;
  settings.loop_noise = 0.01;
  settings.loop_heading_noise = 0.003;
  settings.mounted.scanner = kFar;
  if (drive::has_steering(usual_robot(drive_named(settings.drive)))) settings.full_turns = 0;
  Unknowing one = unknowing(settings);
  one.recording.sightings.clear();
  one.recording.survey.clear();
  const WheelCalibration found = calibrate_wheels({one.recording}, one.model);
  const CalibratedMounting* at = mounting_of(found, "scanner");
  ASSERT_NE(at, nullptr);
  expect_near(at->x, kFar.x, 0.05);
  expect_near(at->y, kFar.y, 0.05);
  expect_near(at->yaw, kFar.yaw, 0.05);
}

INSTANTIATE_TEST_SUITE_P(SensorPlaces, ScannerOf,
                         ::testing::Values("skid-steer", "tricycle", "ackermann", "omni3",
                                           "mecanum", "wheels"),
                         [](const auto& one) {
                           std::string name = one.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(SensorPlaces, AreLeftAsStatedWhereTheDriveTellsNone) {
  SimulationSettings settings = yard(6);
  settings.mesh = "2x2";
  settings.scan_every = 1.0;
  Unknowing one = unknowing(settings);
  // Straight on: the first leg's rows alone.
  Drive& drive = one.recording.drive;
  std::size_t first = 0;
  while (first < drive.rows() && !(drive.left[first] > 0.0 && drive.right[first] > 0.0)) ++first;
  std::size_t last = first;
  while (last < drive.rows() && drive.left[last] > 0.0 && drive.right[last] > 0.0) ++last;
  ASSERT_GT(last - first, 40U);
  const double begin = drive.t[first];
  const double end = drive.t[last - 1];
  for (std::vector<double>* column : {&drive.t, &drive.left, &drive.right}) {
    *column = {column->begin() + static_cast<std::ptrdiff_t>(first),
               column->begin() + static_cast<std::ptrdiff_t>(last)};
  }
  drive.covariates.clear();
  std::erase_if(one.recording.loops,
                [&](const Loop& loop) { return loop.t < begin || loop.t2 > end; });
  one.recording.sightings.clear();
  one.recording.survey.clear();
  one.model.robot.mounted.scanner = Mounting{0.2, 0.1, 0.0};
  const WheelCalibration found = calibrate_wheels({one.recording}, one.model);
  EXPECT_EQ(mounting_of(found, "scanner"), nullptr);
  EXPECT_EQ(found.model.robot.mounted, one.model.robot.mounted);
}

/// Effects of places act on top of what is stated, once, and go into [robot].
TEST(SensorPlaces, StartFromWhatTheModelHas) {
  Unknowing one = known_by_fixes(7);
  const WheelCalibration plain = calibrate_wheels({one.recording}, one.model);
  one.model.robot.mounted.antenna = Mounting{1.0, 0.0, 0.0};
  one.model.effects.push_back(catalogue_effect("antenna ahead of the axle", {2.0}));
  const WheelCalibration found = calibrate_wheels({one.recording}, one.model);
  expect_far_place(found, "antenna", false);
  EXPECT_NEAR(found.fixes.ahead, plain.fixes.ahead, 1e-5);
  EXPECT_EQ(found.model.robot.mounted.antenna->x, mounting_of(found, "antenna")->x->value);
  EXPECT_EQ(found.model.effects.front().coefficients.front(), 0.0);
}

/// What is stated of all four, without noise, leaves nothing of what was measured.
TEST(SensorPlaces, ThatAreStatedExplainWhatTheyMeasured) {
  SimulationSettings settings = yard(8);
  settings.noise_free = true;
  settings.range_sensor = true;
  settings.markers = true;
  settings.reach = 40.0;
  settings.fix_rate = 1.0;
  settings.scan_every = 2.0;
  settings.loops = true;
  settings.mounted.sensor = Mounting{0.8, 0.3, -0.4};
  settings.mounted.antenna = Mounting{-0.5, 0.2, 0.0};
  settings.mounted.scanner = Mounting{0.6, -0.1, 1.2};
  SimulatedRecording made = simulate(settings, {});
  made.drive.recording.truth = tracked(made.drive.motion, {}, 3);
  for (TruthRow& row : made.drive.recording.truth) {
    const auto k = static_cast<std::size_t>(&row - made.drive.recording.truth.data());
    const Pose pose = compose(made.drive.motion.rows[10 * k + 9].pose, {0.4, 0.1, 0.2});
    row = {row.t, pose.x, pose.y, wrap_angle(pose.heading)};
  }
  made.model.robot.mounted.tracked = Mounting{0.4, 0.1, 0.2};
  EXPECT_LT(fit_model({made.drive.recording}, made.model).chi2, 1e-6);
  for (std::optional<Mounting> Mountings::*one :
       {&Mountings::sensor, &Mountings::antenna, &Mountings::tracked, &Mountings::scanner}) {
    Model without = made.model;
    (without.robot.mounted.*one).reset();
    EXPECT_GT(fit_model({made.drive.recording}, without).chi2, 100.0);
  }
}

}  // namespace
}  // namespace trussmap::sensor_places_test
