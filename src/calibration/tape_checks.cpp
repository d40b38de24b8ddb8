// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/tape_parts.hpp"
#include "calibration/welch.hpp"
#include "statistics/distributions.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap::calibration {
namespace {

constexpr double kLeastShare = 5e-4;  // of a ratio: readings are rounded to some such share

std::string line_of(const TapedGroup& group, std::size_t run) {
  return group.lines[run] == 0 ? fmt::format("{} {}", group.one, run + 1)
                               : fmt::format("the {} of line {}", group.one, group.lines[run]);
}

void doubt_scatter(const TapedGroup& group, const RunRatio& all, TapeCalibration& found) {
  if (all.p_value >= kSureOfRuns) return;
  found.doubts.push_back(
      fmt::format("{} contradict each other: they scatter {:.1f} times as much as their sd allow "
                  "(p = {:.1g}), and the error is so much wider",
                  group.many, all.scatter, all.p_value));
}

/// Each run beside all others (externally studentized residuals).
void doubt_outliers(const TapedGroup& group, TapeCalibration& found) {
  constexpr std::size_t kFewest = 5;
  constexpr double kLeastOff = 2e-3;  // of the run
  const std::size_t count = group.rows.size();
  if (count < kFewest) return;
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<RunOfRatio> others = group.rows;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const RunRatio rest = ratio_of(others, false);
    const RunOfRatio& one = group.rows[k];
    const double off = one.y - rest.ratio.value * one.x;
    const double error =
        std::hypot(rest.scatter * std::sqrt(one.variance), rest.ratio.standard_error * one.x);
    if (!(error > 0.0) || std::abs(off) < kLeastOff * std::abs(one.x)) continue;
    const double p = 2.0 * statistics::student_p_value(std::abs(off) / error, rest.ratio.dof);
    if (p * static_cast<double>(count) > kSureOfRuns) continue;
    found.doubts.push_back(fmt::format(
        "{} is {:.2g} {} from what all others say, which scatter by {:.2g} {}: a slip, a misread "
        "tape, a slip of the pen?",
        line_of(group, k), group.unit_size * std::abs(off), group.unit,
        group.unit_size * rest.scatter * std::sqrt(one.variance), group.unit));
  }
}

/// Each run has the same error, whatever its size; 0 where that is not to be seen.
double doubt_offset(const TapedGroup& group, double ratio, TapeCalibration& found) {
  constexpr double kDiffer = 1.5;  // largest over smallest run
  double least = std::abs(group.rows.front().x);
  double most = least;
  std::vector<double> sign;
  for (const RunOfRatio& one : group.rows) {
    least = std::min(least, std::abs(one.x));
    most = std::max(most, std::abs(one.x));
    sign.push_back(one.x < 0.0 ? -1.0 : 1.0);
  }
  if (most < kDiffer * least) return 0.0;
  const std::optional<RatioBeside> beside = ratio_beside(group.rows, group.stated, sign);
  if (!beside || !contradicts(*beside, beside->ratio - ratio)) return 0.0;
  const auto size = [&](double value) { return group.unit_size * value; };
  found.doubts.push_back(fmt::format("every {}, short or long, is {:.2g} {} {} than its share: {}",
                                     group.one, size(std::abs(beside->c.value)), group.unit,
                                     beside->c.value < 0.0 ? "shorter" : "longer", group.offset));
  return beside->ratio - ratio;
}

}  // namespace

bool contradicts(const RatioBeside& beside, double share) {
  if (std::abs(share) < kLeastShare) return false;
  const double p = two_sided_p(beside.c);
  return std::isnan(p) || p < kSureOfRuns;
}

Estimate widened(const Estimate& estimate, double by, double dof) {
  return also_by(estimate, 1.0, {0.0, std::abs(by), dof});
}

std::vector<TapedRun> runs_of_kind(const std::vector<TapedRun>& runs, TapedKind kind) {
  std::vector<TapedRun> result;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(result),
               [kind](const TapedRun& run) { return run.kind == kind; });
  return result;
}

bool all_stated(const std::vector<TapedRun>& runs, double TapedRun::*sd, const char* column,
                const TapedGroup& group, TapeCalibration& found) {
  const auto with = std::count_if(runs.begin(), runs.end(),
                                  [sd](const TapedRun& run) { return std::isfinite(run.*sd); });
  const auto count = static_cast<std::ptrdiff_t>(runs.size());
  if (with > 0 && with < count) {
    found.notes.push_back(fmt::format("{} of {} {} have {}: errors are by their scatter instead",
                                      with, count, group.many, column));
  }
  return with == count && count > 0;
}

Estimate judged_ratio(const TapedGroup& group, TapeCalibration& found) {
  const RunRatio all = ratio_of(group.rows, group.stated);
  Estimate ratio = all.ratio;
  if (ratio.dof <= 0.0) {
    found.notes.push_back(
        group.rows.size() == 1
            ? fmt::format("one {} has no standard error: measure three, or state its sd", group.one)
            : fmt::format("all {} agree to the last digit, so that no standard error can be "
                          "stated: measure each anew, or state their sd",
                          group.many));
  }
  doubt_scatter(group, all, found);
  doubt_outliers(group, found);
  if (const double shift = doubt_offset(group, ratio.value, found); shift != 0.0) {
    ratio = widened(ratio, shift);
  }
  return ratio;
}

}  // namespace trussmap::calibration
