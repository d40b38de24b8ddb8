// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Surveyed points that lie elsewhere: legs to and from them are not what was driven or seen, laid
// over the survey by the legs before and after, and in its scale where that suits more of them. The
// landmark with most such legs is taken out, until the others agree.
#include "check/findings.hpp"
#include "check/survey_legs.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace trussmap::check {
namespace {

constexpr double kOff = 0.5;        // m, and
constexpr double kOffShare = 0.25;  // of the leg
constexpr std::size_t kFewestLegs = 10;
constexpr int kFewestWrong = 2;       // legs of a landmark
constexpr double kMostly = 0.6;       // of a landmark's legs
constexpr double kHardlyAny = 0.05;   // of all others
constexpr double kMostPoints = 0.25;  // of the landmarks

enum class By { vector, length };

bool is_wrong(const Vector2& measured, const Vector2& surveyed, By by) {
  const double off =
      by == By::vector ? (surveyed - measured).norm() : std::abs(surveyed.norm() - measured.norm());
  return off > std::max(kOff, kOffShare * measured.norm());
}

/// The angle from which the others lie least far, in sum.
double median_angle(const std::vector<double>& angles) {
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const double one : angles) {
    double sum = 0.0;
    for (const double other : angles) sum += std::abs(wrap_angle(one - other));
    if (sum >= least) continue;
    least = sum;
    best = one;
  }
  return best;
}

/// Turned as most of the legs about each are, so many before and after: the track's heading drifts.
std::vector<SurveyLeg> turned_onto_survey(const std::vector<SurveyLeg>& legs, std::size_t about) {
  std::vector<SurveyLeg> result = legs;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    std::vector<double> angles;
    const std::size_t first = k > about ? k - about : 0;
    for (std::size_t other = first; other < std::min(legs.size(), k + about + 1); ++other) {
      const SurveyLeg& leg = legs[other];
      if (other == k || leg.measured.norm() < kOff || leg.surveyed.norm() < kOff) continue;
      angles.push_back(direction(leg.surveyed) - direction(leg.measured));
    }
    result[k].measured = rotation(median_angle(angles)) * legs[k].measured;
  }
  return result;
}

struct Count {
  int all = 0;
  int wrong = 0;
};

bool touches(const SurveyLeg& leg, std::string_view name) {
  return leg.from == name || leg.to == name;
}

int wrong_of(const std::vector<SurveyLeg>& legs, By by) {
  return static_cast<int>(std::count_if(legs.begin(), legs.end(), [by](const SurveyLeg& leg) {
    return is_wrong(leg.measured, leg.surveyed, by);
  }));
}

std::map<std::string_view, Count> counts_of(const std::vector<SurveyLeg>& legs, By by) {
  std::map<std::string_view, Count> counts;
  for (const SurveyLeg& leg : legs) {
    const int wrong = is_wrong(leg.measured, leg.surveyed, by) ? 1 : 0;
    for (const std::string_view name : {leg.from, leg.to}) {
      ++counts[name].all;
      counts[name].wrong += wrong;
    }
  }
  return counts;
}

bool are_right(const std::vector<SurveyLeg>& legs, By by) {
  return wrong_of(legs, by) <= kHardlyAny * static_cast<double>(legs.size());
}

/// Of so many: where few are left, they agree with whatever is true of them.
std::size_t most_points(std::size_t landmarks) {
  constexpr std::size_t kHandful = 8;
  const auto share = static_cast<std::size_t>(kMostPoints * static_cast<double>(landmarks));
  return landmarks < kHandful ? std::size_t{1} : std::max<std::size_t>(2, share);
}

/// Of the legs as driven and in the survey's scale, those that fewer are wrong of.
std::vector<SurveyLeg> in_better_scale(std::vector<SurveyLeg> legs, double ratio) {
  constexpr double kFar = 3.0;  // factor: no wheel's
  if (!(ratio > 0.0) || std::abs(std::log(ratio)) > std::log(kFar)) return legs;
  std::vector<SurveyLeg> scaled = legs;
  for (SurveyLeg& one : scaled) one.measured *= ratio;
  return wrong_of(scaled, By::vector) < wrong_of(legs, By::vector) ? scaled : legs;
}

