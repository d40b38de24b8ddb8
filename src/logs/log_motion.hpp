// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The robot's motion as a log has it, for a comparison of clocks: how far it turned since the
// start, by whatever sensor, or where it was.
#pragma once

#include "logs/joined_logs.hpp"
#include "logs/log_map.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::logs {

struct LoggedMotion {
  std::string what;             ///< "wheels", "gyro", "heading", "odometry", "truth", "fixes"
  bool turns = true;            ///< false: it is the way that is known
  std::vector<std::int64_t> t;  ///< ns, by the log's own clock, increasing
  std::vector<double> x;        ///< turned so far, in any unit; way so far; x of fixes [m]
  std::vector<double> y = {};   ///< of fixes, else empty

  [[nodiscard]] double first() const;  ///< s
  [[nodiscard]] double last() const;   ///< s
  /// Rates are taken as held since the sample before; where in its step one was measured nobody
  /// states.
  bool held = false;
  /// s, median
  [[nodiscard]] double step() const;
  /// Turned, or moved (without a sign), from one time to another [s]; NaN where it does not cover
  /// them, or has a gap there.
  [[nodiscard]] double between(double from, double to) const;
};

/// All that the log has, as its map says; none where it has no motion. Throws InputError where the
/// log is damaged.
[[nodiscard]] std::vector<LoggedMotion> motions_of(const JoinedLogs& log, const LogMap& map);

/// By how much a second clock has to be set on for its motion to be that of the first.
struct ClockOffset {
  double offset = 0.0;    ///< s, to be added to the second one's times
  double sd = 0.0;        ///< s; half a step of what is held counts
  double likeness = 0.0;  ///< correlation of the motions over the windows, -1 to 1
  double drift = 0.0;     ///< by how much it grows per s, where that is plain; else 0
  std::string by, with;   ///< "turns of the gyro", "turns of the wheels"
};

/// By the likest of the motions that both have; none where no two are alike at one offset alone.
[[nodiscard]] std::optional<ClockOffset> clock_offset(const std::vector<LoggedMotion>& first,
                                                      const std::vector<LoggedMotion>& second);

}  // namespace trussmap::logs
