// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "planning/recorded_world.hpp"

#include "drive/wheel_kinematics.hpp"
#include "geometry/index.hpp"
#include "recording/variable_names.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace trussmap::planning {
namespace {

constexpr double kStraight = 1.2;     // driven length over distance of a route
constexpr double kMoves = 0.02;       // m/s, rad/s
constexpr double kMostFixRate = 1.0;  // Hz

using Exits = std::map<std::string, std::set<std::string>>;

double length_between(const MotionRows& drive, double from, double to) {
  double sum = 0.0;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    if (drive.t[row] <= from || drive.t[row] > to + 1e-9) continue;
    const BodyMotion motion = drive.motion(row);
    sum += std::hypot(motion.forward, motion.sideways);
  }
  return sum;
}

/// Routes that were driven about straight, with their ends.
Exits routes_of(const fitting::FitState& fit, const std::map<std::string, Vector2>& places) {
  Exits exits;
  for (const DrivenRecording& recording : fit.recordings) {
    const Sighting* last = nullptr;
    for (const Sighting& one : recording.sightings) {
      if (!one.standing() || !places.contains(one.landmark)) continue;
      if (last != nullptr && last->landmark != one.landmark) {
        const double apart = (places.at(one.landmark) - places.at(last->landmark)).norm();
        if (length_between(recording.drive, last->t, one.t) <= kStraight * apart) {
          exits[last->landmark].insert(one.landmark);
          exits[one.landmark].insert(last->landmark);
        }
      }
      last = &one;
    }
  }
  return exits;
}

std::string start_of(const fitting::FitState& fit, const Exits& exits, const std::string& wanted) {
  if (exits.empty()) {
    throw SolveError(
        "the recordings show no route that was driven straight from one landmark to another that "
        "the robot stands on, between which a drive could be planned");
  }
  if (!wanted.empty()) {
    if (exits.contains(wanted)) return wanted;
    throw std::invalid_argument("the start " + wanted +
                                " is no landmark that a route leads to, expected one like " +
                                exits.begin()->first);
  }
  for (auto recording = fit.recordings.rbegin(); recording != fit.recordings.rend(); ++recording) {
    for (auto one = recording->sightings.rbegin(); one != recording->sightings.rend(); ++one) {
      if (one->standing() && exits.contains(one->landmark)) return one->landmark;
    }
  }
  return exits.begin()->first;
}

/// Landmarks that routes lead to, in the order of their names.
RouteNetwork network_of(const Exits& exits, const std::map<std::string, Vector2>& places) {
  RouteNetwork routes;
  std::map<std::string, int> numbers;
  for (const auto& [name, others] : exits) {
    numbers[name] = static_cast<int>(routes.names.size());
    routes.names.push_back(name);
    routes.positions.push_back(places.at(name));
  }
  for (const auto& [name, others] : exits) {
    routes.exits.emplace_back();
    for (const std::string& to : others) routes.exits.back().push_back(numbers.at(to));
  }
  return routes;
}

double quantile_of(std::vector<double> values, double share, double otherwise) {
  if (values.empty()) return otherwise;
  std::sort(values.begin(), values.end());
  return values[idx(std::lround(share * static_cast<double>(values.size() - 1)))];
}

void learn_rates(const fitting::FitState& fit, double max_speed, PlanWorld& world) {
  std::vector<double> speeds;
  std::vector<double> rates;
  for (const DrivenRecording& recording : fit.recordings) {
    const MotionRows& drive = recording.drive;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      const double dt = drive.duration(row);
      const BodyMotion motion = drive.motion(row);
      const double speed = std::hypot(motion.forward, motion.sideways) / dt;
      const double rate = std::abs(motion.turn) / dt;
      if (speed > kMoves) speeds.push_back(speed);
      if (speed <= kMoves && rate > kMoves) rates.push_back(rate);
    }
  }
  const double limit = max_speed > 0.0 ? max_speed : quantile_of(speeds, 0.95, 0.8);
  const double usual = std::min(limit, quantile_of(speeds, 0.5, 0.5));
  const double slow = std::min(quantile_of(speeds, 0.05, 0.25), 0.5 * limit);
  world.speeds = {slow, std::max(slow, usual), limit};
  const double fast_turn = quantile_of(rates, 0.95, 0.8);
  world.turn_rates = {std::min(quantile_of(rates, 0.05, 0.3), 0.5 * fast_turn), fast_turn};
  const auto digits = [](double value) {
    return std::max(0.01, std::floor(100.0 * value + 1e-9) / 100.0);
  };
  for (double& one : world.speeds) one = digits(one);
  if (max_speed > 0.0) {
    for (double& one : world.speeds) one = std::min(one, max_speed);
    world.speeds.back() = max_speed;
  }
  for (double& one : world.turn_rates) one = digits(one);
}

