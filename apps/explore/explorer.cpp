// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "explorer.hpp"

#include <algorithm>
#include <limits>

namespace trussmap::explore {

Explorer::Explorer(World& world, const MapBuilderOptions& options) : world_(world), map_(options) {
  map_.start(world_.landmark());
  stand_here();
}

void Explorer::explore(double way, const std::function<void(const Arrival&)>& arrived) {
  arrived_ = arrived;
  while (true) {  // unknown ways first
    if (const std::optional<int> unknown = unknown_way()) {
      drive(*unknown);
      continue;
    }
    const std::vector<int> path = to_nearest_unknown();
    if (path.empty()) break;
    follow(path);
  }
  while (way_ < way) follow(to_most_worth_driving());
  follow(path(driven(), map_.here(), 0, PathBy::uncertainty));
}

/// From wheels to map: rows are composed, with their covariance, and handed on as they are.
void Explorer::drive(int way) {
  const std::string from = world_.landmark();
  const Driven driven = world_.leave_by(way);
  const double k = world_.options().wheels;
  Motion motion;
  for (const WheelTravel& row : driven.rows) {
    motion = then(motion, arc_motion(row, world_.options().wheelbase, {k, k}));
  }
  came_from_ = map_.here();
  const Arrival arrival = map_.arrive(driven.landmark, motion);
  way_ += motion.displacement.position().norm();
  stand_here();
  ways_[from][static_cast<std::size_t>(way)] = driven.landmark;
  ways_[driven.landmark][static_cast<std::size_t>(driven.way_back)] = from;
  if (arrived_) arrived_(arrival);
}

/// What can be read and seen where the robot stands.
void Explorer::stand_here() {
  const WorldOptions& robot = world_.options();
  if (const std::optional<double> reading = world_.read_compass()) {
    map_.compass(*reading, robot.compass_sd);
  }
  for (const Seen& seen : world_.look_round()) {
    map_.observe(seen.landmark,
                 seen_at(seen.range, seen.bearing, robot.range_sd, robot.bearing_sd));
  }
  ways_[world_.landmark()].resize(world_.ways_out().size());
}

/// Along landmarks that driven routes join.
void Explorer::follow(const std::vector<int>& landmarks) {
  const LandmarkGraph map = map_.map();
  for (std::size_t k = 1; k < landmarks.size(); ++k) {
    const WaysOut& ways = ways_[world_.landmark()];
    const auto way = std::find(ways.begin(), ways.end(), map.landmark(landmarks[k]).name);
    drive(static_cast<int>(way - ways.begin()));
  }
}

/// The map without routes to what was only seen: nobody can drive there.
LandmarkGraph Explorer::driven() const {
  const LandmarkGraph map = map_.map();
  LandmarkGraph driven;
  for (int k = 0; k < map.landmarks(); ++k) {
    driven.add_landmark(map.landmark(k).name, map.landmark(k).position);
  }
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    const auto ways = ways_.find(map.landmark(route.source).name);
    if (ways == ways_.end() ||
        std::ranges::count(ways->second, map.landmark(route.target).name) == 0) {
      continue;
    }
    driven.set_route(driven.add_route(route.source, route.target), route);
  }
  return driven;
}

std::optional<int> Explorer::unknown_way() const {
  const WaysOut& ways = ways_.at(world_.landmark());
  const auto unknown = std::find(ways.begin(), ways.end(), std::nullopt);
  if (unknown == ways.end()) return std::nullopt;
  return static_cast<int>(unknown - ways.begin());
}

double Explorer::length(const std::vector<int>& path) const {
  double sum = 0.0;
  for (std::size_t k = 1; k < path.size(); ++k) {
    sum += (map_.position(path[k]) - map_.position(path[k - 1])).norm();
  }
  return sum;
}

/// The shortest way to a landmark that still has an unknown way out; empty: there is none.
std::vector<int> Explorer::to_nearest_unknown() const {
  std::vector<int> best;
  const LandmarkGraph map = driven();
  for (const auto& [name, ways] : ways_) {
    if (std::find(ways.begin(), ways.end(), std::nullopt) == ways.end()) continue;
    std::vector<int> path = trussmap::path(map, map_.here(), *map_.find(name));
    if (best.empty() || length(path) < length(best)) best = std::move(path);
  }
  return best;
}

/// To the route whose next drive lets the summed variance of all landmarks fall most per metre of
/// the way there and along it. Routes on the way count as well, a little less; the way it came by
/// only where there is no other.
std::vector<int> Explorer::to_most_worth_driving() const {
  constexpr double kOnTheWay = 0.7;
  const LandmarkGraph map = driven();
  const LandmarkGraph whole = map_.map();
  const std::vector<double> falls = map_.expected_falls();  // of the whole's routes
  const auto fall_of = [&](int a, int b) {
    return falls[static_cast<std::size_t>(*whole.route_between(a, b))];
  };
  std::vector<int> best;
  double most = -std::numeric_limits<double>::infinity();
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    for (const bool forward : {true, false}) {
      std::vector<int> path =
          trussmap::path(map, map_.here(), forward ? route.source : route.target);
      double fall = fall_of(route.source, route.target);
      for (std::size_t k = 1; k < path.size(); ++k) {
        fall += kOnTheWay * fall_of(path[k - 1], path[k]);
      }
      path.push_back(forward ? route.target : route.source);
      if (path[1] == came_from_ && !best.empty()) continue;  // to turn round says little
      const double worth = fall / length(path);
      if (!best.empty() && best[1] != came_from_ && worth <= most) continue;
      most = worth;
      best = std::move(path);
    }
  }
  best.resize(2);  // after the next landmark it is asked anew
  return best;
}

}  // namespace trussmap::explore
