// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/wheel_rows.hpp"

#include "logs/calendar.hpp"
#include "logs/message_feed.hpp"
#include "trussmap/error.hpp"
#include "trussmap/planar.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap::logs {
namespace {

/// Named left and right, and not columns of their own.
bool has_two_wheels(const Robot& robot) {
  return robot.drive == DriveKind::differential && robot.columns.empty();
}

struct NamedSignal {
  std::string name;
  Signal signal;
};

SignalMap of_kind(SignalMap::Kind kind) {
  SignalMap map;
  map.kind = kind;
  return map;
}

/// How a robot that goes sideways may be told: by the motions of its body.
bool is_told_by_body(const Robot& robot) {
  return robot.drive == DriveKind::wheels && robot.matrix.rows() == 3 && robot.matrix.cols() == 3 &&
         robot.matrix.isIdentity();
}

/// What an odometry says: velocities that hold since the one before, or ways since then.
struct BodyMotions {
  SignalMap::Kind kind = SignalMap::Kind::rate;
  std::vector<TimedTwist> motions;
};

/// Of the poses that an odometry sums up: from one to the next along an arc.
BodyMotions motions_between(std::vector<TimedFieldPose> poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const TimedFieldPose& a, const TimedFieldPose& b) { return a.t < b.t; });
  BodyMotions result{SignalMap::Kind::per_row, {}};
  for (std::size_t k = 0; k < poses.size(); ++k) {
    FieldTwist way;
    if (k > 0) {
      const TimedFieldPose& from = poses[k - 1];
      const double half_turn = 0.5 * wrap_angle(poses[k].heading - from.heading);
      const double c = std::cos(from.heading + half_turn);
      const double s = std::sin(from.heading + half_turn);
      const double dx = poses[k].x - from.x;
      const double dy = poses[k].y - from.y;
      const double arc = std::abs(half_turn) < 1e-9 ? 1.0 : half_turn / std::sin(half_turn);
      way = {(dx * c + dy * s) * arc, (dy * c - dx * s) * arc, 2.0 * half_turn};
    }
    result.motions.push_back({poses[k].t, way});
  }
  return result;
}

BodyMotions body_motions_of(const LogMap& map, const GatheredLog& log) {
  const OdometryMap& odometry = map.odometry;
  const bool twist =
      !odometry.twist.empty() || !odometry.speed.empty() || !odometry.modules.empty();
  if (twist) return {SignalMap::Kind::rate, log.twists};
  if (!is_frame_path(odometry.pose)) return motions_between(log.odometry);
  return motions_between(
      poses_along(odometry.pose, log.frames, map, odometry.line, odometry.clock));
}

/// The two wheels that would drive so.
std::vector<NamedSignal> two_wheels(const BodyMotions& body, double wheelbase) {
  std::vector<NamedSignal> wheels{{"left", Signal(of_kind(body.kind))},
                                  {"right", Signal(of_kind(body.kind))}};
  for (const TimedTwist& one : body.motions) {
    const double half = 0.5 * wheelbase * one.twist.turn;
    wheels[0].signal.add(one.t, one.twist.ahead - half);
    wheels[1].signal.add(one.t, one.twist.ahead + half);
  }
  return wheels;
}

std::vector<NamedSignal> body_columns(const BodyMotions& body,
                                      const std::vector<std::string>& names) {
  std::vector<NamedSignal> columns;
  for (const std::string& name : names) columns.push_back({name, Signal(of_kind(body.kind))});
  for (const TimedTwist& one : body.motions) {
    columns[0].signal.add(one.t, one.twist.ahead);
    columns[1].signal.add(one.t, one.twist.left);
    columns[2].signal.add(one.t, one.twist.turn);
  }
  return columns;
}

void warn_of_sideways(const std::vector<TimedTwist>& twists, std::vector<std::string>& warnings) {
  double ahead = 0.0;
  double sideways = 0.0;
  for (const TimedTwist& one : twists) {
    ahead += std::abs(one.twist.ahead);
    sideways += std::abs(one.twist.left);
  }
  constexpr double kFew = 0.02;  // of the way ahead
  if (sideways <= kFew * ahead) return;
  warnings.push_back(fmt::format(
      "the twist also moves to the side, {:.0f} % as much as ahead: passed over; a robot that does "
      "so needs drive = \"wheels\" with a matrix, or [wheels] (docs/logs.md)",
      100.0 * sideways / std::max(ahead, 1e-9)));
}

