// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/heading_in_map.hpp"

#include "map/heading_reset.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace trussmap {
namespace {

constexpr std::size_t kEnoughSightings = 50;
constexpr double kLostHeading = 0.5;  // rad, sd of the reckoning beyond which it is no help
constexpr double kAgree = 3.0;        // standard deviations

bool agree(const HeadingEstimate& a, const HeadingEstimate& b) {
  return std::abs(wrap_angle(a.heading - b.heading)) <= kAgree * std::sqrt(a.variance + b.variance);
}

/// What each sighting of another landmark of the map says of the heading at the start.
std::vector<HeadingEstimate> opinions(const SightedDrive& drive, const Sighting& start,
                                      double map_sd, const Believed& believed) {
  std::vector<HeadingEstimate> said;
  const Vector2 origin = *believed(start.landmark);
  PoseEstimate pose = pose_from_landmark({0.0, 0.0}, drive.offset_of(start));
  double time = start.t;
  for (const Sighting& sighting : drive.recording().sightings) {
    if (sighting.t < start.t || sighting.landmark == start.landmark) continue;
    const std::optional<Vector2> there = believed(sighting.landmark);
    if (!there || *there == origin) continue;
    pose = drive.reckon(pose, time, sighting.t);
    time = sighting.t;
    if (pose.covariance(2, 2) > kLostHeading * kLostHeading) break;
    const Vector2 in_map = *there - origin;
    const PositionEstimate place = landmark_from_pose(pose, drive.offset_of(sighting));
    if (place.position.squaredNorm() <= 0.0) continue;
    said.push_back({direction(in_map) - direction(place.position),
                    direction_variance(place.position, place.covariance) +
                        2.0 * map_sd * map_sd / in_map.squaredNorm()});
    if (said.size() >= kEnoughSightings) break;
  }
  return said;
}

}  // namespace

std::optional<HeadingEstimate> heading_in_map(const SightedDrive& drive, const Sighting& start,
                                              double map_sd, const Believed& believed) {
  const std::vector<HeadingEstimate> said = opinions(drive, start, map_sd, believed);
  const HeadingEstimate* best = nullptr;
  std::ptrdiff_t most = 0;
  for (const HeadingEstimate& one : said) {
    const auto votes =
        std::count_if(said.begin(), said.end(),
                      [&one](const HeadingEstimate& other) { return agree(one, other); });
    if (votes > most || (votes == most && one.variance < best->variance)) {
      best = &one;
      most = votes;
    }
  }
  if (best == nullptr || 2 * most <= std::ssize(said)) return std::nullopt;
  return HeadingEstimate{wrap_angle(best->heading), best->variance};
}

}  // namespace trussmap
