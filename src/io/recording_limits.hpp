// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How large the figures of a recording may be: beyond all that robots do and clocks show. What is
// larger is a slip of the pen or another unit, and sums of its squares would overflow.
#pragma once

#include "trussmap/recording.hpp"

#include <cstddef>
#include <string>

namespace trussmap::io {

inline constexpr double kLargestTime = 1e12;       // s: Unix time in nanoseconds is more
inline constexpr double kLargestTravel = 1e6;      // m in a row
inline constexpr double kLargestRange = 1e6;       // m
inline constexpr double kLargestAngle = 1e9;       // rad: turns add up
inline constexpr double kLargestYawRate = 1e3;     // rad/s: a gyro in degrees reads less
inline constexpr double kLargestPosition = 1e9;    // m
inline constexpr double kLargestCovariate = 1e50;  // in whatever unit

/// A line of a foreign file, of which a row of a recording was made. Its calls throw InputError
/// with that line where no recording can hold the row. `line` 0: the file as a whole.
class SourceLine {
 public:
  SourceLine(const std::string& file, std::size_t line) : file_(file), line_(line) {}

  /// "time is 1e+300, expected a number of at most 1e+12 in size".
  void expect(const char* what, double value, double largest) const;

  /// The last row that the drive has, whose wheels may be covariates.
  void expect_last_row(const Drive& drive) const;
  void expect(const Sighting& sighting) const;
  void expect(const TruthRow& truth) const;
  void expect(const SurveyPoint& point) const;
  void expect(const Fix& fix) const;
  void expect(const Loop& loop) const;

 private:
  const std::string& file_;
  std::size_t line_;
};

}  // namespace trussmap::io
