// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Turns of the compass against the wheels', in stretches in which two wheels have come apart by a
// tenth of a metre, other drives have turned by a third of a radian. Where the wheelbase is not
// known it is the one taken, over the slope.
#include "check/findings.hpp"
#include "text/number_text.hpp"

#include <cmath>
#include <numbers>

namespace trussmap::check {
namespace {

constexpr double kTurningTravel = 0.1;  // m of difference
constexpr double kTellingTurn = 0.3;    // rad, where the wheelbase is known
constexpr double kLongestTurn = 10.0;   // s
constexpr int kFewestTurns = 12;        // stretches
constexpr double kClearTurns = 0.8;     // correlation
constexpr double kUnclear = 0.6;

double wrapped(double angle, double turn) {
  return std::remainder(angle, turn);
}

/// Readings in units of which `turn` are a whole turn, brought within half of one or going on.
TurnAgreement turns_of(const Checked& checked, WheelMistake mistake, double turn,
                       bool wrap = true) {
  const MotionRows& drive = checked.recording.drive;
  const double stretch = drive.wheels.empty() ? kTurningTravel / checked.wheelbase : kTellingTurn;
  double dd = 0.0;
  double dc = 0.0;
  double cc = 0.0;
  TurnAgreement result;
  double turned = 0.0;
  double change = 0.0;
  double last = kAbsent;
  double begun = drive.start();
  double waiting = 0.0;  // turned since the last reading
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    waiting += motion_without(mistake, drive, row, checked.wheelbase).turn;
    const double reading = drive.heading[row];
    if (std::isnan(reading)) continue;
    if (!std::isnan(last)) {
      turned += waiting;
      change +=
          (wrap ? wrapped(reading - last, turn) : reading - last) * 2.0 * std::numbers::pi / turn;
    }
    last = reading;
    waiting = 0.0;
    const bool full = std::abs(turned) >= stretch;
    if (!full && drive.t[row] - begun < kLongestTurn) continue;
    if (full) {
      dd += turned * turned;
      dc += turned * change;
      cc += change * change;
      ++result.turns;
    }
    turned = change = 0.0;
    begun = drive.t[row];
  }
  if (dd > 0.0 && cc > 0.0) {
    result.slope = dc / dd;
    result.correlation = dc / std::sqrt(dd * cc);
  }
  return result;
}

/// Seconds in which the compass turns as wheels make it on the spot, both going on by as much.
int turns_on_the_spot(const MotionRows& drive, double wheelbase) {
  constexpr double kWindow = 1.0;  // s
  constexpr double kTurns = 0.4;   // rad
  int count = 0;
  double shown = 0.0;
  double ahead = 0.0;
  double first = kAbsent;
  double begun = 0.0;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    shown += drive.turn[row];
    ahead += drive.forward[row];
    const double reading = drive.heading[row];
    if (std::isnan(reading)) continue;
    if (!std::isnan(first) && drive.t[row] - begun < kWindow) continue;
    const double turn = std::isnan(first) ? 0.0 : wrapped(reading - first, 2.0 * std::numbers::pi);
    if (std::abs(turn) > kTurns && looks_unsigned(turn, shown, ahead, wheelbase)) ++count;
    first = reading;
    begun = drive.t[row];
    shown = 0.0;
    ahead = 0.0;
  }
  return count;
}

/// Goes with the wheels, by a wheelbase that robots have.
bool is_clear(const TurnAgreement& turns, const Checked& checked) {
  constexpr double kNear = 3.0;  // times the wheelbase
  if (std::abs(turns.correlation) < kClearTurns) return false;
  const double wheelbase = checked.wheelbase / std::abs(turns.slope);
  return checked.wheelbase_known
             ? std::abs(std::log(wheelbase / checked.wheelbase)) < std::log(kNear)
             : wheelbase > 0.03 && wheelbase < 3.0;
}

}  // namespace

bool looks_unsigned(double turn, double shown, double ahead, double wheelbase) {
  const double on_the_spot = 2.0 * ahead / wheelbase;
  return std::abs(turn) > 0.4 * on_the_spot && std::abs(turn) < 1.6 * on_the_spot &&
         std::abs(shown) < 0.3 * std::abs(turn);
}

TurnAgreement check_compass(Checked& checked) {
  const MotionRows& drive = checked.recording.drive;
  if (!drive.has_compass() || checked.wrong.contains("left")) return {};
  TurnAgreement best = turns_of(checked, WheelMistake::none, 2.0 * std::numbers::pi);
  if (best.turns >= kFewestTurns && std::abs(best.correlation) < kClearTurns) {
    const TurnAgreement going_on =
        turns_of(checked, WheelMistake::none, 2.0 * std::numbers::pi, false);
    const TurnAgreement degrees = turns_of(checked, WheelMistake::none, 360.0);
    if (is_clear(going_on, checked)) {
      best = going_on;  // few readings, whole turns apart
    } else if (is_clear(degrees, checked)) {
      checked.add("drive.csv", "heading", "angle unit",
                  text::joined("as degrees the readings turn with the wheels (correlation ",
                               text::fixed_text(std::abs(degrees.correlation), 2),
                               "), as radians they do not (",
                               text::fixed_text(std::abs(best.correlation), 2), ")"),
                  "convert the readings to radians");
      best = degrees;
    }
  }
  for (const WheelMistake mistake : {WheelMistake::left_negated, WheelMistake::right_negated}) {
    if (!drive.of_two_wheels() || std::abs(best.correlation) > kUnclear) break;
    const TurnAgreement other = turns_of(checked, mistake, 2.0 * std::numbers::pi);
    if (other.turns < kFewestTurns || other.correlation < kClearTurns) continue;
    add_lone_wheel(
        checked, mistake,
        text::joined("with the ", lone_wheel(mistake),
                     " wheel's sign changed the wheels turn with the compass (correlation ",
                     text::fixed_text(other.correlation, 2), "), as recorded they do not (",
                     text::fixed_text(best.correlation, 2), ")"));
    return {};
  }
  if (best.turns < kFewestTurns || std::abs(best.correlation) < kClearTurns) {
    constexpr int kFewestContradicting = 6;
    best.unsigned_wheels = turns_on_the_spot(drive, checked.wheelbase) >= kFewestContradicting;
    best.sign = 0;
    return best;
  }
  best.sign = best.correlation > 0.0 ? 1 : -1;
  return best;
}

}  // namespace trussmap::check
