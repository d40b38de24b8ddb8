// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "explorer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trussmap::explore {

namespace {

/// How fast the wheels go, m/s: all that says how long a row lasts.
constexpr double kWheelSpeed = 0.5;
/// An alarm waits until one effect has this share of the evidence, so many legs at most: the map is
/// made anew from where the effect began, and loses nothing by it.
constexpr double kClearlyNamed = 0.98;
constexpr int kLongestWait = 10;
/// More are no longer taken in: then it is not one of the effects watched.
constexpr std::size_t kMostAlarms = 20;
/// It stops on a landmark as exactly as this, m.
constexpr double kStop = 0.001;

Model model_of(const WorldOptions& world) {
  Model model;
  model.robot.wheelbase = world.wheelbase;
  model.noise.left = model.noise.right = world.wheels;
  model.noise.compass = world.compass_sd;
  model.noise.sighting = kStop;
  model.noise.range = world.range_sd;
  model.noise.bearing = world.bearing_sd;
  return model;
}

WheelRow row_of(const DrivenRow& driven) {
  WheelRow row;
  row.left = driven.left;
  row.right = driven.right;
  const double way = std::max(std::abs(driven.left), std::abs(driven.right));
  row.duration = std::max(way / kWheelSpeed, 1e-3);
  return row;
}

}  // namespace

Explorer::Explorer(World& world, const MapBuilderOptions& options, bool watches)
    : world_(world),
      options_(options),
      watches_(watches),
      model_(model_of(world.options())),
      start_(look()),
      monitor_(fresh_monitor()),
      map_(options) {
  begin();
}

/// An empty map, from where the robot started.
void Explorer::begin() {
  map_ = MapBuilder(options_);
  driven_ = LandmarkGraph();
  ways_out_.clear();
  way_ = 0.0;
  map_.start(start_.landmark);
  here_ = map_.here();
  stand_at(start_);
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

Arrival Explorer::drive(int way) {
  legs_.push_back({way, world_.leave_by(way), {}});
  legs_.back().end = look();
  Arrival arrival;
  if (watches_ && model_fails()) {
    begin();
    for (std::size_t leg = 0; leg < legs_.size(); ++leg) arrival = take(leg);
  } else {
    arrival = take(legs_.size() - 1);
  }
  if (arrived_) arrived_(arrival);
  return arrival;
}

MeasuredEnd Explorer::measured_at(const Stand& stand) {
  MeasuredEnd end;
  end.sightings.push_back({0.0, stand.landmark});
  for (const Seen& seen : stand.seen) {
    end.sightings.push_back({0.0, seen.landmark, seen.range, seen.bearing});
  }
  return end;
}

Monitor Explorer::fresh_monitor() const {
  Monitor monitor(model_, {.compass = world_.options().compass});
  (void)monitor.arrive(measured_at(start_));
  return monitor;
}

/// The monitor sees the leg; whether something is found, of which the name is clear by now.
bool Explorer::sees_failure(const DrivenLeg& leg) {
  const std::vector<DrivenRow>& rows = leg.driven.rows;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    WheelRow row = row_of(rows[k]);
    if (k + 1 == rows.size() && leg.end.compass) row.compass = *leg.end.compass;
    (void)monitor_.drive(row);
  }
  const MonitorReport report = monitor_.arrive(measured_at(leg.end));
  if (!report.alarm || !report.found) return false;
  if (report.found->share < kClearlyNamed && ++unclear_ < kLongestWait) return false;
  unclear_ = 0;
  return true;
}

/// What is found belongs to the odometry from there on where it began: the monitor sees all legs
/// anew, and may find more.
bool Explorer::model_fails() {
  if (!sees_failure(legs_.back())) return false;
  for (bool fails = true; fails;) {
    const FoundEffect found = *monitor_.report().found;
    alarms_.push_back({static_cast<long>(legs_.size()), found});
    fails = false;
    monitor_ = fresh_monitor();
    for (std::size_t leg = 0; leg < legs_.size() && !fails; ++leg) {
      for (const Alarm& alarm : alarms_) {
        if (alarm.found.leg == static_cast<long>(leg) + 1) {
          monitor_.add(alarm.found.effect, alarm.found.sd);
        }
      }
      fails = sees_failure(legs_[leg]) && alarms_.size() < kMostAlarms;
    }
  }
  return true;
}

/// Rows are composed, with their covariance, by the model as it was for this leg.
Motion Explorer::motion_of(std::size_t leg) const {
  Model model = model_;
  for (const Alarm& alarm : alarms_) {
    const bool since = static_cast<long>(leg) + 1 >= alarm.found.leg;
    if (since) model.effects.push_back(alarm.found.effect);
  }
  CorrectedOdometry odometry(model);
  Motion motion;
  for (const DrivenRow& row : legs_[leg].driven.rows) {
    motion = then(motion, odometry.drive(row_of(row)).motion);
  }
  return motion;
}

/// From wheels to map: the motion is handed on as it is. Where the map leaves the arrival out, the
/// robot stands there all the same.
Arrival Explorer::take(std::size_t number) {
  const DrivenLeg& leg = legs_[number];
  const int from = here_;
  const Motion motion = motion_of(number);
  Arrival arrival = map_.arrive(leg.driven.landmark, motion);
  way_ += motion.displacement.position().norm();
  here_ = arrival.landmark;
  stand_at(leg.end);
  const int to = here_;
  ways_out_[from][static_cast<std::size_t>(leg.way)] = to;
  ways_out_[to][static_cast<std::size_t>(leg.driven.way_back)] = from;
  const std::optional<Route> route = map_.route_between(from, to);
  const Matrix2 covariance = route ? route->covariance : motion.covariance.topLeftCorner<2, 2>();
  driven_.add_traversal(from, to, {map_.position(to) - map_.position(from), covariance});
  return arrival;
}

Explorer::Stand Explorer::look() {
  Stand stand{world_.landmark(), world_.ways_out(), world_.read_compass(), {}};
  stand.seen = world_.look_round();
  return stand;
}

/// What was read and seen goes into the map.
void Explorer::stand_at(const Stand& stand) {
  const WorldOptions& robot = world_.options();
  note(stand.landmark);
  if (stand.compass) map_.compass(*stand.compass, robot.compass_sd);
  for (const Seen& seen : stand.seen) {
    map_.observe(seen.landmark,
                 seen_at(seen.range, seen.bearing, robot.range_sd, robot.bearing_sd));
    note(seen.landmark);
  }
  ways_out_[here_].resize(stand.ways_out, kUnknown);
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
