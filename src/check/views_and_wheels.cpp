// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A landmark seen twice, and the wheels' way in between: from the first view and the way follows
// where it has to be seen the second time.
//
//   first view p, way (d, a)   predicted R(-a) (p - d)    against the second view, by the size of
//                                                         the shift: 0 agrees, 1 tells nothing
//
// Units and mistakes are tried where they disagree. A mirrored robot sees a mirrored world:
// exchanged wheels and clockwise bearings cannot be told apart here.
#include "check/findings.hpp"
#include "geometry/units.hpp"
#include "recording/floor_code.hpp"
#include "statistics/median.hpp"
#include "statistics/thinned.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace trussmap::check {
namespace {

constexpr double kLongestView = 30.0;   // s
constexpr double kFarthestView = 12.0;  // m
constexpr double kLeastWay = 0.3;       // m, or
constexpr double kLeastTurn = 0.5;      // rad
constexpr std::size_t kMostPairs = 300;
constexpr std::size_t kFewestPairs = 8;
constexpr double kAgrees = 0.45;  // median error by the size of the shift
constexpr double kShiftFits = 0.3;
constexpr double kShiftBetter = 0.5;  // of the error as recorded

struct Pair {
  const Sighting* first = nullptr;
  const Sighting* second = nullptr;
};

bool is_view(const Sighting& one) {
  return std::isfinite(one.range) && std::isfinite(one.bearing);
}

std::vector<Pair> pairs_of(const DrivenRecording& recording, const Track& track,
                           double from = -HUGE_VAL, double to = HUGE_VAL) {
  std::map<std::string_view, const Sighting*> last;
  std::vector<Pair> pairs;
  for (const Sighting& one : recording.sightings) {
    if (!is_view(one) || one.t < from || one.t > to) continue;
    const Sighting*& before = last[one.landmark];
    if (before != nullptr && one.t - before->t <= kLongestView) {
      const double way = track.way_at(one.t) - track.way_at(before->t);
      const double turn = track.at(one.t).heading - track.at(before->t).heading;
      if (way < kLeastWay && std::abs(turn) < kLeastTurn) continue;
      if (way <= kFarthestView) pairs.push_back({before, &one});
    }
    before = &one;
  }
  return statistics::thinned(std::move(pairs), kMostPairs);
}

/// Those between which the robot turns: of the others a mirrored world looks the same.
std::vector<Pair> turning(const std::vector<Pair>& pairs, const Track& track) {
  constexpr double kTurns = 0.3;  // rad
  std::vector<Pair> result;
  for (const Pair& one : pairs) {
    const double turn = track.at(one.second->t).heading - track.at(one.first->t).heading;
    if (std::abs(turn) > kTurns) result.push_back(one);
  }
  return result;
}

struct Reading {
  double range_unit = 1.0;    ///< m
  double bearing_unit = 1.0;  ///< rad; negative: clockwise
};

Vector2 seen(const Sighting& one, const Reading& unit) {
  return unit.range_unit * one.range * rotation(unit.bearing_unit * one.bearing).col(0);
}

/// Those between which the robot turns by what it sees, whatever the track says of turns.
std::vector<Pair> seen_turning(const std::vector<Pair>& pairs, const Track& track,
                               const Reading& unit) {
  constexpr double kTurns = 0.3;    // rad
  constexpr double kNearest = 1.0;  // m: no errors of ranges look like turns
  std::vector<Pair> result;
  for (const Pair& pair : pairs) {
    const Pose way = relative(track.at(pair.first->t), track.at(pair.second->t));
    const Vector2 first = seen(*pair.first, unit) - way.position();
    const Vector2 second = seen(*pair.second, unit);
    if (first.norm() < kNearest || second.norm() < kNearest) continue;
    if (std::abs(wrap_angle(direction(first) - direction(second))) > kTurns) result.push_back(pair);
  }
  return result;
}

double disagreement(const std::vector<Pair>& pairs, const Track& track, const Reading& unit) {
  std::vector<double> errors;
  for (const Pair& pair : pairs) {
    const Pose way = relative(track.at(pair.first->t), track.at(pair.second->t));
    const Vector2 first = seen(*pair.first, unit);
    const Vector2 second = seen(*pair.second, unit);
    const Vector2 predicted = rotation(-way.heading) * (first - way.position());
    const double turned =
        2.0 * std::abs(std::sin(0.5 * way.heading)) * 0.5 * (first.norm() + second.norm());
    const double shift = std::max({(predicted - first).norm(), way.position().norm(), turned});
    errors.push_back((predicted - second).norm() / std::max(shift, 1e-6));
  }
  return statistics::median(std::move(errors));
}

/// What the views would be explained by.
struct Explained {
  double error;
  WheelMistake wheels = WheelMistake::none;
  Reading unit;
};

/// Of mistakes at the wheels and units of ranges; `best`: as recorded.
Explained best_explanation(const Checked& checked, const std::vector<Pair>& pairs, Explained best) {
  const MotionRows& drive = checked.recording.drive;
  std::vector<WheelMistake> mistakes{WheelMistake::none, WheelMistake::exchanged};
  if (drive.of_two_wheels()) {  // of others, check_other_drive knows more
    mistakes.insert(mistakes.end(), {WheelMistake::negated, WheelMistake::left_negated,
                                     WheelMistake::right_negated});
  }
  for (const WheelMistake wheels : mistakes) {
    const Track other(drive, wheels, checked.wheelbase);
    for (const double range : {1.0, 0.01, 0.001, 0.3048, 0.0254}) {
      const Reading unit{range, checked.angle_unit};
      const double error = disagreement(pairs, other, unit);
      if (error < best.error) best = {error, wheels, unit};
    }
  }
  return best;
}

/// Returns the sign of turns that follows, 0: none.
int say_explanation(Checked& checked, const Explained& best, const std::string& evidence) {
  if (best.unit.range_unit != 1.0) {
    const std::string unit = unit_of_ratio(1.0 / best.unit.range_unit);
    checked.add("sightings.csv", "range", "range unit", evidence + "with ranges in " + unit,
                "convert the ranges to metres");
  }
  switch (best.wheels) {
    case WheelMistake::none:
      return 1;
    case WheelMistake::exchanged:
      return -1;
    case WheelMistake::negated:
      checked.add("drive.csv", "left,right", "wheels negated",
                  evidence + "with both wheels' signs changed",
                  "change the sign of left and right");
      break;
    case WheelMistake::left_negated:
    case WheelMistake::right_negated:
      add_lone_wheel(checked, best.wheels,
                     evidence + "with the " + lone_wheel(best.wheels) + " wheel's sign changed");
      break;
  }
  return 0;
}

}  // namespace

