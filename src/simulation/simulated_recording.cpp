// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/simulated_recording.hpp"

#include "simulation/wheeled_robot.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr double kGapSpread = 0.4;     // uneven: gaps of 1 -+ this times the spacing,
constexpr double kJitterShare = 0.06;  // and landmarks moved by up to this times the spacing
constexpr double kRestShare = 0.1;
constexpr double kDelayOverrun = 0.4;  // m: a robot that stands shows no delay

Robot geometry_of(const SimulationSettings& settings) {
  Robot robot = usual_robot(drive_named(settings.drive), settings.wheelbase, settings.length);
  robot.wheel_left = settings.wheel_left;
  robot.steer_left = settings.steer_left;
  robot.mounted = settings.mounted;
  return robot;
}

Mesh make_mesh(const SimulationSettings& settings) {
  const MeshSize size = parse_mesh_size(settings.mesh);
  if (!settings.uneven) return even_mesh(size, settings.spacing);
  std::mt19937_64 random = random_stream(settings.seed, Stream::mesh);
  const double shortest = (1.0 - kGapSpread) * settings.spacing;
  const double longest = (1.0 + kGapSpread) * settings.spacing;
  const std::vector<double> x = random_lines(size.columns, shortest, longest, random);
  const std::vector<double> y = random_lines(size.rows, shortest, longest, random);
  return jittered(mesh_of_lines(x, y), kJitterShare * settings.spacing, random);
}

WheeledRobot make_robot(const SimulationSettings& settings) {
  WheeledRobot robot;
  robot.geometry = geometry_of(settings);
  robot.noise.steer = settings.steer_noise;
  robot.compass = !settings.no_compass;
  robot.gyro = settings.gyro;
  robot.noise.gyro = settings.gyro_noise;
  robot.noise.gyro_walk = settings.gyro_walk;
  robot.range_sensor = settings.range_sensor || settings.ranges_alone || settings.bearings_alone;
  if (settings.ranges_alone) robot.sensor_parts = SensorParts::range_alone;
  if (settings.bearings_alone) robot.sensor_parts = SensorParts::bearing_alone;
  robot.loops = settings.loops;
  robot.scan_every = settings.scan_every;
  robot.markers = settings.markers;
  robot.noise.yaw = settings.yaw_noise;
  robot.noise.loop = settings.loop_noise;
  robot.noise.loop_heading = settings.loop_heading_noise;
  robot.reach = settings.reach;
  robot.noise.left = settings.wheel_noise;
  robot.noise.right = settings.wheel_noise;
  robot.noise.compass = settings.compass_noise;
  robot.noise.survey = settings.survey_noise;
  robot.noise.fix = settings.fix_noise;
  robot.fix_rate = settings.fix_rate;
  robot.rough = rough_of(settings);
  if (settings.noise_free) robot.noise = kNoiseFree;
  return robot;
}

DrivingStyle make_style(const SimulationSettings& settings, const std::vector<Effect>& effects) {
  DrivingStyle style;
  style.slowest = settings.speeds.at(0);
  style.fastest = settings.speeds.at(1);
  style.slowest_turn = settings.turn_rates.at(0);
  style.fastest_turn = settings.turn_rates.at(1);
  style.ramp = settings.ramp;
  style.covariates = settings.covariates;
  const bool delayed = std::any_of(effects.begin(), effects.end(),
                                   [](const Effect& one) { return one.channel == Channel::delay; });
  style.overrun = settings.overrun >= 0.0 ? settings.overrun : delayed ? kDelayOverrun : 0.0;
  style.standing = settings.noise_free ? 0.0 : settings.sighting_noise;
  style.rest_share = settings.rests ? kRestShare : 0.0;
  style.full_spins = settings.full_turns;
  return style;
}

}  // namespace

