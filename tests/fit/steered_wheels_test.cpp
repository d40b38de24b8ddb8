// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Steered robots whose wheels are not those that the model says: their kinematics beside plain
// geometry, and fits that steer past what is possible on their way.
#include "drive/steered_motion.hpp"
#include "effects/channel_physics.hpp"
#include "effects/steering.hpp"
#include "fit/effect_columns.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/simulated_recording.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::steered_wheels_test {
using namespace drive;
using namespace effects;
namespace {

constexpr double kLength = 1.3;  // m

/// What a wheel at a place of a body that turns about (0, radius) shows of `ahead` m of the
/// reference point's way: its travel, and where it points.
struct Shown {
  double travel = 0.0;
  double angle = 0.0;
};

Shown shown_at(double x, double y, double ahead, double radius) {
  const double turn = ahead / radius;
  const double way_x = ahead - turn * y;
  const double way_y = turn * x;
  return {std::hypot(way_x, way_y) * (way_x < 0.0 ? -1.0 : 1.0), std::atan(way_y / way_x)};
}

Robot robot_of(DriveKind drive, double wheel_left, double steer_left) {
  Robot robot;
  robot.drive = drive;
  robot.columns = {"wheel", "steer"};
  robot.length = robot.wheelbase = kLength;
  robot.wheel_left = wheel_left;
  robot.steer_left = steer_left;
  return robot;
}

TEST(SteeredWheels, MoveTheBodyAsTheirPlacesGo) {
  int tried = 0;
  for (const double left : {-0.4, 0.0, 0.3}) {
    for (const double steer_left : {-0.35, 0.0, 0.5}) {
      for (const double radius : {-6.0, -1.1, 0.9, 4.0}) {
        constexpr double kAhead = 0.02;
        const Shown front = shown_at(kLength, steer_left, kAhead, radius);
        const double rear = kAhead * (1.0 - left / radius);
        const SteeredMotion car =
            steered_motion(robot_of(DriveKind::ackermann, left, steer_left), rear, front.angle);
        const SteeredMotion fork = steered_motion(robot_of(DriveKind::tricycle, 0.0, steer_left),
                                                  front.travel, front.angle);
        ASSERT_TRUE(car.possible && fork.possible);
        for (const SteeredMotion& one : {car, fork}) {
          EXPECT_NEAR(one.motion[0], kAhead, 1e-14);
          EXPECT_NEAR(one.motion[2], kAhead / radius, 1e-14);
        }
        ++tried;
      }
    }
  }
  EXPECT_EQ(tried, 36);
}

TEST(SteeredWheels, ThatStandMoveNothingWhereverTheyPoint) {
  const Robot robot = robot_of(DriveKind::ackermann, 0.3, 0.0);
  const SteeredMotion standing = steered_motion(robot, 0.0, 2.0);
  EXPECT_TRUE(standing.possible);
  EXPECT_TRUE(standing.motion.isZero(0.0));
  EXPECT_TRUE(standing.by_reading[1].allFinite());
  EXPECT_FALSE(steered_motion(robot, 0.01, 2.0).possible);
}

/// The columns of the places beside differences of the kinematics, where effects act already.
TEST(SteeredWheels, HaveColumnsThatAreThoseOfDifferences) {
  constexpr double kStep = 1e-6;
  constexpr double kTravel = 0.05;
  int tried = 0;
  for (const DriveKind drive : {DriveKind::tricycle, DriveKind::ackermann}) {
    const Robot robot = robot_of(drive, drive == DriveKind::tricycle ? 0.0 : 0.25, -0.2);
    for (const double angle : {-0.8, -0.1, 0.4, 0.9}) {
      Recording raw;
      raw.drive.t = {0.0, 0.1};
      raw.drive.covariates = {{"wheel", {0.0, kTravel}}, {"steer", {0.0, angle}}};
      const DrivenRecording recording = with_wheels(raw, robot);
      for (const Channel channel : {Channel::wheel_left, Channel::steer_left}) {
        if (!is_of_drive(channel, robot)) continue;
        SteeringChange more;
        SteeringChange less;
        add_steering(channel, kStep, angle, more);
        add_steering(channel, -kStep, angle, less);
        const Eigen::Vector3d slope = (steered_motion(robot, kTravel, angle, more).motion -
                                       steered_motion(robot, kTravel, angle, less).motion) /
                                      (2.0 * kStep);
        const DrivePattern column =
            drive_pattern(channel, 1.0, row_motion(recording.drive, 1, robot));
        EXPECT_NEAR(column.advance, slope[0], 1e-9) << name_of(channel);
        EXPECT_NEAR(column.turn, slope[2], 1e-9) << name_of(channel);
        ++tried;
      }
    }
  }
  EXPECT_EQ(tried, 12);
}

SimulationSettings yard(const std::string& drive, std::uint64_t seed) {
  SimulationSettings settings;
  settings.mesh = "3x3";
  settings.spacing = 6.0;
  settings.tours = 1;
  settings.seed = seed;
  settings.drive = drive;
  settings.no_compass = true;
  settings.range_sensor = true;
  return settings;
}

/// Steps of Gauss and Newton lead past where the inner wheel would go backwards.
TEST(SteeredFit, ShortensStepsThatLeaveAWheelNoWay) {
  SimulationSettings settings = yard("ackermann", 3);
  settings.wheel_left = 0.3;
  const SimulatedRecording made = simulate(settings, {catalogue_effect("steering offset", {-0.15}),
                                                      catalogue_effect("steering gain", {-0.2})});
  Model model = made.model;
  model.effects = {catalogue_effect("steering offset", {0.3}),
                   catalogue_effect("steering gain", {0.9})};
  ModelFit fit;
  ASSERT_NO_THROW(fit = fit_model({made.drive.recording}, model));
  // The start itself was none.
  const std::vector<DrivenRecording> driven =
      with_wheels(std::vector{made.drive.recording}, model.robot);
  EXPECT_FALSE(fitting::leave_a_way(model.effects, driven, model.robot, {}));
  EXPECT_TRUE(fitting::leave_a_way(fit.model.effects, driven, model.robot, {}));
}

/// The same, held as they are: no row of the robot's can be driven so.
TEST(SteeredFit, NamesTheRowThatGivenEffectsLeaveNoWay) {
  SimulationSettings settings = yard("ackermann", 3);
  const SimulatedRecording made = simulate(settings, {});
  Model model = made.model;
  model.effects = {catalogue_effect("steering offset", {1.2})};
  FitOptions held;
  held.fit_effects = false;
  try {
    static_cast<void>(fit_model({made.drive.recording}, model, held));
    ADD_FAILURE() << "a wheel past a right angle was driven";
  } catch (const std::invalid_argument& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("\"steering offset\""), std::string::npos) << said;
    EXPECT_NE(said.find("at t = "), std::string::npos) << said;
    EXPECT_NE(said.find("expected"), std::string::npos) << said;
  }
}