bool tells_place(const Sighting& sighting) {
  return sighting.standing() || is_view(sighting);
}

Vector2 place_seen(const Sighting& sighting, const Pose& from, double bearing_unit) {
  if (sighting.standing()) {
    return from.position() + rotation(from.heading) * recording::code_from_robot(sighting);
  }
  return from.position() +
         sighting.range * rotation(from.heading + bearing_unit * sighting.bearing).col(0);
}

void check_bearing_unit(Checked& checked) {
  std::vector<double> sizes;
  for (const Sighting& one : checked.recording.sightings) {
    if (std::isfinite(one.bearing)) sizes.push_back(std::abs(one.bearing));
  }
  if (sizes.empty()) return;
  const auto beyond = std::count_if(
      sizes.begin(), sizes.end(), [](double size) { return size > 2.0 * std::numbers::pi + 0.1; });
  if (5 * beyond < std::ssize(sizes)) return;
  checked.angle_unit = geometry::kDegree;
  checked.add(
      "sightings.csv", "bearing", "angle unit",
      text::joined(beyond, " of ", sizes.size(), " bearings are beyond a whole turn in radians (",
                   figure(*std::max_element(sizes.begin(), sizes.end())),
                   "): they look like degrees"),
      "convert them to radians");
}

std::optional<double> views_misfit(const DrivenRecording& recording, const Track& track,
                                   double range_unit, double bearing_unit, double from, double to) {
  const std::vector<Pair> pairs = pairs_of(recording, track, from, to);
  if (pairs.size() < kFewestPairs) return std::nullopt;
  const Reading unit{range_unit, bearing_unit};
  constexpr std::size_t kSome = 10;  // one in so many
  double worst = disagreement(pairs, track, unit);
  for (const std::vector<Pair>& turns : {turning(pairs, track), seen_turning(pairs, track, unit)}) {
    if (turns.size() < std::max(kFewestPairs, pairs.size() / kSome)) continue;
    worst = std::max(worst, disagreement(turns, track, unit));
  }
  return std::min(worst, 1.0);
}

TurnAgreement check_views(Checked& checked, const Track& track) {
  TurnAgreement result;
  if (checked.wrong.contains("left") || checked.wrong.contains("t")) return result;
  std::vector<Pair> pairs = pairs_of(checked.recording, track);
  result.turns = static_cast<int>(pairs.size());
  if (pairs.size() < kFewestPairs) return result;
  const Reading stated{1.0, checked.angle_unit};
  double recorded = disagreement(pairs, track, stated);
  if (recorded < kAgrees) {
    std::vector<Pair> turns = turning(pairs, track);
    const double turned = turns.size() < kFewestPairs ? 0.0 : disagreement(turns, track, stated);
    if (turned < kAgrees) {
      result.sign = 1;
      return result;
    }
    pairs = std::move(turns);
    recorded = turned;
  }
  const Explained best = best_explanation(checked, pairs, {recorded, WheelMistake::none, stated});
  if (best.error > kShiftFits || best.error > kShiftBetter * recorded) return result;
  const std::string evidence =
      text::joined("of ", pairs.size(), " landmarks seen again the wheels lead ",
                   text::fixed_text(100.0 * recorded, 0), " % of the shift astray (median), and ",
                   text::fixed_text(100.0 * best.error, 0), " % ");
  result.sign = say_explanation(checked, best, evidence);
  return result;
}

}  // namespace trussmap::check
