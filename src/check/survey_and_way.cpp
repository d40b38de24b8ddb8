// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// From landmark to landmark by the survey, against the way between two stops (in the wheels' own
// axes) and against views of both at one time (in the robot's). Lengths tell a unit; what matters
// of the directions is how they change from one to the next, alike or mirrored.
#include "check/findings.hpp"
#include "check/places.hpp"
#include "check/survey_legs.hpp"
#include "check/turn_factor.hpp"
#include "geometry/units.hpp"
#include "statistics/median.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <Eigen/Eigenvalues>

namespace trussmap::check {
namespace {

constexpr double kLeastLength = 0.3;     // m
constexpr double kLeastMeasured = 0.01;  // m, for a ratio
constexpr double kFarOff = 2.5;          // factor that is no wheel's, nor a range's
constexpr std::size_t kFewestPlaces = 6;
constexpr double kAlike = 0.4;  // rad, median

double ratio_of(const std::vector<SurveyLeg>& legs) {
  std::vector<double> ratios;
  for (const SurveyLeg& leg : legs) {
    const double measured = leg.measured.norm();
    if (measured > kLeastMeasured) ratios.push_back(leg.surveyed.norm() / measured);
  }
  return ratios.size() < kFewestPlaces ? 0.0 : statistics::median(std::move(ratios));
}

struct Sign {
  int value = 0;
  bool contradicts = false;
  bool straight = false;  ///< no corner where the survey has them
};

/// 1, -1, or 0 where neither holds, which contradicts, or too few tell.
Sign sign_of(const std::vector<SurveyLeg>& legs, double ratio) {
  std::vector<double> alike;
  std::vector<double> mirrored;
  std::vector<double> corners;
  for (std::size_t k = 1; k < legs.size(); ++k) {
    const SurveyLeg& a = legs[k - 1];
    const SurveyLeg& b = legs[k];
    const double least = kLeastLength * std::max(ratio, 1e-9);
    if (a.surveyed.norm() < least || b.surveyed.norm() < least) continue;
    if (a.measured.norm() < kLeastLength || b.measured.norm() < kLeastLength) continue;
    const double measured = direction(b.measured) - direction(a.measured);
    const double surveyed = direction(b.surveyed) - direction(a.surveyed);
    if (std::abs(std::sin(surveyed)) < 0.3) continue;  // straight on: mirrored alike
    corners.push_back(std::abs(wrap_angle(measured)));
    alike.push_back(std::abs(wrap_angle(measured - surveyed)));
    mirrored.push_back(std::abs(wrap_angle(measured + surveyed)));
  }
  if (alike.size() < kFewestPlaces) return {};
  const double as_is = statistics::median(std::move(alike));
  const double as_mirrored = statistics::median(std::move(mirrored));
  if (as_is < kAlike && as_is < 0.5 * as_mirrored) return {1};
  if (as_mirrored < kAlike && as_mirrored < 0.5 * as_is) return {-1};
  constexpr double kStraight = 0.45;  // rad, what arcs on the way come to
  return {0, std::min(as_is, as_mirrored) > kAlike,
          statistics::median(std::move(corners)) < kStraight};
}

/// The compass's reading less the track's heading where a leg ends.
void check_compass_frame(Checked& checked, const Track& track, const std::vector<SurveyLeg>& legs) {
  const MotionRows& drive = checked.recording.drive;
  MeanAngle offset;
  for (const SurveyLeg& leg : legs) {
    const auto row = static_cast<std::size_t>(
        std::lower_bound(drive.t.begin(), drive.t.end(), leg.t) - drive.t.begin());
    if (row == drive.rows() || std::isnan(drive.heading[row])) continue;
    if (leg.measured.norm() < kLeastLength || leg.surveyed.norm() < kLeastLength) continue;
    const double turned = drive.heading[row] - track.at(drive.t[row]).heading;
    offset.add(direction(leg.measured) + turned - direction(leg.surveyed));
  }
  if (!offset.is_clear() || std::abs(offset.angle()) < kCompassTurned) return;
  checked.add("drive.csv", "heading", "compass turned",
              text::joined("the compass reads ", figure(offset.angle() * geometry::kDegrees),
                           " degrees more than directions in the survey have"),
              "let readings count from the survey's x axis, not from north");
}

struct Spread {
  Vector2 mean = Vector2::Zero();
  double wide = 0.0;  ///< m, root mean square along and across
  double thin = 0.0;
};

Spread spread_of(const std::vector<Vector2>& points) {
  Spread result;
  const auto count = static_cast<double>(points.size());
  for (const Vector2& point : points) result.mean += point / count;
  Matrix2 squares = Matrix2::Zero();
  for (const Vector2& point : points) {
    squares += (point - result.mean) * (point - result.mean).transpose() / count;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix2> axes(squares);
  result.wide = std::sqrt(std::max(axes.eigenvalues()[1], 0.0));
  result.thin = std::sqrt(std::max(axes.eigenvalues()[0], 0.0));
  return result;
}

/// Whether landmarks were found all about, and not in a corridor.
bool is_spread(const Checked& checked, const Track& track) {
  constexpr double kCorridor = 0.2;
  std::vector<Vector2> found;
  for (const Sighting& one : checked.recording.sightings) {
    if (!tells_place(one)) continue;
    found.push_back(place_seen(one, track.at(one.t), checked.angle_unit));
  }
  if (found.size() < 3) return false;
  const Spread spread = spread_of(found);
  return spread.thin > kCorridor * spread.wide;
}

/// Points on a line, or on one another, give a map no frame.
void check_spread(Checked& checked, const Track& track, const SurveyPlaces& places) {
  std::vector<Vector2> points;
  points.reserve(places.size());
  for (const auto& [name, place] : places) points.push_back(place);
  if (points.size() < 3) return;
  constexpr double kThin = 1e-3;
  const auto [mean, wide, thin] = spread_of(points);
  if (wide <= 1e-9 * (1.0 + mean.norm())) {
    checked.add("survey.csv", "x,y", "survey at one point",
                text::joined("all ", points.size(), " landmarks lie at (", figure(mean.x()), ", ",
                             figure(mean.y()), ")"),
                "survey them one by one, or leave the file out");
  } else if (thin < kThin * wide && is_spread(checked, track)) {
    checked.add("survey.csv", "x,y", "survey on a line",
                text::joined("all ", points.size(), " landmarks lie within ", figure(thin, "m"),
                             " of a line of ", figure(wide, "m"),
                             " (root mean squares); they were found all about"),
                "look for a column that was written twice, or lost");
  }
}

void check_units(Checked& checked, const SurveyAgreement& agreement) {
  const double by_way = agreement.contradicts ? 0.0 : agreement.way_ratio;
  const double by_views = checked.wrong.contains("range") ? 0.0 : agreement.views_ratio;
  const auto off = [](double ratio) { return ratio > 0.0 && looks_like_a_unit(ratio); };
  if (!off(by_way) && !off(by_views)) return;
  // Where only one of the two is off, it is that one which is wrong.
  const bool survey = (off(by_way) || by_way == 0.0) && (off(by_views) || by_views == 0.0);
  const double ratio = off(by_way) ? by_way : by_views;
  const std::string unit = unit_of_ratio(survey ? ratio : 1.0 / ratio);
  const std::string evidence =
      text::joined("from landmark to landmark the survey is ", figure(ratio), " times as long as ",
                   off(by_way) ? "the way driven" : "what is seen", " (median)",
                   unit.empty() ? "" : ": as if in " + unit);
  if (survey) {
    checked.add("survey.csv", "x,y", "survey unit", evidence, "convert the survey to metres");
  } else if (off(by_way)) {
    checked.add("drive.csv", wheel_columns(checked.recording.drive), "travel unit", evidence,
                "convert travels to metres");
  } else {
    checked.add("sightings.csv", "range", "range unit", evidence, "convert ranges to metres");
  }
}

/// Whatever the wheels' scale and the size of their turns.
int sign_of_places(const Checked& checked, const Track& track, const PlacesSeen& places) {
  return turn_sign(checked.recording.drive, track, places);
}

}  // namespace

SurveyAgreement survey_agreement(const Checked& checked, const Track& track) {
  const DrivenRecording& recording = checked.recording;
  SurveyAgreement result;
  if (recording.survey.empty() || recording.sightings.empty()) return result;
  const SurveyPlaces places = surveyed_places(recording);
  result.way = legs_by_way(recording, places, track);
  result.way_ratio = ratio_of(result.way);
  if (result.way_ratio > 0.0) {
    const Sign sign = sign_of(result.way, result.way_ratio);
    result.by_way = sign.value;
    result.unsigned_wheels = sign.contradicts && sign.straight;
    const bool far = std::abs(std::log(result.way_ratio)) > std::log(kFarOff);
    result.contradicts =
        sign.contradicts || (sign.value == 0 && far && !looks_like_a_unit(result.way_ratio));
  }
  result.views = legs_by_views(recording, places, track, checked.angle_unit);
  result.views_ratio = ratio_of(result.views);
  if (result.views_ratio > 0.0) {
    result.by_views = sign_of(result.views, result.views_ratio).value;
  }
  return result;
}

void settle_by_places(const Checked& checked, const Track& track, SurveyAgreement& agreement) {
  if (agreement.by_way != 0 || checked.wrong.contains("x")) return;
  agreement.by_way = sign_of_places(checked, track, places_by_stops(checked.recording));
  if (agreement.by_way != 0) agreement.contradicts = agreement.unsigned_wheels = false;
}

int sign_of_fixes(const Checked& checked, const Track& track) {
  if (checked.wrong.contains("fix x")) return 0;
  const std::vector<SurveyLeg> legs = legs_by_fixes(checked.recording, track);
  const double ratio = ratio_of(legs);
  const int sign = ratio > 0.0 ? sign_of(legs, ratio).value : 0;
  return sign != 0 ? sign : sign_of_places(checked, track, places_by_fixes(checked.recording));
}

int sign_of_ranges(const Checked& checked, const Track& track) {
  if (checked.wrong.contains("x") || checked.wrong.contains("range")) return 0;
  return sign_of_places(checked, track, places_by_ranges(checked.recording));
}

void check_survey(Checked& checked, const Track& track, const SurveyAgreement& agreement,
                  bool compass) {
  const DrivenRecording& recording = checked.recording;
  if (recording.survey.empty() || recording.sightings.empty()) return;
  const std::set<std::string_view> sighted = sighted_landmarks(recording);
  const SurveyPlaces places = surveyed_places(recording);
  if (places.size() < 2 && sighted.size() > 1 && recording.survey.size() > 1) {
    checked.add(
        "survey.csv", "landmark", "other landmarks",
        text::joined("of ", recording.survey.size(), " landmarks surveyed and ", sighted.size(),
                     " sighted ", places.size(), places.size() == 1 ? " is" : " are",
                     " the same, by name: ", recording.survey.front().landmark, ", ... against ",
                     *sighted.begin(), ", ..."),
        "give both files the same names");
    return;
  }
  check_spread(checked, track, places);
  if (checked.wrong.contains("x") || checked.wrong.contains("t")) return;
  check_units(checked, agreement);
  if (!compass || checked.wrong.contains("x") || checked.wrong.contains("left")) return;
  if (agreement.by_way > 0) {
    check_compass_frame(checked, track, agreement.way);
  } else if (agreement.by_views > 0) {
    check_compass_frame(checked, track, agreement.views);
  }
}

}  // namespace trussmap::check