void learn_sensors(const fitting::FitState& fit, PlanWorld& world) {
  WheeledRobot& robot = world.robot;
  robot.geometry = fit.model.robot;
  robot.noise = kNoiseFree;
  robot.compass = false;
  bool ranges = false;
  bool bearings = false;
  std::vector<double> reach;
  for (const DrivenRecording& recording : fit.recordings) {
    robot.compass = robot.compass || recording.drive.has_compass();
    robot.gyro = robot.gyro || recording.drive.has_gyro();
    world.truth = world.truth || (fit.used.truth && !recording.truth.empty());
    for (const Sighting& one : recording.sightings) {
      ranges = ranges || one.range == one.range;
      bearings = bearings || one.bearing == one.bearing;
      robot.markers = robot.markers || one.yaw == one.yaw;
      if (one.range == one.range) reach.push_back(one.range);
    }
    if (fit.used.fixes && recording.fixes.size() > 1) {
      const double lasted = recording.fixes.back().t - recording.fixes.front().t;
      if (lasted > 0.0) {
        robot.fix_rate =
            std::min(kMostFixRate, static_cast<double>(recording.fixes.size() - 1) / lasted);
      }
    }
  }
  robot.range_sensor = ranges || bearings;
  if (ranges != bearings) {
    robot.sensor_parts = ranges ? SensorParts::range_alone : SensorParts::bearing_alone;
  }
  robot.reach = quantile_of(reach, 0.9, robot.reach);
}

/// "payload_kg", but no "cpu_loader".
bool is_load(const std::string& name) {
  static const std::set<std::string> words{"load",  "payload", "mass", "weight",
                                           "cargo", "ballast", "kg",   "payload_kg"};
  std::string word;
  for (const char letter : name + "_") {
    if (letter != '_') {
      word += letter;
      continue;
    }
    if (words.contains(word)) return true;
    word.clear();
  }
  return false;
}

/// All values that a column had.
std::set<double> values_of(const std::string& name, const fitting::FitState& fit) {
  std::set<double> values;
  for (const DrivenRecording& recording : fit.recordings) {
    for (const Covariate& one : recording.drive.covariates) {
      if (one.name == name) values.insert(one.values.begin(), one.values.end());
    }
  }
  return values;
}

/// From the drive's start on, changes alone.
ColumnInTime as_recorded(const Covariate& column, const MotionRows& drive) {
  ColumnInTime result{column.name, {}, {}};
  for (std::size_t row = 0; row < column.values.size(); ++row) {
    if (!result.values.empty() && result.values.back() == column.values[row]) continue;
    result.from.push_back(drive.t[row] - drive.start());
    result.values.push_back(column.values[row]);
  }
  return result;
}

void learn_columns(const fitting::FitState& fit, const std::vector<std::string>& variables,
                   PlanWorld& world) {
  const auto& reserved = recording::reserved_variables();
  for (const Covariate& column : fit.recordings.back().drive.covariates) {
    const std::string& name = column.name;
    if (std::find(reserved.begin(), reserved.end(), name) != reserved.end()) continue;
    if (drive::is_own_column(fit.model.robot, name) || column.values.empty()) continue;
    const std::set<double> distinct = values_of(name, fit);
    const bool asked = std::find(variables.begin(), variables.end(), name) != variables.end();
    if (asked && distinct.size() > 1 && name != "temperature_C" &&
        (is_load(name) || distinct.size() == 2)) {
      world.loads.push_back({name, {*distinct.begin(), *distinct.rbegin()}});
    } else {
      world.columns.push_back(as_recorded(column, fit.recordings.back().drive));
    }
  }
}

}  // namespace

PlanWorld recorded_world(const fitting::FitState& fit, const std::vector<std::string>& variables,
                         const std::string& start, double max_speed) {
  const std::map<std::string, Vector2> places = fitting::landmark_places(fit);
  const Exits exits = routes_of(fit, places);
  const std::string first = start_of(fit, exits, start);
  PlanWorld world;
  lay_near(static_cast<int>(std::distance(exits.begin(), exits.find(first))),
           network_of(exits, places), world);
  world.model = fit.model;
  world.model.effects.clear();
  learn_rates(fit, max_speed, world);
  learn_sensors(fit, world);
  learn_columns(fit, variables, world);
  if (!world.robot.range_sensor) return world;
  const std::set<std::string> laid(world.mesh.names.begin(), world.mesh.names.end());
  for (const auto& [name, place] : places) {
    if (laid.contains(name)) continue;
    world.mesh.names.push_back(name);
    world.mesh.positions.push_back(place);
  }
  world.mesh.size = {static_cast<int>(world.mesh.names.size()), 1};
  return world;
}

}  // namespace trussmap::planning
