// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Effects that no catalogue has, hidden in simulated recordings: a formula each, with constants
// that are drawn from the world's seed.
#pragma once

#include "trussmap/simulated_recording.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace trussmap::bench {

/// A formula, and what a robot needs to show it.
struct HiddenFormula {
  std::string name;
  Effect effect;  ///< without coefficients
  bool needs_compass = false;
  bool needs_gyro = false;
};

/// How large and how long a recording is: what constants are drawn by.
struct Extent {
  Vector2 low = Vector2::Zero();   ///< m
  Vector2 high = Vector2::Zero();  ///< m
  double duration = 0.0;           ///< s
};
[[nodiscard]] Extent extent_of(const SimulatedRecording& world);

/// All of them, constants drawn anew for each seed.
[[nodiscard]] std::vector<HiddenFormula> hidden_formulas(const Extent& extent, std::uint64_t seed);

}  // namespace trussmap::bench
