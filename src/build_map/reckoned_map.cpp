// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/reckoned_map.hpp"

#include "drive/legs.hpp"

#include <map>
#include <string>
#include <utility>

namespace trussmap::map_building {
namespace {

constexpr double kShortestLoop = 1.0;  // m of driven path

struct Seen {
  Vector2 sum = Vector2::Zero();
  int count = 0;
  Vector2 last = Vector2::Zero();
  double last_path = -1.0;  // m driven until then, -1: only wrongly so far
};

class Reckoning {
 public:
  Reckoning(const SightedDrive& session, ReckonedMap& result)
      : session_(session), result_(result), path_(drive::driven_path(session.drive())) {}

  void run() {
    const std::vector<drive::Stop> stops = drive::stops_of(session_.recording().sightings);
    if (stops.empty()) return;
    double time = stops.front().t;
    const InitialHeading first = session_.heading_at(time);
    PoseEstimate pose;
    pose.pose.heading = first.heading.heading;
    pose.covariance(2, 2) = first.heading.variance;
    for (const drive::Stop& stop : stops) {
      pose = session_.reckon(pose, time, stop.t, first.reading_time);
      time = stop.t;
      for (std::size_t k = stop.first; k < stop.first + stop.count; ++k) {
        if (session_.recording().sightings[k].locates())
          see(session_.recording().sightings[k], pose);
      }
    }
    for (const auto& [name, seen] : seen_) result_.places.try_emplace(name, seen.sum / seen.count);
  }

 private:
  void see(const Sighting& sighting, const PoseEstimate& pose) {
    Seen& seen = seen_[sighting.landmark];
    const Vector2 here = landmark_from_pose(pose, session_.offset_of(sighting)).position;
    seen.sum += here;
    ++seen.count;
    if (session_.is_left_out(sighting)) return;
    const double path = drive::path_at(session_.drive(), path_, sighting.t);
    if (seen.last_path >= 0.0 && path - seen.last_path < kShortestLoop) return;
    if (seen.last_path >= 0.0) {
      result_.misclosures.push_back((here - seen.last).norm() / (path - seen.last_path));
    }
    seen.last = here;
    seen.last_path = path;
  }

  const SightedDrive& session_;
  ReckonedMap& result_;
  std::vector<double> path_;
  std::map<std::string, Seen> seen_;
};

}  // namespace

ReckonedMap reckoned_map(const std::vector<SightedDrive>& sessions) {
  ReckonedMap result;
  for (const SightedDrive& session : sessions) Reckoning(session, result).run();
  return result;
}

}  // namespace trussmap::map_building