std::vector<NamedSignal> all_wheels(const LogMap& map, GatheredLog& log, WheelRows& rows) {
  const Robot& robot = map.model.robot;
  const bool two = has_two_wheels(robot);
  const std::vector<std::string> expected =
      two ? std::vector<std::string>{"left", "right"} : robot.columns;
  if (map.odometry.line > 0 && map.wheels.empty()) {
    const BodyMotions body = body_motions_of(map, log);
    if (is_told_by_body(robot)) return body_columns(body, robot.columns);
    if (!two) {
      throw InputError(
          map.file.string(), map.odometry.line,
          fmt::format(
              "[odometry] gives the travels of two wheels, drive {} has others, expected "
              "[wheels.NAME] for each of its columns, or of a robot that goes sideways "
              "drive = \"wheels\", three columns and matrix = [[1, 0, 0], [0, 1, 0], [0, 0, "
              "1]]",
              name_of(robot.drive)));
    }
    if (body.kind == SignalMap::Kind::rate) warn_of_sideways(body.motions, rows.warnings);
    return two_wheels(body, robot.wheelbase);
  }
  std::vector<NamedSignal> wheels;
  for (const std::string& name : expected) {
    const auto found = std::find_if(log.wheels.begin(), log.wheels.end(),
                                    [&](const auto& one) { return one.first == name; });
    if (found == log.wheels.end()) {
      throw InputError(map.file.string(), 0,
                       fmt::format("has no [wheels.{}], expected one, for the drive {}", name,
                                   name_of(robot.drive)));
    }
    wheels.push_back({name, std::move(found->second)});
  }
  for (const auto& [name, signal] : map.wheels) {
    if (std::find(expected.begin(), expected.end(), name) == expected.end()) {
      throw InputError(map.file.string(), signal.line,
                       fmt::format("[wheels.{}] is no wheel of drive {}, expected {}", name,
                                   name_of(robot.drive), fmt::join(expected, ", ")));
    }
  }
  return wheels;
}

/// Poses that stand still although the velocities beside them do not are none of an odometry; and
/// of what never moves it is said.
void check_that_it_moves(const LogMap& map, const GatheredLog& log, WheelRows& rows) {
  const auto moves = [](const std::vector<double>& travels) {
    return std::any_of(travels.begin(), travels.end(), [](double one) { return one != 0.0; });
  };
  bool any = moves(rows.left) || moves(rows.right);
  for (const Covariate& one : rows.columns) {
    any = any || (!is_steering_column(map.model.robot, one.name) && moves(one.values));
  }
  if (any) return;
  if (!map.odometry.pose.empty() && log.twists_move) {
    throw InputError(map.file.string(), map.odometry.line,
                     fmt::format("[odometry]: the poses of {} never move where its velocities do, "
                                 "expected twist = \"{}\" in place of pose",
                                 map.odometry.pose, map.odometry.pose));
  }
  rows.warnings.emplace_back(
      "the wheels never move: every travel is 0; another field has the motion, or the robot stood");
}

/// Beginnings and ends of rows, within what all wheels have.
std::vector<std::int64_t> bounds_of(const LogMap& map, const std::vector<NamedSignal>& wheels) {
  const Signal* slowest = &wheels.front().signal;
  std::int64_t from = slowest->times().front();
  std::int64_t to = slowest->times().back();
  for (const NamedSignal& one : wheels) {
    from = std::max(from, one.signal.times().front());
    to = std::min(to, one.signal.times().back());
    if (one.signal.size() < slowest->size()) slowest = &one.signal;
  }
  std::vector<std::int64_t> bounds;
  if (map.period > 0.0) {
    const auto period = nanoseconds(map.period);
    constexpr std::int64_t kMostRows = 20000000;
    if (period <= 0 || (to > from && (to - from) / period > kMostRows)) {
      throw InputError(
          map.file.string(), 0,
          fmt::format("[rows] period = {} s gives more than {} rows, expected a longer "
                      "one",
                      map.period, kMostRows));
    }
    for (std::int64_t t = from; t <= to; t += period) bounds.push_back(t);
  } else {
    for (const std::int64_t t : slowest->times()) {
      if (t >= from && t <= to) bounds.push_back(t);
    }
  }
  return bounds;
}

