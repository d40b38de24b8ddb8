// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One coefficient per robot and day, and what the robots of a fleet have in common (trussmap/fleet
// .hpp): slopes first, then what it goes with, then common value, spread and robots that differ.
#pragma once

#include "fleet/pooled_sums.hpp"

#include <string>
#include <vector>

namespace trussmap::fleet {

/// Rows of one robot, in the order of their dates.
struct FleetMember {
  std::string robot;
  std::vector<std::size_t> rows;
  std::vector<double> day;                      ///< since its service, else since its first date
  std::map<std::string, std::string> metadata;  ///< that does not change
};

struct FleetMembers {
  std::vector<FleetMember> members;
  std::vector<std::string> keys;  ///< of the metadata, that divide the members into groups
};

/// Rows are sorted by robot and date.
[[nodiscard]] FleetMembers fleet_members(const std::vector<FleetRow>& rows);

struct DayEstimate {
  bool seen = false;
  double value = 0.0;
  double variance = 0.0;
  double remainder = 0.0;  ///< share of the variance that is second order, and may be of one sign
};

/// `days`: per row; `tests`: findings times coefficients that share the level.
[[nodiscard]] FleetCoefficient analyse_coefficient(const FleetMembers& fleet,
                                                   const std::vector<DayEstimate>& days,
                                                   double level, double tests);

}  // namespace trussmap::fleet
