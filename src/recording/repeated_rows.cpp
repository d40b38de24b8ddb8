// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "recording/repeated_rows.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <set>
#include <string_view>
#include <tuple>

namespace trussmap::recording {
namespace {

/// Absent ones behind all others.
double ordered(double value) {
  return value != value ? std::numeric_limits<double>::infinity() : value;
}

}  // namespace

std::vector<bool> repeated_rows(const std::vector<Sighting>& sightings) {
  using Row = std::tuple<std::string_view, double, double, double, double, double>;
  std::set<Row> seen;  // at one time
  std::vector<bool> repeated;
  repeated.reserve(sightings.size());
  for (std::size_t k = 0; k < sightings.size(); ++k) {
    const Sighting& one = sightings[k];
    if (k > 0 && one.t != sightings[k - 1].t) seen.clear();
    repeated.push_back(!seen.emplace(one.landmark, ordered(one.range), ordered(one.bearing),
                                     ordered(one.yaw), ordered(one.dx), ordered(one.dy))
                            .second);
  }
  return repeated;
}

std::vector<bool> repeated_rows(const std::vector<Loop>& loops) {
  std::set<std::array<double, 7>> seen;
  std::vector<bool> repeated;
  repeated.reserve(loops.size());
  for (const Loop& one : loops) {
    repeated.push_back(!seen.insert({one.t, one.t2, one.dx, one.dy, one.dtheta, ordered(one.sd),
                                     ordered(one.sd_heading)})
                            .second);
  }
  return repeated;
}

}  // namespace trussmap::recording
