// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
// A plan, driven: the robot is at each waypoint in turn, and does there what is planned.
#include "scratch_folder.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/simulated_recording.hpp"
#include "trussmap/test_path.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::planned_motion_test {
namespace {

using std::numbers::pi;

/// L0_0, two turns to the left, L1_0 in a bow to the right, three quarters to the left and a rest,
/// L1_1 with a load, back to L1_0.
DrivePlan plan() {
  DrivePlan result;
  result.loads = {"payload_kg", "tank"};
  result.waypoints = {
      {"L0_0", {0.0, 0.0}, 0.3, 0.0, 0.0, 0.0, 4.0 * pi, 0.8, {0.0, 1.0}},
      {"L1_0", {5.0, 0.0}, -1.5 * pi + 2.0 * pi, 0.4, -0.6, 12.0, 2.5 * pi + 0.3, 0.5, {20.0, 2.0}},
      {"L1_1", {5.0, 5.0}, -0.5 * pi, 0.8, 0.0, 0.0, -pi, 1.0, {5.0, 3.0}},
      {"L1_0", {5.0, 0.0}, -0.5 * pi, 0.25, 0.0, 0.0, 0.0, 0.0, {5.0, 3.0}}};
  return result;
}

SimulatedDrive driven(DriveKind kind = DriveKind::differential) {
  DrivingStyle style;
  style.standing = 0.0;
  WheeledRobot robot;
  robot.geometry = usual_robot(kind);
  robot.noise = kNoiseFree;
  return simulate_plan(even_mesh({2, 2}, 5.0), plan(), style, robot, 5);
}

double turned_on_the_spot(const TrueMotion& motion, std::size_t from, std::size_t to) {
  double sum = 0.0;
  for (std::size_t row = motion.stops[from].rows; row < motion.stops[to].rows; ++row) {
    if (motion.rows[row].activity == Activity::spin) {
      sum += motion.rows[row].turn_rate * motion.rows[row].duration;
    }
  }
  return sum;
}

TEST(PlannedMotion, IsAtItsWaypointsInTurn) {
  const SimulatedDrive drive = driven();
  const DrivePlan planned = plan();
  ASSERT_EQ(drive.motion.stops.size(), planned.waypoints.size());
  ASSERT_EQ(drive.recording.sightings.size(), planned.waypoints.size());
  for (std::size_t k = 0; k < planned.waypoints.size(); ++k) {
    EXPECT_EQ(drive.recording.sightings[k].landmark, planned.waypoints[k].landmark);
    EXPECT_LT((drive.motion.stops[k].pose.position() - planned.waypoints[k].place).norm(), 1e-9);
  }
}

TEST(PlannedMotion, TurnsAsFarAndTheWayThatIsPlanned) {
  const TrueMotion motion = driven().motion;
  EXPECT_NEAR(turned_on_the_spot(motion, 0, 1), 4.0 * pi, 1e-9);
  EXPECT_NEAR(turned_on_the_spot(motion, 1, 2), 2.5 * pi + 0.3, 1e-9);
  EXPECT_NEAR(std::abs(turned_on_the_spot(motion, 2, 3)), pi, 1e-9);
  EXPECT_NEAR(wrap_angle(motion.stops[1].pose.heading + 0.3), 0.0, 1e-9);  // after the bow
}

TEST(PlannedMotion, TakesAsLongAndGoesAsFarAsIsPlanned) {
  const SimulatedDrive drive = driven();
  double length = 0.0;
  for (const TrueRow& row : drive.motion.rows) length += std::abs(row.speed) * row.duration;
  EXPECT_NEAR(length, plan_length(plan()), 1e-3);
  // Each segment is of whole rows of a tenth of a second: 8 segments, half a row each.
  EXPECT_NEAR(drive.motion.rows.back().t, plan_duration(plan()), 0.4);
  // 5 m are bowed by 0.6 rad, 12 s stood: known answers.
  EXPECT_NEAR(plan_length(plan()), 15.0 + 5.0 * 0.3 * 0.3 / 4.0, 2e-3);
}

TEST(PlannedMotion, LoadsAreAsPlannedFromEachWaypointOn) {
  const SimulatedDrive drive = driven();
  const auto value = [&](const char* name, std::size_t row) {
    for (const Covariate& one : drive.recording.drive.covariates) {
      if (one.name == name) return one.values[row];
    }
    return -1.0;
  };
  const DrivePlan planned = plan();
  for (std::size_t leg = 0; leg + 1 < planned.waypoints.size(); ++leg) {
    for (const std::size_t row :
         {drive.motion.stops[leg].rows, drive.motion.stops[leg + 1].rows - 1}) {
      EXPECT_EQ(value("payload_kg", row), planned.waypoints[leg].loads[0]) << leg;
      EXPECT_EQ(value("tank", row), planned.waypoints[leg].loads[1]) << leg;
    }
  }
}

TEST(PlannedMotion, EveryDriveReachesItsWaypoints) {
  for (const DriveKind kind : {DriveKind::unicycle, DriveKind::skid_steer, DriveKind::tricycle,
                               DriveKind::ackermann, DriveKind::omni3, DriveKind::mecanum}) {
    const SimulatedDrive drive = driven(kind);
    ASSERT_EQ(drive.motion.stops.size(), 4U) << name_of(kind);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_LT((drive.motion.stops[k].pose.position() - plan().waypoints[k].place).norm(), 1e-6)
          << name_of(kind) << " " << k;
    }
  }
}

