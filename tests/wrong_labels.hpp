// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Sightings under another landmark's name.
#pragma once

#include "trussmap/recording.hpp"
#include "trussmap/simulated_recording.hpp"

#include <cstddef>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace trussmap::testing {

/// Two tours by a robot with a gyro that sees a mesh of landmarks by range and bearing.
inline SimulationSettings seen_hall(const std::string& mesh, std::uint64_t seed) {
  SimulationSettings settings;
  settings.mesh = mesh;
  settings.tours = 2;
  settings.seed = seed;
  settings.no_compass = true;
  settings.gyro = true;
  settings.range_sensor = true;
  return settings;
}

/// Gives such a share of the sightings the name of another of the landmarks that are seen, at
/// random. Their rows.
inline std::set<std::size_t> spoil_labels(Recording& recording, double share, std::uint64_t seed) {
  std::set<std::string> names;
  for (const Sighting& one : recording.sightings) names.insert(one.landmark);
  const std::vector<std::string> all(names.begin(), names.end());
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  std::uniform_int_distribution<std::size_t> which(0, all.size() - 1);
  std::set<std::size_t> wrong;
  for (std::size_t row = 0; row < recording.sightings.size(); ++row) {
    if (uniform(random) >= share) continue;
    std::string& label = recording.sightings[row].landmark;
    const std::string right = label;
    while (label == right) label = all[which(random)];
    wrong.insert(row);
  }
  return wrong;
}

}  // namespace trussmap::testing