namespace {

constexpr std::uint64_t kFurtherSession = 0x9e3779b97f4a7c15U;  // apart from the first one's seed

/// Its landmarks are those of the plan, each where it comes first.
Mesh mesh_of(const DrivePlan& plan) {
  Mesh mesh;
  std::vector<int> walk;
  for (const Waypoint& one : plan.waypoints) {
    const auto found = std::find(mesh.names.begin(), mesh.names.end(), one.landmark);
    walk.push_back(static_cast<int>(found - mesh.names.begin()));
    if (found != mesh.names.end()) continue;
    mesh.names.push_back(one.landmark);
    mesh.positions.push_back(one.place);
  }
  for (std::size_t k = 1; k < walk.size(); ++k) {
    const MeshRoute route{std::min(walk[k - 1], walk[k]), std::max(walk[k - 1], walk[k])};
    const bool there = std::any_of(
        mesh.routes.begin(), mesh.routes.end(),
        [&](const MeshRoute& one) { return one.from == route.from && one.to == route.to; });
    if (!there) mesh.routes.push_back(route);
  }
  mesh.size = {static_cast<int>(mesh.names.size()), 1};
  return mesh;
}

std::vector<int> walk_of(const DrivePlan& plan, const Mesh& mesh) {
  std::map<std::string, int> numbers;
  for (int k = 0; k < mesh.landmarks(); ++k) numbers[landmark_name(mesh, k)] = k;
  std::vector<int> walk;
  for (const Waypoint& one : plan.waypoints) {
    const auto found = numbers.find(one.landmark);
    if (found == numbers.end()) {
      throw std::invalid_argument(
          fmt::format("the plan's landmark {} is none of the mesh, expected the mesh that it was "
                      "planned for",
                      one.landmark));
    }
    walk.push_back(found->second);
  }
  return walk;
}

/// What is ordered from one waypoint to the next.
LegOrder order_of(const DrivePlan& plan, std::size_t leg,
                  const std::vector<std::string>& covariates) {
  const Waypoint& from = plan.waypoints[leg];
  const Waypoint& to = plan.waypoints[leg + 1];
  LegOrder order;
  order.rest = from.stop;
  order.turn = from.turn;
  if (from.turn_rate > 0.0) order.turn_rate = from.turn_rate;
  order.speed = to.speed;
  order.bend = to.bend;
  order.further.assign(covariates.size(), 0.0);
  for (std::size_t k = 0; k < plan.loads.size(); ++k) {
    const double value = from.loads.at(k);
    const auto column = std::find(covariates.begin(), covariates.end(), plan.loads[k]);
    if (plan.loads[k] == "payload_kg") order.surroundings.payload_kg = value;
    if (plan.loads[k] == "lights") order.surroundings.lights = value;
    if (column != covariates.end()) {
      order.further[static_cast<std::size_t>(column - covariates.begin())] = value;
    }
  }
  return order;
}

}  // namespace

DrivingStyle style_of_plan(const DrivePlan& plan, DrivingStyle style) {
  for (const std::string& name : plan.loads) {
    const bool own = name == "payload_kg" || name == "lights";
    const bool there =
        std::find(style.covariates.begin(), style.covariates.end(), name) != style.covariates.end();
    if (!own && !there) style.covariates.push_back(name);
  }
  style.orders.clear();
  for (std::size_t leg = 0; leg + 1 < plan.waypoints.size(); ++leg) {
    style.orders.push_back(order_of(plan, leg, style.covariates));
  }
  if (!plan.waypoints.empty()) {
    const Waypoint& first = plan.waypoints.front();
    style.first_heading = wrap_angle(first.heading - first.turn);
  }
  return style;
}

SimulatedDrive simulate_plan(const Mesh& mesh, const DrivePlan& plan, const DrivingStyle& style,
                             const WheeledRobot& robot, std::uint64_t seed,
                             const SimulatedEffects& effects) {
  return simulate_drive(mesh, walk_of(plan, mesh), style_of_plan(plan, style), robot, seed,
                        effects);
}

