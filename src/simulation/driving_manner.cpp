// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/driving_manner.hpp"

#include "effects/channel_physics.hpp"
#include "geometry/index.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap::simulation {
namespace {

constexpr double kMostSteering = 0.6;  // rad, ackermann
constexpr double kNearlyAcross = 1.4;  // rad, tricycle
constexpr double kLongestArc = 0.6;    // rad of turn, to and fro
constexpr double kInOneArc = 100.0;    // rad
constexpr double kForwards = 1.171;    // of a mean arc's turn; no ratio of small whole numbers to
constexpr double kBack = 0.829;        // this
constexpr double kBackwards = 0.25;    // of the legs of a robot that steers
constexpr double kAside = 1.2;         // rad

}  // namespace

DrivingManner manner_of(const Robot& robot) {
  DrivingManner manner;
  if (effects::is_of_drive(Channel::steer, robot)) {
    manner.backwards = kBackwards;
    manner.bends_by_way = true;
  }
  if (robot.drive == DriveKind::tricycle) {
    manner.turning_radius = robot.length / std::tan(kNearlyAcross);
    manner.longest_arc = kInOneArc;
  }
  if (robot.drive == DriveKind::ackermann) {
    // A measured wheel goes ahead even where it is the inner one.
    manner.turning_radius =
        std::max({robot.length / std::tan(kMostSteering), 1.5 * std::abs(robot.wheel_left),
                  1.5 * std::abs(robot.steer_left)});
    manner.longest_arc = kLongestArc;
  }
  if (effects::is_of_drive(Channel::sideways, robot)) manner.aside = kAside;
  return manner;
}

int arcs_of_turn(double turn, const DrivingManner& manner) {
  return std::max(1, static_cast<int>(std::ceil(std::abs(turn) / manner.longest_arc)));
}

std::vector<double> turns_of_arcs(double turn, std::size_t arcs) {
  std::vector<double> turns;
  double sum = 0.0;
  for (std::size_t k = 0; k < arcs; ++k) {
    turns.push_back(k % 2 == 0 ? kForwards : kBack);
    sum += turns.back();
  }
  for (double& one : turns) one *= turn / sum;
  return turns;
}

int whole_rows(double seconds, double row_duration) {
  constexpr double kMost = 1e7;
  if (!(seconds / row_duration < kMost)) {
    throw std::invalid_argument(fmt::format(
        "speeds, turn rates and rests must not make a leg or a turn last {:g} s: 10^7 rows of {:g} "
        "s at most",
        seconds, row_duration));
  }
  return static_cast<int>(std::max(1L, std::lround(seconds / row_duration)));
}

std::vector<int> rows_of_arcs(double turn, const std::vector<double>& rates, double row_duration,
                              std::span<const int> earlier) {
  const std::vector<double> turns = turns_of_arcs(turn, rates.size());
  const int least = turn == 0.0 ? 0 : 1;
  std::vector<int> rows;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    const int wanted = least * whole_rows(std::abs(turns[k]) / rates[k], row_duration);
    rows.push_back(std::max(k < earlier.size() ? earlier[k] : wanted, least));
  }
  return rows;
}

std::vector<ArcRow> turning_arcs(double turn, double radius, const std::vector<int>& rows) {
  std::vector<ArcRow> result;
  const std::vector<double> turns = turns_of_arcs(turn, rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double way = (k % 2 == 0 ? 1.0 : -1.0) * radius * std::abs(turns[k]);
    result.insert(result.end(), idx(rows[k]), {way / rows[k], turns[k] / rows[k]});
  }
  return result;
}

}  // namespace trussmap::simulation
