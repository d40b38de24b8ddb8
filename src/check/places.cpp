// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/places.hpp"

#include "check/survey_legs.hpp"
#include "statistics/median.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/Dense>

namespace trussmap::check {
namespace {

constexpr double kTogether = 2.0;  // s of ranges that make a place
constexpr std::size_t kFewestRanges = 5;
constexpr std::size_t kFewestBeacons = 3;
constexpr std::size_t kMostRanges = 20000;

/// How far a place lies from the line between its neighbours in time, in the middle; the way is
/// straight over three of them, or they are too far apart to matter.
double noise_of(const std::vector<TimedPlace>& all) {
  constexpr double kBySum = 0.6;  // of a coordinate's standard deviation, by the median of three's
  std::vector<double> off;
  for (std::size_t k = 1; k + 1 < all.size(); ++k) {
    const TimedPlace& a = all[k - 1];
    const TimedPlace& b = all[k + 1];
    if (!(b.t > a.t)) continue;
    const double share = (all[k].t - a.t) / (b.t - a.t);
    off.push_back((all[k].at - a.at - share * (b.at - a.at)).norm());
  }
  return off.empty() ? 0.0 : kBySum * statistics::median(std::move(off));
}

bool within(const MotionRows& drive, double t) {
  return t >= drive.start() && t <= drive.t.back();
}

struct RangeToBeacon {
  double t = 0.0;  ///< s, from the middle
  double range = 0.0;
  Vector2 beacon = Vector2::Zero();
};

/// From the differences of squared ranges, which are linear in the place; nothing where the beacons
/// stand nearly in a line.
std::optional<Vector2> place_at_rest(const std::vector<RangeToBeacon>& readings) {
  constexpr double kThin = 0.02;  // of the larger eigenvalue
  Vector2 mean = Vector2::Zero();
  double squares = 0.0;
  const auto count = static_cast<double>(readings.size());
  for (const RangeToBeacon& one : readings) {
    mean += one.beacon / count;
    squares += (one.range * one.range - one.beacon.squaredNorm()) / count;
  }
  Matrix2 normal = Matrix2::Zero();
  Vector2 right = Vector2::Zero();
  for (const RangeToBeacon& one : readings) {
    const Vector2 row = -2.0 * (one.beacon - mean);
    normal += row * row.transpose();
    right += row * (one.range * one.range - one.beacon.squaredNorm() - squares);
  }
  const Eigen::SelfAdjointEigenSolver<Matrix2> axes(normal);
  if (!(axes.eigenvalues()[0] > kThin * axes.eigenvalues()[1])) return std::nullopt;
  return Vector2(normal.ldlt().solve(right));
}

/// Place and velocity in the middle that explain the ranges, the velocity held near 0 by what
/// robots drive; nothing where they leave much.
std::optional<Vector2> place_of(const std::vector<RangeToBeacon>& readings) {
  constexpr double kFast = 1.0;   // m/s
  constexpr double kError = 0.1;  // m
  constexpr double kLeft = 0.1;   // of the ranges
  constexpr int kRounds = 8;
  const std::optional<Vector2> start = place_at_rest(readings);
  if (!start) return std::nullopt;
  Eigen::Vector4d x(start->x(), start->y(), 0.0, 0.0);
  double left = 0.0;
  double size = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    normal.diagonal().tail<2>().setConstant(1.0 / (kFast * kFast));
    Eigen::Vector4d gradient(0.0, 0.0, -x[2] / (kFast * kFast), -x[3] / (kFast * kFast));
    left = size = 0.0;
    for (const RangeToBeacon& one : readings) {
      const Vector2 from = x.head<2>() + one.t * x.tail<2>() - one.beacon;
      const double far = std::max(from.norm(), 1e-6);
      Eigen::Vector4d row;
      row << from / far, one.t * from / far;
      const double off = one.range - far;
      const double weight = 1.0 / (kError * std::max(kError, std::abs(off)));
      normal += weight * row * row.transpose();
      gradient += weight * off * row;
      left += std::abs(off);
      size += one.range;
    }
    x += normal.ldlt().solve(gradient);
  }
  if (!x.allFinite() || left > kLeft * size) return std::nullopt;
  return Vector2(x.head<2>());
}

}  // namespace

PlacesSeen places_by_stops(const DrivenRecording& recording) {
  PlacesSeen seen{"the survey"};
  const SurveyPlaces places = surveyed_places(recording);
  for (const Sighting& one : recording.sightings) {
    const auto place = places.find(one.landmark);
    if (one.standing() && place != places.end()) seen.all.push_back({one.t, place->second});
  }
  return seen;
}

PlacesSeen places_by_fixes(const DrivenRecording& recording) {
  PlacesSeen seen{"the fixes"};
  std::vector<double> stated;
  for (const Fix& one : recording.fixes) {
    if (!within(recording.drive, one.t)) continue;
    seen.all.push_back({one.t, {one.x, one.y}});
    if (!std::isnan(one.sd)) stated.push_back(one.sd);
  }
  seen.noise = noise_of(seen.all);
  if (!stated.empty()) seen.noise = std::max(seen.noise, statistics::median(std::move(stated)));
  return seen;
}

PlacesSeen places_by_ranges(const DrivenRecording& recording) {
  PlacesSeen seen{"the ranges to surveyed landmarks"};
  const SurveyPlaces places = surveyed_places(recording);
  std::vector<RangeToBeacon> readings;
  std::set<std::string_view> beacons;
  std::size_t taken = 0;
  const auto finish = [&] {
    if (readings.size() >= kFewestRanges && beacons.size() >= kFewestBeacons) {
      const double middle = 0.5 * (readings.front().t + readings.back().t);
      for (RangeToBeacon& one : readings) one.t -= middle;
      if (const auto place = place_of(readings)) seen.all.push_back({middle, *place});
    }
    readings.clear();
    beacons.clear();
  };
  for (const Sighting& one : recording.sightings) {
    const auto place = places.find(one.landmark);
    if (std::isnan(one.range) || place == places.end()) continue;
    if (!readings.empty() && one.t - readings.front().t > kTogether) finish();
    if (++taken > kMostRanges) break;
    readings.push_back({one.t, one.range, place->second});
    beacons.insert(one.landmark);
  }
  finish();
  seen.noise = noise_of(seen.all);
  return seen;
}

PlacesSeen places_by_truth(const DrivenRecording& recording) {
  PlacesSeen seen{"the truth"};
  for (const TruthRow& one : recording.truth) {
    if (within(recording.drive, one.t)) seen.all.push_back({one.t, {one.x, one.y}});
  }
  seen.noise = noise_of(seen.all);
  return seen;
}

}  // namespace trussmap::check
