// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A counter that is wrong in one sample, or in a few, shows two travels that no wheel makes in a
// row, as large and of opposite sign: what both rows travel together is right.
#pragma once

#include "trussmap/recording.hpp"
#include "trussmap/robot.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace trussmap::check {

struct CounterJump {
  std::size_t column = 0;  ///< of wheel_readings
  std::size_t row = 0;     ///< counted from 0, and
  std::size_t back = 0;    ///< where the counter is right again
  double usual = 0.0;      ///< m that such a row travels at most, but for one in a hundred
};

/// A drive's wheels: left and right, or the columns of its own that are travels.
struct WheelReadings {
  std::string name;
  const std::vector<double>* travel = nullptr;  ///< m a row
};
[[nodiscard]] std::vector<WheelReadings> wheel_readings(const MotionRows& drive);
[[nodiscard]] std::vector<std::string> names_of_wheels(const MotionRows& drive);

/// Of a counter that was wrong for some samples, in order of columns and rows.
[[nodiscard]] std::vector<CounterJump> counter_glitches(const MotionRows& drive);

/// Both rows share what they travel together, evenly in time. `names`: of the columns that jumps
/// count (wheel_readings).
[[nodiscard]] Recording without_glitches(Recording recording,
                                         const std::vector<CounterJump>& glitches,
                                         const std::vector<std::string>& names);

}  // namespace trussmap::check
