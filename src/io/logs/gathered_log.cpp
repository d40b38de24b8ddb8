// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/logs/gathered_log.hpp"

#include "io/logs/asked_paths.hpp"
#include "io/logs/field_path.hpp"
#include "io/logs/message_feed.hpp"
#include "text/plain_text.hpp"
#include "trussmap/error.hpp"

#include <cmath>
#include <functional>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap {
namespace {

/// "marker_ids[3]" of "../marker_ids[#]": what goes with element 3 in another list of the message.
std::optional<std::string> beside(const std::string& path, std::size_t number, bool table) {
  if (table || !path.starts_with("../")) return std::nullopt;
  std::string found = path.substr(3);
  if (const std::size_t at = found.find('#'); at != std::string::npos) {
    found.replace(at, 1, std::to_string(number));
  }
  return found;
}

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

class Gatherer {
 public:
  Gatherer(const LogMap& map, GatheredLog& to) : map_(map), to_(to), feeds_(map), paths_(map) {}

  void set_up() {
    for (const auto& [name, signal] : map_.wheels) to_.wheels.emplace_back(name, Signal(signal));
    for (const auto& [name, one] : map_.covariates) to_.covariates.emplace_back(name, Signal(one));
    for (std::size_t k = 0; k < map_.wheels.size(); ++k) {
      feed(map_.wheels[k].second, to_.wheels[k].second);
    }
    for (std::size_t k = 0; k < map_.covariates.size(); ++k) {
      feed(map_.covariates[k].second, to_.covariates[k].second);
    }
    if (map_.heading) feed(*map_.heading, to_.heading.emplace_back(*map_.heading));
    if (map_.yaw_rate) feed(*map_.yaw_rate, to_.yaw_rate.emplace_back(*map_.yaw_rate));
    if (!map_.odometry.twist.empty()) feed_twist();
    if (!map_.odometry.pose.empty()) {
      feed_pose(map_.odometry.pose, map_.odometry.line, map_.odometry.clock, to_.odometry);
    }
    if (map_.truth) feed_truth(*map_.truth);
    if (map_.fixes) feed_fixes(*map_.fixes);
    for (const SightingMap& one : map_.sightings) feed_sightings(one);
  }

  void read(const std::filesystem::path& log) {
    LogVisit visit;
    visit.wanted = [this](const LogTopic& topic) {
      return feeds_.wants(topic) || tf_topics_.contains(topic.name);
    };
    visit.message = [this](const LogMessage& message) {
      if (tf_topics_.contains(message.topic.name)) take_frames(message);
      feeds_.take(message);
    };
    try {
      to_.end = read_message_log(log, visit);
      require_messages(log, to_.end);
    } catch (const std::invalid_argument& error) {  // of a path below a message
      throw InputError(map_.file.string(), 0, error.what());
    }
    paths_.check(log);
    feeds_.check(log, to_.end);
    to_.refused = feeds_.refused();
    to_.frames.sort();
  }