/// Nothing where they do not explain what is wrong.
std::vector<std::string_view> wrong_points(std::vector<SurveyLeg> legs, std::size_t landmarks,
                                           By by) {
  std::vector<std::string_view> points;
  while (true) {
    const std::map<std::string_view, Count> counts = counts_of(legs, by);
    if (are_right(legs, by)) return points;
    const auto worst = std::max_element(
        counts.begin(), counts.end(),
        [](const auto& a, const auto& b) { return a.second.wrong < b.second.wrong; });
    const Count& most = worst->second;
    const bool explains = most.wrong >= kFewestWrong && most.wrong >= kMostly * most.all;
    if (!explains || points.size() + 1 > most_points(landmarks)) return {};
    points.push_back(worst->first);
    std::erase_if(legs, [&](const SurveyLeg& leg) { return touches(leg, points.back()); });
  }
}

/// How many legs are wrong once two points have each other's place.
int wrong_once_exchanged(const std::vector<SurveyLeg>& legs, const SurveyPlaces& places,
                         std::string_view a, std::string_view b, By by) {
  const auto place = [&](std::string_view name) {
    return places.at(name == a ? b : name == b ? a : name);
  };
  return static_cast<int>(std::count_if(legs.begin(), legs.end(), [&](const SurveyLeg& leg) {
    return is_wrong(leg.measured, place(leg.to) - place(leg.from), by);
  }));
}

/// Two points that explain what is wrong by having each other's place.
std::vector<std::string_view> exchanged_points(const std::vector<SurveyLeg>& legs,
                                               const SurveyPlaces& places, By by) {
  constexpr std::size_t kMostSuspects = 12;
  constexpr double kHalf = 0.5;  // of a landmark's legs
  std::map<std::string_view, Count> counts = counts_of(legs, by);
  std::vector<std::pair<int, std::string_view>> suspects;
  for (const auto& [name, count] : counts) {
    if (count.wrong < kFewestWrong || count.wrong < kHalf * count.all) continue;
    suspects.emplace_back(-count.wrong, name);
  }
  std::sort(suspects.begin(), suspects.end());
  if (suspects.size() > kMostSuspects) suspects.resize(kMostSuspects);
  const auto most = static_cast<int>(kHardlyAny * static_cast<double>(legs.size()));
  int least = most + 1;
  std::vector<std::string_view> best;
  for (std::size_t i = 0; i < suspects.size(); ++i) {
    for (std::size_t j = i + 1; j < suspects.size(); ++j) {
      const std::string_view a = suspects[i].second;
      const std::string_view b = suspects[j].second;
      const int wrong = wrong_once_exchanged(legs, places, a, b, by);
      if (wrong >= least) continue;
      least = wrong;
      best = {a, b};
    }
  }
  return best;
}

}  // namespace

void check_survey_points(Checked& checked, const SurveyAgreement& agreement) {
  const SurveyPlaces places = surveyed_places(checked.recording);
  const bool driven = agreement.way.size() >= kFewestLegs;
  std::vector<SurveyLeg> legs = driven ? agreement.way : agreement.views;
  if (legs.size() < kFewestLegs) return;
  // Of three wheels about a centre a large one turns the robot all the time.
  constexpr std::size_t kAbout = 12;
  constexpr std::size_t kAboutOthers = 4;
  legs = turned_onto_survey(legs, checked.recording.drive.wheels.empty() ? kAbout : kAboutOthers);
  legs = in_better_scale(std::move(legs), driven ? agreement.way_ratio : agreement.views_ratio);
  const std::string legs_words = text::joined(" are not what was ", driven ? "driven" : "seen");
  for (const By by : {By::vector, By::length}) {
    if (are_right(legs, by)) continue;
    const std::vector<std::string_view> two = exchanged_points(legs, places, by);
    if (!two.empty()) {
      checked.add("survey.csv", "landmark", "labels exchanged",
                  text::joined("legs of ", two[0], " and ", two[1], legs_words,
                               ", and are once the two are exchanged"),
                  "exchange the two labels, in survey.csv or in sightings.csv");
      return;
    }
    const std::vector<std::string_view> points = wrong_points(legs, places.size(), by);
    for (const std::string_view name : points) {
      checked.add("survey.csv", "x,y", "survey point off",
                  text::joined("legs of landmark ", name, legs_words, ", those of the others are"),
                  "survey it again, or remove it from the file");
    }
    if (!points.empty()) return;
  }
}

}  // namespace trussmap::check
