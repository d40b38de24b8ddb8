// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/gathered_log.hpp"

#include "logs/field_path.hpp"
#include "logs/gathering.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trussmap::logs {
namespace {

/// REP 145: an Imu that does not read its orientation, or its angular velocity, says so by a -1 at
/// the start of that one's covariance.
class ImuReading {
 public:
  explicit ImuReading(const std::string& path) {
    for (const char* part : {"orientation", "angular_velocity"}) {
      if (path.find(std::string("/") + part) == std::string::npos) continue;
      covariance_ = FieldPath(std::string(part) + "_covariance[0]", false);
    }
  }
  [[nodiscard]] bool is_absent(const FedMessage& fed) const {
    if (covariance_.is_empty() || !fed.topic.type.ends_with("/Imu")) return false;
    const std::optional<FieldRef> first = covariance_.find(fed.message);
    return first && first->number() == -1.0;
  }

 private:
  FieldPath covariance_;
};

/// Numbers in the fields of one message, by their paths.
class FieldNumbers {
 public:
  FieldNumbers(Gathering& g, const FedMessage& fed, std::size_t line)
      : g_(&g), fed_(&fed), line_(line) {}

  /// NaN where there is none.
  double at(const std::string& path) {
    if (!is_of_topic(path, fed_->topic)) {
      throw InputError(
          g_->map.file.string(), line_,
          path + " is of another topic than " + fed_->topic.name + ", expected the same");
    }
    const std::string below = below_topic(path, fed_->topic);
    const auto field = g_->paths.find(below, line_, fed_->topic, fed_->message);
    if (field && !field->is_number()) {
      if (good_) g_->feeds.blame(path, *field);
      good_ = false;
    }
    return field && std::isfinite(field->number()) ? field->number() : kAbsent;
  }

  /// Of a quaternion's four, or of its z and w, rad; NaN where they are no rotation.
  double yaw(const std::vector<std::string>& paths) {
    double parts[4] = {0.0, 0.0, 0.0, 0.0};
    const std::size_t first = 4 - paths.size();
    for (std::size_t k = 0; k < paths.size(); ++k) parts[first + k] = at(paths[k]);
    const auto yaw = yaw_of_quaternion(parts[0], parts[1], parts[2], parts[3]);
    const bool measured = std::all_of(parts, parts + 4, [](double one) { return one == one; });
    if (!yaw && measured) ++g_->to.wrong_poses;
    return yaw.value_or(kAbsent);
  }

  /// False: a field is a text.
  [[nodiscard]] bool good() const { return good_; }

