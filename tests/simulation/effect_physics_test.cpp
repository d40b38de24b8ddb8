// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Effects of the catalogue in simulated recordings, undone by the definitions of the channels: a
// slow integration of a few lines, which shares nothing with the simulator or the adjustment.
#include "drive/row_variables.hpp"
#include "driven.hpp"
#include "effects/channel_physics.hpp"
#include "geometry/index.hpp"
#include "simulation/tours.hpp"
#include "simulation/wheeled_robot.hpp"
#include "trussmap/catalogue.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::effect_physics_test {
namespace {

struct Case {
  const char* name;
  std::vector<double> values;
};

/// One for every entry of the catalogue, of a size that a user would notice.
std::vector<Case> cases() {
  return {{"wheel diameter ratio", {0.01}},
          {"wheelbase", {-0.02}},
          {"travel scale", {0.015}},
          {"wheel scale", {-0.01}},
          {"sighting delay", {0.2}},
          {"constant creep", {0.03}},
          {"cross-slope creep", {0.02, -0.03}},
          {"centrifugal side-slip", {0.1}},
          {"slope", {0.01, 0.02}},
          {"slip with speed", {-0.02}},
          {"loss per start", {-0.008}},
          {"arc loss", {-0.1}},
          {"spin loss", {-0.02}},
          {"turn scrub", {-0.045}},
          {"turn asymmetry", {0.02}},
          {"twist per spin", {0.02}},
          {"load on both wheels (payload_kg)", {-0.0005}},
          {"load on one wheel (payload_kg)", {-0.0004}},
          {"tyre drift (temperature_C)", {0.0005}},
          {"tyre drift (t)", {1e-5}},
          {"tyre drift (distance)", {-2e-5}},
          {"backlash", {0.010, 0.006}},  // more than a slow spin's wheels travel in a row
          {"backlash of the left wheel", {0.003}},
          {"backlash of the right wheel", {0.003}},
          {"backlash twist", {0.004, 0.003}},
          {"missed ticks (v0=0.5)", {0.1}},
          {"missed ticks of the right wheel (v0=0.4)", {0.1}},
          {"sampling skew", {0.01}},
          {"heading drift", {0.002}},
          {"compass offset", {0.1}},
          {"hard iron", {0.15, -0.1}},
          {"soft iron", {0.05, 0.03}},
          {"body tilt", {0.1, 0.05}},
          {"compass lag", {-0.1}},
          {"motor current", {0.1, 0.05}},
          {"local magnetic anomaly (x=10, y=9, r=3)", {0.3}},
          {"compass disturbance (lights)", {0.04}},
          {"slippery patch (x=10, y=9, r=3)", {-0.03}},
          {"lever arm", {0.12}},
          {"lever arm to the left", {-0.08}},
          {"range bias", {0.05}},
          {"range scale", {-0.02}},
          {"bearing offset", {0.03}}};
}

struct World {
  Mesh mesh;
  SimulatedDrive drive;
  Effect effect;
  WheeledRobot robot;
};

World simulate(const Case& one, Rates rates) {
  std::mt19937_64 random(41);
  World world;
  const std::vector<double> x = random_lines(5, 3.0, 7.0, random);
  const std::vector<double> y = random_lines(5, 3.0, 7.0, random);
  world.mesh = jittered(mesh_of_lines(x, y), 0.3, random);
  const std::vector<int> walk = make_tours(world.mesh, WalkKind::euler, 1, random).walk;
  DrivingStyle style;
  style.standing = 0.0;
  style.rest_share = 0.1;
  style.full_spins = 2;
  style.overrun = 0.4;
  style.ramp = 1.0;
  world.robot.range_sensor = true;
  world.robot.noise = kNoiseFree;
  world.effect = catalogue_effect(one.name, one.values);
  world.drive = simulate_drive(world.mesh, walk, style, world.robot, 3, {{world.effect}, rates});
  return world;
}

/// The rows in which a wheel truly goes over to the other sense. (In slow rows a loss of
/// millimetres makes wheels look as if they did.)
std::vector<double> reversals(const World& world, double side) {
  std::vector<double> events;
  double sense = 0.0;
  for (const TrueRow& row : world.drive.motion.rows) {
    const double wheel = row.speed + side * 0.5 * world.robot.geometry.wheelbase * row.turn_rate;
    events.push_back(wheel * sense < 0.0 ? 1.0 : 0.0);
    if (std::abs(wheel) * row.duration > 1e-6) sense = wheel;
  }
  return events;
}

/// g in every row: at its middle, and at its end for what is read then.
std::vector<double> gains(const World& world) {
  const TrueMotion& motion = world.drive.motion;
  std::vector<Pose> path;
  for (const TrueRow& row : motion.rows) path.push_back(row.pose);
  RowVariables variables = drive::row_variables(testing::driven(world.drive.recording).drive,
                                                world.robot.geometry, motion.start, path, 0);
  variables["reverses_left"] = reversals(world, -1.0);
  variables["reverses_right"] = reversals(world, 1.0);
  const std::set<Channel> instant = {Channel::compass, Channel::range, Channel::range_scale,
                                     Channel::bearing};
  if (instant.contains(world.effect.channel)) {
    for (std::size_t k = 0; k < path.size(); ++k) {
      variables["heading"][k] = path[k].heading;
      variables["x"][k] = path[k].x;
      variables["y"][k] = path[k].y;
    }
  }
  std::vector<double> g(path.size(), 0.0);
  for (std::size_t k = 0; k < world.effect.shape.size(); ++k) {
    const std::vector<double> f = world.effect.shape[k].values(variables);
    for (std::size_t row = 0; row < g.size(); ++row) {
      g[row] += world.effect.coefficients[k] * f[row];
    }
  }
  return g;
}

/// The motion of a row as the model has it, in small steps (midpoint rule).
Pose advance(Pose pose, double left, double right, double dt, double g, Channel channel,
             double wheelbase) {
  if (channel == Channel::left || channel == Channel::wheels) left *= 1.0 + g;
  if (channel == Channel::right || channel == Channel::wheels) right *= 1.0 + g;
  if (channel == Channel::difference) {
    left *= 1.0 - g / 2.0;
    right *= 1.0 + g / 2.0;
  }
  double ds = (left + right) / 2.0;
  double turn = (right - left) / wheelbase;
  const double aside = channel == Channel::creep ? g * ds : 0.0;
  if (channel == Channel::travel) ds *= 1.0 + g;
  if (channel == Channel::turn) turn *= 1.0 + g;
  if (channel == Channel::drift) turn += g * dt;
  if (channel == Channel::advance) ds += g;
  if (channel == Channel::rotate) turn += g;
  constexpr int steps = 60;
  for (int k = 0; k < steps; ++k) {
    const double c = std::cos(pose.heading + 0.5 * turn / steps);
    const double s = std::sin(pose.heading + 0.5 * turn / steps);
    pose.x += (ds * c - aside * s) / steps;
    pose.y += (ds * s + aside * c) / steps;
    pose.heading += turn / steps;
  }
  return pose;
}

/// Largest misfits of what the model makes of the recording.
struct Misfit {
  double landmark = 0.0;  ///< m, of what the robot stood on or saw
  double compass = 0.0;   ///< rad
};

Misfit misfit(const World& world) {
  const Recording& recording = world.drive.recording;
  const Drive& drive = recording.drive;
  const Channel channel = world.effect.channel;
  const std::vector<double> g = gains(world);
  std::map<std::string, Vector2> landmarks;
  for (int k = 0; k < world.mesh.landmarks(); ++k) {
    landmarks[landmark_name(world.mesh, k)] = world.mesh.positions[idx(k)];
  }
  Misfit worst;
  Pose pose = world.drive.motion.start;
  std::size_t row = 0;
  for (const Sighting& sighting : recording.sightings) {
    const double t = sighting.t - (channel == Channel::delay ? g.front() : 0.0);
    for (; row < drive.rows() && drive.t[row] <= t + 1e-9; ++row) {
      const double dt = drive.t[row] - (row == 0 ? drive.start() : drive.t[row - 1]);
      pose = advance(pose, drive.left[row], drive.right[row], dt, g[row], channel,
                     world.robot.geometry.wheelbase);
      const double offset = channel == Channel::compass ? g[row] : 0.0;
      worst.compass =
          std::max(worst.compass, std::abs(wrap_angle(drive.heading[row] - offset - pose.heading)));
    }
    const double here = g[row == 0 ? 0 : row - 1];
    Vector2 point(channel == Channel::lever ? here : 0.0,
                  channel == Channel::lever_left ? here : 0.0);
    if (!sighting.standing()) {
      double range = sighting.range - (channel == Channel::range ? here : 0.0);
      if (channel == Channel::range_scale) range /= 1.0 + here;
      const double bearing = sighting.bearing - (channel == Channel::bearing ? here : 0.0);
      point += range * Vector2(std::cos(bearing), std::sin(bearing));
    }
    const Vector2 seen = pose.position() + rotation(pose.heading) * point;
    worst.landmark = std::max(worst.landmark, (seen - landmarks.at(sighting.landmark)).norm());
  }
  EXPECT_GT(row, 0.9 * static_cast<double>(drive.rows()));
  return worst;
}

TEST(EffectPhysics, EveryCatalogueEffectIsTriedHere) {
  std::set<const CatalogueEntry*> tried;
  for (const Case& one : cases()) tried.insert(find_entry(one.name));
  for (const CatalogueEntry& entry : catalogue()) {
    if (entry.channel == Channel::truth_heading) continue;  // of a tracker, not of a robot
    if (effects::acts_on_fixes(entry.channel)) continue;    // tests of fixes
    if (effects::acts_on_loops(entry.channel)) continue;    // calibration/sensor_places_test.cpp
    // No landmark has an axis here: fit/landmark_yaw_test.cpp.
    if (entry.channel == Channel::sighting_yaw) continue;
    if (!effects::is_of_drive(entry.channel, Robot())) continue;  // fit/other_drives_test.cpp
    if (entry.channel == Channel::gyro || entry.channel == Channel::gyro_scale) {
      continue;  // this robot has none: fit/gyro_test.cpp
    }
    EXPECT_TRUE(tried.contains(&entry)) << entry.name;
  }
}

/// The true effect explains the whole recording: over 300 m only the midpoint rule's and rounding
/// errors are left.
TEST(EffectPhysics, TheTrueEffectExplainsTheRecording) {
  for (const Case& one : cases()) {
    const Misfit left = misfit(simulate(one, Rates::as_recorded));
    EXPECT_LT(left.landmark, 1e-6) << one.name;
    EXPECT_LT(left.compass, 1e-7) << one.name;
  }
}

/// Where an effect depends on how fast the robot truly is, the recording's own rates differ by a
/// fraction g: a second order of the effect is left.
TEST(EffectPhysics, TrueRatesDifferFromRecordedOnesInTheSecondOrder) {
  const std::set<std::string> by_rate = {"slip with speed",
                                         "turn scrub",
                                         "arc loss",
                                         "spin loss",
                                         "turn asymmetry",
                                         "tyre drift (distance)",
                                         "missed ticks (v0=0.5)",
                                         "missed ticks of the right wheel (v0=0.4)",
                                         "sampling skew"};
  for (const Case& one : cases()) {
    const World world = simulate(one, Rates::true_motion);
    const Misfit left = misfit(world);
    if (!by_rate.contains(one.name)) {
      EXPECT_LT(left.landmark, 1e-6) << one.name;
      EXPECT_LT(left.compass, 1e-7) << one.name;
      continue;
    }
    World without = world;
    std::fill(without.effect.coefficients.begin(), without.effect.coefficients.end(), 0.0);
    // Missed ticks begin at a threshold, which one rate may have passed and the other not.
    EXPECT_LT(left.landmark, 0.5 * misfit(without).landmark) << one.name;
  }
}

TEST(EffectPhysics, NoEffectGoesUnnoticed) {
  for (const Case& one : cases()) {
    World world = simulate(one, Rates::true_motion);
    std::fill(world.effect.coefficients.begin(), world.effect.coefficients.end(), 0.0);
    const Misfit left = misfit(world);
    EXPECT_GT(std::max(left.landmark, left.compass), 0.005) << one.name;
  }
}

TEST(EffectPhysics, TwoEffectsActSideBySide) {
  std::mt19937_64 random(5);
  const Mesh mesh = even_mesh({3, 3}, 5.0);
  const std::vector<int> walk = make_tours(mesh, WalkKind::euler, 1, random).walk;
  WheeledRobot robot;
  robot.noise = kNoiseFree;
  DrivingStyle style;
  style.standing = 0.0;
  const SimulatedDrive drive =
      simulate_drive(mesh, walk, style, robot, 1,
                     {{Effect{"left", Channel::left, {"1"}, {0.02}, false},
                       Effect{"turn", Channel::turn, {"lights"}, {-0.03}, false},
                       Effect{"advance", Channel::advance, {"starts"}, {0.004}, false}},
                      Rates::true_motion});
  const Drive& recorded = drive.recording.drive;
  bool started = false;
  for (std::size_t row = 0; row < recorded.rows(); ++row) {
    const TrueRow& truth = drive.motion.rows[row];
    const double left = recorded.left[row];
    const double right = recorded.right[row];
    const bool starts = truth.activity == Activity::drive && !started;
    started = truth.activity == Activity::drive;
    EXPECT_NEAR((left + right) / 2.0 + 0.02 * left / 2.0 + (starts ? 0.004 : 0.0),
                truth.speed * truth.duration, 1e-12);
    EXPECT_NEAR(
        (right - left) / robot.geometry.wheelbase * (1.0 - 0.03 * truth.surroundings.lights) -
            0.02 * left / robot.geometry.wheelbase,
        truth.turn_rate * truth.duration, 1e-12);
  }
}

TEST(EffectPhysics, NoEffectsLeaveARecordingAsItWas) {
  std::mt19937_64 random(5);
  const Mesh mesh = even_mesh({3, 3}, 5.0);
  const std::vector<int> walk = make_tours(mesh, WalkKind::euler, 1, random).walk;
  const Recording a = simulate_drive(mesh, walk, {}, {}, 7).recording;
  const Recording b = simulate_drive(mesh, walk, {}, {}, 7, {{}, Rates::as_recorded}).recording;
  const Recording c =
      simulate_drive(mesh, walk, {}, {}, 7,
                     {{catalogue_effect("compass offset", {0.1})}, Rates::true_motion})
          .recording;
  EXPECT_EQ(a.drive.left, b.drive.left);
  EXPECT_EQ(a.drive.heading, b.drive.heading);
  for (std::size_t row = 0; row < a.drive.rows(); ++row) {
    EXPECT_NEAR(a.drive.left[row], c.drive.left[row], 1e-12);
    EXPECT_NEAR(wrap_angle(c.drive.heading[row] - a.drive.heading[row]), 0.1, 1e-12);
  }
}

TEST(EffectPhysics, SlipAndLeverLeaveTheRobotsWayOfDriving) {
  const Case straight{"constant creep", {0.0}};
  const Case creeping{"constant creep", {0.05}};
  const World a = simulate(straight, Rates::true_motion);
  const World b = simulate(creeping, Rates::true_motion);
  ASSERT_EQ(a.drive.motion.rows.size(), b.drive.motion.rows.size());
  EXPECT_EQ(a.drive.motion.segments, b.drive.motion.segments);
  for (std::size_t k = 0; k < a.drive.motion.stops.size(); ++k) {
    EXPECT_LT(
        (a.drive.motion.stops[k].pose.position() - b.drive.motion.stops[k].pose.position()).norm(),
        1e-9);
  }
  const World beside = simulate({"lever arm to the left", {0.1}}, Rates::true_motion);
  for (const TrueStop& stop : beside.drive.motion.stops) {
    const Vector2 point = stop.pose.position() + rotation(stop.pose.heading) * Vector2(0.0, 0.1);
    EXPECT_LT((point - beside.mesh.positions[idx(stop.landmark)]).norm(), 1e-9);
  }
}

TEST(EffectPhysics, FurtherColumnsVaryAndActAsCovariates) {
  const Mesh mesh = even_mesh({3, 3}, 5.0);
  std::mt19937_64 random(5);
  const std::vector<int> walk = make_tours(mesh, WalkKind::euler, 1, random).walk;
  DrivingStyle style;
  style.covariates = {"crates"};
  const SimulatedEffects effects{{catalogue_effect("load on one wheel (crates)", {0.1})},
                                 Rates::true_motion};
  const SimulatedDrive with = simulate_drive(mesh, walk, style, {}, 7, effects);
  const Covariate& crates = with.recording.drive.covariates.back();
  EXPECT_EQ(crates.name, "crates");
  EXPECT_GT(std::set<double>(crates.values.begin(), crates.values.end()).size(), 3U);
  style.covariates = {};
  try {
    (void)simulate_drive(mesh, walk, style, {}, 7, effects);
    ADD_FAILURE() << "a column that is not there was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("names \"crates\", which is unknown"),
              std::string::npos)
        << error.what();
  }
}

TEST(EffectPhysics, WheelsThatCouldNotShowTheMotionAreRefused) {
  EXPECT_THROW((void)simulate({"travel scale", {-1.0}}, Rates::true_motion), std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::effect_physics_test
