// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Elementary manoeuvres: one leg along a route, and what is done before it.
//
//   stand   0, 30 or 300 s                             turn    as needed, or 1 or 2 whole turns
//   more speed   slow, usual, limit                                 either way, slow or fast bend
//   none, 0.8 rad to the left or the right     loads   each level that the driver can set
#pragma once

#include "planning/plan_world.hpp"

#include <cstddef>
#include <vector>

namespace trussmap::planning {

inline constexpr double kStand = 30.0;       // s
inline constexpr double kLongStand = 300.0;  // s: until time and distance have gone apart
inline constexpr double kBend = 0.8;         // rad

struct Manoeuvre {
  int to = 0;          ///< landmark
  double speed = 0.0;  ///< m/s
  int turns = 0;       ///< whole ones beside what is needed, + to the left
  double rate = 0.0;   ///< rad/s
  double bend = 0.0;   ///< rad
  double stand = 0.0;  ///< s
  std::vector<double> loads;

  friend bool operator==(const Manoeuvre& a, const Manoeuvre& b) = default;
};

/// Connected: each leg begins where the one before ended.
struct PlannedTour {
  int start = 0;  ///< landmark
  std::vector<Manoeuvre> legs;

  /// Where its leg begins, or (one past the last) the tour ends.
  [[nodiscard]] int landmark(std::size_t leg) const { return leg == 0 ? start : legs[leg - 1].to; }
};

/// The leg as it is driven where nothing is to be told: loads as they were.
[[nodiscard]] Manoeuvre plain_leg(const PlanWorld& world, const PlannedTour& tour, int to);

/// The same leg with one thing changed, each way that there is.
[[nodiscard]] std::vector<Manoeuvre> variants_of(const PlanWorld& world, const Manoeuvre& leg);

[[nodiscard]] DrivePlan plan_of(const PlanWorld& world, const PlannedTour& tour);

}  // namespace trussmap::planning