 private:
  void feed(const SignalMap& signal, Signal& into) {
    const ImuReading imu(signal.field);
    feeds_.add(signal.field, signal.line, [&signal, &into, imu](const FedMessage& fed) {
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

  void feed_twist() {
    feeds_.add(map_.odometry.twist, map_.odometry.line, [this](const FedMessage& fed) {
      const auto twist = twist_of(fed.field);
      if (twist) to_.twists.push_back({fed.t + nanoseconds(map_.odometry.clock), *twist});
      return twist.has_value();
    });
  }

  void feed_pose(const std::string& path, std::size_t line, double clock,
                 std::vector<TimedFieldPose>& into) {
    if (is_frame_path(path)) {
      want_frames(path.substr(0, path.find(':')));
      // Any way to split it at a dot.
      const std::string both = path.substr(path.find(':') + 1);
      for (std::size_t dot = both.find('.'); dot != std::string::npos;
           dot = both.find('.', dot + 1)) {
        to_.frames.wants(both.substr(0, dot));
        to_.frames.wants(both.substr(dot + 1));
      }
      return;
    }
    feeds_.add(path, line, [this, clock, &into](const FedMessage& fed) {
      const auto pose = pose_of(fed.field);
      if (!pose || !pose->turned) {
        ++to_.wrong_poses;
        return false;
      }
      into.push_back(
          {fed.t + nanoseconds(clock), pose->position.x(), pose->position.y(), pose->yaw()});
      return true;
    });
  }

  void feed_truth(const TruthMap& truth) {
    if (!truth.pose.empty()) {
      feed_pose(truth.pose, truth.line, truth.clock, to_.truth);
      return;
    }
    // Its three fields are of one message: those of the topic of x.
    feeds_.add_message(truth.x, truth.line, [this, &truth](const FedMessage& fed) {
      const auto number = [&](const std::string& path) {
        if (!is_of_topic(path, fed.topic)) {
          throw InputError(map_.file.string(), truth.line,
                           "[truth]: " + path + " is of another topic than x, expected the same");
        }
        std::string below = path;
        if (!fed.topic.table) below.erase(0, std::min(fed.topic.name.size() + 1, below.size()));
        return paths_.number(below, truth.line, fed.topic.table, fed.field);
      };
      const TimedFieldPose pose{fed.t + nanoseconds(truth.clock), truth.unit * number(truth.x),
                                truth.unit * number(truth.y),
                                truth.heading_unit * number(truth.heading)};
      if (std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.heading)) {
        to_.truth.push_back(pose);
      }
      return true;
    });
  }

  void feed_fixes(const FixMap& fixes) {
    feeds_.add(fixes.topic, fixes.line, [this, &fixes](const FedMessage& fed) {
      const auto number = [&](const std::string& path) {
        return paths_.number(path, fixes.line, fed.topic.table, fed.field);
      };
      SeenFix fix;
      fix.t = fed.t + nanoseconds(fixes.clock);
      fix.sd = fixes.sd_unit * number(fixes.sd);
      fix.quality = number(fixes.quality);
      if (!fixes.x.empty()) {
        fix.x = fixes.unit * number(fixes.x);
        fix.y = fixes.unit * number(fixes.y);
      } else if (!fixes.latitude.empty() || fed.field.member("latitude")) {
        const bool named = !fixes.latitude.empty();
        fix.geodetic = true;
        fix.y = number(named ? fixes.latitude : "latitude");
        fix.x = number(named ? fixes.longitude : "longitude");
        const auto height = fed.field.member("altitude");
        if (height && std::isfinite(height->number())) fix.height = height->number();
        if (!status_of(fed.field, fix)) return true;
      } else if (const auto pose = pose_of(fed.field)) {
        fix.x = pose->position.x();
        fix.y = pose->position.y();
      } else {
        return false;
      }
      if (std::isfinite(fix.x) && std::isfinite(fix.y)) to_.fixes.push_back(fix);
      return true;
    });
  }

  /// NavSatFix: whether it has a fix, how good, and how certain.
  bool status_of(FieldRef message, SeenFix& fix) {
    const auto status = FieldPath("status.status", false).find(message);
    // Receivers without a fix say 0, 0, which is in the sea.
    if ((status && status->field().integer < 0) || (fix.x == 0.0 && fix.y == 0.0)) {
      ++to_.lost_fixes;
      return false;
    }
    if (status && !std::isfinite(fix.quality)) fix.quality = status->number();
    const auto type = message.member("position_covariance_type");
    const auto xx = FieldPath("position_covariance[0]", false).find(message);
    const auto yy = FieldPath("position_covariance[4]", false).find(message);
    if (type && type->field().integer > 0 && xx && yy && !std::isfinite(fix.sd)) {
      const double variance = 0.5 * (xx->number() + yy->number());
      if (variance > 0.0 && std::isfinite(variance)) fix.sd = std::sqrt(variance);
    }
    return true;
  }

  void feed_sightings(const SightingMap& one) {
    if (!one.frames.empty()) {
      want_frames(one.tf);
      to_.frames.wants(one.frames);
      to_.frames.wants(one.base);
      return;
    }
    if (!one.position.empty()) {
      want_frames(one.tf);
      to_.frames.wants(one.base);
      if (!one.sensor.empty()) to_.frames.wants(one.sensor);
    }
    feeds_.add(one.topic, one.line,
               [this, &one, before = std::string()](const FedMessage& fed) mutable {
                 if (one.each.empty()) return take_sighting(one, fed, fed.field, before);
                 const auto list = paths_.find(one.each, one.line, fed.topic.table, fed.field);
                 if (!list) return false;
                 const std::vector<FieldRef> elements = list->children();
                 for (std::size_t k = 0; k < elements.size(); ++k) {
                   std::string none;
                   if (!take_sighting(one, fed, elements[k], none, k)) return false;
                 }
                 return true;
               });
  }

  bool take_sighting(const SightingMap& map, const FedMessage& fed, FieldRef at,
                     std::string& before, std::size_t number = 0) {
    const bool table = fed.topic.table;
    SeenLandmark seen;
    seen.t = fed.t + nanoseconds(map.clock);
    seen.map = &map;
    std::string name = map.name;
    if (name.empty()) {
      const auto other = beside(map.landmark, number, table);
      const auto field = other ? FieldPath(*other, table).find(fed.field)
                               : paths_.find(map.landmark, map.line, table, at);
      if (!field) return false;
      name = as_text(*field);
    }
    seen.range = map.range_unit * paths_.number(map.range, map.line, table, at);
    seen.bearing = map.bearing_unit * paths_.number(map.bearing, map.line, table, at);
    seen.yaw = map.yaw_unit * paths_.number(map.yaw, map.line, table, at);
    if (map.changes) {
      const std::string now = fmt::format("{} {} {} {}", name, seen.range, seen.bearing, seen.yaw);
      if (now == before) return true;
      before = now;
    }
    const bool nothing = std::find(map.none.begin(), map.none.end(), name) != map.none.end();
    if (name.empty() || nothing) {
      to_.unnamed += name.empty() && !table ? 1U : 0U;
      return true;
    }
    if (!is_plain_text(name)) {
      ++to_.unnamed;
      return true;
    }
    seen.landmark = map.prefix + name;
    // A range below 0 is how drivers say that there is none.
    if (seen.range < 0.0) {
      ++to_.negative_ranges;
      return true;
    }
    // An empty field beside a name: nothing was measured there.
    if (!map.range.empty() && map.bearing.empty() && !std::isfinite(seen.range)) return true;
    if (!map.bearing.empty() && map.range.empty() && !std::isfinite(seen.bearing)) return true;
    if (!map.range.empty() && !map.bearing.empty() && !std::isfinite(seen.range) &&
        !std::isfinite(seen.bearing)) {
      return true;
    }
    if (!map.position.empty()) {
      const auto field = paths_.find(map.position, map.line, table, at);
      const auto pose = field ? pose_of(*field) : std::nullopt;
      if (!pose) return false;
      seen.positioned = true;
      seen.pose = *pose;
      seen.frame = map.sensor.empty() ? frame_of(fed.message) : map.sensor;
      to_.frames.wants(seen.frame);
    }
    to_.seen.push_back(std::move(seen));
    return true;
  }

  void want_frames(const std::string& topic) {
    tf_topics_.insert(topic);
    tf_topics_.insert(topic + "_static");
  }

  void take_frames(const LogMessage& message) {
    const auto all = message.fields.member("transforms");
    if (!all) return;
    const bool is_static = message.topic.name.ends_with("_static");
    for (const FieldRef& one : all->children()) {
      const auto child = one.member("child_frame_id");
      const auto pose = pose_of(one);
      const std::int64_t t = feeds_.time_of(message, one);
      if (!child || !pose ||
          !to_.frames.add(frame_of(one), child->field().text, {t, pose->position, pose->rotation},
                          is_static)) {
        ++to_.wrong_poses;
      }
    }
  }

  const LogMap& map_;
  GatheredLog& to_;
  MessageFeeds feeds_;
  AskedPaths paths_;
  std::set<std::string> tf_topics_;
};

}  // namespace

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
    Gatherer gatherer(map, result);
    gatherer.set_up();
    gatherer.read(log);
    lost = result.frames.lost();
    // A frame that turned out to be needed when it had gone: again, and now it is kept.
    if (lost.empty() || pass > 0) return result;
  }
}

}  // namespace trussmap
