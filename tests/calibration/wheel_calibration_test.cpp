// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Known wheels are found again, with honest errors; what a motion does not show is said.
#include "calibration/wheel_calibration.hpp"

#include "calibration/truth_holdout.hpp"
#include "driven.hpp"
#include "estimation/drawn_drive.hpp"
#include "estimation/simulated_recordings.hpp"
#include "shared_data.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"

#include <cmath>
#include <filesystem>
#include <utility>

#include <gtest/gtest.h>

namespace trussmap::wheel_calibration_test {
using namespace calibration;
namespace {

using testing::draw;
using testing::DrawnRobot;
using testing::figure;
using testing::Stretch;

Model model_of(const DrawnRobot& robot) {
  Model model;
  model.robot.wheelbase = robot.nominal_wheelbase;
  model.noise.truth = robot.truth_sd > 0.0 ? robot.truth_sd : 0.001;
  model.noise.truth_heading = robot.truth_heading_sd > 0.0 ? robot.truth_heading_sd : 0.002;
  return model;
}

DrawnRobot faulty() {
  DrawnRobot robot;
  robot.E_d = 1.004;
  robot.E_b = 0.97;
  robot.E_s = 1.02;
  return robot;
}

WheelCalibrationOptions without_noise() {
  WheelCalibrationOptions options;
  options.noise = false;
  return options;
}

/// Wheels explain the twist of a, not the compass of b, which pulls the estimates to and fro.
TEST(SlowWheelCalibration, SaysWhereItHasNotSettled) {
  TRUSSMAP_NEEDS_SHARED("data/hidden");
  for (const auto& [name, settled] : {std::pair{"a", true}, std::pair{"b", false}}) {
    const std::filesystem::path folder = testing::shared("data/hidden") / name;
    const WheelCalibration found =
        calibrate_wheels({read_recording(folder)}, read_model(folder / "model.toml"));
    EXPECT_EQ(found.settled, settled) << name;
  }
}

TEST(WheelCalibration, ExactRecordingsGiveTheWheelsExactly) {
  DrawnRobot robot = faulty();
  robot.ahead = 0.05;
  robot.left = -0.02;
  robot.heading = 0.03;
  const WheelCalibration found =
      calibrate_wheels({testing::driven(draw(figure(), robot))}, model_of(robot), without_noise());
  ASSERT_TRUE(found.diameter_ratio && found.wheelbase_ratio && found.scale);
  EXPECT_TRUE(found.undetermined.empty());
  // The priors of the truth's alignment pull a little.
  EXPECT_NEAR(found.diameter_ratio->value, robot.E_d, 2e-5);
  EXPECT_NEAR(found.wheelbase_ratio->value, robot.E_b, 2e-5);
  EXPECT_NEAR(found.scale->value, robot.E_s, 2e-5);
  EXPECT_NEAR(found.truth.ahead, robot.ahead, 1e-3);
  EXPECT_NEAR(found.truth.left, robot.left, 1e-3);
  EXPECT_NEAR(found.truth.heading, robot.heading, 1e-3);
}

TEST(WheelCalibration, SecondRecordingsAndGivenCoefficientsChangeNothing) {
  const DrawnRobot robot = faulty();
  const Recording one = draw(figure(), robot);
  const WheelCalibration first = calibrate_wheels({testing::driven(one), testing::driven(one)},
                                                  model_of(robot), without_noise());
  const WheelCalibration again =
      calibrate_wheels({testing::driven(one), testing::driven(one)}, first.model, without_noise());
  EXPECT_NEAR(again.diameter_ratio->value, first.diameter_ratio->value, 1e-8);
  EXPECT_NEAR(again.wheelbase_ratio->value, first.wheelbase_ratio->value, 1e-8);
  EXPECT_NEAR(again.scale->value, first.scale->value, 1e-8);
}

TEST(WheelCalibration, TheFoundModelReckonsTheDrive) {
  const DrawnRobot robot = faulty();
  const std::vector<Recording> one = {draw(figure(), robot)};
  const WheelCalibration found =
      calibrate_wheels(testing::driven(one), model_of(robot), without_noise());
  EXPECT_GT(drive_errors(one, model_of(robot)).front().end, 0.3);
  EXPECT_LT(drive_errors(one, found.model).front().end, 0.005);
}

TEST(WheelCalibration, ALateAndDriftingClockIsNoWheelError) {
  DrawnRobot robot = faulty();
  robot.late = 0.12;
  robot.clock = 7e-4;
  const WheelCalibration found =
      calibrate_wheels({testing::driven(draw(figure(), robot))}, model_of(robot), without_noise());
  EXPECT_NEAR(found.diameter_ratio->value, robot.E_d, 1e-4);
  EXPECT_NEAR(found.wheelbase_ratio->value, robot.E_b, 3e-4);
  EXPECT_NEAR(found.scale->value, robot.E_s, 1e-4);
  ASSERT_EQ(found.truth.clocks.size(), 1U);
  EXPECT_NEAR(found.truth.clocks.at(0).late, robot.late, 0.002);
  EXPECT_NEAR(found.truth.clocks.at(0).drift, robot.clock, 3e-5);
}

TEST(WheelCalibration, StraightLinesDoNotTellTheWheelbase) {
  const DrawnRobot robot;
  const WheelCalibration found = calibrate_wheels(
      {testing::driven(draw({{1.0, 0.0, 0.0}, {20.0, 0.5, 0.0}, {1.0, 0.0, 0.0}}, robot))},
      model_of(robot), without_noise());
  EXPECT_FALSE(found.wheelbase_ratio);
  EXPECT_TRUE(found.diameter_ratio);
  EXPECT_TRUE(found.scale);
  ASSERT_EQ(found.undetermined.size(), 1U);
  EXPECT_EQ(found.undetermined[0],
            "E_b (wheelbase / nominal): the robot hardly turns; drive turns, both ways");
}

TEST(WheelCalibration, SpinsDoNotTellLargerWheelsFromASmallerWheelbase) {
  const DrawnRobot robot;
  const WheelCalibration found = calibrate_wheels(
      {testing::driven(draw({{1.0, 0.0, 0.0}, {10.0, 0.0, 0.8}, {10.0, 0.0, -0.8}}, robot))},
      model_of(robot), without_noise());
  EXPECT_TRUE(found.wheelbase_ratio);
  EXPECT_FALSE(found.scale);
  ASSERT_FALSE(found.undetermined.empty());
  EXPECT_EQ(found.undetermined.back().rfind("E_s (true / measured travel)", 0), 0U);
}

TEST(WheelCalibration, NothingThatMeasuresDistanceMeansNoScale) {
  const testing::SimulatedRecording one = testing::simulate_recording({true, false, false}, 3);
  const WheelCalibration found = calibrate_wheels({one.recording}, one.model, without_noise());
  EXPECT_TRUE(found.wheelbase_ratio);
  EXPECT_FALSE(found.scale);
  ASSERT_EQ(found.undetermined.size(), 1U);
  EXPECT_EQ(found.undetermined[0],
            "E_s (true / measured travel): nothing in use measures a distance; add a survey, "
            "truth, or loops between poses far apart");
}

TEST(WheelCalibration, ASurveyDoesAsWell) {
  const testing::SimulatedRecording one = testing::simulate_recording({true, true, false}, 3);
  const WheelCalibration found = calibrate_wheels({one.recording}, one.model, without_noise());
  ASSERT_TRUE(found.diameter_ratio && found.wheelbase_ratio && found.scale);
  EXPECT_TRUE(found.undetermined.empty());
  EXPECT_NEAR(found.diameter_ratio->value, 1.0, 4.0 * found.diameter_ratio->sd);
  EXPECT_NEAR(found.wheelbase_ratio->value, 1.0, 4.0 * found.wheelbase_ratio->sd);
  EXPECT_NEAR(found.scale->value, 1.0, 4.0 * found.scale->sd);
}

/// Nonsense, were it used.
TEST(WheelCalibration, TruthThatIsNotWantedChangesNothing) {
  testing::SimulatedRecording one = testing::simulate_recording({true, true, false}, 3);
  WheelCalibrationOptions options = without_noise();
  options.problem.truth = false;
  one.recording.truth.clear();
  const WheelCalibration without = calibrate_wheels({one.recording}, one.model, options);
  for (const double t : one.recording.drive.t) {
    one.recording.truth.push_back({t, 1000.0 - t, std::sin(t), 0.1 * t});
  }
  const WheelCalibration with = calibrate_wheels({one.recording}, one.model, options);
  EXPECT_EQ(with.chi2, without.chi2);
  EXPECT_EQ(with.dof, without.dof);
  EXPECT_EQ(with.undetermined, without.undetermined);
  ASSERT_TRUE(with.diameter_ratio && without.diameter_ratio);
  EXPECT_EQ(with.diameter_ratio->value, without.diameter_ratio->value);
  EXPECT_EQ(with.diameter_ratio->sd, without.diameter_ratio->sd);
  ASSERT_TRUE(with.scale && without.scale);
  EXPECT_EQ(with.scale->value, without.scale->value);
}

/// Mean and scatter of estimates in units of their standard errors, about a known value.
class Standardised {
 public:
  void add(const std::optional<Calibrated>& one, double known) {
    ASSERT_TRUE(one);
    const double z = (one->value - known) / one->sd;
    sum_ += z;
    squares_ += z * z;
    ++n_;
  }
  /// Over n estimates the mean of z has sd 1/sqrt(n), its rms 1/sqrt(2 n).
  void expect_honest(const char* name) const {
    EXPECT_LT(std::abs(sum_ / n_), 3.5 / std::sqrt(n_)) << name;
    EXPECT_NEAR(std::sqrt(squares_ / n_), 1.0, 3.5 / std::sqrt(2.0 * n_)) << name;
  }

