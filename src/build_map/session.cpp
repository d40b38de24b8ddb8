// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/session.hpp"

#include "build_map/heading_in_map.hpp"
#include "map/heading_reset.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace trussmap {
namespace {

// What each contradiction takes from the trust in the reckoning: after several in a row it is the
// robot that is lost, not the sightings that are wrong.
constexpr double kDoubtHeading = 0.1;   // rad
constexpr double kDoubtPosition = 0.1;  // m

constexpr double kMuchPoorer = 4.0;  // in variance

double mahalanobis(const Vector2& misfit, const Matrix2& covariance) {
  return std::sqrt(misfit.dot(covariance.inverse() * misfit));
}

}  // namespace

bool Candidates::confirmed(const std::string& landmark, const PositionEstimate& place) {
  std::vector<PositionEstimate>& places = places_[landmark];
  places.push_back(place);
  const Matrix2 slack = options_->build.map_sd * options_->build.map_sd * Matrix2::Identity();
  const auto agrees = [&](const PositionEstimate& other) {
    const Matrix2 spread = place.covariance + other.covariance + slack;
    return mahalanobis(place.position - other.position, spread) <= options_->gate;
  };
  if (std::count_if(places.begin(), places.end(), agrees) < options_->build.confirmations)
    return false;
  places_.erase(landmark);
  return true;
}

std::vector<std::string> Candidates::unconfirmed() const {
  std::vector<std::string> names;
  names.reserve(places_.size());
  for (const auto& [name, places] : places_) names.push_back(name);
  return names;
}

Session::Session(const SightedDrive& drive, const LegByLegOptions& options,
                 const LandmarkPositions& guide, MapBuilder& builder, Candidates& candidates,
                 BuiltMap& result)
    : drive_(drive),
      recording_(drive.recording()),
      options_(options),
      guide_(guide),
      builder_(builder),
      candidates_(candidates),
      result_(result),
      path_(driven_path(drive.drive())) {}

void Session::run() {
  for (const Stop& stop : stops_of(recording_.sightings)) {
    if (reference_ != nullptr) {
      visit(stop);
    } else if (builder_.landmarks() == 0) {
      const Sighting& sighting = recording_.sightings[stop.reference];
      const InitialHeading first = drive_.heading_at(stop.t);
      readings_used_until_ = first.reading_time;
      begin(stop, sighting, first.heading);
    } else {
      resume(stop);
    }
  }
  if (reference_ == nullptr) {
    throw SolveError(recording_.name +
                     " is tied to nothing: expected sightings of a landmark of the other sessions"
                     ", and without a compass of two");
  }
}

/// A further session begins where it first sights a landmark of the map and finds its heading.
void Session::resume(const Stop& stop) {
  const Sighting* nearest = nullptr;
  for (std::size_t k = stop.first; k < stop.first + stop.count; ++k) {
    const Sighting& sighting = recording_.sightings[k];
    if (!builder_.find(sighting.landmark)) continue;
    const double distance = offset_of(sighting).offset_robot.norm();
    if (nearest == nullptr || distance < offset_of(*nearest).offset_robot.norm()) {
      nearest = &sighting;
    }
  }
  if (nearest == nullptr) return;
  const InitialHeading first = drive_.heading_at(stop.t);
  std::optional<HeadingEstimate> heading = first.heading;
  if (!recording_.drive.has_compass()) {
    heading = heading_in_map(drive_, *nearest, options_.build.map_sd,
                             [this](const std::string& name) { return believed(name); });
  }
  if (!heading) return;
  readings_used_until_ = first.reading_time;
  begin(stop, *nearest, *heading);
}

LandmarkOffset Session::offset_of(const Sighting& sighting) const {
  return drive_.offset_of(sighting,
                          recording_.drive.has_compass() ? 0.0 : options_.build.bearing_slack);
}

/// Where a landmark is thought to be: by the earlier look, else by the map so far.
std::optional<Vector2> Session::believed(const std::string& landmark) const {
  if (const auto place = guide_.find(landmark); place != guide_.end()) return place->second;
  if (const auto known = builder_.find(landmark)) return builder_.position(*known);
  return std::nullopt;
}

void Session::begin(const Stop& stop, const Sighting& at, const HeadingEstimate& heading) {
  builder_.start(at.landmark);
  settle(stop, {&at, offset_of(at)}, heading);
  std::vector<Accepted> others;
  for (std::size_t k = stop.first; k < stop.first + stop.count; ++k) {
    if (&recording_.sightings[k] != &at) consider(recording_.sightings[k], others);
  }
  observe(others);
}

