// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Worlds whose assumptions are broken: robots whose wheels, wheelbase, heading and compass are not
// what their model says, and sightings with a wrong name. All drawn from a seed.
#pragma once

#include "trussmap/catalogue.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/survey_comparison.hpp"

#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace trussmap::bench {

inline constexpr int kLargeEvery = 100;  // one world in so many is a mesh of 30 x 30
inline constexpr double kDegree = 0.017453292519943295;

struct BrokenWorld {
  Mesh mesh;
  Recording recording;
  Model nominal;
  Model true_model;
  std::set<std::pair<double, std::string>> wrong;  ///< time and name given
  Recording right;                                 ///< without the wrong sightings
  std::string what;
};

struct BrokenWorldOptions {
  bool clean = false;  ///< no effect and no wrong label
};

inline BrokenWorld draw_broken_world(std::uint64_t seed, const BrokenWorldOptions& options = {}) {
  std::mt19937_64 random(seed * 6364136223846793005ULL + 11);
  const auto uniform = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto pick = [&random](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  BrokenWorld world;
  const bool large = seed % kLargeEvery == kLargeEvery - 1;
  const MeshSize size = large ? MeshSize{30, 30} : MeshSize{pick(4, 12), pick(4, 12)};
  const int tours = pick(2, large ? 3 : 6);
  std::mt19937_64 lines = random_stream(seed, Stream::mesh);
  const bool uneven = pick(0, 1) == 1;
  world.mesh = uneven ? jittered(mesh_of_lines(random_lines(size.columns, 3.0, 7.0, lines),
                                               random_lines(size.rows, 3.0, 7.0, lines)),
                                 0.5, lines)
                      : even_mesh(size, 5.0);
  WheeledRobot robot;
  robot.compass = pick(0, 1) == 1;
  robot.range_sensor = pick(0, 2) == 0;
  std::vector<Effect> effects;
  const auto act = [&](const char* name, const std::vector<double>& coefficients) {
    Effect effect = catalogue_effect(name);
    effect.coefficients = coefficients;
    effects.push_back(effect);
    world.what += fmt::format(" {}={:.4f}", name, fmt::join(coefficients, ","));
  };
  double share = 0.0;
  if (!options.clean) {
    if (pick(0, 2) != 0) {
      const double E_d = 1.0 + uniform(-0.01, 0.01);
      act("wheel diameter ratio", {2.0 * (E_d - 1.0) / (E_d + 1.0)});
    }
    if (pick(0, 2) != 0) act("wheelbase", {1.0 / (1.0 + uniform(-0.05, 0.05)) - 1.0});
    if (pick(0, 2) != 0) act("heading drift", {uniform(-30.0, 30.0) * kDegree / 60.0});
    if (robot.compass && pick(0, 2) != 0) act("compass offset", {uniform(-0.3, 0.3)});
    if (robot.compass && pick(0, 2) != 0) {
      const double size_of = uniform(0.0, 0.2);
      const double phase = uniform(-3.14, 3.14);
      act("hard iron", {size_of * std::cos(phase), size_of * std::sin(phase)});
    }
    if (pick(0, 3) != 0) share = uniform(0.0, 0.05);
  }
  std::mt19937_64 walking = random_stream(seed, Stream::walk);
  const Tours walk = make_tours(world.mesh, WalkKind::euler, tours, walking);
  SimulatedEffects acting;
  acting.effects = effects;
  SimulatedDrive drive = simulate_drive(world.mesh, walk.walk, {}, robot, seed, acting);
  world.recording = std::move(drive.recording);
  world.recording.name = "world";
  world.recording.survey.clear();
  world.right = world.recording;
  for (std::size_t k = 0; k < world.recording.sightings.size(); ++k) {
    if (uniform(0.0, 1.0) >= share) continue;
    Sighting& one = world.recording.sightings[k];
    const std::string right = one.landmark;
    while (one.landmark == right) {
      one.landmark = landmark_name(world.mesh, pick(0, world.mesh.landmarks() - 1));
    }
    world.wrong.insert({one.t, one.landmark});
  }
  std::erase_if(world.right.sightings, [&](const Sighting& one) {
    const auto k = static_cast<std::size_t>(&one - world.right.sightings.data());
    return world.recording.sightings[k].landmark != one.landmark;
  });
  world.nominal.robot.wheelbase = robot.geometry.wheelbase;
  world.true_model = world.nominal;
  world.true_model.effects = effects;
  world.what =
      fmt::format("{}x{} {} tours{}{}{}", size.columns, size.rows, tours, uneven ? " uneven" : "",
                  robot.compass ? " compass" : "", robot.range_sensor ? " range" : "") +
      world.what + fmt::format(" wrong={}", world.wrong.size());
  return world;
}

/// Rigid rms error, m. Infinite where a tenth of the landmarks that were sighted is not there.
inline double error_of(const LandmarkPositions& places, const Mesh& mesh) {
  std::vector<Vector2> here;
  std::vector<Vector2> there;
  for (int k = 0; k < mesh.landmarks(); ++k) {
    const auto place = places.find(landmark_name(mesh, k));
    if (place == places.end()) continue;
    here.push_back(place->second);
    there.push_back(mesh.positions[static_cast<std::size_t>(k)]);
  }
  if (10 * here.size() < 9 * mesh.positions.size()) return HUGE_VAL;
  return align_rigidly(here, there).rms;
}

}  // namespace trussmap::bench
