// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/leg_by_leg.hpp"

#include "build_map/session.hpp"
#include "recording/legs.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace trussmap {
namespace {

/// Landmarks where the wheels (and compass) alone put them: mean over all sightings.
LandmarkPositions dead_reckoned_positions(const SightedDrive& session) {
  std::map<std::string, std::pair<Vector2, int>> sums;
  const std::vector<Sighting>& sightings = session.recording().sightings;
  const std::vector<Stop> stops = stops_of(sightings);
  double time = stops.front().t;
  const InitialHeading first = session.heading_at(time);
  PoseEstimate pose;
  pose.pose.heading = first.heading.heading;
  pose.covariance(2, 2) = first.heading.variance;
  for (const Stop& stop : stops) {
    pose = session.reckon(pose, time, stop.t, first.reading_time);
    time = stop.t;
    for (std::size_t k = stop.first; k < stop.first + stop.count; ++k) {
      const LandmarkOffset offset = session.offset_of(sightings[k]);
      auto& [sum, count] =
          sums.try_emplace(sightings[k].landmark, Vector2::Zero(), 0).first->second;
      sum += landmark_from_pose(pose, offset).position;
      ++count;
    }
  }
  LandmarkPositions means;
  for (const auto& [name, sum] : sums) means[name] = sum.first / sum.second;
  return means;
}

/// Sessions with a compass first: it gives the map its direction.
std::vector<const SightedDrive*> in_order(const std::vector<SightedDrive>& sessions) {
  std::vector<const SightedDrive*> order;
  order.reserve(sessions.size());
  for (const SightedDrive& session : sessions) order.push_back(&session);
  std::stable_partition(order.begin(), order.end(),
                        [](const SightedDrive* one) { return one->drive().has_compass(); });
  return order;
}

BuiltMap look(const std::vector<const SightedDrive*>& sessions, const LegByLegOptions& options,
              const LandmarkPositions& guide) {
  BuiltMap result;
  result.method = options.build.method;
  MapBuilderOptions how;
  how.method = options.build.method;
  how.eta = options.build.eta;
  MapBuilder builder(how);
  Candidates candidates(options);
  for (const SightedDrive* session : sessions) {
    Session(*session, options, guide, builder, candidates, result).run();
  }
  for (int round = 0; round < options.build.settle; ++round) {
    builder.settle(how.gain_limit / (round + 1));
  }
  result.map = builder.map();
  result.unconfirmed = candidates.unconfirmed();
  return result;
}

}  // namespace

BuiltMap map_leg_by_leg(const std::vector<SightedDrive>& sessions, const LegByLegOptions& options) {
  const bool compass =
      std::all_of(sessions.begin(), sessions.end(),
                  [](const SightedDrive& session) { return session.drive().has_compass(); });
  BuiltMap result;
  LandmarkPositions guide = options.guide;
  const int looks = compass || !guide.empty() ? 1 : options.build.looks;
  for (int n = 0; n < looks; ++n) {
    result = look(in_order(sessions), options, guide);
    guide = positions_of(result.map);
  }
  if (result.legs == 0) {
    throw InputError(sessions.front().recording().name, 0,
                     "no leg, expected a drive from one landmark to another");
  }
  for (const SightedDrive& session : sessions) {
    for (const auto& [name, position] : dead_reckoned_positions(session)) {
      result.dead_reckoned.try_emplace(name, position);
    }
  }
  return result;
}

}  // namespace trussmap
