// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Wheels that show one half of a motion: they turn the robot and never travel (a mean taken off, a
// forward speed that was left out), or travel and never turn it (one wheel's counts in both
// columns, one speed for both), while something else moves, or turns.
#include "check/findings.hpp"
#include "check/places.hpp"
#include "check/still_limits.hpp"
#include "check/turn_factor.hpp"
#include "statistics/median.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace trussmap::check {
namespace {

constexpr double kHardlyMoves = 0.05;  // of the motion that something else shows, and
constexpr double kHardlyTurns = 0.1;   // of its turns

// ----------------------------------------
// never travel

constexpr double kLeastChord = 1.0;       // m, and
constexpr double kChordWheelbases = 4.0;  // that no antenna beside the axle makes by turning, and
constexpr double kChordNoise = 8.0;       // times the places' noise
constexpr double kLongestChord = 60.0;    // s
constexpr std::size_t kFewestChords = 5;

/// What the wheels lead the robot, forwards or backwards, and turn it, to either side.
struct WheelSums {
  double path = 0.0;    ///< m
  double turn = 0.0;    ///< rad
  double spread = 0.0;  ///< m that one of two wheels goes for it
};

WheelSums wheel_sums(const MotionRows& drive, double wheelbase) {
  WheelSums sums;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    sums.path += drive.way(row);
    sums.turn += std::abs(drive.turn[row]);
  }
  sums.spread = 0.5 * wheelbase * sums.turn;
  return sums;
}

struct Moved {
  std::size_t chords = 0;
  double chord = 0.0;      ///< m, in all
  double by_wheels = 0.0;  ///< m driven over them, in the middle, by the chord
};

Moved moved_by(const PlacesSeen& places, const Checked& checked, const Track& track) {
  const double least =
      std::max({kLeastChord, kChordWheelbases * checked.wheelbase, kChordNoise * places.noise});
  Moved moved;
  std::vector<double> ratios;
  const TimedPlace* before = nullptr;
  for (const TimedPlace& one : places.all) {
    if (before == nullptr || one.t - before->t > kLongestChord) {
      before = &one;
      continue;
    }
    const double chord = (one.at - before->at).norm();
    if (chord < least) continue;
    ratios.push_back((track.way_at(one.t) - track.way_at(before->t)) / chord);
    moved.chord += chord;
    before = &one;
  }
  moved.chords = ratios.size();
  if (!ratios.empty()) moved.by_wheels = statistics::median(std::move(ratios));
  return moved;
}

// ----------------------------------------
// never turn

constexpr double kTurning = 0.3;         // rad, of a stretch
constexpr double kLongestTurning = 4.0;  // s: no bias of a gyro makes as much of it
constexpr std::size_t kFewestTurning = 8;
constexpr std::size_t kFewestRound = 3;

/// Turns that something shows, and what the wheels do in them.
struct Turnings {
  std::size_t count = 0;
  std::size_t on_the_spot = 0;  ///< as unsigned wheels show them
  double shown = 0.0;           ///< rad
  double by_wheels = 0.0;       ///< rad

  [[nodiscard]] bool contradict() const {
    return count >= kFewestTurning && by_wheels < kHardlyTurns * shown && 2 * on_the_spot < count;
  }
};

class TurningStretch {
 public:
  explicit TurningStretch(double wheelbase) : wheelbase_(wheelbase) {}

  void add(double shown, double by_wheels, double ahead, double duration) {
    if (std::abs(shown) > kUntold) return reset();
    shown_ += shown;
    by_wheels_ += by_wheels;
    ahead_ += ahead;
    time_ += duration;
    if (std::abs(shown_) >= kTurning) {
      ++turnings_.count;
      if (looks_unsigned(shown_, by_wheels_, ahead_, wheelbase_)) ++turnings_.on_the_spot;
      turnings_.shown += std::abs(shown_);
      turnings_.by_wheels += std::abs(by_wheels_);
      reset();
    } else if (time_ > kLongestTurning) {
      reset();
    }
  }
  [[nodiscard]] const Turnings& turnings() const { return turnings_; }

 private:
  void reset() { shown_ = by_wheels_ = ahead_ = time_ = 0.0; }

  double wheelbase_;
  double shown_ = 0.0;
  double by_wheels_ = 0.0;
  double ahead_ = 0.0;
  double time_ = 0.0;
  Turnings turnings_;
};

Turnings turnings_of_gyro(const MotionRows& drive, double wheelbase) {
  TurningStretch stretch(wheelbase);
  for (std::size_t row = 0; row < drive.yaw_rate.size(); ++row) {
    if (std::isnan(drive.yaw_rate[row])) continue;
    stretch.add(drive.yaw_rate[row] * drive.duration(row), drive.turn[row], drive.forward[row],
                drive.duration(row));
  }
  return stretch.turnings();
}

Turnings turnings_of_compass(const MotionRows& drive, double wheelbase) {
  TurningStretch stretch(wheelbase);
  double turn = 0.0;
  double ahead = 0.0;
  std::size_t last = drive.rows();
  for (std::size_t row = 0; row < drive.heading.size(); ++row) {
    turn += drive.turn[row];
    ahead += drive.forward[row];
    if (std::isnan(drive.heading[row])) continue;
    if (last < drive.rows()) {
      stretch.add(wrap_angle(drive.heading[row] - drive.heading[last]), turn, ahead,
                  drive.t[row] - drive.t[last]);
    }
    turn = ahead = 0.0;
    last = row;
  }
  return stretch.turnings();
}