void Session::visit(const Stop& stop) {
  pose_ = drive_.reckon(pose_, time_, stop.t, readings_used_until_);
  time_ = stop.t;
  std::vector<Accepted> accepted;
  for (std::size_t k = stop.first; k < stop.first + stop.count; ++k) {
    consider(recording_.sightings[k], accepted);
  }
  // The reference: the landmark stood on, else the nearest seen.
  std::stable_sort(accepted.begin(), accepted.end(), [](const Accepted& a, const Accepted& b) {
    return a.offset.offset_robot.norm() < b.offset.offset_robot.norm();
  });
  if (accepted.empty() || accepted.front().sighting->landmark == reference_->landmark) return;
  if (path_at(recording_.drive, path_, stop.t) - leg_start_ < options_.build.min_drive) return;
  arrive(stop, accepted.front());
  accepted.erase(accepted.begin());
  observe(accepted);
}

/// Lets a sighting through unless it contradicts the map.
void Session::consider(const Sighting& sighting, std::vector<Accepted>& accepted) {
  const LandmarkOffset offset = offset_of(sighting);
  PositionEstimate place = landmark_from_pose(pose_, offset);
  place.position += *believed(reference_->landmark);
  const std::optional<Vector2> known = believed(sighting.landmark);
  if (!known) {
    if (sighting.standing() || candidates_.confirmed(sighting.landmark, place)) {
      accepted.push_back({&sighting, offset});
    }
    return;
  }
  const Vector2 misfit = place.position - *known;
  const Matrix2 spread =
      place.covariance + options_.build.map_sd * options_.build.map_sd * Matrix2::Identity();
  if (mahalanobis(misfit, spread) <= options_.gate) {
    accepted.push_back({&sighting, offset});
  } else {
    reject(sighting, misfit.norm());
  }
}

void Session::reject(const Sighting& sighting, double misfit) {
  result_.rejected.push_back({recording_.name, sighting.t, sighting.landmark, misfit});
  pose_.covariance(0, 0) += kDoubtPosition * kDoubtPosition;
  pose_.covariance(1, 1) += kDoubtPosition * kDoubtPosition;
  pose_.covariance(2, 2) += kDoubtHeading * kDoubtHeading;
}

void Session::arrive(const Stop& stop, const Accepted& at) {
  const PositionEstimate place = landmark_from_pose(pose_, at.offset);
  const HeadingEstimate heading = heading_after(at, place);
  const Arrival arrival =
      builder_.arrive(at.sighting->landmark, {place.position, place.covariance});
  ++result_.legs;
  if (arrival.kind == Arrival::Kind::first_sight) ++result_.first_sight;
  if (arrival.kind == Arrival::Kind::refinement) ++result_.refinements;
  settle(stop, at, heading);
}

/// With a compass as reckoned; without, taken from the map where it knows the landmark.
HeadingEstimate Session::heading_after(const Accepted& at, const PositionEstimate& place) const {
  const HeadingEstimate reckoned{pose_.pose.heading, pose_.covariance(2, 2)};
  const std::optional<Vector2> to = believed(at.sighting->landmark);
  if (recording_.drive.has_compass() || !to) return reckoned;
  const Vector2 in_map = *to - *believed(reference_->landmark);
  if (in_map.squaredNorm() <= 0.0) return reckoned;
  const double of_traversal =
      std::max(direction_variance(place.position, place.covariance) - start_heading_variance_, 0.0);
  double of_map = options_.build.map_sd * options_.build.map_sd / in_map.squaredNorm();
  if (guide_.empty()) {
    const auto known = builder_.find(at.sighting->landmark);
    if (const auto route = builder_.route_between(builder_.here(), *known)) {
      of_map = std::min(of_map, direction_variance(in_map, route->covariance) / route->traversals);
    }
  }
  return reset_heading(reckoned, direction(in_map) - direction(place.position),
                       of_traversal + of_map);
}

/// Everything from here on is reckoned from this landmark, seen at this stop.
void Session::settle(const Stop& stop, const Accepted& at, const HeadingEstimate& heading) {
  reference_ = at.sighting;
  pose_ = pose_from_landmark(heading, at.offset);
  start_heading_variance_ = heading.variance;
  time_ = stop.t;
  leg_start_ = path_at(recording_.drive, path_, stop.t);
}

/// A route's averages are plain: a sighting far poorer than its traversals would only spoil them.
bool Session::dilutes(const std::string& landmark, const Matrix2& covariance) const {
  const std::optional<int> known = builder_.find(landmark);
  if (!known) return false;
  const std::optional<Route> route = builder_.route_between(builder_.here(), *known);
  return route && covariance.trace() > kMuchPoorer * route->covariance.trace();
}

/// The landmarks that are seen from a stop beside its reference: routes from there.
void Session::observe(const std::vector<Accepted>& others) {
  for (const Accepted& other : others) {
    if (other.sighting->landmark == reference_->landmark) continue;
    const PositionEstimate place = landmark_from_pose(pose_, other.offset);
    if (place.position.squaredNorm() <= 0.0) continue;  // two landmarks stood on at once
    if (dilutes(other.sighting->landmark, place.covariance)) continue;
    builder_.observe(other.sighting->landmark, {place.position, place.covariance});
    ++result_.side_sightings;
  }
}

}  // namespace trussmap
