// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/driving_checks.hpp"

#include "recording/plan_limits.hpp"
#include "simulation/further_columns.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

namespace trussmap::simulation {
namespace {

void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument(what);
}

bool is_range(double low, double high) {
  return low > 0.0 && low <= high && std::isfinite(high);
}

bool is_share(double share) {
  return share >= 0.0 && share <= 1.0;
}

}  // namespace

void check_style(const DrivingStyle& style) {
  require(is_range(style.row_duration, 3600.0), "a row must last above 0 s");
  require(is_range(style.slowest, style.fastest), "speeds must be above 0 m/s, slowest first");
  require(is_range(style.slowest_turn, style.fastest_turn),
          "turn rates must be above 0 rad/s, slowest first");
  require(style.bend >= 0.0 && style.bend <= 0.5, "a leg's bend must lie between 0 and 0.5 rad");
  require(style.corner_reach >= 0.0 && style.corner_reach <= 1.0,
          "a corner must lie off the leg by 0 to 1 of its length");
  require(is_share(style.corner_share) && is_share(style.rest_share) &&
              is_share(style.load_change_share) && is_share(style.lights_change_share),
          "a share must lie between 0 and 1");
  require(is_range(style.shortest_rest, style.longest_rest),
          "rests must last above 0 s, shortest first");
  check_covariates(style.covariates);
  require(style.full_spins >= 0, "the number of stops with full spins must not be negative");
  require(std::isfinite(style.standing) && style.standing >= 0.0,
          "how exactly the robot stands on a landmark must be 0 m or more");
  for (const double value : {style.first_rest, style.last_rest, style.overrun, style.ramp}) {
    require(value >= 0.0 && value <= 1e5,
            "a rest, an overrun and a ramp must lie between 0 and 1e5, in s, m and s");
  }
}

void check_orders(const DrivingStyle& style, std::size_t legs) {
  require(std::isfinite(style.first_heading), "the first heading must be a number of rad");
  if (style.orders.empty()) return;
  require(style.orders.size() == legs,
          fmt::format("{} legs are ordered, expected {}, one each", style.orders.size(), legs));
  for (const LegOrder& one : style.orders) {
    require(is_range(one.speed, one.speed), "a leg's speed must be above 0 m/s");
    require(is_range(one.turn_rate, one.turn_rate), "a turn's rate must be above 0 rad/s");
    require(one.rest >= 0.0 && one.rest <= recording::kLongestStop,
            "a rest must lie between 0 and 1e5 s");
    require(std::abs(one.turn) <= recording::kMostTurn,
            fmt::format("a turn must be {} rad at most", recording::kMostTurn));
    require(std::abs(one.bend) <= recording::kSharpestBend, "a leg must bend by a radian at most");
    require(one.further.size() == style.covariates.size(),
            "a leg needs a value of each further column");
  }
}

void check_wheels(const Robot& robot) {
  const std::size_t columns = robot.columns.size();
  const bool lengths_hold = std::isfinite(robot.length) && robot.length > 0.0;
  const auto wants = [&](bool length, std::size_t count) {
    require(!length || lengths_hold, "the robot's length must be above 0 m");
    require(columns == count, fmt::format("a robot of drive {} has {} columns, expected {}",
                                          name_of(robot.drive), columns, count));
  };
  require(std::isfinite(robot.wheelbase) && robot.wheelbase > 0.0,
          "the wheelbase must be above 0 m");
  switch (robot.drive) {
    case DriveKind::differential:
      return;
    case DriveKind::unicycle:
      return wants(false, 2);
    case DriveKind::skid_steer:
      return require(
          columns == 2 || columns == 4 || columns == 6,
          fmt::format("a robot of drive skid-steer has {} columns, expected 2, 4 or 6", columns));
    case DriveKind::tricycle:
    case DriveKind::ackermann:
      require(std::isfinite(robot.wheel_left) && std::isfinite(robot.steer_left),
              "the wheels' places must be numbers of m");
      return wants(true, 2);
    case DriveKind::omni3:
      return wants(true, 3);
    case DriveKind::mecanum:
      return wants(true, 4);
    case DriveKind::wheels:
      break;
  }
  require(robot.matrix.rows() == 3 && columns >= 2 && columns <= 6,
          "a robot of drive wheels needs a matrix of 3 rows, and 2 to 6 columns");
  wants(false, static_cast<std::size_t>(robot.matrix.cols()));
  require(robot.places.empty() || robot.places.size() == columns,
          "each wheel's place must be given, or none's");
}

void check_walk(const Mesh& mesh, const std::vector<int>& walk, double standing,
                double turning_radius) {
  require(walk.size() >= 2, "a walk needs two landmarks");
  const double least = std::max({0.01, 20.0 * standing, 2.0 * turning_radius});
  for (std::size_t k = 0; k < walk.size(); ++k) {
    require(walk[k] >= 0 && walk[k] < mesh.landmarks(), "a walk keeps to the mesh's landmarks");
    require(k == 0 || mesh.displacement(walk[k - 1], walk[k]).norm() >= least,
            fmt::format("successive landmarks of a walk must be at least {:g} m apart{}", least,
                        turning_radius > 0.0 ? ", twice the radius in which the robot turns" : ""));
  }
}

}  // namespace trussmap::simulation
