// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "explorer.hpp"

#include <algorithm>
#include <utility>

namespace trussmap::explore {

Explorer::Explorer(World& world, const MapBuilderOptions& options) : world_(world), map_(options) {
  map_.start(world_.landmark());
  here_ = map_.here();
  stand_here();
}

void Explorer::explore(double way, const std::function<void(const Arrival&)>& arrived) {
  arrived_ = arrived;
  while (true) {  // unknown ways first
    const Way unknown = to_nearest_unknown();
    if (unknown.empty()) break;
    follow(unknown);
    const std::vector<int>& ways = ways_out_.at(here_);
    drive(static_cast<int>(std::find(ways.begin(), ways.end(), kUnknown) - ways.begin()));
  }
  while (way_ < way) follow(most_worth_driving());
  follow(path(driven_, here_, 0, PathBy::uncertainty));
}

/// From wheels to map: rows are composed, with their covariance, and handed on as they are. Where
/// the map leaves the arrival out, the robot stands there all the same.
Arrival Explorer::drive(int way) {
  const int from = here_;
  const Driven driven = world_.leave_by(way);
  const double k = world_.options().wheels;
  Motion motion;
  for (const DrivenRow& row : driven.rows) {
    motion = then(motion, arc_motion({row.left, row.right}, world_.options().wheelbase, {k, k}));
  }
  Arrival arrival = map_.arrive(driven.landmark, motion);
  way_ += motion.displacement.position().norm();
  here_ = arrival.landmark;
  stand_here();
  const int to = here_;
  ways_out_[from][static_cast<std::size_t>(way)] = to;
  ways_out_[to][static_cast<std::size_t>(driven.way_back)] = from;
  const std::optional<Route> route = map_.route_between(from, to);
  const Matrix2 covariance = route ? route->covariance : motion.covariance.topLeftCorner<2, 2>();
  driven_.add_traversal(from, to, {map_.position(to) - map_.position(from), covariance});
  if (arrived_) arrived_(arrival);
  return arrival;
}

/// What can be read and seen where the robot stands.
void Explorer::stand_here() {
  const WorldOptions& robot = world_.options();
  note(world_.landmark());
  if (const std::optional<double> reading = world_.read_compass()) {
    map_.compass(*reading, robot.compass_sd);
  }
  for (const Seen& seen : world_.look_round()) {
    map_.observe(seen.landmark,
                 seen_at(seen.range, seen.bearing, robot.range_sd, robot.bearing_sd));
    note(seen.landmark);
  }
  ways_out_[here_].resize(world_.ways_out(), kUnknown);
}

void Explorer::note(const std::string& landmark) {
  if (!driven_.find(landmark)) {
    driven_.add_landmark(landmark, map_.position(*map_.find(landmark)));
  }
}

/// Along routes that were driven.
void Explorer::follow(const Way& landmarks) {
  for (std::size_t k = 1; k < landmarks.size(); ++k) {
    const std::vector<int>& ways = ways_out_.at(here_);
    drive(static_cast<int>(std::find(ways.begin(), ways.end(), landmarks[k]) - ways.begin()));
  }
}

double Explorer::length(const Way& way) const {
  double sum = 0.0;
  for (std::size_t k = 1; k < way.size(); ++k) {
    sum += (map_.position(way[k]) - map_.position(way[k - 1])).norm();
  }
  return sum;
}

/// The shortest way to a landmark that has an unknown way out; empty: there is none.
Explorer::Way Explorer::to_nearest_unknown() const {
  Way best;
  for (const auto& [landmark, ways] : ways_out_) {
    if (std::find(ways.begin(), ways.end(), kUnknown) == ways.end()) continue;
    Way way = path(driven_, here_, landmark);
    if (best.empty() || length(way) < length(best)) best = std::move(way);
  }
  return best;
}

/// All ways on of a few legs that the map has, turning round only in dead ends.
void Explorer::add_ways_on(const Way& so_far, std::vector<Way>& ways) const {
  constexpr std::size_t kLegsAhead = 4;
  if (so_far.size() > kLegsAhead) return;
  const std::vector<int>& ways_out = ways_out_.at(so_far.back());
  for (const int next : ways_out) {
    const bool back = so_far.size() > 1 && next == so_far[so_far.size() - 2];
    if (back && ways_out.size() > 1) continue;
    if (!map_.route_between(so_far.back(), next)) continue;  // it was left out
    Way way = so_far;
    way.push_back(next);
    add_ways_on(way, ways);
    ways.push_back(std::move(way));
  }
}

/// The first leg of the way whose drive lets the summed variance of all landmarks fall most per
/// metre; where it leads to, that is asked anew.
Explorer::Way Explorer::most_worth_driving() const {
  std::vector<Way> ways;
  add_ways_on({here_}, ways);
  if (ways.empty()) return {here_, ways_out_.at(here_).front()};
  const std::vector<double> falls = map_.expected_falls(ways);
  const auto worth = [&](std::size_t k) { return falls[k] / length(ways[k]); };
  std::size_t best = 0;
  for (std::size_t k = 1; k < ways.size(); ++k) {
    if (worth(k) > worth(best)) best = k;
  }
  return {ways[best][0], ways[best][1]};
}

}  // namespace trussmap::explore
