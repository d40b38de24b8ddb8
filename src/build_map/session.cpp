// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/session.hpp"

#include "map/heading_reset.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap {
namespace {

constexpr double kMuchPoorer = 4.0;      // in variance
constexpr double kGuidedHeading = 0.01;  // rad, standard deviation of a first heading

}  // namespace

Session::Session(const SightedDrive& drive, const LegByLegOptions& options, MapBuilder& builder,
                 BuiltMap& result)
    : drive_(drive),
      recording_(drive.recording()),
      options_(options),
      builder_(builder),
      result_(result),
      path_(driven_path(drive.drive())) {}

void Session::run() {
  for (const Stop& stop : stops_of(recording_.sightings)) {
    if (reference_ == nullptr) {
      begin(stop);
    } else {
      visit(stop);
    }
  }
  if (reference_ == nullptr && builder_.landmarks() > 0) {
    throw SolveError(recording_.name +
                     " is tied to nothing: expected sightings of a landmark of the other sessions");
  }
}

/// A session begins at the nearest landmark of the map that it sees, the first one anywhere.
void Session::begin(const Stop& stop) {
  std::vector<Accepted> seen = accepted_at(stop);
  const bool first_ever = builder_.landmarks() == 0;
  const auto at = std::find_if(seen.begin(), seen.end(), [&](const Accepted& one) {
    return first_ever || builder_.find(one.sighting->landmark);
  });
  if (at == seen.end()) return;
  const InitialHeading first = drive_.heading_at(stop.t);
  readings_used_until_ = first.reading_time;
  builder_.start(at->sighting->landmark);
  settle(stop, *at, first_heading(*at->sighting, first));
  seen.erase(at);
  observe(seen);
}

/// By the compass; without one as the best fit has it.
HeadingEstimate Session::first_heading(const Sighting& at, const InitialHeading& first) const {
  if (recording_.drive.has_compass()) return with_yaw(at, first.heading);
  return {drive_.guided_heading(at), kGuidedHeading * kGuidedHeading};
}

/// Taken together with what the sighting's yaw and the landmark's orientation in the best fit say.
HeadingEstimate Session::with_yaw(const Sighting& at, const HeadingEstimate& heading) const {
  const Landmark& landmark = options_.guide.landmark(*options_.guide.find(at.landmark));
  const double yaw = drive_.yaw_of(at);
  if (std::isnan(yaw) || !landmark.heading) return heading;
  const double own = std::hypot(drive_.yaw_sd(), landmark.sd_heading.value_or(0.0));
  const double total = heading.variance + own * own;
  if (!(total > 0.0)) return heading;
  const double gain = heading.variance / total;
  const double off = wrap_angle(*landmark.heading - yaw - heading.heading);
  return {heading.heading + gain * off, heading.variance * own * own / total};
}

/// Nearest first: the landmark stood on, else the nearest seen, is the stop's reference.
std::vector<Session::Accepted> Session::accepted_at(const Stop& stop) const {
  std::vector<Accepted> accepted;
  for (std::size_t k = stop.first; k < stop.first + stop.count; ++k) {
    const Sighting& sighting = recording_.sightings[k];
    if (sighting.locates() && !drive_.is_left_out(sighting))
      accepted.push_back({&sighting, drive_.offset_of(sighting)});
  }
  std::stable_sort(accepted.begin(), accepted.end(), [](const Accepted& a, const Accepted& b) {
    return a.offset.offset_robot.norm() < b.offset.offset_robot.norm();
  });
  return accepted;
}

void Session::visit(const Stop& stop) {
  pose_ = drive_.reckon(pose_, time_, stop.t, readings_used_until_);
  time_ = stop.t;
  std::vector<Accepted> accepted = accepted_at(stop);
  if (accepted.empty() || accepted.front().sighting->landmark == reference_->landmark) return;
  if (path_at(recording_.drive, path_, stop.t) - leg_start_ < options_.build.min_drive) return;
  arrive(stop, accepted.front());
  accepted.erase(accepted.begin());
  observe(accepted);
}

void Session::arrive(const Stop& stop, const Accepted& at) {
  const PositionEstimate place = landmark_from_pose(pose_, at.offset);
  const HeadingEstimate heading = heading_after(at, place);
  const Arrival arrival = builder_.arrive(at.sighting->landmark, in_map(place));
  ++result_.legs;
  if (arrival.kind == Arrival::Kind::first_sight) ++result_.first_sight;
  if (arrival.kind == Arrival::Kind::refinement) ++result_.refinements;
  if (arrival.kind == Arrival::Kind::left_out) result_.off_map.push_back(at.sighting->landmark);
  settle(stop, at, heading);
}

Traversal Session::in_map(const PositionEstimate& place) const {
  const Matrix2& R = options_.to_map;
  return {R * place.position, R * place.covariance * R.transpose()};
}

/// With a compass as reckoned; without, as the best fit has it, and as certain as one that is taken
/// from the landmarks at both ends of the leg.
HeadingEstimate Session::heading_after(const Accepted& at, const PositionEstimate& place) const {
  const HeadingEstimate reckoned{pose_.pose.heading, pose_.covariance(2, 2)};
  if (recording_.drive.has_compass()) return with_yaw(*at.sighting, reckoned);
  const Landmark& from = options_.guide.landmark(*options_.guide.find(reference_->landmark));
  const Landmark& to = options_.guide.landmark(*options_.guide.find(at.sighting->landmark));
  const double heading = drive_.guided_heading(*at.sighting);
  const Vector2 in_map = to.position - from.position;
  if (in_map.squaredNorm() <= 0.0) return {heading, reckoned.variance};
  const double of_traversal =
      std::max(direction_variance(place.position, place.covariance) - start_heading_variance_, 0.0);
  const double of_map = direction_variance(in_map, *from.covariance + *to.covariance);
  return {heading, reset_heading(reckoned, 0.0, of_traversal + of_map).variance};
}

/// Everything from here on is reckoned from this landmark, seen at this stop.
void Session::settle(const Stop& stop, const Accepted& at, const HeadingEstimate& heading) {
  reference_ = at.sighting;
  pose_ = pose_from_landmark(heading, at.offset);
  start_heading_variance_ = heading.variance;
  time_ = stop.t;
  leg_start_ = path_at(recording_.drive, path_, stop.t);
}

/// The paper's averages are plain and its stiffness is that of the mean error: sightings far poorer
/// than traversals would only spoil a route, and a landmark that the robot stands on elsewhere does
/// better without them.
bool Session::dilutes(const std::string& landmark, const Matrix2& covariance) const {
  const bool plain =
      options_.build.method == Method::elastic || options_.build.method == Method::elastic_printed;
  if (plain && options_.stood_on.contains(landmark)) return true;
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
    builder_.observe(other.sighting->landmark, in_map(place));
    ++result_.side_sightings;
  }
}

}  // namespace trussmap