/// rad by which the places turn from each to the next but one.
double corners_of(const std::vector<TimedPlace>& places, const CornerPiece& piece) {
  double sum = 0.0;
  for (std::size_t k = piece.first + 2; k < piece.end; ++k) {
    const Vector2 a = places[k - 1].at - places[k - 2].at;
    const Vector2 b = places[k].at - places[k - 1].at;
    if (a.norm() > 0.0 && b.norm() > 0.0) sum += std::abs(wrap_angle(direction(b) - direction(a)));
  }
  return sum;
}

/// Pieces of places that go round corners, while the wheels turn the robot by hardly anything.
bool go_round_without(const PlacesSeen& places, const Checked& checked, const Track& track) {
  const std::vector<TimedPlace> apart = places_apart(places, track);
  const std::vector<CornerPiece> pieces = corner_pieces(apart, track, places.noise);
  if (pieces.size() < kFewestRound) return false;
  const MotionRows& drive = checked.recording.drive;
  double corners = 0.0;
  double turned = 0.0;
  for (const CornerPiece& piece : pieces) {
    corners += corners_of(apart, piece);
    const double from = apart[piece.first].t;
    const double to = apart[piece.end - 1].t;
    auto row = static_cast<std::size_t>(std::upper_bound(drive.t.begin(), drive.t.end(), from) -
                                        drive.t.begin());
    for (; row < drive.rows() && drive.t[row] <= to; ++row) {
      turned += std::abs(drive.turn[row]);
    }
  }
  return turned < kHardlyTurns * corners;
}

Turnings turnings_of_truth(const DrivenRecording& recording, double wheelbase, const Track& track) {
  TurningStretch stretch(wheelbase);
  const TruthRow* last = nullptr;
  for (const TruthRow& one : recording.truth) {
    if (one.t < recording.drive.start() || one.t > recording.drive.t.back()) continue;
    if (last != nullptr) {
      const double turn = track.at(one.t).heading - track.at(last->t).heading;
      stretch.add(wrap_angle(one.heading - last->heading), turn,
                  track.way_at(one.t) - track.way_at(last->t), one.t - last->t);
    }
    last = &one;
  }
  return stretch.turnings();
}

/// In every row both wheels travel the same, to the last digits.
bool never_differ(const MotionRows& drive, double wheelbase) {
  constexpr double kRounding = 1e-6;  // of the travel
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double apart = wheelbase * std::abs(drive.turn[row]);
    if (apart > kRounding * std::abs(drive.forward[row])) return false;
  }
  return true;
}

std::string and_others(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k) {
    text += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + names[k];
  }
  return text;
}

}  // namespace

void check_no_travel(Checked& checked, const Track& track) {
  const MotionRows& drive = checked.recording.drive;
  const WheelSums sums = wheel_sums(drive, checked.wheelbase);
  if (checked.wheels_wrong() || sums.path > kHardlyMoves * sums.spread) return;
  for (const PlacesSeen& places :
       {places_by_stops(checked.recording), places_by_fixes(checked.recording),
        places_by_ranges(checked.recording), places_by_truth(checked.recording)}) {
    const Moved moved = moved_by(places, checked, track);
    if (moved.chords < kFewestChords || moved.by_wheels > kHardlyMoves) continue;
    checked.add("drive.csv", wheel_columns(drive), "no travel",
                text::joined("the wheels turn the robot by ", figure(sums.turn, "rad"),
                             " in all and never travel (", figure(sums.path, "m"),
                             "), while it moves ", figure(moved.chord, "m"), " by ", places.name),
                "look where the travels come from: the forward speed, or what both wheels have in "
                "common, was left out");
    return;
  }
}

void check_no_turning(Checked& checked, const Track& track) {
  constexpr double kNoise = 0.03;  // of the way, by which travels that are meant to be alike differ
  const MotionRows& drive = checked.recording.drive;
  const WheelSums sums = wheel_sums(drive, checked.wheelbase);
  if (checked.wheels_wrong() || !drive.wheels.empty() || sums.spread > kNoise * sums.path) return;
  std::vector<std::string> turning;
  const auto take = [&](const char* name, const Turnings& one) {
    if (one.contradict()) turning.emplace_back(name);
  };
  if (!checked.wrong.contains("yaw_rate")) {
    take("the gyro", turnings_of_gyro(drive, checked.wheelbase));
  }
  if (!checked.wrong.contains("heading")) {
    take("the compass", turnings_of_compass(drive, checked.wheelbase));
  }
  take("the truth", turnings_of_truth(checked.recording, checked.wheelbase, track));
  // By places alone turns on the spot without signs look the same.
  const bool same = never_differ(drive, checked.wheelbase);
  if (same || !turning.empty()) {
    for (const PlacesSeen& places :
         {places_by_stops(checked.recording), places_by_fixes(checked.recording),
          places_by_ranges(checked.recording)}) {
      if (go_round_without(places, checked, track)) turning.emplace_back(places.name);
    }
  }
  if (turning.empty()) return;
  const std::string wheels = same ? std::string(": left and right are the same in every row")
                                  : text::joined(" (", figure(sums.turn, "rad"), " in all)");
  checked.add("drive.csv", wheel_columns(drive), "no turning",
              text::joined("the wheels show no turning", wheels, ", while the robot turns by ",
                           and_others(turning)),
              "look where the travels come from: one wheel's counts in both columns, or one speed "
              "for both");
}

}  // namespace trussmap::check
