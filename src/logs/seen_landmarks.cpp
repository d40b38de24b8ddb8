// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/seen_landmarks.hpp"

#include "logs/message_feed.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap::logs {
namespace {

/// A landmark's place in the robot's base as range, bearing and yaw.
Sighting sighting_at(const Eigen::Isometry3d& place, const SightingMap& map, bool turned) {
  Sighting sighting;
  sighting.range = std::hypot(place.translation().x(), place.translation().y());
  sighting.bearing = std::atan2(place.translation().y(), place.translation().x());
  if (map.with_yaw && turned) {
    const PlanarAxis axis = planar_axis(place.rotation(), map.axis);
    constexpr double kFlat = 0.5;  // an axis that stands up has no direction in the plane
    if (axis.share > kFlat) sighting.yaw = axis.angle;
  }
  return sighting;
}

void add_frames(const LogMap& map, const SightingMap& asked, const FrameTree& frames,
                SightingCounts& counts, std::vector<SeenSighting>& found) {
  const auto clock = nanoseconds(asked.clock);
  std::vector<std::string> children = frames.children_like(asked.frames);
  std::erase(children, asked.base);
  if (children.empty()) {
    throw InputError(map.file.string(), asked.line,
                     "no frame is called like " + asked.frames + ", expected children of /tf");
  }
  bool joined = false;
  for (const std::string& child : children) {
    joined = joined || frames.are_joined(asked.base, child);
    const FrameLink& link = frames.links().find(child)->second;
    if (link.is_static) continue;
    for (const FrameSample& one : link.samples) {
      const auto place = frames.transform(asked.base, child, one.t);
      if (!place) {
        ++counts.no_frame;
        continue;
      }
      SeenSighting seen{one.t + clock, sighting_at(*place, asked, true)};
      seen.sighting.landmark = asked.prefix + child;
      found.push_back(std::move(seen));
    }
  }
  if (!joined) {
    throw InputError(map.file.string(), asked.line,
                     fmt::format("frame {} is not joined to {}, expected base = the robot's frame",
                                 children.front(), asked.base));
  }
}

void add_messages(const GatheredLog& log, SightingCounts& counts,
                  std::vector<SeenSighting>& found) {
  for (const SeenLandmark& one : log.seen) {
    SeenSighting seen{one.t, {}};
    if (one.positioned) {
      Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
      place.linear() = one.pose.rotation.toRotationMatrix();
      place.translation() = one.pose.position;
      if (!one.frame.empty() && one.frame != one.map->base) {
        const auto sensor = log.frames.transform(one.map->base, one.frame, one.t);
        if (!sensor) {
          ++counts.no_frame;
          continue;
        }
        place = *sensor * place;
      }
      seen.sighting = sighting_at(place, *one.map, one.pose.turned);
    } else {
      seen.sighting.range = one.range;
      seen.sighting.bearing = one.bearing;
      seen.sighting.yaw = one.yaw;
    }
    seen.sighting.landmark = one.landmark;
    found.push_back(std::move(seen));
  }
}

bool is_same(const SeenSighting& a, const SeenSighting& b) {
  const auto same = [](double one, double other) {
    return one == other || (one != one && other != other);
  };
  return a.t == b.t && a.sighting.landmark == b.sighting.landmark &&
         same(a.sighting.range, b.sighting.range) && same(a.sighting.bearing, b.sighting.bearing) &&
         same(a.sighting.yaw, b.sighting.yaw);
}

/// A reading that is there twice is one reading.
std::size_t drop_repeated(std::vector<SeenSighting>& sorted) {
  std::size_t kept = 0;
  std::size_t first = 0;  // kept of this time
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    if (kept > 0 && sorted[kept - 1].t != sorted[k].t) first = kept;
    const auto begin = sorted.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(kept);
    const auto twin = [&](const SeenSighting& other) { return is_same(other, sorted[k]); };
    if (std::any_of(begin, end, twin)) continue;
    if (kept != k) sorted[kept] = std::move(sorted[k]);
    ++kept;
  }
  const std::size_t dropped = sorted.size() - kept;
  sorted.resize(kept);
  return dropped;
}

}  // namespace

std::vector<SeenSighting> seen_sightings(const LogMap& map, const GatheredLog& log,
                                         SightingCounts& counts) {
  std::vector<SeenSighting> found;
  for (const SightingMap& one : map.sightings) {
    if (!one.frames.empty()) add_frames(map, one, log.frames, counts, found);
  }
  add_messages(log, counts, found);
  std::stable_sort(found.begin(), found.end(),
                   [](const SeenSighting& a, const SeenSighting& b) { return a.t < b.t; });
  counts.repeated = drop_repeated(found);
  return found;
}

}  // namespace trussmap::logs
