// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What robots on other wheels than two record: each wheel's own way in the rigid body, by the poses
// alone, and how they drive.
#include "other_drives.hpp"

#include "effects/channel_physics.hpp"
#include "geometry/index.hpp"
#include "simulation/driving_manner.hpp"
#include "simulation/hidden_effects.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::other_drives_test {
using namespace simulation;
namespace {

using testing::other_drive;
using testing::OtherDrive;
using testing::Twist;

constexpr DriveKind kDrives[] = {DriveKind::skid_steer, DriveKind::tricycle, DriveKind::ackermann,
                                 DriveKind::omni3,      DriveKind::mecanum,  DriveKind::wheels};

struct World {
  Mesh mesh;
  std::vector<int> walk;
  SimulatedDrive drive;
};

World simulate(const Robot& geometry, const SensorNoise& noise = kNoiseFree,
               const RoughNoise& rough = {}) {
  World world;
  world.mesh = even_mesh({4, 4}, 5.0);
  std::mt19937_64 random(29);
  world.walk = make_tours(world.mesh, WalkKind::euler, 2, random).walk;
  WheeledRobot robot;
  robot.geometry = geometry;
  robot.noise = noise;
  robot.rough = rough;
  DrivingStyle style;
  style.full_spins = 2;
  style.rest_share = 0.1;
  world.drive = simulate_drive(world.mesh, world.walk, style, robot, 5);
  return world;
}

/// By two poses alone: the twist of the arc from one to the other.
Twist between(const Pose& from, const Pose& to) {
  const double turn = to.heading - from.heading;
  const double half = 0.5 * turn;
  const double chord = std::abs(half) < 1e-12 ? 1.0 : std::sin(half) / half;
  const Vector2 way = rotation(-(from.heading + half)) * (to.position() - from.position()) / chord;
  return {way.x(), way.y(), turn};
}

class SimulatedWheels : public ::testing::TestWithParam<DriveKind> {};

TEST_P(SimulatedWheels, ShowTheWayOfTheirOwnPlace) {
  const OtherDrive drive = other_drive(GetParam());
  const World world = simulate(drive.model.robot);
  const TrueMotion& motion = world.drive.motion;
  const Drive& recorded = world.drive.recording.drive;
  EXPECT_TRUE(recorded.left.empty());
  for (std::size_t row = 0; row < motion.rows.size(); ++row) {
    Twist twist =
        between(row == 0 ? motion.start : motion.rows[row - 1].pose, motion.rows[row].pose);
    const bool rests = motion.rows[row].activity == Activity::rest;
    // A tricycle that drives backwards has its wheel ahead and turning backwards.
    const bool back = drive.steers && motion.rows[row].speed < 0.0;
    if (back && GetParam() == DriveKind::tricycle) twist = {-twist.f, -twist.s, -twist.a};
    std::vector<double> expected = drive.wheels(twist);
    if (back && GetParam() == DriveKind::tricycle) expected[0] = -expected[0];
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const bool angle = drive.steers && k == 1;
      if (angle && rests) continue;
      ASSERT_NEAR(recorded.covariates[k].values[row], expected[k], angle ? 1e-9 : 1e-12)
          << "row " << row << ", column " << k;
      EXPECT_EQ(recorded.covariates[k].name, drive.model.robot.columns[k]);
    }
  }
}

/// Variance by variance: k^2 |travel| of each wheel, q^2/|travel| of the angle.
TEST_P(SimulatedWheels, HaveTheNoiseThatIsStated) {
  const OtherDrive drive = other_drive(GetParam());
  SensorNoise noise = kNoiseFree;
  noise.left = 0.003;
  noise.right = 0.005;
  noise.steer = 0.004;
  const Drive exact = simulate(drive.model.robot).drive.recording.drive;
  const Drive noisy = simulate(drive.model.robot, noise).drive.recording.drive;
  const double variance = 0.5 * (0.003 * 0.003 + 0.005 * 0.005);
  for (std::size_t k = 0; k < drive.model.robot.columns.size(); ++k) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t row = 0; row < exact.rows(); ++row) {
      const double error = noisy.covariates[k].values[row] - exact.covariates[k].values[row];
      const bool angle = drive.steers && k == 1;
      const double travel = std::abs(exact.covariates[angle ? 0 : k].values[row]);
      if (travel == 0.0) {
        EXPECT_EQ(error, 0.0);
        continue;
      }
      sum += angle ? error * error * travel / (0.004 * 0.004) : error * error / (variance * travel);
      ++count;
    }
    // Of chi-square(count): standard deviation sqrt(2 count).
    EXPECT_NEAR(sum / count, 1.0, 4.0 * std::sqrt(2.0 / count));
  }
}

