// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/mapped_session.hpp"

#include "map/heading_reset.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

namespace trussmap::map_building {
namespace {

constexpr double kMuchPoorer = 4.0;      // in variance
constexpr double kGuidedHeading = 0.01;  // rad, standard deviation of a first heading

}  // namespace

MappedSession::MappedSession(const SightedDrive& drive, const LegByLegOptions& options,
                             MapBuilder& builder, BuiltMap& result)
    : drive_(drive),
      own_axes_(!options.guided && !drive.recording().drive.has_compass()),
      recording_(drive.recording()),
      options_(options),
      builder_(builder),
      result_(result),
      path_(drive::driven_path(drive.drive())) {}

void MappedSession::run() {
  for (const SurveyPoint& point : recording_.survey) {
    survey_.emplace(point.landmark, Vector2(point.x, point.y));
  }
  if (!options_.guided) tour_ends_ = tour_ends();
  for (const drive::Stop& stop : drive::stops_of(recording_.sightings)) {
    if (reference_ == nullptr) {
      begin(stop);
    } else {
      visit(stop);
    }
  }
  const bool within_tour = tour_ends_.empty() || legs_ > tour_ends_.back();
  if (!options_.guided && legs_ > 0 && within_tour) {
    note_tour();
    if (!result_.tours.empty()) result_.tours.back().complete = false;
  }
  if (reference_ == nullptr && builder_.landmarks() > 0) {
    throw SolveError(recording_.name +
                     " is tied to nothing: expected sightings of a landmark of the other sessions");
  }
}

/// A session begins at the nearest landmark of the map that it sees, the first one anywhere.
void MappedSession::begin(const drive::Stop& stop) {
  std::vector<Accepted> seen = accepted_at(stop);
  const bool first_ever = builder_.landmarks() == 0;
  const auto at = std::find_if(seen.begin(), seen.end(), [&](const Accepted& one) {
    return first_ever || builder_.find(one.sighting->landmark);
  });
  if (at == seen.end()) return;
  const InitialHeading first = drive_.heading_at(stop.t);
  readings_used_until_ = first.reading_time;
  if (own_axes_) {
    builder_.start(at->sighting->landmark, at->offset);
  } else {
    builder_.start(at->sighting->landmark);
  }
  settle(stop, *at, first_heading(*at->sighting, first));
  seen.erase(at);
  observe(seen);
}

/// By the compass; without one as the best fit has it.
HeadingEstimate MappedSession::first_heading(const Sighting& at, const InitialHeading& first) {
  if (recording_.drive.has_compass() || !options_.guided) return with_yaw(at, first.heading);
  return {drive_.guided_heading(at), kGuidedHeading * kGuidedHeading};
}

/// Taken together with what the sighting's yaw and the landmark's orientation in the best fit say.
HeadingEstimate MappedSession::with_yaw(const Sighting& at, const HeadingEstimate& heading) {
  if (!options_.guided) return with_own_yaw(at, heading);
  const Landmark& landmark = options_.guide.landmark(*options_.guide.find(at.landmark));
  const double yaw = drive_.yaw_of(at);
  if (std::isnan(yaw) || !landmark.heading) return heading;
  const double own = std::hypot(drive_.yaw_sd(), landmark.sd_heading.value_or(0.0));
  return map::reset_heading(heading, *landmark.heading - yaw - heading.heading, own * own);
}

/// A landmark's orientation is what its first yaw made it, and the better known the more are read.
HeadingEstimate MappedSession::with_own_yaw(const Sighting& at, const HeadingEstimate& heading) {
  const double yaw = drive_.yaw_of(at);
  if (std::isnan(yaw) || !(heading.variance > 0.0)) return heading;
  const double own = drive_.yaw_sd() * drive_.yaw_sd();
  const auto [known, is_new] =
      orientations_.try_emplace(at.landmark, HeadingEstimate{heading.heading + yaw, 0.0});
  HeadingEstimate& orientation = known->second;
  if (is_new) {
    orientation.variance = heading.variance + own;
    return heading;
  }
  const HeadingEstimate after = map::reset_heading(
      heading, orientation.heading - yaw - heading.heading, orientation.variance + own);
  orientation = map::reset_heading(orientation, after.heading + yaw - orientation.heading,
                                   heading.variance + own);
  return after;
}

/// Nearest first: the landmark stood on, else the nearest seen, is the stop's reference.
std::vector<MappedSession::Accepted> MappedSession::accepted_at(const drive::Stop& stop) const {
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

void MappedSession::visit(const drive::Stop& stop) {
  pose_ = drive_.reckon(pose_, time_, stop.t, readings_used_until_);
  time_ = stop.t;
  std::vector<Accepted> accepted = accepted_at(stop);
  if (accepted.empty() || accepted.front().sighting->landmark == reference_->landmark) return;
  if (drive::path_at(recording_.drive, path_, stop.t) - leg_start_ < options_.build.min_drive)
    return;
  if (!has_map_axes() && !builder_.find(accepted.front().sighting->landmark)) return;
  arrive(stop, accepted.front());
  accepted.erase(accepted.begin());
  observe(accepted);
}

/// A new landmark cannot be placed while nothing tells a further session's heading.
bool MappedSession::has_map_axes() const {
  return !own_axes_ || builder_.landmarks() < 2 || builder_.pose().has_value();
}

Arrival MappedSession::arrive_at(const Accepted& at) {
  if (own_axes_) {
    return builder_.arrive(at.sighting->landmark, Motion{pose_.pose, pose_.covariance}, at.offset);
  }
  return builder_.arrive(at.sighting->landmark, in_map(landmark_from_pose(pose_, at.offset)));
}

void MappedSession::arrive(const drive::Stop& stop, const Accepted& at) {
  const HeadingEstimate heading =
      own_axes_ ? HeadingEstimate{} : heading_after(at, landmark_from_pose(pose_, at.offset));
  const Arrival arrival = arrive_at(at);
  ++result_.legs;
  ++legs_;
  if (std::ranges::binary_search(tour_ends_, legs_)) note_tour();
  // Exact methods share nothing out along chains: any loop that closes counts.
  const bool closes =
      arrival.kind == Arrival::Kind::new_route && options_.build.method == Method::gauss_markov;
  if (closes || arrival.kind == Arrival::Kind::first_sight) ++result_.first_sight;
  if (arrival.kind == Arrival::Kind::refinement) ++result_.refinements;
  if (arrival.kind == Arrival::Kind::left_out) result_.off_map.push_back(at.sighting->landmark);
  settle(stop, at, heading);
}

Traversal MappedSession::in_map(const PositionEstimate& place) const {
  const Matrix2& R = options_.to_map;
  return {R * place.position, R * place.covariance * R.transpose()};
}

/// With a compass as reckoned; without, as the best fit has it, and as certain as one that is taken
/// from the landmarks at both ends of the leg.
HeadingEstimate MappedSession::heading_after(const Accepted& at, const PositionEstimate& place) {
  const HeadingEstimate reckoned{pose_.pose.heading, pose_.covariance(2, 2)};
  if (recording_.drive.has_compass() || !options_.guided) {
    return with_yaw(*at.sighting, reckoned);
  }
  const Landmark& from = options_.guide.landmark(*options_.guide.find(reference_->landmark));
  const Landmark& to = options_.guide.landmark(*options_.guide.find(at.sighting->landmark));
  const double heading = drive_.guided_heading(*at.sighting);
  const Vector2 in_map = to.position - from.position;
  if (in_map.squaredNorm() <= 0.0) return {heading, reckoned.variance};
  const double of_traversal = std::max(
      map::direction_variance(place.position, place.covariance) - start_heading_variance_, 0.0);
  const double of_map = map::direction_variance(in_map, *from.covariance + *to.covariance);
  return {heading, map::reset_heading(reckoned, 0.0, of_traversal + of_map).variance};
}

/// Everything from here on is reckoned from this landmark, seen at this stop.
void MappedSession::settle(const drive::Stop& stop, const Accepted& at,
                           const HeadingEstimate& heading) {
  reference_ = at.sighting;
  pose_ = own_axes_ ? PoseEstimate{} : pose_from_landmark(heading, at.offset);
  start_heading_variance_ = heading.variance;
  reference_offset_ = at.offset;
  time_ = stop.t;
  leg_start_ = drive::path_at(recording_.drive, path_, stop.t);
}

/// Numbers of legs after which every route that the recording drives has been driven once more.
std::vector<std::size_t> MappedSession::tour_ends() const {
  using Way = std::pair<std::string, std::string>;
  std::vector<Way> ways;
  const Sighting* last = nullptr;
  double begun = 0.0;
  for (const drive::Stop& stop : drive::stops_of(recording_.sightings)) {
    const std::vector<Accepted> seen = accepted_at(stop);
    if (seen.empty()) continue;
    const Sighting* next = seen.front().sighting;
    const double at = drive::path_at(recording_.drive, path_, stop.t);
    if (last != nullptr) {
      if (next->landmark == last->landmark || at - begun < options_.build.min_drive) continue;
      ways.emplace_back(std::minmax(last->landmark, next->landmark));
    }
    last = next;
    begun = at;
  }
  const std::set<Way> all(ways.begin(), ways.end());
  std::vector<std::size_t> ends;
  std::set<Way> driven;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    driven.insert(ways[k]);
    if (driven.size() < all.size()) continue;
    ends.push_back(k + 1);
    driven.clear();
  }
  return ends;
}

void MappedSession::note_tour() {
  constexpr int kFewest = 3;
  const LandmarkGraph map = builder_.map();
  int known = 0;
  for (const auto& [name, place] : survey_) known += map.find(name) ? 1 : 0;
  if (known < kFewest) return;
  LandmarkPositions truth = survey_;
  for (const std::string& name :
       compare_with_survey(positions_of(map), recording_.survey).contradicting) {
    truth.erase(name);
  }
  result_.tours.push_back({map_errors(map, truth, Laid::aligned), true});
}

/// The paper's averages are plain and its stiffness is that of the mean error: sightings far poorer
/// than traversals would only spoil a route, and a landmark that the robot stands on elsewhere does
/// better without them.
bool MappedSession::dilutes(const std::string& landmark, const Matrix2& covariance) const {
  const bool plain =
      options_.build.method == Method::elastic || options_.build.method == Method::elastic_printed;
  if (plain && options_.stood_on.contains(landmark)) return true;
  const std::optional<int> known = builder_.find(landmark);
  if (!known) return false;
  const std::optional<Route> route = builder_.route_between(builder_.here(), *known);
  return route && covariance.trace() > kMuchPoorer * route->covariance.trace();
}

/// The landmarks that are seen from a stop beside its reference: routes from there.
void MappedSession::observe(const std::vector<Accepted>& others) {
  for (const Accepted& other : others) {
    if (other.sighting->landmark == reference_->landmark) continue;
    if (own_axes_) {
      const Vector2 apart = other.offset.offset_robot - reference_offset_.offset_robot;
      if (apart.squaredNorm() <= 0.0) continue;
      if (!has_map_axes() && !builder_.find(other.sighting->landmark)) continue;
      builder_.observe(other.sighting->landmark, other.offset);
      ++result_.side_sightings;
      continue;
    }
    const PositionEstimate place = landmark_from_pose(pose_, other.offset);
    if (place.position.squaredNorm() <= 0.0) continue;  // two landmarks stood on at once
    if (dilutes(other.sighting->landmark, place.covariance)) continue;
    builder_.observe(other.sighting->landmark, in_map(place));
    ++result_.side_sightings;
  }
}

}  // namespace trussmap::map_building
