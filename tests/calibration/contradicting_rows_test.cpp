// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Labels read as others', beside a survey: a calibration leaves them out, and finds what the same
// recording without them shows.
#include "calibration/contradicting_rows.hpp"

#include "trussmap/calibrate.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/error.hpp"
#include "trussmap/simulated_recording.hpp"
#include "wrong_labels.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace trussmap::contradicting_rows_test {
namespace {

constexpr double kTurn = 0.07;    // further than the wheels say
constexpr double kTravel = 0.03;  // likewise
constexpr Mounting kSensor{0.3, 0.0, 0.0};

SimulatedRecording surveyed_hall(std::uint64_t seed) {
  SimulationSettings settings = testing::seen_hall("4x4", seed);
  settings.mounted.sensor = kSensor;
  Effect turn = catalogue_effect("wheelbase");
  turn.coefficients = {kTurn};
  Effect travel = catalogue_effect("travel scale");
  travel.coefficients = {kTravel};
  return simulate(settings, {turn, travel});
}

struct Spoilt {
  Recording recording;
  std::size_t wrong = 0;  ///< labels
};

Spoilt with_wrong_labels(const SimulatedRecording& made, double share, std::uint64_t seed) {
  Spoilt result{made.drive.recording, 0};
  result.wrong = testing::spoil_labels(result.recording, share, seed).size();
  return result;
}

void expect_same(const std::optional<Calibrated>& one, const std::optional<Calibrated>& clean) {
  ASSERT_TRUE(one && clean);
  EXPECT_NEAR(one->value, clean->value, clean->sd);
  EXPECT_NEAR(one->sd, clean->sd, 0.15 * clean->sd);
}

/// Seed 4; labels of seed 2.
TEST(SlowContradictingRows, WrongLabelsLeaveTheConstantsAsTheyAre) {
  const SimulatedRecording hall = surveyed_hall(4);
  const WheelCalibration clean =
      calibrate_wheels({with_wrong_labels(hall, 0.0, 1).recording}, hall.model, {});
  EXPECT_TRUE(clean.left_out.empty());
  for (const double share : {0.02, 0.05}) {
    const Spoilt spoilt = with_wrong_labels(hall, share, 2);
    ASSERT_GE(spoilt.wrong, 2U);
    const WheelCalibration found = calibrate_wheels({spoilt.recording}, hall.model, {});
    EXPECT_EQ(found.left_out.size(), spoilt.wrong) << share;
    expect_same(found.diameter_ratio, clean.diameter_ratio);
    expect_same(found.wheelbase_ratio, clean.wheelbase_ratio);
    expect_same(found.scale, clean.scale);
    EXPECT_LT(found.chi2 / found.dof, 1.3);
    EXPECT_NEAR(found.noise_left->value, clean.noise_left->value, clean.noise_left->sd);
    EXPECT_NEAR(found.noise_right->value, clean.noise_right->value, clean.noise_right->sd);
  }
}

/// Where a calibration is to use all it says of each row that it fits badly.
TEST(SlowContradictingRows, NoneWithoutAGate) {
  const SimulatedRecording hall = surveyed_hall(4);
  CalibrationOptions all;
  all.gate = 0.0;
  try {
    const WheelCalibration found =
        calibrate_wheels({with_wrong_labels(hall, 0.02, 2).recording}, hall.model, all);
    EXPECT_TRUE(found.left_out.empty());
    EXPECT_GT(found.chi2 / found.dof, 10.0);
  } catch (const SolveError&) {  // lost its way: as bad
  }
}

/// A survey in feet contradicts far more rows than are ever misread: nothing is left out.
TEST(SlowContradictingRows, ASurveyInOtherUnitsIsNotLeftOut) {
  const SimulatedRecording hall = surveyed_hall(4);
  Recording in_feet = hall.drive.recording;
  for (SurveyPoint& point : in_feet.survey) {
    point.x *= 3.28084;
    point.y *= 3.28084;
  }
  try {
    EXPECT_TRUE(calibrate_wheels({in_feet}, hall.model, {}).left_out.empty());
  } catch (const SolveError&) {  // as good: it is told that this is no robot
  }
}

/// Rows 1 and 3 of the sightings of the second of two; a row named twice goes once.
TEST(ContradictingRows, AreTakenOutByTheirPlace) {
  std::vector<DrivenRecording> two(2);
  for (DrivenRecording& one : two) {
    one.sightings.resize(5);
    for (std::size_t k = 0; k < 5; ++k) one.sightings[k].t = static_cast<double>(k);
  }
  const std::vector<DrivenRecording> left =
      calibration::without_rows(two, {{estimation::RecordingStream::sightings, 1, 3, ""},
                                      {estimation::RecordingStream::sightings, 1, 1, ""},
                                      {estimation::RecordingStream::sightings, 1, 3, ""}});
  EXPECT_EQ(left[0].sightings.size(), 5U);
  std::vector<double> times;
  for (const Sighting& one : left[1].sightings) times.push_back(one.t);
  EXPECT_EQ(times, (std::vector<double>{0.0, 2.0, 4.0}));
}

}  // namespace
}  // namespace trussmap::contradicting_rows_test
