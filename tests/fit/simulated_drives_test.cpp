// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Simulated recordings of every drive, without noise: the effect that acted, in the model with the
// same coefficient, leaves nothing; without it much is left.
#include "effects/channel_physics.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/simulation.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::simulated_drives_test {
namespace {

struct Case {
  const char* name;
  std::vector<double> values;
};

/// Of every drive, and of those that have what it acts on.
std::vector<Case> cases() {
  return {{"wheelbase", {-0.02}},
          {"travel scale", {0.015}},
          {"wheel scale", {-0.01}},
          {"constant creep", {0.03}},
          {"cross-slope creep", {0.02, -0.03}},
          {"slope", {0.01, 0.02}},
          {"slip with speed", {-0.02}},
          {"turn scrub", {-0.045}},
          {"turn asymmetry", {0.02}},
          {"tyre drift (temperature_C)", {0.0005}},
          {"heading drift", {0.002}},
          {"compass offset", {0.1}},
          {"hard iron", {0.15, -0.1}},
          {"slippery patch (x=5, y=5, r=3)", {-0.03}},
          {"lever arm", {0.12}},
          {"range bias", {0.05}},
          {"bearing offset", {0.03}},
          {"steering offset", {0.01}},
          {"steering offset by direction", {-0.01}},
          {"steering gain", {0.03}},
          {"angle read beside the middle", {0.1}},
          {"travel read beside the middle", {-0.1}},
          {"travel read at the other axle", {0.5}},
          {"roller slip", {-0.04}},
          {"radius of wheel 1", {0.01}},
          {"radius of wheel 2", {-0.01}},
          {"radius of wheel 3", {0.01}},
          {"radius of wheel 4", {-0.01}}};
}

struct World {
  DrivenRecording recording;
  Model model;
};

World simulated(const WheeledRobot& robot, const std::vector<Effect>& effects) {
  const Mesh mesh = even_mesh({3, 3}, 5.0);
  std::mt19937_64 random(17);
  const std::vector<int> walk = make_tours(mesh, WalkKind::euler, 1, random).walk;
  DrivingStyle style;
  style.standing = 0.0;
  style.ramp = 0.5;
  World world;
  world.model.robot = robot.geometry;
  world.recording =
      with_wheels(simulate_drive(mesh, walk, style, robot, 6, {effects}).recording, robot.geometry);
  return world;
}

WheeledRobot exact_robot(DriveKind drive) {
  WheeledRobot robot;
  robot.geometry = usual_robot(drive);
  if (drive == DriveKind::ackermann) robot.geometry.wheel_left = 0.2;
  robot.range_sensor = true;
  robot.noise = kNoiseFree;
  return robot;
}

double chi2_of(const World& world) {
  FitOptions options;
  options.fit_effects = false;
  return fit_model({world.recording}, world.model, options).chi2;
}

class SimulatedDrives : public ::testing::TestWithParam<DriveKind> {};

TEST_P(SimulatedDrives, EffectsWithTheirCoefficientsLeaveNothing) {
  const WheeledRobot robot = exact_robot(GetParam());
  EXPECT_LT(chi2_of(simulated(robot, {})), 1e-6);
  int tried = 0;
  for (const Case& one : cases()) {
    const Effect effect = catalogue_effect(one.name, one.values);
    if (!effects::is_of_drive(effect.channel, robot.geometry)) continue;
    World world = simulated(robot, {effect});
    const double without = chi2_of(world);
    world.model.effects = {effect};
    const double with = chi2_of(world);
    EXPECT_LT(with, 1e-6) << one.name;
    EXPECT_GT(without, 5.0) << one.name;
    ++tried;
  }
  EXPECT_GE(tried, GetParam() == DriveKind::unicycle ? 17 : 19);  // it has no wheels of its own
}

/// The inner wheels of a turn go backwards, so that each wheel's own share matters, and six of them
/// are more than needed.
TEST(SimulatedSkidSteer, HasTwoFourOrSixWheels) {
  for (const std::size_t count : {2U, 4U, 6U}) {
    WheeledRobot robot = exact_robot(DriveKind::skid_steer);
    robot.geometry.columns.clear();
    for (std::size_t k = 0; k < count; ++k) {
      robot.geometry.columns.push_back("w" + std::to_string(k));
    }
    const Effect effect =
        catalogue_effect("radius of wheel " + std::to_string(count), std::vector<double>{0.02});
    World world = simulated(robot, {effect});
    world.model.effects = {effect};
    EXPECT_LT(chi2_of(world), 1e-6);
  }
}

/// Two that act on one row: side by side.
TEST_P(SimulatedDrives, TwoEffectsActSideBySide) {
  const WheeledRobot robot = exact_robot(GetParam());
  const std::vector<Effect> effects = {
      catalogue_effect("wheelbase", {0.05}), catalogue_effect("wheel scale", {-0.03}),
      catalogue_effect("travel scale", {0.04}), catalogue_effect("heading drift", {0.001})};
  World world = simulated(robot, effects);
  world.model.effects = effects;
  EXPECT_LT(chi2_of(world), 1e-6);
}

/// Odometry that comes as increments of the body has no wheels that could be seen.
TEST(SimulatedIncrements, AreThoseOfTheMatrix) {
  WheeledRobot robot = exact_robot(DriveKind::wheels);
  robot.geometry.places.clear();
  robot.geometry.columns = {"ahead", "aside", "turn"};
  robot.geometry.matrix = Eigen::MatrixXd::Identity(3, 3);
  const Effect effect = catalogue_effect("radius of wheel 2", {0.02});
  World world = simulated(robot, {effect});
  EXPECT_GT(chi2_of(world), 5.0);
  world.model.effects = {effect};
  EXPECT_LT(chi2_of(world), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Drives, SimulatedDrives,
                         ::testing::Values(DriveKind::unicycle, DriveKind::skid_steer,
                                           DriveKind::tricycle, DriveKind::ackermann,
                                           DriveKind::omni3, DriveKind::mecanum, DriveKind::wheels),
                         [](const auto& one) {
                           std::string name(name_of(one.param));
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace trussmap::simulated_drives_test
