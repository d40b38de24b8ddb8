// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/tape_parts.hpp"
#include "calibration/welch.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap {
using namespace calibration;

namespace {

void require_measured(const std::vector<TapedRun>& runs, double wheelbase) {
  if (runs.empty()) throw std::invalid_argument("no run, expected one or more");
  if (!(wheelbase > 0.0) || !std::isfinite(wheelbase)) {
    throw std::invalid_argument("the wheelbase must be above 0");
  }
  for (const TapedRun& run : runs) {
    if (!std::isfinite(run.expected) || !std::isfinite(run.odometry)) {
      throw std::invalid_argument("what was expected and what the odometry said must be finite");
    }
    const bool length = run.expected > 0.0 && run.odometry > 0.0;
    if (run.kind == TapedKind::straight && !length) {
      throw std::invalid_argument("the lengths of a straight run must be above 0");
    }
    if (run.kind == TapedKind::spin && !(run.expected * run.odometry > 0.0)) {
      throw std::invalid_argument("a turn and its odometry must not be 0, and of the same sign");
    }
    if (run.kind == TapedKind::rest && std::isfinite(run.gyro) && !(run.seconds > 0.0)) {
      throw std::invalid_argument("a rest with a gyro's reading must have its seconds");
    }
  }
}

void doubt_rests(const std::vector<TapedRun>& rests, TapeCalibration& found) {
  for (const TapedRun& run : rests) {
    if (run.odometry == 0.0 && run.expected == 0.0) continue;
    found.doubts.push_back(fmt::format(
        "{}: the robot rested and {} {:.2g}, expected 0: did it creep, or does the odometry drift?",
        run.line == 0 ? std::string("a rest") : fmt::format("line {}", run.line),
        run.expected != 0.0 ? "yet moved by" : "its odometry moved by",
        run.expected != 0.0 ? run.expected : run.odometry));
  }
}

}  // namespace

TapeCalibration calibrate_by_tape(const std::vector<TapedRun>& runs, double wheelbase) {
  require_measured(runs, wheelbase);
  const std::vector<TapedRun> straight = runs_of_kind(runs, TapedKind::straight);
  const std::vector<TapedRun> turns = runs_of_kind(runs, TapedKind::spin);
  const std::vector<TapedRun> rests = runs_of_kind(runs, TapedKind::rest);
  TapeCalibration found;
  found.straight_runs = static_cast<int>(straight.size());
  found.turns = static_cast<int>(turns.size());
  found.rests = static_cast<int>(rests.size());
  add_turns(turns, found);
  add_lengths(straight, wheelbase, found);
  add_gyro(turns, rests, found);
  doubt_rests(rests, found);
  if (!found.scale) {
    found.undetermined.emplace_back(
        "E_s (true / measured travel): turns on the spot cannot tell larger wheels from a smaller "
        "wheelbase; drive straight runs of several metres beside a tape");
  }
  if (!found.turn_factor) {
    found.undetermined.emplace_back(
        "E_b (wheelbase / believed): nothing was turned; turn ten full turns on the spot each way");
    return found;
  }
  const Estimate& turning = *found.turn_factor;
  Estimate scale{1.0, 0.0, 0.0};
  if (found.scale) {
    scale = *found.scale;
  } else {
    found.look_alikes.insert(found.look_alikes.begin(), "wheel scale");
  }
  const double ratio = scale.value / turning.value;
  const Estimate of_turning{ratio, ratio / turning.value * turning.standard_error, turning.dof};
  found.wheelbase_ratio = also_by(of_turning, 1.0 / turning.value, scale);
  return found;
}

}  // namespace trussmap