 private:
  Gathering* g_;
  const FedMessage* fed_;
  std::size_t line_;
  bool good_ = true;
};

void feed_signal(Gathering& g, const SignalMap& signal, Signal& into) {
  const AskedField asked{signal.field, signal.file, signal.line};
  if (!signal.quaternion_fields.empty()) {
    g.feeds.add_message(asked, [&g, &signal, &into](const FedMessage& fed) {
      FieldNumbers numbers(g, fed, signal.line);
      const double yaw = numbers.yaw(signal.quaternion_fields);
      if (std::isfinite(yaw)) into.add(fed.t, yaw);
      return numbers.good();
    });
    return;
  }
  const ImuReading imu(signal.field);
  g.feeds.add(asked, [&signal, &into, imu](const FedMessage& fed) {
    if (imu.is_absent(fed)) return false;
    if (signal.quaternion) {
      const auto yaw = yaw_of_quaternion(fed.field);
      if (yaw) into.add(fed.t, *yaw);
      return yaw.has_value();
    }
    if (!fed.field.is_number()) return false;
    if (std::isfinite(fed.field.number())) into.add(fed.t, fed.field.number(), fed.row);
    return true;
  });
}

/// Of a message that has both, as nav_msgs/Odometry. `twist`: the message's.
void compare_twist(Gathering& g, const FedMessage& fed, const std::optional<FieldTwist>& twist) {
  if (!fed.message.member("pose") || !fed.message.member("twist")) return;
  const auto pose = pose_of(fed.message);
  if (twist && pose && pose->turned) g.to.beside.add(fed.t, *twist, *pose);
}

void feed_twist(Gathering& g) {
  const OdometryMap& odometry = g.map.odometry;
  g.feeds.add({odometry.twist, odometry.file, odometry.line}, [&g](const FedMessage& fed) {
    const auto twist = twist_of(fed.field);
    if (twist) g.to.twists.push_back({fed.t + nanoseconds(g.map.odometry.clock), *twist});
    compare_twist(g, fed, twist_of(fed.message));
    return twist.has_value();
  });
}

/// The velocity of a body whose wheels all steer, by theirs.
void feed_modules(Gathering& g) {
  const OdometryMap& odometry = g.map.odometry;
  g.feeds.add({odometry.modules, odometry.file, odometry.line},
              [&g, &odometry](const FedMessage& fed) {
                const auto twist = twist_of_modules(fed.field, odometry.places);
                if (twist) g.to.twists.push_back({fed.t + nanoseconds(odometry.clock), *twist});
                return twist.has_value();
              });
}

/// Velocities by their fields.
void feed_speeds(Gathering& g) {
  const OdometryMap& odometry = g.map.odometry;
  g.feeds.add_message({odometry.speed, odometry.file, odometry.line},
                      [&g, &odometry](const FedMessage& fed) {
                        FieldNumbers numbers(g, fed, odometry.line);
                        FieldTwist twist;
                        twist.ahead = odometry.speed_unit * numbers.at(odometry.speed);
                        twist.turn = odometry.turn_rate_unit * numbers.at(odometry.turn_rate);
                        if (!odometry.sideways.empty()) {
                          const double left = odometry.speed_unit * numbers.at(odometry.sideways);
                          twist.left = std::isfinite(left) ? left : 0.0;
                        }
                        if (std::isfinite(twist.ahead) && std::isfinite(twist.turn)) {
                          g.to.twists.push_back({fed.t + nanoseconds(odometry.clock), twist});
                        }
                        return numbers.good();
                      });
}

void feed_pose(Gathering& g, const AskedField& asked, double clock,
               std::vector<TimedFieldPose>& into) {
  const std::string& path = asked.path;
  if (is_frame_path(path)) {
    want_frames(g, path.substr(0, path.find(':')));
    // Any way to split it at a dot.
    const std::string both = path.substr(path.find(':') + 1);
    for (std::size_t dot = both.find('.'); dot != std::string::npos;
         dot = both.find('.', dot + 1)) {
      g.to.frames.wants(both.substr(0, dot));
      g.to.frames.wants(both.substr(dot + 1));
    }
    return;
  }
  const bool odometry = &into == &g.to.odometry;
  g.feeds.add(asked, [&g, clock, &into, odometry](const FedMessage& fed) {
    const auto pose = pose_of(fed.field);
    if (!pose || !pose->turned) {
      ++g.to.wrong_poses;
      return false;
    }
    if (const auto twist = odometry ? twist_of(fed.message) : std::nullopt) {
      g.to.twists_move = g.to.twists_move || twist->ahead != 0.0 || twist->turn != 0.0;
      compare_twist(g, fed, twist);
    }
    into.push_back(
        {fed.t + nanoseconds(clock), pose->position.x(), pose->position.y(), pose->yaw()});
    return true;
  });
}

/// A pose by its fields, all of one message.
void feed_pose_fields(Gathering& g, const PoseFields& fields, const AskedField& asked, double clock,
                      std::vector<TimedFieldPose>& into) {
  const std::size_t line = asked.line;
  g.feeds.add_message(asked, [&g, &fields, line, clock, &into](const FedMessage& fed) {
    FieldNumbers numbers(g, fed, line);
    const double x = fields.unit * numbers.at(fields.x);
    const double y = fields.unit * numbers.at(fields.y);
    const double heading =
        fields.heading_unit *
        (fields.quaternion.empty() ? numbers.at(fields.heading) : numbers.yaw(fields.quaternion));
    if (std::isfinite(x) && std::isfinite(y) && std::isfinite(heading)) {
      into.push_back({fed.t + nanoseconds(clock), x, y, heading});
    }
    return numbers.good();
  });
}

void feed_poses(Gathering& g, const std::string& pose, const PoseFields& fields,
                const std::string& file, std::size_t line, double clock,
                std::vector<TimedFieldPose>& into) {
  if (pose.empty()) {
    feed_pose_fields(g, fields, {fields.x, file, line}, clock, into);
  } else {
    feed_pose(g, {pose, file, line}, clock, into);
  }
}

void take_frames(Gathering& g, const LogMessage& message) {
  const auto all = message.fields.member("transforms");
  if (!all) return;
  const bool is_static = message.topic.name.ends_with("_static");
  for (const FieldRef& one : all->children()) {
    const auto child = one.member("child_frame_id");
    const auto pose = pose_of(one);
    const std::int64_t t = g.feeds.time_of(message, one);
    if (!child || !pose ||
        !g.to.frames.add(frame_of(one), child->field().text, {t, pose->position, pose->rotation},
                         is_static)) {
      ++g.to.wrong_poses;
    }
  }
}

void feed_all(Gathering& g) {
  for (const auto& [name, signal] : g.map.wheels) g.to.wheels.emplace_back(name, Signal(signal));
  for (const auto& [name, one] : g.map.covariates) g.to.covariates.emplace_back(name, Signal(one));
  for (std::size_t k = 0; k < g.map.wheels.size(); ++k) {
    feed_signal(g, g.map.wheels[k].second, g.to.wheels[k].second);
  }
  for (std::size_t k = 0; k < g.map.covariates.size(); ++k) {
    feed_signal(g, g.map.covariates[k].second, g.to.covariates[k].second);
  }
  if (g.map.heading) feed_signal(g, *g.map.heading, g.to.heading.emplace_back(*g.map.heading));
  if (g.map.yaw_rate) feed_signal(g, *g.map.yaw_rate, g.to.yaw_rate.emplace_back(*g.map.yaw_rate));
  const OdometryMap& odometry = g.map.odometry;
  if (!odometry.twist.empty()) {
    feed_twist(g);
  } else if (!odometry.modules.empty()) {
    feed_modules(g);
  } else if (!odometry.speed.empty()) {
    feed_speeds(g);
  } else if (odometry.line > 0) {
    feed_poses(g, odometry.pose, odometry.fields, odometry.file, odometry.line, odometry.clock,
               g.to.odometry);
  }
  if (g.map.truth) {
    const TruthMap& truth = *g.map.truth;
    feed_poses(g, truth.pose, truth.fields, truth.file, truth.line, truth.clock, g.to.truth);
  }
  if (g.map.fixes) feed_fixes(g, *g.map.fixes);
  for (const SightingMap& one : g.map.sightings) feed_sightings(g, one);
}

void read(Gathering& g) {
  LogVisit visit;
  visit.wanted = [&g](const LogTopic& topic) {
    return g.feeds.wants(topic) || g.tf_topics.contains(topic.name);
  };
  visit.message = [&g](const LogMessage& message) {
    if (g.tf_topics.contains(message.topic.name)) take_frames(g, message);
    g.feeds.take(message);
  };
  try {
    g.to.end = g.logs.read(
        visit, [&g](std::size_t log) { return g.feeds.wants_of(log) || !g.logs.is_table(log); });
  } catch (const std::invalid_argument& error) {  // of a path below a message
    throw InputError(g.map.file.string(), 0, error.what());
  }
  g.paths.check();
  g.feeds.check(g.to.end);
  g.to.refused = g.feeds.refused();
  g.to.first_refused = g.feeds.first_refused();
  g.to.frames.sort();
}

}  // namespace