/// A floor error misreads a leg's way and turning by one share each: the wheels stay consistent.
TEST_P(SimulatedWheels, MisreadALegAsAWhole) {
  const OtherDrive drive = other_drive(GetParam());
  const Robot& robot = drive.model.robot;
  RoughNoise rough;
  rough.floor = true;
  const MotionRows exact = with_wheels(simulate(robot).drive.recording, robot).drive;
  const World world = simulate(robot, kNoiseFree, rough);
  const MotionRows misread = with_wheels(world.drive.recording, robot).drive;
  const auto path = [](const MotionRows& of, std::size_t row) { return of.forward[row]; };
  const TrueStop& a = world.drive.motion.stops[3];
  const TrueStop& b = world.drive.motion.stops[4];
  double share = 0.0;
  for (std::size_t row = a.rows; row < b.rows; ++row) {
    if (std::abs(path(exact, row)) < 1e-4) continue;
    const double here = path(misread, row) / path(exact, row) - 1.0;
    if (share != 0.0) {
      EXPECT_NEAR(here, share, 1e-9);
    }
    share = here;
  }
  EXPECT_GT(std::abs(share), 1e-5);
  EXPECT_LT(std::abs(share), 0.02);
}

INSTANTIATE_TEST_SUITE_P(Drives, SimulatedWheels, ::testing::ValuesIn(kDrives),
                         [](const auto& one) {
                           std::string name(name_of(one.param));
                           std::erase(name, '-');
                           return name;
                         });

TEST(DrivingManner, ArcsAddUpToTheTurnAndStayNearTheirPlace) {
  const DrivingManner manner = manner_of(usual_robot(DriveKind::ackermann));
  for (const double turn : {-3.1, -1.3, -0.2, 0.5, 0.7, 2.0, 3.14}) {
    const int arcs = arcs_of_turn(turn, manner);
    double turned = 0.0;
    Pose pose;
    for (const ArcRow& row :
         turning_arcs(turn, manner.turning_radius, std::vector<int>(idx(arcs), 7))) {
      turned += row.turn;
      // The rear axle's middle goes along a circle of that radius.
      EXPECT_NEAR(std::abs(row.way), manner.turning_radius * std::abs(row.turn), 1e-12);
      pose = testing::after(pose, {row.way, 0.0, row.turn});
    }
    EXPECT_NEAR(turned, turn, 1e-12);
    EXPECT_LT(pose.position().norm(), 0.9 * manner.turning_radius);
  }
}

TEST(DrivingManner, ARobotThatSteersAsACarDoesTurnsNowhereOnTheSpot) {
  Robot robot = usual_robot(DriveKind::ackermann);
  const World world = simulate(robot);
  int backwards = 0;
  for (const TrueRow& row : world.drive.motion.rows) {
    EXPECT_EQ(row.sideways, 0.0);
    backwards += row.speed < 0.0 ? 1 : 0;
    if (row.activity == Activity::rest) continue;
    const double angle = std::atan(robot.length * row.turn_rate / row.speed);
    EXPECT_LT(std::abs(angle), 0.6 + 1e-9);
  }
  EXPECT_GT(backwards, 0.1 * static_cast<double>(world.drive.motion.rows.size()));
  for (const TrueStop& stop : world.drive.motion.stops) {
    EXPECT_LT((stop.pose.position() - world.mesh.positions[idx(stop.landmark)]).norm(), 0.03);
  }
}

