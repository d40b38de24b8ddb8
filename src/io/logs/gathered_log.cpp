// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/logs/gathered_log.hpp"

#include "io/logs/field_path.hpp"
#include "io/logs/gathering.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trussmap {
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

void feed_signal(Gathering& g, const SignalMap& signal, Signal& into) {
  const ImuReading imu(signal.field);
  g.feeds.add(signal.field, signal.line, [&signal, &into, imu](const FedMessage& fed) {
    if (imu.is_absent(fed)) return false;
    if (signal.quaternion) {
      const auto yaw = yaw_of_quaternion(fed.field);
      if (yaw) into.add(fed.t, *yaw);
      return yaw.has_value();
    }
    if (!fed.field.is_number()) return false;
    if (std::isfinite(fed.field.number())) into.add(fed.t, fed.field.number());
    return true;
  });
}

void feed_twist(Gathering& g) {
  g.feeds.add(g.map.odometry.twist, g.map.odometry.line, [&g](const FedMessage& fed) {
    const auto twist = twist_of(fed.field);
    if (twist) g.to.twists.push_back({fed.t + nanoseconds(g.map.odometry.clock), *twist});
    return twist.has_value();
  });
}

void feed_pose(Gathering& g, const std::string& path, std::size_t line, double clock,
               std::vector<TimedFieldPose>& into) {
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
  g.feeds.add(path, line, [&g, clock, &into](const FedMessage& fed) {
    const auto pose = pose_of(fed.field);
    if (!pose || !pose->turned) {
      ++g.to.wrong_poses;
      return false;
    }
    into.push_back(
        {fed.t + nanoseconds(clock), pose->position.x(), pose->position.y(), pose->yaw()});
    return true;
  });
}

void feed_truth(Gathering& g, const TruthMap& truth) {
  if (!truth.pose.empty()) {
    feed_pose(g, truth.pose, truth.line, truth.clock, g.to.truth);
    return;
  }
  // Its three fields are of one message: those of the topic of x.
  g.feeds.add_message(truth.x, truth.line, [&g, &truth](const FedMessage& fed) {
    const auto number = [&](const std::string& path) {
      if (!is_of_topic(path, fed.topic)) {
        throw InputError(g.map.file.string(), truth.line,
                         "[truth]: " + path + " is of another topic than x, expected the same");
      }
      std::string below = path;
      if (!fed.topic.table) below.erase(0, std::min(fed.topic.name.size() + 1, below.size()));
      return g.paths.number(below, truth.line, fed.topic.table, fed.field);
    };
    const TimedFieldPose pose{fed.t + nanoseconds(truth.clock), truth.unit * number(truth.x),
                              truth.unit * number(truth.y),
                              truth.heading_unit * number(truth.heading)};
    if (std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.heading)) {
      g.to.truth.push_back(pose);
    }
    return true;
  });
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
  if (!g.map.odometry.twist.empty()) feed_twist(g);
  if (!g.map.odometry.pose.empty()) {
    feed_pose(g, g.map.odometry.pose, g.map.odometry.line, g.map.odometry.clock, g.to.odometry);
  }
  if (g.map.truth) feed_truth(g, *g.map.truth);
  if (g.map.fixes) feed_fixes(g, *g.map.fixes);
  for (const SightingMap& one : g.map.sightings) feed_sightings(g, one);
}

void read(Gathering& g, const std::filesystem::path& log) {
  LogVisit visit;
  visit.wanted = [&g](const LogTopic& topic) {
    return g.feeds.wants(topic) || g.tf_topics.contains(topic.name);
  };
  visit.message = [&g](const LogMessage& message) {
    if (g.tf_topics.contains(message.topic.name)) take_frames(g, message);
    g.feeds.take(message);
  };
  try {
    g.to.end = read_message_log(log, visit);
    require_messages(log, g.to.end);
  } catch (const std::invalid_argument& error) {  // of a path below a message
    throw InputError(g.map.file.string(), 0, error.what());
  }
  g.paths.check(log);
  g.feeds.check(log, g.to.end);
  g.to.refused = g.feeds.refused();
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

GatheredLog gather(const std::filesystem::path& log, const LogMap& map) {
  std::vector<std::string> lost;
  for (int pass = 0;; ++pass) {
    GatheredLog result;
    for (const std::string& frame : lost) result.frames.wants(frame);
    Gathering gathering{map, result};
    feed_all(gathering);
    read(gathering, log);
    lost = result.frames.lost();
    // A frame that turned out to be needed when it had gone: again, and now it is kept.
    if (lost.empty() || pass > 0) return result;
  }
}

}  // namespace trussmap
