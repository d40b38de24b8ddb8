// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The simulator turns the physics round, the adjustment has it the right way round; neither knows
// the other. Without noise they must meet at chi^2 = 0 and at the coefficients that were given.
#include "drive/row_variables.hpp"
#include "driven.hpp"
#include "estimation/recording_adjustment.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/simulation.hpp"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::simulated_effects_test {
using namespace effects;
using namespace estimation;
namespace {

struct Simulated {
  SimulatedDrive drive;
  WheeledRobot robot;
};

Simulated simulate(const Effect& effect) {
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0}, {0.0, 3.0, 7.0});
  std::mt19937_64 random(3);
  const Tours tours = make_tours(mesh, WalkKind::euler, 2, random);
  Simulated result;
  result.robot.range_sensor = true;
  result.robot.noise = kNoiseFree;
  DrivingStyle style;
  style.standing = 0.0;
  style.rest_share = 0.2;
  style.full_spins = 2;
  style.ramp = 1.0;
  result.drive = simulate_drive(mesh, tours.walk, style, result.robot, 3, {{effect}});
  return result;
}

/// What one unit of g does to a row, by the table of channels.
DrivePattern by_the_table(Channel channel, const MotionRows& drive, std::size_t row,
                          double wheelbase) {
  const double left = drive.pair.left[row];
  const double right = drive.pair.right[row];
  const double path = 0.5 * (left + right);
  const double turn = (right - left) / wheelbase;
  const double duration = drive.t[row] - (row == 0 ? drive.start() : drive.t[row - 1]);
  if (channel == Channel::travel) return {path, 0.0, 0.0, 0.0};
  if (channel == Channel::left) return {0.5 * left, 0.0, -left / wheelbase, 0.0};
  if (channel == Channel::right) return {0.5 * right, 0.0, right / wheelbase, 0.0};
  if (channel == Channel::wheels) return {path, 0.0, turn, 0.0};
  if (channel == Channel::difference) return {0.25 * (right - left), 0.0, path / wheelbase, 0.0};
  if (channel == Channel::turn) return {0.0, 0.0, turn, 0.0};
  if (channel == Channel::drift) return {0.0, 0.0, duration, 0.0};
  if (channel == Channel::advance) return {1.0, 0.0, 0.0, 0.0};
  if (channel == Channel::rotate) return {0.0, 0.0, 1.0, 0.0};
  if (channel == Channel::creep) return {0.0, path, 0.0, 0.0};
  if (channel == Channel::compass) return {0.0, 0.0, 0.0, 1.0};
  return {};
}

ViewPattern by_the_table(Channel channel) {
  ViewPattern pattern;
  if (channel == Channel::lever) pattern.ahead = 1.0;
  if (channel == Channel::lever_left) pattern.left = 1.0;
  if (channel == Channel::range) pattern.range = 1.0;
  if (channel == Channel::range_scale) pattern.range_scale = 1.0;
  if (channel == Channel::bearing) pattern.bearing = 1.0;
  return pattern;
}

/// A coefficient of the model per shape; shapes are constant where a view is concerned.
EffectParameters border_of(const Effect& effect, const Simulated& simulated) {
  const MotionRows drive = testing::driven(simulated.drive.recording).drive;
  const TrueMotion& motion = simulated.drive.motion;
  std::vector<Pose> path;
  for (const TrueRow& row : motion.rows) path.push_back(row.pose);
  RowVariables variables =
      drive::row_variables(drive, simulated.robot.geometry, motion.start, path, 0);
  if (effect.channel == Channel::compass) {
    for (std::size_t row = 0; row < path.size(); ++row) {
      variables["heading"][row] = path[row].heading;
      variables["x"][row] = path[row].x;
      variables["y"][row] = path[row].y;
    }
  }
  EffectParameters border;
  for (const Shape& shape : effect.shape) {
    const std::vector<double> f = shape.values(variables);
    EffectPattern& pattern = border.emplace_back();
    pattern.name = effect.name;
    std::vector<DrivePattern>& rows = pattern.drives.emplace_back();
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      const DrivePattern unit =
          by_the_table(effect.channel, drive, row, simulated.robot.geometry.wheelbase);
      rows.push_back(
          {f[row] * unit.advance, f[row] * unit.slip, f[row] * unit.turn, f[row] * unit.compass});
    }
    pattern.sightings.emplace_back(simulated.drive.recording.sightings.size(),
                                   by_the_table(effect.channel));
  }
  return border;
}

TEST(SimulatedEffects, AFitFindsTheCoefficientsThatWereGiven) {
  const std::vector<Effect> effects = {catalogue_effect("wheel diameter ratio", {0.01}),
                                       catalogue_effect("wheelbase", {-0.02}),
                                       catalogue_effect("travel scale", {0.015}),
                                       catalogue_effect("wheel scale", {-0.01}),
                                       catalogue_effect("cross-slope creep", {0.02, -0.03}),
                                       catalogue_effect("slope", {0.01, 0.02}),
                                       catalogue_effect("slip with speed", {-0.02}),
                                       catalogue_effect("loss per start", {-0.008}),
                                       catalogue_effect("turn scrub", {-0.045}),
                                       catalogue_effect("turn asymmetry", {0.02}),
                                       catalogue_effect("twist per spin", {0.01}),
                                       catalogue_effect("load on one wheel (payload_kg)", {4e-4}),
                                       catalogue_effect("tyre drift (distance)", {-2e-5}),
                                       catalogue_effect("missed ticks (v0=0.5)", {0.1}),
                                       catalogue_effect("sampling skew", {0.01}),
                                       catalogue_effect("heading drift", {0.002}),
                                       catalogue_effect("compass offset", {0.1}),
                                       catalogue_effect("hard iron", {0.15, -0.1}),
                                       catalogue_effect("compass lag", {-0.1}),
                                       catalogue_effect("motor current", {0.1, 0.05}),
                                       catalogue_effect("slippery patch (x=4, y=3, r=3)", {-0.03}),
                                       catalogue_effect("lever arm", {0.12}),
                                       catalogue_effect("lever arm to the left", {-0.08}),
                                       catalogue_effect("range bias", {0.05}),
                                       catalogue_effect("range scale", {-0.02}),
                                       catalogue_effect("bearing offset", {0.03})};
  for (const Effect& effect : effects) {
    const Simulated simulated = simulate(effect);
    const RecordingProblem problem =
        make_problem({testing::driven(simulated.drive.recording)}, Model{});
    const double without = adjust(problem).chi2;
    const RecordingAdjustment with = adjust(problem, border_of(effect, simulated));
    EXPECT_GT(without, 1.0) << effect.name;
    EXPECT_LT(with.chi2, 1e-8 * without) << effect.name;
    for (std::size_t k = 0; k < effect.coefficients.size(); ++k) {
      EXPECT_NEAR(with.coefficients[static_cast<Eigen::Index>(k)], effect.coefficients[k],
                  1e-6 * std::abs(effect.coefficients[k]))
          << effect.name;
    }
  }
}

}  // namespace
}  // namespace trussmap::simulated_effects_test
