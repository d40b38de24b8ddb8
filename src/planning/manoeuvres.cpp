// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "planning/manoeuvres.hpp"

#include "geometry/index.hpp"

#include <cmath>
#include <numbers>

namespace trussmap::planning {
namespace {

std::vector<double> first_levels(const PlanWorld& world) {
  std::vector<double> levels;
  for (const LoadLevels& load : world.loads) levels.push_back(load.levels.front());
  return levels;
}

}  // namespace

Manoeuvre plain_leg(const PlanWorld& world, const PlannedTour& tour, int to) {
  Manoeuvre leg;
  leg.to = to;
  leg.speed = world.speeds[1];
  leg.rate = world.turn_rates.back();
  leg.loads = tour.legs.empty() ? first_levels(world) : tour.legs.back().loads;
  return leg;
}

std::vector<Manoeuvre> variants_of(const PlanWorld& world, const Manoeuvre& leg) {
  std::vector<Manoeuvre> all;
  const auto add = [&](const auto& change) {
    Manoeuvre other = leg;
    change(other);
    if (other != leg) all.push_back(std::move(other));
  };
  for (const double speed : world.speeds) add([&](Manoeuvre& one) { one.speed = speed; });
  for (const double rate : world.turn_rates) {
    add([&](Manoeuvre& one) { one.rate = rate; });
    for (const int turns : {0, -1, 1, -2, 2}) {
      add([&](Manoeuvre& one) {
        one.turns = turns;
        one.rate = rate;
      });
    }
  }
  for (const double bend : {0.0, -kBend, kBend}) add([&](Manoeuvre& one) { one.bend = bend; });
  for (const double stand : {0.0, kStand, kLongStand})
    add([&](Manoeuvre& one) { one.stand = stand; });
  for (std::size_t k = 0; k < world.loads.size(); ++k) {
    for (const double level : world.loads[k].levels) {
      add([&](Manoeuvre& one) { one.loads[k] = level; });
    }
  }
  return all;
}

DrivePlan plan_of(const PlanWorld& world, const PlannedTour& tour) {
  DrivePlan plan;
  for (const LoadLevels& load : world.loads) plan.loads.push_back(load.name);
  double arrives = 0.0;
  for (std::size_t k = 0; k <= tour.legs.size(); ++k) {
    const int here = tour.landmark(k);
    Waypoint one;
    one.landmark = landmark_name(world.mesh, here);
    one.place = world.mesh.positions[idx(here)];
    one.heading = arrives;
    if (k > 0) {
      one.speed = tour.legs[k - 1].speed;
      one.bend = tour.legs[k - 1].bend;
    }
    if (k < tour.legs.size()) {
      const Manoeuvre& leg = tour.legs[k];
      const double course = direction(world.mesh.displacement(here, leg.to));
      const double leaves = wrap_angle(course - 0.5 * leg.bend);
      const double needed = k == 0 ? 0.0 : wrap_angle(leaves - arrives);
      one.heading = leaves;
      one.turn = needed + 2.0 * std::numbers::pi * leg.turns;
      if (one.turn != 0.0) one.turn_rate = leg.rate;
      one.stop = leg.stand;
      one.loads = leg.loads;
      arrives = wrap_angle(course + 0.5 * leg.bend);
    } else {
      one.loads = tour.legs.empty() ? first_levels(world) : tour.legs.back().loads;
    }
    plan.waypoints.push_back(std::move(one));
  }
  return plan;
}

}  // namespace trussmap::planning
