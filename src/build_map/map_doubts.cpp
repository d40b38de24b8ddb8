// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/map_doubts.hpp"

#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace trussmap {
namespace {

void doubt_units(const std::vector<Recording>& recordings, const Model& model,
                 std::vector<std::string>& warnings) {
  constexpr double kFast = 30.0;  // m/s
  constexpr double kWide = 10.0;  // m
  for (const Recording& recording : recordings) {
    const Drive& drive = recording.drive;
    double path = 0.0;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      path += std::max(std::abs(drive.left[row]), std::abs(drive.right[row]));
    }
    const double speed = path / (drive.t.back() - drive.start());
    if (speed > kFast) {
      warnings.push_back(recording.name + ": the wheels drive at " + short_text(speed, 3) +
                         " m/s on average; are left and right in metres, t in seconds?");
    }
  }
  if (model.robot.wheelbase > kWide) {
    warnings.push_back("a wheelbase of " + short_text(model.robot.wheelbase) +
                       " m; is it in metres?");
  }
}

/// How far the map's routes are from what was measured of them, in standard deviations, in the
/// middle of all routes. Sound maps have 1 to 5.
double contradiction(const LandmarkGraph& map) {
  std::vector<double> distances;
  for (int k = 0; k < map.routes(); ++k) {
    const Route& route = map.route(k);
    const Vector2 off = map.landmark(route.target).position - map.landmark(route.source).position -
                        route.displacement;
    distances.push_back(std::sqrt(off.dot(route.covariance.inverse() * off)));
  }
  if (distances.empty()) return 0.0;
  std::nth_element(distances.begin(), distances.begin() + std::ssize(distances) / 2,
                   distances.end());
  return distances[distances.size() / 2];
}

}  // namespace

std::vector<std::string> doubts_of(const BuiltMap& built, const std::vector<Recording>& recordings,
                                   const Model& model) {
  constexpr double kTorn = 20.0;  // standard deviations
  std::vector<std::string> warnings;
  doubt_units(recordings, model, warnings);
  const double torn = contradiction(built.map);
  if (torn > kTorn) {
    warnings.push_back("the map contradicts its own routes, by " + fixed_text(torn, 0) +
                       " standard deviations in the middle; " +
                       (built.method == Method::elastic_printed
                            ? "the printed refinement diverges here, use the method elastic"
                            : "wrong units, a wrong wheelbase, exchanged columns or labels, or "
                              "noise that is believed too small"));
  }
  return warnings;
}

}  // namespace trussmap