void warn_of_gaps(const std::vector<std::int64_t>& bounds, std::vector<std::string>& warnings) {
  const double step = median_step(bounds);
  constexpr double kLong = 10.0;  // steps
  std::size_t gaps = 0;
  double longest = 0.0;
  for (std::size_t k = 1; k < bounds.size(); ++k) {
    const double dt = static_cast<double>(bounds[k] - bounds[k - 1]) / kNanosecondsPerSecond;
    if (dt <= kLong * step || dt <= 1.0) continue;
    ++gaps;
    longest = std::max(longest, dt);
  }
  if (gaps > 0) {
    warnings.push_back(
        fmt::format("the wheels' messages have {} gap{}, the longest of {:.1f} s: what was driven "
                    "there is taken as one arc",
                    gaps, gaps == 1 ? "" : "s", longest));
  }
}

}  // namespace

std::vector<TimedFieldPose> poses_along(const std::string& path, const FrameTree& frames,
                                        const LogMap& map, std::size_t line, double clock) {
  const FramePath names = frame_path(path, frames);
  std::string known;
  constexpr std::size_t kMost = 20;
  for (const auto& [child, link] : frames.links()) {
    if (known.size() > kMost * kMost) break;
    known += (known.empty() ? "" : ", ") + link.parent + "." + child;
  }
  if (!frames.are_joined(names.parent, names.child)) {
    throw InputError(
        map.file.string(), line,
        fmt::format("frames {} and {} are not joined, expected two that are; there are "
                    "{}",
                    names.parent, names.child, known));
  }
  std::vector<TimedFieldPose> poses;
  for (const std::int64_t t : frames.times(names.parent, names.child)) {
    const auto transform = frames.transform(names.parent, names.child, t);
    if (!transform) continue;
    poses.push_back({t + nanoseconds(clock), transform->translation().x(),
                     transform->translation().y(), planar_axis(transform->rotation(), 'x').angle});
  }
  if (poses.empty()) {
    throw InputError(map.file.string(), line,
                     fmt::format("frame {} does not move in {}, expected one that does",
                                 names.child, names.parent));
  }
  return poses;
}

OdometryRows odometry_rows(const LogMap& map, const GatheredLog& log,
                           const std::vector<std::int64_t>& bounds) {
  std::vector<NamedSignal> wheels =
      two_wheels(body_motions_of(map, log), map.model.robot.wheelbase);
  OdometryRows rows;
  for (NamedSignal& one : wheels) one.signal.finish();
  const Signal& times = wheels.front().signal;
  if (times.size() < 3) return rows;
  for (const std::int64_t t : bounds) {
    if (t < times.times().front() || t > times.times().back()) continue;
    rows.bounds.push_back(t);
    if (rows.bounds.size() < 2) continue;
    const std::int64_t before = rows.bounds[rows.bounds.size() - 2];
    rows.left.push_back(wheels[0].signal.sum(before, t));
    rows.right.push_back(wheels[1].signal.sum(before, t));
  }
  return rows;
}

WheelRows wheel_rows(const LogMap& map, GatheredLog& log) {
  WheelRows rows;
  std::vector<NamedSignal> wheels = all_wheels(map, log, rows);
  for (NamedSignal& one : wheels) {
    one.signal.finish();
    rows.unordered = std::max(rows.unordered, one.signal.unordered());
    rows.repeated = std::max(rows.repeated, one.signal.repeated());
    if (one.signal.size() < 3) {
      throw InputError(map.file.string(), 0,
                       fmt::format("wheel {} has {} messages with different times, expected three "
                                   "or more",
                                   one.name, one.signal.size()));
    }
  }
  rows.bounds = bounds_of(map, wheels);
  if (rows.bounds.size() < 3) {
    throw InputError(map.file.string(), 0,
                     "the wheels have fewer than two rows in common, expected messages of all of "
                     "them at the same times");
  }
  warn_of_gaps(rows.bounds, rows.warnings);
  const bool two = has_two_wheels(map.model.robot);
  for (std::size_t w = 0; w < wheels.size(); ++w) {
    const bool steers = !two && is_steering_column(map.model.robot, wheels[w].name);
    std::vector<double> travels;
    travels.reserve(rows.bounds.size());
    for (std::size_t k = 1; k < rows.bounds.size(); ++k) {
      const double sum = wheels[w].signal.sum(rows.bounds[k - 1], rows.bounds[k]);
      const double dt =
          static_cast<double>(rows.bounds[k] - rows.bounds[k - 1]) / kNanosecondsPerSecond;
      travels.push_back(steers ? sum / dt : sum);
    }
    if (two) {
      (w == 0 ? rows.left : rows.right) = std::move(travels);
    } else {
      rows.columns.push_back({wheels[w].name, std::move(travels)});
    }
  }
  check_that_it_moves(map, log, rows);
  return rows;
}

}  // namespace trussmap::logs
