// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/wheel_topics.hpp"

#include "logs/gathered_log.hpp"
#include "logs/log_survey.hpp"
#include "logs/map_guess.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::logs {
namespace {

/// Paths of the two wheels' angles among a JointState's joints.
bool find_joints(const LogTopicFacts& topic, WheelTopics& topics) {
  std::vector<std::string> left;
  std::vector<std::string> right;
  for (const LogFieldFacts& one : topic.fields) {
    if (!one.path.starts_with("position[") || !(one.largest > one.least)) continue;
    if (!has_word(one.path, {"wheel"})) continue;
    const std::string path = topic.name + '/' + one.path;
    if (has_word(one.path, {"left", "_l_", "[l_wheel", "wheel_l"})) left.push_back(path);
    if (has_word(one.path, {"right", "_r_", "[r_wheel", "wheel_r"})) right.push_back(path);
  }
  if (left.size() != 1 || right.size() != 1) return false;
  topics.left = left.front();
  topics.right = right.front();
  return true;
}

/// Those that are the wheels' own first, then what a filter made of them.
int rank(const std::string& name) {
  if (has_word(name, {"wheel", "raw", "controller"})) return 0;
  return has_word(name, {"filter", "ekf", "fused", "laser", "visual", "global", "gps", "map", "vio",
                         "icp", "slam"})
             ? 2
             : 1;
}

/// y = factor x by least squares; none where what is left is more than a twentieth.
std::optional<double> factor_of(const std::vector<double>& x, const std::vector<double>& y) {
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += x[k] * x[k];
    xy += x[k] * y[k];
    yy += y[k] * y[k];
  }
  if (!(xx > 0.0) || !(yy > 0.0)) return std::nullopt;
  const double factor = xy / xx;
  constexpr double kLeft = 0.05 * 0.05;
  if (yy - factor * xy > kLeft * yy || factor <= 0.0) return std::nullopt;
  return factor;
}

/// To four digits: more is noise of the clocks.
double rounded(double value) {
  const double scale = std::pow(10.0, 3.0 - std::floor(std::log10(value)));
  return std::round(value * scale) / scale;
}

}  // namespace

WheelTopics wheel_topics(const LogSurvey& survey) {
  WheelTopics topics;
  std::vector<std::string> odometries;
  for (const LogTopicFacts& one : survey.topics) {
    if (one.messages < 3) continue;
    const std::string type = short_type(one.type);
    if (type == "sensor_msgs/JointState" && topics.left.empty()) find_joints(one, topics);
    if (type == "nav_msgs/Odometry" && !is_called_truth(one.name)) odometries.push_back(one.name);
  }
  std::stable_sort(odometries.begin(), odometries.end(),
                   [](const auto& a, const auto& b) { return rank(a) < rank(b); });
  if (!odometries.empty()) {
    topics.odometry = odometries.front();
    topics.others.assign(odometries.begin() + 1, odometries.end());
  }
  return topics;
}

std::optional<WheelConstants> wheel_constants(const JoinedLogs& log, const WheelTopics& topics) {
  if (topics.left.empty() || topics.odometry.empty()) return std::nullopt;
  LogMap map;
  for (const std::string& path : {topics.left, topics.right}) {
    SignalMap wheel;
    wheel.field = path;
    wheel.kind = SignalMap::Kind::cumulative;
    map.wheels.emplace_back("", wheel);
  }
  map.odometry.twist = topics.odometry;
  GatheredLog gathered;
  try {
    gathered = gather(log, map);
  } catch (const InputError&) {  // what it lacks a conversion will say
    return std::nullopt;
  }
  Signal& left = gathered.wheels[0].second;
  Signal& right = gathered.wheels[1].second;
  left.finish();
  right.finish();
  SignalMap rate;
  rate.kind = SignalMap::Kind::rate;
  Signal ahead(rate);
  Signal turn(rate);
  for (const TimedTwist& one : gathered.twists) {
    ahead.add(one.t, one.twist.ahead);
    turn.add(one.t, one.twist.turn);
  }
  ahead.finish();
  turn.finish();
  if (left.size() < 3 || right.size() < 3 || ahead.size() < 3) return std::nullopt;
  // Over a second or so, for the twist may be late against the joints.
  constexpr std::int64_t kStep = 1000000000;
  std::vector<double> means, differences, ways, turns;
  const std::int64_t end =
      std::min({left.times().back(), right.times().back(), ahead.times().back()});
  std::int64_t t = std::max({left.times().front(), right.times().front(), ahead.times().front()});
  for (; t + kStep <= end; t += kStep) {
    const double l = left.sum(t, t + kStep);
    const double r = right.sum(t, t + kStep);
    means.push_back(0.5 * (l + r));
    differences.push_back(r - l);
    ways.push_back(ahead.sum(t, t + kStep));
    turns.push_back(turn.sum(t, t + kStep));
  }
  const auto radius = factor_of(means, ways);
  const auto per_difference = factor_of(differences, turns);
  if (!radius || !per_difference) return std::nullopt;
  return WheelConstants{rounded(*radius), rounded(*radius / *per_difference)};
}

}  // namespace trussmap::logs
