// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/tape_parts.hpp"
#include "calibration/welch.hpp"
#include "geometry/units.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap::calibration {
namespace {

std::vector<TapedRun> with_gyro(const std::vector<TapedRun>& runs) {
  std::vector<TapedRun> result;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(result),
               [](const TapedRun& run) { return std::isfinite(run.gyro); });
  return result;
}

/// rad/s that the gyro reads at rest.
Estimate rate_at_rest(const std::vector<TapedRun>& rests, TapeCalibration& found) {
  TapedGroup group{"rest", "rests", "deg", geometry::kDegrees, ""};
  group.stated = all_stated(rests, &TapedRun::sd_gyro, "an sd_gyro", group, found);
  for (const TapedRun& run : rests) {
    const double variance = group.stated ? run.sd_gyro * run.sd_gyro : run.seconds;
    group.rows.push_back({run.seconds, run.gyro, variance});
    group.lines.push_back(run.line);
  }
  const RunRatio all = ratio_of(group.rows, group.stated);
  if (all.ratio.dof <= 0.0) {
    found.notes.emplace_back(
        rests.size() == 1 ? "one rest gives the gyro's bias no standard error: rest three times, "
                            "or state its sd_gyro"
                          : "all rests agree to the last digit, so that the gyro's bias has no "
                            "standard error: state their sd_gyro");
  }
  if (all.p_value < kSureOfRuns) {
    found.doubts.push_back(
        fmt::format("the gyro's bias changes from rest to rest, by {:.1f} times what sd_gyro "
                    "allows: it walks, or goes with the temperature; its error is so much wider",
                    all.scatter));
  }
  return all.ratio;
}

/// Turns of the gyro, what it reads at rest taken off, beside true ones.
TapedGroup group_of_readings(const std::vector<TapedRun>& turns, double rate,
                             TapeCalibration& found) {
  TapedGroup group{"turn by the gyro", "turns by the gyro", "deg", geometry::kDegrees,
                   "the gyro starts late, or the protractor's zero is off"};
  group.stated = all_stated(turns, &TapedRun::sd, "an sd", group, found);
  for (const TapedRun& run : turns) {
    const double drifted = std::isfinite(run.seconds) ? rate * run.seconds : 0.0;
    double variance = group.stated ? run.sd * run.sd : 1.0;
    if (group.stated && std::isfinite(run.sd_gyro)) variance += run.sd_gyro * run.sd_gyro;
    group.rows.push_back({run.gyro - drifted, run.expected, variance});
    group.lines.push_back(run.line);
  }
  return group;
}

/// Without rests: turns both ways tell scale and bias apart.
void add_both_by_turns(const std::vector<TapedRun>& turns, TapeCalibration& found) {
  const TapedGroup group = group_of_readings(turns, 0.0, found);
  std::vector<double> seconds;
  for (const TapedRun& run : turns) seconds.push_back(run.seconds);
  const bool timed =
      std::all_of(seconds.begin(), seconds.end(), [](double one) { return std::isfinite(one); });
  const auto beside =
      timed ? ratio_beside(group.rows, group.stated, seconds) : std::optional<RatioBeside>();
  if (!beside) {
    found.undetermined.emplace_back(
        "gyro bias: rest the robot for a minute, and write down the seconds and what the gyro "
        "turned");
    const Estimate scale = judged_ratio(group, found);
    found.gyro_scale = Estimate{scale.value - 1.0, scale.standard_error, scale.dof};
    found.notes.emplace_back("the gyro's scale holds what its bias has turned meanwhile");
    return;
  }
  found.gyro_bias = Estimate{-beside->c.value, beside->c.standard_error, beside->c.dof};
  // What is left of it goes with the scale alone.
  TapedGroup corrected = group;
  for (std::size_t k = 0; k < seconds.size(); ++k) {
    corrected.rows[k].y -= beside->c.value * seconds[k];
  }
  const Estimate scale = judged_ratio(corrected, found);
  double products = 0.0;
  double squares = 0.0;
  for (std::size_t k = 0; k < seconds.size(); ++k) {
    products += corrected.rows[k].x * seconds[k] / corrected.rows[k].variance;
    squares += std::pow(corrected.rows[k].x, 2) / corrected.rows[k].variance;
  }
  found.gyro_scale =
      also_by({scale.value - 1.0, scale.standard_error, scale.dof}, products / squares, beside->c);
}

}  // namespace

void add_gyro(const std::vector<TapedRun>& turns, const std::vector<TapedRun>& rests,
              TapeCalibration& found) {
  const std::vector<TapedRun> standing = with_gyro(rests);
  const std::vector<TapedRun> turned = with_gyro(turns);
  if (standing.empty() && turned.empty()) return;
  if (standing.empty()) {
    add_both_by_turns(turned, found);
    return;
  }
  const Estimate rate = rate_at_rest(standing, found);
  if (turned.empty()) {
    found.gyro_bias = rate;
    found.undetermined.emplace_back(
        "gyro scale: turn ten full turns each way, and write down what the gyro turned");
    return;
  }
  const bool untimed = std::any_of(turned.begin(), turned.end(),
                                   [](const TapedRun& run) { return !std::isfinite(run.seconds); });
  if (untimed) {
    found.notes.emplace_back(
        "turns without seconds keep what the gyro's bias turned meanwhile: write these down");
  }
  const TapedGroup group = group_of_readings(turned, rate.value, found);
  const Estimate ratio = judged_ratio(group, found);
  double products = 0.0;
  double squares = 0.0;
  for (std::size_t k = 0; k < turned.size(); ++k) {
    const double seconds = std::isfinite(turned[k].seconds) ? turned[k].seconds : 0.0;
    products += group.rows[k].x * seconds / group.rows[k].variance;
    squares += std::pow(group.rows[k].x, 2) / group.rows[k].variance;
  }
  found.gyro_scale = also_by({ratio.value - 1.0, ratio.standard_error, ratio.dof},
                             ratio.value * products / squares, rate);
  found.gyro_bias = Estimate{ratio.value * rate.value, ratio.value * rate.standard_error, rate.dof};
}

}  // namespace trussmap::calibration