TEST(PlannedMotion, UnderEffectsThatBendItsPathItStillArrives) {
  DrivingStyle style;
  style.standing = 0.0;
  WheeledRobot robot;
  robot.noise = kNoiseFree;
  const std::vector<Effect> effects = {{"creep", Channel::creep, {"1"}, {0.05}},
                                       {"lever", Channel::lever, {"1"}, {0.2}}};
  const SimulatedDrive drive =
      simulate_plan(even_mesh({2, 2}, 5.0), plan(), style, robot, 5, {effects});
  for (std::size_t k = 1; k < 4; ++k) {
    const Pose& pose = drive.motion.stops[k].pose;
    const Vector2 sensor = pose.position() + rotation(pose.heading) * Vector2(0.2, 0.0);
    EXPECT_LT((sensor - plan().waypoints[k].place).norm(), 1e-6) << k;
  }
}

TEST(PlannedMotion, ALandmarkThatIsNotThereIsNamed) {
  DrivePlan other = plan();
  other.waypoints[2].landmark = "L7_7";
  try {
    static_cast<void>(simulate_plan(even_mesh({2, 2}, 5.0), other, {}, WheeledRobot(), 1));
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("L7_7"), std::string::npos) << error.what();
  }
}

TEST(SimulatedPlan, IsAFurtherSessionOfTheSameWorld) {
  SimulationSettings settings;
  settings.mesh = "3x3";
  settings.uneven = true;
  settings.tours = 1;
  settings.seed = 9;
  const SimulatedRecording first = simulate(settings);
  DrivePlan walk;
  for (const char* name : {"L0_0", "L0_1", "L1_1"}) {
    Waypoint one;
    one.landmark = name;
    one.speed = 0.5;
    walk.waypoints.push_back(one);
  }
  settings.plan = walk;
  const SimulatedRecording second = simulate(settings);
  ASSERT_EQ(first.mesh.positions.size(), second.mesh.positions.size());
  for (std::size_t k = 0; k < first.mesh.positions.size(); ++k) {
    EXPECT_EQ(first.mesh.positions[k], second.mesh.positions[k]);
    EXPECT_EQ(first.drive.recording.survey[k].x, second.drive.recording.survey[k].x);
  }
  EXPECT_EQ(second.drive.recording.sightings.size(), 3U);
  // Noise of its own: where it stands first is elsewhere by a few millimetres.
  EXPECT_NE(first.drive.motion.start.x, second.drive.motion.start.x);
}

TEST(PlanFile, ReadsBackToTheSameBits) {
  const testing::ScratchFolder scratch;
  const DrivePlan written = plan();
  const DrivePlan read = read_plan(scratch.write("plan.csv", format_plan(written)));
  EXPECT_EQ(read.loads, written.loads);
  ASSERT_EQ(read.waypoints.size(), written.waypoints.size());
  for (std::size_t k = 0; k < written.waypoints.size(); ++k) {
    const Waypoint& a = read.waypoints[k];
    const Waypoint& b = written.waypoints[k];
    EXPECT_EQ(a.landmark, b.landmark);
    EXPECT_EQ(a.place, b.place);
    EXPECT_EQ(a.loads, b.loads);
    for (const auto member : {&Waypoint::heading, &Waypoint::speed, &Waypoint::bend,
                              &Waypoint::stop, &Waypoint::turn, &Waypoint::turn_rate}) {
      EXPECT_EQ(a.*member, b.*member) << k;
    }
  }
}

}  // namespace
}  // namespace trussmap::planned_motion_test
