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

constexpr const char* kDiameterRatio = "E_d (right wheel / left wheel): ";

std::vector<TapedRun> with(const std::vector<TapedRun>& runs, double TapedRun::*what) {
  std::vector<TapedRun> result;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(result),
               [what](const TapedRun& run) { return std::isfinite(run.*what); });
  return result;
}

/// What the robot turns per metre of odometry, by the headings measured.
Estimate bend_by_headings(const std::vector<TapedRun>& runs, TapeCalibration& found) {
  TapedGroup group{"heading", "headings of straight runs", "deg", geometry::kDegrees,
                   "the start's heading is off by that"};
  group.stated = all_stated(runs, &TapedRun::sd_heading, "an sd_heading", group, found);
  for (const TapedRun& run : runs) {
    group.rows.push_back(
        {run.odometry, run.heading, group.stated ? run.sd_heading * run.sd_heading : 1.0});
    group.lines.push_back(run.line);
  }
  return judged_ratio(group, found);
}

/// The same by ends that are aside: an arc's end lies half of what it turns aside of its start's
/// direction. Where the runs were aimed is off alike in all of them.
Estimate bend_by_ends(const std::vector<TapedRun>& runs) {
  std::vector<double> bends;
  double common = 0.0;
  for (const TapedRun& run : runs) {
    bends.push_back(2.0 * run.aside / (run.expected * run.odometry));
    common = std::max(common, 2.0 * run.sd_start / run.odometry);
  }
  Estimate bend{bends.front(), 0.0, 0.0};
  if (bends.size() > 1) bend = mean_of(bends);
  return widened(bend, common, kStatedDof);
}

/// E_d by what a straight run turns per metre.
Estimate ratio_by_bend(const Estimate& bend, double wheelbase, const TapeCalibration& found) {
  Estimate turning{1.0, 0.0, 0.0};
  if (found.turn_factor) turning = *found.turn_factor;
  const double per_bend = wheelbase / (2.0 * turning.value);
  const double q = per_bend * bend.value;
  const double slope = 2.0 / ((1.0 - q) * (1.0 - q));
  const Estimate of_bend{(1.0 + q) / (1.0 - q), slope * per_bend * bend.standard_error, bend.dof};
  return also_by(of_bend, slope * q / turning.value, turning);
}

void say_why_no_ratio(const std::vector<TapedRun>& runs, double wheelbase, TapeCalibration& found) {
  const std::vector<TapedRun> ends = with(runs, &TapedRun::aside);
  if (ends.empty()) {
    found.undetermined.push_back(
        std::string(kDiameterRatio) +
        "a tape along the way shows no bend; measure by how much the robot has turned at the end "
        "of a straight run (column heading), or drive squares both ways (umbmark)");
    return;
  }
  double aside = 0.0;
  double angle = 0.0;
  double share = 0.0;
  for (const TapedRun& run : ends) {
    const double part = 1.0 / static_cast<double>(ends.size());
    aside += part * run.aside;
    angle += part * run.aside / run.expected;
    share += part * wheelbase * 2.0 * run.aside / (run.expected * run.odometry);
  }
  found.undetermined.push_back(fmt::format(
      "{}the runs end {:.2g} m to the {}, as wheels that differ by {:.2g} % would, and a start "
      "aimed {:.2g} deg askew as well; measure how far the robot has turned at the end (column "
      "heading), say how exactly it was aimed (column sd_start), or drive squares both ways "
      "(umbmark)",
      kDiameterRatio, std::abs(aside), aside < 0.0 ? "right" : "left", 100.0 * std::abs(share),
      geometry::kDegrees * std::abs(angle)));
}

/// What the runs turn per metre; none where nothing measured shows it.
std::optional<Estimate> bend_of(const std::vector<TapedRun>& straight, TapeCalibration& found) {
  const std::vector<TapedRun> turned = with(straight, &TapedRun::heading);
  if (!turned.empty()) return bend_by_headings(turned, found);
  const std::vector<TapedRun> aimed = with(with(straight, &TapedRun::aside), &TapedRun::sd_start);
  if (aimed.empty()) return std::nullopt;
  return bend_by_ends(aimed);
}

/// The tape is the chord of a bent run.
Estimate scale_of_runs(const std::vector<TapedRun>& straight, double bend, TapeCalibration& found) {
  TapedGroup group{"straight run", "straight runs", "mm", geometry::kMillimetres,
                   "a tape laid from another point of the robot at the start than at the stop, or "
                   "a length that is lost at each start"};
  group.stated = all_stated(straight, &TapedRun::sd, "an sd", group, found);
  double unknown = 0.0;  // share of the length that an unknown bend may take
  for (const TapedRun& run : straight) {
    const double half = 0.5 * (std::isfinite(run.heading) ? run.heading : bend * run.odometry);
    const double chord = half == 0.0 ? run.odometry : run.odometry * std::sin(half) / half;
    double variance = 1.0;
    if (group.stated) variance = run.sd * run.sd;
    if (group.stated && std::isfinite(run.sd_odometry)) {
      variance += std::pow(run.sd_odometry * run.expected / run.odometry, 2);
    }
    group.rows.push_back({chord, run.expected, variance});
    group.lines.push_back(run.line);
    if (half == 0.0 && std::isfinite(run.aside)) {
      unknown = std::max(unknown, std::pow(2.0 * run.aside / run.expected, 2) / 24.0);
    }
  }
  const Estimate scale = judged_ratio(group, found);
  if (scale.dof <= 0.0 || unknown == 0.0) return scale;
  return widened(scale, unknown * scale.value, kStatedDof);
}

}  // namespace

void add_lengths(const std::vector<TapedRun>& straight, double wheelbase, TapeCalibration& found) {
  if (straight.empty()) {
    found.undetermined.push_back(
        std::string(kDiameterRatio) +
        "turns on the spot do not show it; drive straight runs and measure by how much the robot "
        "has turned at their ends (column heading), or squares both ways (umbmark)");
    return;
  }
  const std::optional<Estimate> bend = bend_of(straight, found);
  found.scale = scale_of_runs(straight, bend ? bend->value : 0.0, found);
  if (bend) {
    found.diameter_ratio = ratio_by_bend(*bend, wheelbase, found);
  } else {
    say_why_no_ratio(straight, wheelbase, found);
  }
}

}  // namespace trussmap::calibration
