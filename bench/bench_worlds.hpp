// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Worlds, robots and effects for the criticism's figures: all drawn from a seed.
#pragma once

#include "criticism/score_test.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/simulation.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace trussmap::bench {

struct World {
  Mesh mesh;
  std::vector<int> walk;
  DrivingStyle style;
  WheeledRobot robot;
  bool surveyed = true;
  Model model;  ///< true noise, no effect
  std::uint64_t seed = 0;
};

enum class Survey { yes, no, either };

/// 60 to 300 legs, several noise levels; with or without survey, compass and range sensor.
[[nodiscard]] World draw_world(std::uint64_t seed, Survey survey = Survey::either);

/// The same world driven for so many legs.
[[nodiscard]] World with_legs(World world, int legs);

/// The world's recording with these effects (channel, shape and coefficients given).
[[nodiscard]] DrivenRecording record_in(const World& world, const std::vector<Effect>& effects);

/// An effect and what it needs to be shown.
struct Subject {
  Effect effect;  ///< without coefficients
  bool needs_compass = false;
  bool needs_range = false;
};

/// More than 25 of the catalogue's; places lie in the world.
[[nodiscard]] std::vector<Subject> subjects(const World& world);

/// Shapes that no catalogue has.
[[nodiscard]] std::vector<Subject> odd_subjects(const World& world);

[[nodiscard]] double percent(int part, int whole);

/// Coefficients along a random direction whose expected score is `times`^2 * 24.4; empty where the
/// world does not show the effect at a plausible size.
[[nodiscard]] std::vector<double> sized(const Subject& subject, const World& world,
                                        const criticism::ScoreTest& tests, double times,
                                        std::uint64_t seed);

/// How much of one effect's trace the other's columns can show.
[[nodiscard]] double cosine(const Effect& truth, const Effect& found,
                            const criticism::ScoreTest& tests);

/// Whether the world's robot has what the effect acts on.
[[nodiscard]] bool shows(const World& world, const Subject& subject);

}  // namespace trussmap::bench
