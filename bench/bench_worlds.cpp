// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "bench_worlds.hpp"

#include "effects/channel_physics.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/simulation.hpp"

#include <cmath>
#include <random>

#include <Eigen/QR>
#include <fmt/format.h>

namespace trussmap::bench {
using namespace criticism;
namespace {

Subject subject_of(Effect effect) {
  const Channel channel = effect.channel;
  return {
      std::move(effect), channel == Channel::compass,
      channel == Channel::range || channel == Channel::range_scale || channel == Channel::bearing};
}

Subject catalogued(const std::string& name) {
  return subject_of(catalogue_effect(name));
}

Subject own(Channel channel, const std::vector<Shape>& shape) {
  return subject_of(
      {fmt::format("{} x {}", name_of(channel), shape.front().text()), channel, shape, {}});
}

}  // namespace

World draw_world(std::uint64_t seed, Survey survey) {
  World world;
  world.seed = seed;
  std::mt19937_64 random(seed * 7919 + 17);
  const auto uniform = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto pick = [&random](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  const double shortest = uniform(2.5, 4.0);
  const double longest = shortest * uniform(1.6, 2.6);
  world.mesh = jittered(mesh_of_lines(random_lines(pick(3, 5), shortest, longest, random),
                                      random_lines(pick(3, 5), shortest, longest, random)),
                        0.15 * shortest, random);
  const int wanted = pick(60, 300);
  const WalkKind kinds[] = {WalkKind::euler, WalkKind::depth_first, WalkKind::random,
                            WalkKind::euler};
  const WalkKind kind = kinds[pick(0, 3)];
  for (int tours = 1; static_cast<int>(world.walk.size()) <= wanted; ++tours) {
    std::mt19937_64 again(seed * 31 + 5);
    world.walk = make_tours(world.mesh, kind, tours, again).walk;
  }
  world.walk.resize(static_cast<std::size_t>(wanted) + 1);
  world.style.rest_share = uniform(0.0, 0.3);
  world.style.full_spins = pick(0, 3);
  world.style.fastest = uniform(0.6, 1.0);
  world.style.bend = uniform(0.08, 0.2);
  world.style.ramp = uniform(0.0, 0.6);
  world.style.standing = uniform(0.003, 0.008);
  const bool surveyed = pick(0, 2) != 0;
  world.surveyed = survey == Survey::either ? surveyed : survey == Survey::yes;
  world.robot.compass = pick(0, 3) != 0;
  world.robot.range_sensor = pick(0, 2) == 0;
  world.robot.geometry.wheelbase = uniform(0.25, 0.5);
  const double k = uniform(0.002, 0.005);
  world.robot.noise.left = k;
  world.robot.noise.right = k * uniform(0.8, 1.25);
  world.robot.noise.compass = uniform(0.01, 0.04);
  world.model.robot.wheelbase = world.robot.geometry.wheelbase;
  world.model.noise.left = world.robot.noise.left;
  world.model.noise.right = world.robot.noise.right;
  world.model.noise.compass = world.robot.noise.compass;
  world.model.noise.range = world.robot.noise.range;
  world.model.noise.bearing = world.robot.noise.bearing;
  world.model.noise.survey = world.robot.noise.survey;
  world.model.noise.sighting = world.style.standing;
  return world;
}

World with_legs(World world, int legs) {
  for (int tours = 1; static_cast<int>(world.walk.size()) <= legs; tours *= 2) {
    std::mt19937_64 random(world.seed * 31 + 5);
    world.walk = make_tours(world.mesh, WalkKind::euler, tours, random).walk;
  }
  world.walk.resize(static_cast<std::size_t>(legs) + 1);
  return world;
}

DrivenRecording record_in(const World& world, const std::vector<Effect>& effects) {
  SimulatedEffects acting;
  acting.effects = effects;
  SimulatedDrive drive =
      simulate_drive(world.mesh, world.walk, world.style, world.robot, world.seed, acting);
  if (!world.surveyed) drive.recording.survey.clear();
  return with_wheels(drive.recording, world.model.robot);
}

std::vector<Subject> subjects(const World& world) {
  std::vector<Subject> list;
  for (const char* name : {"wheel diameter ratio",
                           "wheelbase",
                           "travel scale",
                           "wheel scale",
                           "constant creep",
                           "cross-slope creep",
                           "slope",
                           "slip with speed",
                           "loss per start",
                           "turn scrub",
                           "turn asymmetry",
                           "twist per spin",
                           "load on both wheels (payload_kg)",
                           "load on one wheel (payload_kg)",
                           "tyre drift (distance)",
                           "tyre drift (t)",
                           "tyre drift (temperature_C)",
                           "heading drift",
                           "compass offset",
                           "hard iron",
                           "soft iron",
                           "compass lag",
                           "motor current",
                           "compass disturbance (lights)",
                           "lever arm",
                           "lever arm to the left",
                           "range bias",
                           "range scale",
                           "bearing offset"}) {
    list.push_back(catalogued(name));
  }
  std::mt19937_64 random(world.seed * 104729 + 3);
  const auto uniform = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double reach = shortest_route(world.mesh);
  for (const char* name : {"slippery patch", "local magnetic anomaly"}) {
    const auto at = static_cast<std::size_t>(
        uniform(0.0, static_cast<double>(world.mesh.positions.size()) - 1e-9));
    const Vector2 place =
        world.mesh.positions[at] + reach * Vector2(uniform(-0.3, 0.3), uniform(-0.3, 0.3));
    list.push_back(catalogued(fmt::format("{} (x={:.1f}, y={:.1f}, r={:.1f})", name, place.x(),
                                          place.y(), reach * uniform(0.6, 1.0))));
  }
  const double threshold = uniform(0.4, 0.6) * world.style.fastest;
  list.push_back(catalogued(fmt::format("missed ticks (v0={:.2f})", threshold)));
  return list;
}

std::vector<Subject> odd_subjects(const World& world) {
  const double end = 8.0 * static_cast<double>(world.walk.size());
  return {own(Channel::wheels, {"payload_kg^2"}),
          own(Channel::turn, {"payload_kg^2"}),
          own(Channel::compass, {"payload_kg*sin(heading)", "payload_kg*cos(heading)"}),
          own(Channel::creep, {"payload_kg*sin(heading)", "payload_kg*cos(heading)"}),
          own(Channel::travel, {fmt::format("max(0, speed-{:.2f})", 0.5 * world.style.fastest)}),
          own(Channel::turn, {fmt::format("(1+sign(t-{:.0f}))/2", 0.6 * end)}),
          own(Channel::travel, {fmt::format("(1+sign(t-{:.0f}))/2", 0.4 * end)}),
          own(Channel::compass, {fmt::format("(1+sign(t-{:.0f}))/2", 0.5 * end)})};
}

double percent(int part, int whole) {
  return whole > 0 ? 100.0 * part / whole : 0.0;
}

std::vector<double> sized(const Subject& subject, const World& world, const ScoreTest& tests,
                          double times, std::uint64_t seed) {
  const Score score = tests.test({subject.effect}).front();
  if (score.dof < static_cast<int>(subject.effect.shape.size())) return {};
  std::mt19937_64 random(seed * 1299709 + world.seed);
  Eigen::VectorXd direction(score.projected.cols());
  std::normal_distribution<double> normal;
  for (double& d : direction) d = normal(random);
  // A loss is one.
  if (subject.effect.channel == Channel::advance) direction = -direction.cwiseAbs();
  const double size = (score.projected * direction).norm();
  if (!(size > 0.0)) return {};
  direction *= times * std::sqrt(kDetectableScore) / size;
  // What would have to be implausibly large counts as not shown.
  const double prior_sd = facts_of(subject.effect.channel).prior_sd;
  for (Eigen::Index k = 0; k < direction.size(); ++k) {
    if (std::abs(direction[k]) * score.largest[static_cast<std::size_t>(k)] > prior_sd) return {};
  }
  return {direction.begin(), direction.end()};
}

double cosine(const Effect& truth, const Effect& found, const ScoreTest& tests) {
  const std::vector<Score> scores = tests.test({truth, found});
  Eigen::VectorXd trace = Eigen::VectorXd::Zero(scores[0].projected.rows());
  for (std::size_t k = 0; k < truth.coefficients.size(); ++k) {
    trace += truth.coefficients[k] * scores[0].projected.col(static_cast<Eigen::Index>(k));
  }
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factor(scores[1].projected);
  return (scores[1].projected * factor.solve(trace)).norm() / std::max(trace.norm(), 1e-300);
}

bool shows(const World& world, const Subject& subject) {
  return (world.robot.compass || !subject.needs_compass) &&
         (world.robot.range_sensor || !subject.needs_range);
}

}  // namespace trussmap::bench
