// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/sensor_frames.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace trussmap::logs {
namespace {

/// As it is at that time; nothing of the base itself.
std::optional<Mounting> place_of_frame(const std::string& frame, std::int64_t t, const LogMap& map,
                                       const FrameTree& frames) {
  constexpr double kFlat = 0.5;  // of an x axis that stands up the direction says nothing
  const std::vector<std::string> bases = base_frames(map);
  if (frame.empty() || std::find(bases.begin(), bases.end(), frame) != bases.end()) {
    return std::nullopt;
  }
  for (const std::string& base : bases) {
    if (!frames.are_joined(base, frame)) continue;
    const auto place = frames.transform(base, frame, t);
    if (!place) continue;
    const PlanarAxis axis = planar_axis(place->rotation(), 'x');
    const Mounting found{place->translation().x(), place->translation().y(),
                         axis.share > kFlat ? axis.angle : 0.0};
    return found == Mounting() ? std::nullopt : std::optional(found);
  }
  return std::nullopt;
}

/// The one frame that all sightings by range or bearing are of; empty: several, or others beside.
std::string frame_of_readings(const GatheredLog& log) {
  std::string frame;
  for (const SeenLandmark& one : log.seen) {
    if (one.positioned || (!std::isfinite(one.range) && !std::isfinite(one.bearing))) return "";
    if (!frame.empty() && one.frame != frame) return "";
    frame = one.frame;
  }
  return frame;
}

bool sees_by_frames(const LogMap& map) {
  return std::any_of(map.sightings.begin(), map.sightings.end(),
                     [](const SightingMap& one) { return !one.frames.empty(); });
}

}  // namespace

std::vector<std::string> base_frames(const LogMap& map) {
  std::vector<std::string> bases;
  for (const SightingMap& one : map.sightings) bases.push_back(one.base);
  bases.insert(bases.end(), {"base_link", "base_footprint"});
  return bases;
}

MountedByFrames mounted_by_frames(const LogMap& map, const GatheredLog& log) {
  MountedByFrames result{map.model.robot.mounted, {}};
  const auto take = [&](std::optional<Mounting>& place, const char* what, const std::string& frame,
                        std::int64_t t, bool turns) {
    if (place) return;
    place = place_of_frame(frame, t, map, log.frames);
    if (!place) return;
    if (!turns) place->yaw = 0.0;
    result.told.push_back(
        fmt::format("place of the {} taken from the frame {}: {:.3g} m ahead, "
                    "{:.3g} m to the left{}",
                    what, frame, place->x, place->y,
                    place->yaw == 0.0 ? "" : fmt::format(", turned by {:.3g} rad", place->yaw)));
  };
  if (!log.fixes.empty()) {
    take(result.mounted.antenna, "antenna", log.fix_frame, log.fixes.front().t, false);
  }
  if (!log.seen.empty() && !sees_by_frames(map)) {
    take(result.mounted.sensor, "sensor", frame_of_readings(log), log.seen.front().t, true);
  }
  if (map.truth && is_frame_path(map.truth->pose)) {
    const FramePath path = frame_path(map.truth->pose, log.frames);
    const std::vector<std::int64_t> times = log.frames.times(path.parent, path.child);
    if (!times.empty()) {
      take(result.mounted.tracked, "tracked point", path.child, times.front(), true);
    }
  }
  return result;
}

}  // namespace trussmap::logs
