// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/survey_legs.hpp"

#include "check/findings.hpp"
#include "statistics/thinned.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::check {
namespace {

constexpr double kFarthest = 40.0;  // m between two stops
constexpr std::size_t kMost = 400;  // that cost next to nothing

}  // namespace

std::set<std::string_view> sighted_landmarks(const DrivenRecording& recording) {
  std::set<std::string_view> names;
  for (const Sighting& one : recording.sightings) names.insert(one.landmark);
  return names;
}

SurveyPlaces surveyed_places(const DrivenRecording& recording) {
  const std::set<std::string_view> sighted = sighted_landmarks(recording);
  SurveyPlaces places;
  for (const SurveyPoint& one : recording.survey) {
    if (sighted.contains(one.landmark)) places[one.landmark] = {one.x, one.y};
  }
  return places;
}

std::vector<SurveyLeg> legs_by_way(const DrivenRecording& recording, const SurveyPlaces& places,
                                   const Track& track) {
  std::vector<SurveyLeg> legs;
  const Sighting* before = nullptr;
  for (const Sighting& one : recording.sightings) {
    if (!one.standing() || !places.contains(one.landmark)) continue;
    if (before != nullptr && before->landmark != one.landmark &&
        track.way_at(one.t) - track.way_at(before->t) < kFarthest) {
      legs.push_back({before->landmark, one.landmark,
                      track.at(one.t).position() - track.at(before->t).position(),
                      places.at(one.landmark) - places.at(before->landmark), one.t});
    }
    before = &one;
  }
  return statistics::thinned(std::move(legs), kMost);
}

std::vector<SurveyLeg> legs_by_views(const DrivenRecording& recording, const SurveyPlaces& places,
                                     const Track& track, double bearing_unit) {
  std::vector<SurveyLeg> legs;
  const Sighting* before = nullptr;
  for (const Sighting& one : recording.sightings) {
    if (one.standing() || !one.locates() || !places.contains(one.landmark)) continue;
    if (before != nullptr && before->t == one.t && before->landmark != one.landmark) {
      const Pose pose = track.at(one.t);
      legs.push_back({before->landmark, one.landmark,
                      place_seen(one, pose, bearing_unit) - place_seen(*before, pose, bearing_unit),
                      places.at(one.landmark) - places.at(before->landmark), one.t});
    }
    before = &one;
  }
  return statistics::thinned(std::move(legs), kMost);
}

std::vector<SurveyLeg> legs_by_fixes(const DrivenRecording& recording, const Track& track) {
  constexpr double kLeg = 5.0;       // m: corners are told in spite of a GNSS receiver's errors
  constexpr double kLongest = 60.0;  // s
  std::vector<SurveyLeg> legs;
  const Fix* before = nullptr;
  for (const Fix& one : recording.fixes) {
    if (one.t < recording.drive.start() || one.t > recording.drive.t.back()) continue;
    if (before == nullptr || one.t - before->t > kLongest) {
      before = &one;
      continue;
    }
    const double apart = std::hypot(one.x - before->x, one.y - before->y);
    if (std::max(track.way_at(one.t) - track.way_at(before->t), apart) < kLeg) continue;
    legs.push_back({{},
                    {},
                    track.at(one.t).position() - track.at(before->t).position(),
                    Vector2(one.x - before->x, one.y - before->y),
                    one.t});
    before = &one;
  }
  return legs;
}

}  // namespace trussmap::check
