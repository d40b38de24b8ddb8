// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/untied_drive.hpp"

#include "logs/log_map.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap::logs {
namespace {

constexpr double kShortestRest = 2.0;  // s: shorter, and slow wheels stand between two ticks
constexpr std::size_t kFewestRestRows = 10;

/// Whether no wheel moves in the row; what steers may.
bool stands(const Drive& drive, const Robot& robot, std::size_t row) {
  if (!drive.left.empty()) return drive.left[row] == 0.0 && drive.right[row] == 0.0;
  return std::all_of(drive.covariates.begin(), drive.covariates.end(), [&](const Covariate& one) {
    const bool wheel =
        std::find(robot.columns.begin(), robot.columns.end(), one.name) != robot.columns.end();
    return !wheel || is_steering_column(robot, one.name) || one.values[row] == 0.0;
  });
}

}  // namespace

std::optional<GyroAtRest> gyro_at_rest(const Drive& drive, const Robot& robot) {
  if (!drive.has_gyro()) return std::nullopt;
  GyroAtRest found;
  std::vector<double> rates;
  std::size_t row = 0;
  while (row < drive.rows()) {
    std::size_t end = row;
    double lasts = 0.0;
    while (end < drive.rows() && stands(drive, robot, end)) lasts += drive.duration(end++);
    for (std::size_t k = row + 1; lasts >= kShortestRest && k + 1 < end; ++k) {
      if (std::isnan(drive.yaw_rate[k])) continue;
      rates.push_back(drive.yaw_rate[k]);
      found.duration += drive.duration(k);
    }
    row = std::max(end, row + 1);
  }
  if (rates.size() < kFewestRestRows) return std::nullopt;
  const auto count = static_cast<double>(rates.size());
  for (const double one : rates) found.mean += one / count;
  double squares = 0.0;
  for (const double one : rates) squares += (one - found.mean) * (one - found.mean);
  found.sd = std::sqrt(squares / (count - 1.0) / count);
  return found;
}

std::vector<std::string> untied_warnings(const Drive& drive, const Robot& robot) {
  std::vector<std::string> said{
      "nothing ties the drive to a place: no sighting, fix or truth is within it. apply "
      "dead-reckons "
      "it; fit, compare and discover need [[sightings]], [fixes] or [truth]"};
  if (!drive.has_gyro()) return said;
  const std::optional<GyroAtRest> rest = gyro_at_rest(drive, robot);
  if (!rest) {
    said.emplace_back(
        "the gyro's bias is not known: the wheels never stand for 2 s and more, expected a rest");
    return said;
  }
  said.push_back(fmt::format(
      "the gyro reads {:.3g} +- {:.2g} rad/s while the wheels stand ({:.0f} s in all): its bias, "
      "which apply takes off where the model has [[effect]] name = \"gyro bias\", coefficients = "
      "[{:.3g}]",
      rest->mean, rest->sd, rest->duration, rest->mean));
  return said;
}

}  // namespace trussmap::logs
