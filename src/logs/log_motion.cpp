// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/log_motion.hpp"

#include "logs/calendar.hpp"
#include "logs/gathered_log.hpp"
#include "logs/wheel_rows.hpp"
#include "trussmap/error.hpp"
#include "trussmap/planar.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::logs {
namespace {

double in_seconds(std::int64_t t) {
  return static_cast<double>(t) / static_cast<double>(kNanosecondsPerSecond);
}

void add_wheel_motion(const LogMap& map, GatheredLog& log, std::vector<LoggedMotion>& found) {
  if (map.wheels.empty() && map.odometry.line == 0) return;
  WheelRows rows;
  try {
    rows = wheel_rows(map, log);
  } catch (const InputError&) {  // what it lacks a conversion will say
    return;
  }
  if (rows.left.empty()) return;
  const std::string what = map.wheels.empty() ? "odometry" : "wheels";
  LoggedMotion turn{what, true, rows.bounds, {0.0}};
  LoggedMotion way{what, false, rows.bounds, {0.0}};
  for (std::size_t k = 0; k < rows.left.size(); ++k) {
    turn.x.push_back(turn.x.back() + rows.right[k] - rows.left[k]);
    way.x.push_back(way.x.back() + 0.5 * std::abs(rows.right[k] + rows.left[k]));
  }
  const bool held =
      !map.odometry.twist.empty() || !map.odometry.speed.empty() || !map.odometry.modules.empty();
  turn.held = way.held = held;
  found.push_back(std::move(turn));
  found.push_back(std::move(way));
}

void add_turns(const char* what, std::vector<Signal>& signals, bool rate,
               std::vector<LoggedMotion>& found) {
  for (Signal& one : signals) {
    one.finish();
    if (one.size() < 3) continue;
    LoggedMotion motion{what, true, one.times(), one.values()};
    motion.held = rate;
    if (rate) {
      motion.x.assign(1, 0.0);
      for (std::size_t k = 1; k < one.size(); ++k) {
        const double dt = in_seconds(motion.t[k] - motion.t[k - 1]);
        motion.x.push_back(motion.x.back() + one.values()[k] * dt);
      }
    }
    found.push_back(std::move(motion));
  }
}

template <typename Row>
void sort_by_time(std::vector<Row>& rows) {
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.t < b.t; });
  rows.erase(
      std::unique(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.t == b.t; }),
      rows.end());
}

void add_truth(GatheredLog& log, std::vector<LoggedMotion>& found) {
  sort_by_time(log.truth);
  if (log.truth.size() < 3) return;
  LoggedMotion turn{"truth", true, {}, {}};
  LoggedMotion way{"truth", false, {}, {}};
  for (const TimedFieldPose& one : log.truth) {
    const double before = turn.x.empty() ? one.heading : turn.x.back();
    turn.t.push_back(one.t);
    turn.x.push_back(before + wrap_angle(one.heading - before));
    way.x.push_back(one.x);
    way.y.push_back(one.y);
  }
  way.t = turn.t;
  found.push_back(std::move(turn));
  found.push_back(std::move(way));
}

void add_fix_motion(GatheredLog& log, std::vector<LoggedMotion>& found) {
  sort_by_time(log.fixes);
  if (log.fixes.size() < 3 || log.fixes.front().geodetic) return;
  LoggedMotion way{"fixes", false, {}, {}};
  for (const SeenFix& one : log.fixes) {
    way.t.push_back(one.t);
    way.x.push_back(one.x);
    way.y.push_back(one.y);
  }
  found.push_back(std::move(way));
}

}  // namespace

double LoggedMotion::first() const {
  return in_seconds(t.front());
}

double LoggedMotion::last() const {
  return in_seconds(t.back());
}

double LoggedMotion::step() const {
  return median_step(t);
}

double LoggedMotion::between(double from, double to) const {
  const double begin = first();
  const auto at = [this, begin](double time, const std::vector<double>& value) {
    const double since = time - begin;
    const auto when =
        t.front() +
        static_cast<std::int64_t>(std::llround(since * static_cast<double>(kNanosecondsPerSecond)));
    const auto after = std::lower_bound(t.begin(), t.end(), when);
    if (after == t.end() || (after == t.begin() && *after != when)) return kAbsent;
    const auto k = static_cast<std::size_t>(after - t.begin());
    if (t[k] == when) return value[k];
    const double share =
        static_cast<double>(when - t[k - 1]) / static_cast<double>(t[k] - t[k - 1]);
    return value[k - 1] + share * (value[k] - value[k - 1]);
  };
  const double dx = at(to, x) - at(from, x);
  return y.empty() ? dx : std::hypot(dx, at(to, y) - at(from, y));
}

std::vector<LoggedMotion> motions_of(const JoinedLogs& log, const LogMap& map) {
  std::vector<LoggedMotion> found;
  GatheredLog gathered;
  try {
    gathered = gather(log, map);
  } catch (const InputError&) {
    return found;
  }
  add_wheel_motion(map, gathered, found);
  const bool rate = map.yaw_rate && map.yaw_rate->kind == SignalMap::Kind::rate;
  add_turns("gyro", gathered.yaw_rate, rate, found);
  add_turns("heading", gathered.heading, false, found);
  add_truth(gathered, found);
  add_fix_motion(gathered, found);
  return found;
}

}  // namespace trussmap::logs
