// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/legs.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::drive {
namespace {

double distance_of(const Sighting& sighting) {
  return sighting.standing() ? 0.0 : sighting.range;
}

}  // namespace

std::vector<Stop> stops_of(const std::vector<Sighting>& sightings) {
  std::vector<Stop> stops;
  for (std::size_t k = 0; k < sightings.size(); ++k) {
    if (!sightings[k].locates()) continue;
    if (stops.empty() || stops.back().t != sightings[k].t) {
      stops.push_back({sightings[k].t, k, 0, k});
    }
    Stop& stop = stops.back();
    stop.count = k + 1 - stop.first;
    const Sighting& best = sightings[stop.reference];
    const bool stands_first = sightings[k].standing() && !best.standing();
    if (stands_first || distance_of(sightings[k]) < distance_of(best)) stop.reference = k;
  }
  return stops;
}

std::vector<double> driven_path(const MotionRows& drive) {
  std::vector<double> path(drive.rows());
  double sum = 0.0;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    sum += drive.way(row);
    path[row] = sum;
  }
  return path;
}

double path_at(const DriveColumns& drive, const std::vector<double>& path, double t) {
  const auto after = std::lower_bound(drive.t.begin(), drive.t.end(), t);
  if (after == drive.t.end()) return path.back();
  const auto row = static_cast<std::size_t>(after - drive.t.begin());
  const double begin = row == 0 ? drive.start() : drive.t[row - 1];
  const double path_begin = row == 0 ? 0.0 : path[row - 1];
  const double part = std::clamp((t - begin) / (drive.t[row] - begin), 0.0, 1.0);
  return path_begin + part * (path[row] - path_begin);
}

std::vector<Leg> legs_of(const DrivenRecording& recording, const std::vector<Stop>& stops,
                         double min_drive) {
  std::vector<Leg> legs;
  if (stops.empty()) return legs;
  const std::vector<double> path = driven_path(recording.drive);
  const auto reference = [&](std::size_t stop) {
    return recording.sightings[stops[stop].reference].landmark;
  };
  const auto driven = [&](std::size_t stop) {
    return path_at(recording.drive, path, stops[stop].t);
  };
  std::size_t from = 0;
  for (std::size_t to = 1; to < stops.size(); ++to) {
    if (reference(to) == reference(from) || driven(to) - driven(from) < min_drive) continue;
    legs.push_back({from, to});
    from = to;
  }
  return legs;
}

bool is_held_out(std::size_t leg, double share) {
  constexpr std::size_t kBlock = 5;
  constexpr double kRounding = 1e-9;  // 10 x 0.29 is to be 2.9
  const std::size_t number = leg / kBlock;
  const auto block = static_cast<double>(number);
  return std::floor((block + 1.0) * share + kRounding) > std::floor(block * share + kRounding);
}

}  // namespace trussmap::drive
