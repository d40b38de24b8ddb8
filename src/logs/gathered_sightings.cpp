// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/field_path.hpp"
#include "logs/gathering.hpp"
#include "text/plain_text.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace trussmap::logs {
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

/// The landmark's name; none where the message lacks its field.
std::optional<std::string> name_in(AskedPaths& paths, const SightingMap& map, const LogTopic& topic,
                                   FieldRef message, FieldRef at, std::size_t number) {
  if (!map.name.empty()) return map.name;
  const auto other = beside(map.landmark, number, topic.table);
  const auto field = other ? FieldPath(*other, topic.table).find(message)
                           : paths.find(map.landmark, map.line, topic, at);
  if (!field) return std::nullopt;
  return as_text(*field);
}

/// Whether a name is a landmark's; counts those that are none.
bool is_named(const std::string& name, const SightingMap& map, bool table, GatheredLog& to) {
  const bool nothing = std::find(map.none.begin(), map.none.end(), name) != map.none.end();
  if (name.empty() || nothing) {
    to.unnamed += name.empty() && !table ? 1U : 0U;
    return false;
  }
  if (!text::is_plain_text(name)) {
    ++to.unnamed;
    return false;
  }
  return true;
}

/// An empty field beside a name: nothing was measured there.
bool is_measured(const SeenLandmark& seen, const SightingMap& map, GatheredLog& to) {
  // A range below 0 is how drivers say that there is none.
  if (seen.range < 0.0) {
    ++to.negative_ranges;
    return false;
  }
  if (map.range.empty() && map.bearing.empty()) return true;
  return std::isfinite(seen.range) || std::isfinite(seen.bearing);
}

/// False: the field is no pose.
bool take_position(Gathering& g, const SightingMap& map, const FedMessage& fed, FieldRef at,
                   SeenLandmark& seen) {
  const auto field = g.paths.find(map.position, map.line, fed.topic, at);
  const auto pose = field ? pose_of(*field) : std::nullopt;
  if (!pose) return false;
  seen.positioned = true;
  seen.pose = *pose;
  seen.frame = map.sensor.empty() ? frame_of(fed.message) : map.sensor;
  g.to.frames.wants(seen.frame);
  return true;
}

/// The sighting in a message, or in the element of this number in one. `before`: the last one, of a
/// topic that repeats them. False: a field is not what was expected.
bool take_sighting(Gathering& g, const SightingMap& map, const FedMessage& fed, FieldRef at,
                   std::string& before, std::size_t number = 0) {
  const bool table = fed.topic.table;
  SeenLandmark seen;
  seen.t = fed.t + nanoseconds(map.clock);
  seen.map = &map;
  const auto name = name_in(g.paths, map, fed.topic, fed.field, at, number);
  if (!name) return false;
  seen.range = map.range_unit * g.paths.number(map.range, map.line, fed.topic, at);
  seen.bearing = map.bearing_unit * g.paths.number(map.bearing, map.line, fed.topic, at);
  seen.yaw = map.yaw_unit * g.paths.number(map.yaw, map.line, fed.topic, at);
  if (map.changes) {
    const std::string now = fmt::format("{} {} {} {}", *name, seen.range, seen.bearing, seen.yaw);
    if (now == before) return true;
    before = now;
  }
  if (!is_named(*name, map, table, g.to) || !is_measured(seen, map, g.to)) return true;
  seen.landmark = map.prefix + *name;
  if (!map.position.empty() && !take_position(g, map, fed, at, seen)) return false;
  if (!seen.positioned && !table) {
    seen.frame = map.sensor.empty() ? frame_of(fed.message) : map.sensor;
    g.to.frames.wants(seen.frame);
  }
  g.to.seen.push_back(std::move(seen));
  return true;
}

}  // namespace

void feed_sightings(Gathering& g, const SightingMap& one) {
  if (!one.frames.empty()) {
    want_frames(g, one.tf);
    g.to.frames.wants(one.frames);
    g.to.frames.wants(one.base);
    return;
  }
  if (!one.position.empty() || !one.range.empty() || !one.bearing.empty()) {
    want_frames(g, one.tf);
    g.to.frames.wants(one.base);
    if (!one.sensor.empty()) g.to.frames.wants(one.sensor);
  }
  g.feeds.add({one.topic, one.file, one.line},
              [&g, &one, before = std::string()](const FedMessage& fed) mutable {
                if (one.each.empty()) return take_sighting(g, one, fed, fed.field, before);
                const auto list = g.paths.find(one.each, one.line, fed.topic, fed.field);
                if (!list) return false;
                const std::vector<FieldRef> elements = list->children();
                for (std::size_t k = 0; k < elements.size(); ++k) {
                  std::string none;
                  if (!take_sighting(g, one, fed, elements[k], none, k)) return false;
                }
                return true;
              });
}

}  // namespace trussmap::logs
