// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A drive that nothing ties to a place: no sighting, no fix, no truth. What can be told of it all
// the same.
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap::logs {

/// What a gyro reads while the wheels stand: its bias.
struct GyroAtRest {
  double mean = 0.0;      ///< rad/s
  double sd = 0.0;        ///< rad/s, of the mean, from the scatter of the rows
  double duration = 0.0;  ///< s, of all rests
};

/// Over stretches of 2 s and more in which no wheel moves, without their first and last rows; none
/// where there are fewer than 10 rows in all of them, or no gyro.
[[nodiscard]] std::optional<GyroAtRest> gyro_at_rest(const Drive& drive, const Robot& robot);

/// Warnings: what it is good for, and the gyro's bias where its rests tell one.
[[nodiscard]] std::vector<std::string> untied_warnings(const Drive& drive, const Robot& robot);

}  // namespace trussmap::logs
