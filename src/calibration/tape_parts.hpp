// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What calibrate_by_tape is made of. Each part adds what it found, and its doubts.
#pragma once

#include "calibration/run_ratio.hpp"
#include "trussmap/umbmark.hpp"

#include <string>
#include <vector>

namespace trussmap::calibration {

/// Runs of one kind, and what they are called.
struct TapedGroup {
  const char* one;     ///< "straight run"
  const char* many;    ///< "straight runs"
  const char* unit;    ///< "mm"
  double unit_size;    ///< of these in a metre, or a radian
  const char* offset;  ///< what gives each run the same error, whatever its size
  std::vector<RunOfRatio> rows = {};
  std::vector<std::size_t> lines = {};
  bool stated = false;
};

/// Whether every run has this sd; where some have, a note says so.
[[nodiscard]] bool all_stated(const std::vector<TapedRun>& runs, double TapedRun::*sd,
                              const char* column, const TapedGroup& group, TapeCalibration& found);

/// y / x of the group, wider where its runs contradict each other: they scatter more than stated,
/// one is far from the others, or each has the same error whatever its size.
[[nodiscard]] Estimate judged_ratio(const TapedGroup& group, TapeCalibration& found);

/// Another part of its error, known to this.
[[nodiscard]] Estimate widened(const Estimate& estimate, double by, double dof = 1.0);

/// Whether `beside` is no chance, and moves the ratio by more than readings are rounded to.
[[nodiscard]] bool contradicts(const RatioBeside& beside, double share);

[[nodiscard]] std::vector<TapedRun> runs_of_kind(const std::vector<TapedRun>& runs, TapedKind kind);

/// r, and what the turns do not tell from a wheelbase.
void add_turns(const std::vector<TapedRun>& turns, TapeCalibration& found);

/// E_s and E_d, after add_turns.
void add_lengths(const std::vector<TapedRun>& straight, double wheelbase, TapeCalibration& found);

void add_gyro(const std::vector<TapedRun>& turns, const std::vector<TapedRun>& rests,
              TapeCalibration& found);

}  // namespace trussmap::calibration