TEST(DrivingManner, ATricycleDrivesForwardsAndBackwards) {
  const World world = simulate(usual_robot(DriveKind::tricycle));
  const std::vector<double>& steer = world.drive.recording.drive.covariates[1].values;
  EXPECT_NEAR(*std::max_element(steer.begin(), steer.end()), 1.4, 1e-6);
  EXPECT_NEAR(*std::min_element(steer.begin(), steer.end()), -1.4, 1e-6);
  const std::vector<double>& wheel = world.drive.recording.drive.covariates[0].values;
  const auto back = std::count_if(wheel.begin(), wheel.end(), [](double w) { return w < 0.0; });
  EXPECT_GT(back, 0.1 * static_cast<double>(wheel.size()));
}

TEST(DrivingManner, RollersLetARobotGoToEitherSide) {
  for (const DriveKind kind : {DriveKind::omni3, DriveKind::mecanum, DriveKind::wheels}) {
    double ahead = 0.0;
    double left = 0.0;
    double right = 0.0;
    for (const TrueRow& row : simulate(usual_robot(kind)).drive.motion.rows) {
      ahead += row.speed * row.duration;
      (row.sideways > 0.0 ? left : right) += std::abs(row.sideways) * row.duration;
    }
    EXPECT_GT(left, 0.2 * ahead);
    EXPECT_GT(right, 0.2 * ahead);
  }
}

TEST(DrivingManner, LegsShorterThanATurnNeedsAreRefused) {
  WheeledRobot robot;
  robot.geometry = usual_robot(DriveKind::ackermann);
  EXPECT_THROW((void)simulate_drive(even_mesh({3, 3}, 1.0), {0, 1, 2}, {}, robot, 1),
               std::invalid_argument);
  robot.geometry = usual_robot(DriveKind::ackermann, 0.0, 0.2);
  EXPECT_NO_THROW((void)simulate_drive(even_mesh({3, 3}, 1.0), {0, 1, 2}, {}, robot, 1));
}

TEST(SimulatedWheels, EffectsOfAnotherDriveAreRefused) {
  WheeledRobot robot;
  robot.geometry = usual_robot(DriveKind::mecanum);
  const Mesh mesh = even_mesh({3, 3}, 5.0);
  const auto act = [&](const char* name) {
    (void)simulate_drive(mesh, {0, 1, 2}, {}, robot, 1, {{catalogue_effect(name, {0.01})}});
  };
  EXPECT_NO_THROW(act("roller slip"));
  EXPECT_THROW(act("steering offset"), std::invalid_argument);
  EXPECT_THROW(act("wheel diameter ratio"), std::invalid_argument);
  robot.geometry = Robot();
  EXPECT_THROW(act("roller slip"), std::invalid_argument);
}

TEST(SimulatedWheels, WheelsThatAreIncompleteAreRefused) {
  const auto refuses = [](Robot geometry) {
    WheeledRobot robot;
    robot.geometry = std::move(geometry);
    EXPECT_THROW((void)simulate_drive(even_mesh({3, 3}, 5.0), {0, 1, 2}, {}, robot, 1),
                 std::invalid_argument);
  };
  for (const DriveKind kind : kDrives) {
    Robot robot = usual_robot(kind);
    robot.columns.pop_back();
    refuses(robot);
    robot = usual_robot(kind);
    robot.wheelbase = 0.0;
    refuses(robot);
  }
  Robot robot = usual_robot(DriveKind::omni3);
  robot.length = 0.0;
  refuses(robot);
}

/// 100 seeds each: what is drawn is of the drive, and what only the drive has is drawn, too.
TEST(HiddenEffects, AreThoseOfTheDrive) {
  for (const DriveKind kind : kDrives) {
    WheeledRobot robot;
    robot.geometry = usual_robot(kind);
    const World world = simulate(robot.geometry);
    std::set<Channel> own;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      for (const Effect& effect :
           draw_hidden_effects(world.drive.motion, world.mesh, robot, true, seed)) {
        EXPECT_TRUE(effects::is_of_drive(effect.channel, robot.geometry)) << effect.name;
        if (!effects::is_of_drive(effect.channel, Robot())) own.insert(effect.channel);
      }
    }
    EXPECT_GE(own.size(), 2U) << name_of(kind);
  }
}

}  // namespace
}  // namespace trussmap::other_drives_test