double SimulatedRecording::length() const {
  double sum = 0.0;
  for (const TrueRow& row : drive.motion.rows) {
    sum += std::hypot(row.speed, row.sideways) * row.duration;
  }
  return sum;
}

SimulatedRecording simulate(const SimulationSettings& settings,
                            const std::vector<Effect>& effects) {
  for (const Effect& effect : effects) {
    if (effect.channel != Channel::sighting_yaw || settings.markers) continue;
    throw std::invalid_argument(
        fmt::format("effect \"{}\" acts on yaws of landmarks, expected markers", effect.name));
  }
  SimulatedRecording result;
  result.effects = effects;
  const bool own_places = settings.plan && settings.places_of_plan;
  result.mesh = own_places ? mesh_of(*settings.plan) : make_mesh(settings);
  std::mt19937_64 random = random_stream(settings.seed, Stream::walk);
  const Tours tours =
      own_places ? Tours{walk_of(*settings.plan, result.mesh), {}}
                 : make_tours(result.mesh, parse_walk_kind(settings.walk), settings.tours, random);
  const WheeledRobot robot = make_robot(settings);
  if (settings.hide) {
    result.effects = draw_hidden_effects(result.mesh, tours.walk, make_style(settings, {}), robot,
                                         !settings.no_survey, settings.seed);
  }
  const SimulatedEffects acting{result.effects,
                                settings.true_rates ? Rates::true_motion : Rates::as_recorded};
  const DrivingStyle style = make_style(settings, result.effects);
  if (settings.plan) {
    result.drive = simulate_plan(result.mesh, *settings.plan, style, robot,
                                 settings.seed + kFurtherSession, acting);
    // The place was surveyed once.
    result.drive.recording.survey = simulation::survey(result.mesh, robot, settings.seed);
  } else {
    result.drive = simulate_drive(result.mesh, tours.walk, style, robot, settings.seed, acting);
  }
  if (settings.no_survey) result.drive.recording.survey.clear();
  result.model = nominal_model(settings);
  return result;
}

RoughNoise rough_of(const SimulationSettings& settings) {
  RoughNoise rough;
  if (settings.rough.empty()) return rough;
  rough = parse_rough(settings.rough);
  if (settings.no_compass) rough.haze = false;
  if (rough_names(rough).empty()) {
    throw std::invalid_argument(
        "rough noise: haze is noise of a compass, expected a robot that has one");
  }
  return rough;
}

Model nominal_model(const SimulationSettings& settings) {
  Model model;
  const SensorNoise sensors;
  model.robot = geometry_of(settings);
  model.noise.steer = settings.steer_noise;
  model.noise.left = settings.wheel_noise;
  model.noise.right = settings.wheel_noise;
  model.noise.compass = settings.compass_noise;
  model.noise.sighting = settings.sighting_noise;
  model.noise.range = sensors.range;
  model.noise.bearing = sensors.bearing;
  model.noise.survey = settings.survey_noise;
  if (settings.gyro) model.noise.gyro = settings.gyro_noise;
  model.noise.fix = settings.fix_noise;
  if (settings.markers) model.noise.yaw = settings.yaw_noise;
  model.noise.loop = settings.loop_noise;
  model.noise.loop_heading = settings.loop_heading_noise;
  return model;
}

Effect simulated_effect(const Effect& effect) {
  Effect result = effect;
  const auto refuse = [&result](const std::string& what) {
    throw std::invalid_argument(fmt::format("effect \"{}\" {}", result.name, what));
  };
  if (result.coefficients.empty()) refuse("has no coefficients, expected one per shape");
  // A simulated recording is one session, the first.
  if (result.per_session) {
    if (result.coefficients.size() < result.shape.size()) {
      refuse(fmt::format("has {} coefficients, expected {}, one per shape",
                         result.coefficients.size(), result.shape.size()));
    }
    result.coefficients.resize(result.shape.size());
    result.per_session = false;
  }
  return result;
}

}  // namespace trussmap
