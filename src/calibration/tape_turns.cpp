// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/tape_parts.hpp"
#include "geometry/units.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap::calibration {
namespace {

TapedGroup group_of_turns(const std::vector<TapedRun>& turns, TapeCalibration& found) {
  TapedGroup group{"turn", "turns", "deg", geometry::kDegrees,
                   "each turn starts or stops with a twist, or the protractor's zero is off"};
  group.stated = all_stated(turns, &TapedRun::sd, "an sd", group, found);
  for (const TapedRun& run : turns) {
    double variance = 1.0;
    if (group.stated) variance = run.sd * run.sd;
    if (group.stated && std::isfinite(run.sd_odometry)) {
      variance += std::pow(run.sd_odometry * run.expected / run.odometry, 2);
    }
    group.rows.push_back({run.odometry, run.expected, variance});
    group.lines.push_back(run.line);
  }
  return group;
}

/// Turns to the left beside those to the right.
void judge_sides(const TapedGroup& group, Estimate& ratio, TapeCalibration& found) {
  std::vector<double> size;
  bool left = false;
  bool right = false;
  for (const RunOfRatio& one : group.rows) {
    size.push_back(std::abs(one.x));
    (one.x > 0.0 ? left : right) = true;
  }
  if (!left || !right) {
    found.look_alikes.emplace_back("turn asymmetry");
    found.notes.push_back(
        fmt::format("all turns are to the {}: turn by as much to the {} as well, for a robot may "
                    "turn otherwise "
                    "there",
                    left ? "left" : "right", left ? "right" : "left"));
    return;
  }
  const std::optional<RatioBeside> beside = ratio_beside(group.rows, group.stated, size);
  if (!beside) {
    found.look_alikes.emplace_back("turn asymmetry");
    return;
  }
  if (!contradicts(*beside, beside->c.value)) return;
  found.doubts.push_back(fmt::format(
      "turns to the left and to the right contradict each other: the robot turns {:.4f} times what "
      "its odometry says to the left, {:.4f} times to the right (the effect turn asymmetry, or "
      "wheels that scrub on one side); the wheelbase stands between, and its error is wider",
      beside->ratio + beside->c.value, beside->ratio - beside->c.value));
  ratio = widened(ratio, beside->c.value);
}

/// Fast turns beside slow ones.
void judge_rates(const std::vector<TapedRun>& turns, const TapedGroup& group, Estimate& ratio,
                 TapeCalibration& found) {
  constexpr double kDiffer = 1.5;  // fastest over slowest
  std::vector<double> rates;
  for (const TapedRun& run : turns) {
    if (std::isfinite(run.seconds)) rates.push_back(std::abs(run.expected) / run.seconds);
  }
  double slowest = 0.0;
  double fastest = 0.0;
  if (rates.size() == turns.size()) {
    slowest = *std::min_element(rates.begin(), rates.end());
    fastest = *std::max_element(rates.begin(), rates.end());
  }
  std::optional<RatioBeside> beside;
  const double middle = 0.5 * (slowest + fastest);
  if (slowest > 0.0 && fastest >= kDiffer * slowest) {
    std::vector<double> z;
    for (std::size_t k = 0; k < turns.size(); ++k) {
      z.push_back(group.rows[k].x * (rates[k] - middle));
    }
    beside = ratio_beside(group.rows, group.stated, z);
  }
  if (!beside) {
    found.look_alikes.emplace_back("turn scrub");
    found.notes.emplace_back(
        "the turns do not tell a wheelbase from scrub, which grows with the rate: turn slowly and "
        "fast, and write down the seconds of each");
    return;
  }
  const double half = 0.5 * beside->c.value * (fastest - slowest);
  if (!contradicts(*beside, half)) return;
  found.look_alikes.emplace_back("turn scrub");
  found.doubts.push_back(fmt::format(
      "slow and fast turns contradict each other: the robot turns {:.4f} times what its odometry "
      "says at {:.2g} deg/s, {:.4f} times at {:.2g} deg/s (the effect turn scrub); the wheelbase "
      "stands between, and its error is wider",
      beside->ratio - half, geometry::kDegrees * slowest, beside->ratio + half,
      geometry::kDegrees * fastest));
  ratio = widened(ratio, half);
}

}  // namespace

void add_turns(const std::vector<TapedRun>& turns, TapeCalibration& found) {
  if (turns.empty()) return;
  const TapedGroup group = group_of_turns(turns, found);
  Estimate ratio = judged_ratio(group, found);
  judge_sides(group, ratio, found);
  judge_rates(turns, group, ratio, found);
  found.turn_factor = ratio;
}

}  // namespace trussmap::calibration