/// A gain turns the noise of what is read as well.
TEST(SteeredFit, LeavesNoMoreThanNoiseWithALargeGain) {
  SimulationSettings settings = yard("ackermann", 5);
  settings.tours = 2;
  const Effect gain = catalogue_effect("steering gain", {0.5});
  const SimulatedRecording made = simulate(settings, {gain});
  Model model = made.model;
  model.effects = {gain};
  FitOptions held;
  held.fit_effects = false;
  const ModelFit fit = fit_model({made.drive.recording}, model, held);
  ASSERT_GT(fit.dof, 80);
  EXPECT_LT(fit.chi2 / fit.dof, 1.0 + 4.0 * std::sqrt(2.0 / fit.dof));
  EXPECT_GT(fit.chi2 / fit.dof, 1.0 - 4.0 * std::sqrt(2.0 / fit.dof));
}

/// About the map without it a fit of it is lost, worse than that.
TEST(SlowSteeredFit, FindsAWheelbaseThatIsFarOff) {
  SimulationSettings settings;
  settings.mesh = "4x5";
  settings.uneven = settings.rests = true;
  settings.tours = 4;
  settings.seed = 5;
  settings.drive = "ackermann";
  const SimulatedRecording made = simulate(settings, {catalogue_effect("wheelbase", {-0.3})});
  Model model = made.model;
  model.effects = {catalogue_effect("wheelbase")};
  const ModelFit fit = fit_model({made.drive.recording}, model);
  EXPECT_NEAR(fit.effects.front().effect.coefficients.at(0), -0.3, 4.0 * fit.effects.front().sd[0]);
  EXPECT_LT(fit.chi2 / fit.dof, 1.0 + 4.0 * std::sqrt(2.0 / fit.dof));
}

class SlowSteeredDiagnosis
    : public ::testing::TestWithParam<std::pair<const char*, std::pair<const char*, double>>> {};

/// A forklift whose angle is read beside the middle has no sensor that sits elsewhere.
TEST_P(SlowSteeredDiagnosis, NamesTheWheelThatIsRead) {
  const auto& [drive, effect] = GetParam();
  const SimulatedRecording made =
      simulate(yard(drive, 11), {catalogue_effect(effect.first, {effect.second})});
  const Diagnosis found = diagnose({made.drive.recording}, made.model);
  ASSERT_FALSE(found.findings.empty());
  const Finding& first = found.findings.front();
  EXPECT_EQ(first.effect.name, effect.first);
  EXPECT_EQ(first.status, Status::missing);
}

INSTANTIATE_TEST_SUITE_P(
    Wheels, SlowSteeredDiagnosis,
    ::testing::Values(std::pair{"ackermann", std::pair{"angle read beside the middle", 0.06}},
                      std::pair{"ackermann", std::pair{"angle read beside the middle", -0.2}},
                      std::pair{"ackermann", std::pair{"travel read beside the middle", 0.06}},
                      std::pair{"ackermann", std::pair{"travel read beside the middle", -0.2}},
                      std::pair{"ackermann", std::pair{"travel read at the other axle", 1.0}},
                      std::pair{"tricycle", std::pair{"angle read beside the middle", 0.1}}),
    [](const auto& one) { return std::string(one.param.first) + std::to_string(one.index); });

}  // namespace
}  // namespace trussmap::steered_wheels_test
