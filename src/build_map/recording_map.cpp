// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/recording_map.hpp"

#include "build_map/session.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace trussmap {
namespace {

/// Landmarks where the wheels (and compass) alone put them: mean over all sightings.
std::map<std::string, Vector2> dead_reckoned_positions(const Recording& recording,
                                                       const Model& model) {
  std::map<std::string, std::pair<Vector2, int>> sums;
  const std::vector<Stop> stops = stops_of(recording.sightings);
  double time = stops.front().t;
  const InitialHeading first = initial_heading(recording.drive, time, model.robot, model.noise);
  PoseEstimate pose;
  pose.pose.heading = first.heading.heading;
  pose.covariance(2, 2) = first.heading.variance;
  for (const Stop& stop : stops) {
    pose = dead_reckon(pose, recording.drive, time, stop.t, model.robot, model.noise,
                       first.reading_time);
    time = stop.t;
    for (std::size_t k = stop.first; k < stop.first + stop.count; ++k) {
      const Sighting& sighting = recording.sightings[k];
      const LandmarkOffset offset = landmark_offset(sighting, model.noise);
      auto& [sum, count] = sums.try_emplace(sighting.landmark, Vector2::Zero(), 0).first->second;
      sum += landmark_from_pose(pose, offset).position;
      ++count;
    }
  }
  std::map<std::string, Vector2> means;
  for (const auto& [name, sum] : sums) means[name] = sum.first / sum.second;
  return means;
}

/// Sessions with a compass first: it gives the map its direction.
std::vector<const Recording*> in_order(const std::vector<Recording>& recordings) {
  std::vector<const Recording*> sessions;
  sessions.reserve(recordings.size());
  for (const Recording& recording : recordings) sessions.push_back(&recording);
  std::stable_partition(sessions.begin(), sessions.end(),
                        [](const Recording* one) { return one->drive.has_compass(); });
  return sessions;
}

RecordingMap look(const std::vector<const Recording*>& sessions, const Model& model,
                  const RecordingMapOptions& options, const Guide& guide) {
  RecordingMap result;
  result.method = name_of(options.builder.method);
  MapBuilder builder(options.builder);
  Candidates candidates(options);
  for (const Recording* recording : sessions) {
    Session(*recording, model, options, guide, builder, candidates, result).run();
  }
  for (int round = 0; round < options.settle; ++round)
    builder.settle(options.builder.gain_limit / (round + 1));
  result.map = builder.map();
  result.unconfirmed = candidates.unconfirmed();
  return result;
}

Guide guide_of(const LandmarkGraph& map) {
  Guide guide;
  for (int k = 0; k < map.landmarks(); ++k) guide[map.landmark(k).name] = map.landmark(k).position;
  return guide;
}

void check(const std::vector<Recording>& recordings, const RecordingMapOptions& options) {
  if (recordings.empty()) throw std::invalid_argument("a map needs a recording");
  if (!(options.gate > 0.0) || !(options.map_sd >= 0.0) || options.looks < 1 ||
      options.settle < 0 || options.confirmations < 1 || !(options.bearing_slack >= 0.0) ||
      !(options.min_drive >= 0.0)) {
    throw std::invalid_argument("a recording map's option is out of range");
  }
  for (const Recording& recording : recordings) {
    if (recording.sightings.empty()) {
      throw InputError(recording.name, 0,
                       "no landmark was sighted, expected sightings to build a map from");
    }
  }
}

}  // namespace

RecordingMap map_recordings(const std::vector<Recording>& recordings, const Model& model,
                            const RecordingMapOptions& options) {
  check(recordings, options);
  const bool compass =
      std::all_of(recordings.begin(), recordings.end(),
                  [](const Recording& recording) { return recording.drive.has_compass(); });
  RecordingMap result;
  Guide guide = options.guide;
  const int looks = compass || !guide.empty() ? 1 : options.looks;
  for (int n = 0; n < looks; ++n) {
    result = look(in_order(recordings), model, options, guide);
    guide = guide_of(result.map);
  }
  if (result.legs == 0) {
    throw InputError(recordings.front().name, 0,
                     "no leg, expected a drive from one landmark to another");
  }
  for (const Recording& recording : recordings) {
    for (const auto& [name, position] : dead_reckoned_positions(recording, model)) {
      result.dead_reckoned.try_emplace(name, position);
    }
  }
  return result;
}

}  // namespace trussmap