void want_frames(Gathering& g, const std::string& topic) {
  g.tf_topics.insert(topic);
  g.tf_topics.insert(topic + "_static");
}

bool is_frame_path(const std::string& path) {
  const std::size_t colon = path.find(':');
  return colon != std::string::npos && path.find('.', colon) != std::string::npos &&
         path.substr(0, colon).ends_with("tf");
}

FramePath frame_path(const std::string& path, const FrameTree& frames) {
  const std::size_t colon = path.find(':');
  const std::string topic = path.substr(0, colon);
  const std::string both = path.substr(colon + 1);
  FramePath first;
  for (std::size_t dot = both.find('.'); dot != std::string::npos; dot = both.find('.', dot + 1)) {
    FramePath split{topic, both.substr(0, dot), both.substr(dot + 1)};
    if (first.topic.empty()) first = split;
    if (frames.knows(split.parent) && frames.knows(split.child)) return split;
  }
  return first;
}

GatheredLog gather(const JoinedLogs& logs, const LogMap& map) {
  std::vector<std::string> lost;
  for (int pass = 0;; ++pass) {
    GatheredLog result;
    for (const std::string& frame : lost) result.frames.wants(frame);
    Gathering gathering{map, logs, result};
    feed_all(gathering);
    read(gathering);
    lost = result.frames.lost();
    // A frame that turned out to be needed when it had gone: again, and now it is kept.
    if (lost.empty() || pass > 0) return result;
  }
}

}  // namespace trussmap::logs