 private:
  double sum_ = 0.0;
  double squares_ = 0.0;
  int n_ = 0;
};

TEST(SlowWheelCalibration, StandardErrorsAreTheScatterAndNoiseIsUnbiased) {
  constexpr std::uint64_t kSeeds = 40;  // 1 to 40
  DrawnRobot robot = faulty();
  robot.k_left = 0.002;
  robot.k_right = 0.004;
  robot.truth_sd = 0.001;
  robot.truth_heading_sd = 0.005;
  Model model = model_of(robot);
  model.noise.left = model.noise.right = 0.003;
  Standardised E_d;
  Standardised E_b;
  Standardised E_s;
  Standardised k_left;
  Standardised k_right;
  double reduced = 0.0;
  double dof = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const WheelCalibration found =
        calibrate_wheels({testing::driven(draw(figure(), robot, seed))}, model);
    E_d.add(found.diameter_ratio, robot.E_d);
    E_b.add(found.wheelbase_ratio, robot.E_b);
    E_s.add(found.scale, robot.E_s);
    k_left.add(found.noise_left, robot.k_left);
    k_right.add(found.noise_right, robot.k_right);
    reduced += found.chi2 / found.dof / kSeeds;
    dof += found.dof;
  }
  E_d.expect_honest("E_d");
  E_b.expect_honest("E_b");
  E_s.expect_honest("E_s");
  k_left.expect_honest("k_left");
  k_right.expect_honest("k_right");
  // k is fitted to chi^2, so it scatters less than 2/dof; never more.
  EXPECT_NEAR(reduced, 1.0, 3.5 * std::sqrt(2.0 / dof));
}

TEST(TruthHoldout, StretchesAreTheLegsThatAreNotHeldOut) {
  const std::vector<DrivenRecording> recordings = {testing::driven(draw(figure(), {})),
                                                   testing::driven(draw(figure(), {}))};
  const std::vector<TruthLeg> legs = truth_legs(recordings, 0.3, 1.0);
  int held = 0;
  for (const TruthLeg& leg : legs) held += leg.held_out ? 1 : 0;
  EXPECT_EQ(legs.size(), 64U);  // of 66 m: a leg ends with the row that completes a metre
  EXPECT_EQ(held, 15);          // blocks 4, 7 and 10 of five legs each
  const TrainingSegments training_segments = without_held_out(recordings, legs);
  EXPECT_EQ(training_segments.sessions.size(), training_segments.recordings.size());
  for (const TruthLeg& leg : legs) {
    const double middle = 0.5 * (recordings[0].truth[leg.from].t + recordings[0].truth[leg.to].t);
    bool inside = false;
    for (std::size_t k = 0; k < training_segments.recordings.size(); ++k) {
      const DrivenRecording& one = training_segments.recordings[k];
      inside = inside || (training_segments.sessions[k] == leg.session &&
                          one.truth.front().t < middle && middle < one.truth.back().t);
    }
    EXPECT_EQ(inside, !leg.held_out);
  }
}

TEST(TruthHoldout, ArrivalErrorsComeFromTheWheelsAlone) {
  DrawnRobot robot;
  robot.E_s = 1.01;
  const std::vector<DrivenRecording> straight = {
      testing::driven(draw({{1.0, 0.0, 0.0}, {60.0, 0.5, 0.0}, {1.0, 0.0, 0.0}}, robot))};
  const ArrivalErrors nominal =
      arrival_errors(straight, truth_legs(straight, 0.3, 1.0), model_of(robot));
  ASSERT_GT(nominal.legs(), 4);
  // A leg ends with the row that completes a metre by the wheels: 1.01 to 1.06 m of true way.
  EXPECT_GT(nominal.rms(), 0.0099);
  EXPECT_LT(nominal.rms(), 0.0106);
}

TEST(DriveErrors, AreTheEndsDistanceAndTheHeadingPerMetreOfTheWheels) {
  // Nominal wheels turn by 0.34 m x 2 rad too much or too little: E_b alone, on the spot.
  DrawnRobot robot;
  robot.E_b = 1.05;
  const std::vector<Recording> spin = {draw({{1.0, 0.0, 0.0}, {10.0, 0.0, 0.2}}, robot)};
  const DriveError turned = drive_errors(spin, model_of(robot)).front();
  EXPECT_NEAR(turned.heading, 2.0 * 0.05, 1e-9);
  EXPECT_NEAR(turned.driven, 0.5 * 0.34 * 1.05 * 2.0, 1e-9);
  EXPECT_NEAR(turned.end, 0.0, 1e-9);

  robot = {};
  robot.E_s = 1.02;
  const std::vector<Recording> straight = {draw({{1.0, 0.0, 0.0}, {10.0, 0.5, 0.0}}, robot)};
  const DriveError driven = drive_errors(straight, model_of(robot)).front();
  EXPECT_NEAR(driven.end, 5.0 * (1.0 - 1.0 / 1.02), 1e-9);
  EXPECT_NEAR(driven.heading, 0.0, 1e-12);
  EXPECT_NEAR(driven.driven, 5.0 / 1.02, 1e-9);
}

TEST(DriveErrors, NeedTruth) {
  Recording bare = draw(figure(), {});
  bare.truth.resize(1);
  EXPECT_THROW(static_cast<void>(drive_errors({bare}, Model())), InputError);
}

}  // namespace
}  // namespace trussmap::wheel_calibration_test
