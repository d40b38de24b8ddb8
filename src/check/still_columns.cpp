// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A column that stands still while the robot drives, where the other wheels or sensors contradict
// the motion that is left. A wheel may well stand still: of three, the rear one on the way ahead.
#include "check/findings.hpp"
#include "check/misfit.hpp"
#include "check/still_limits.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::check {
namespace {

constexpr double kStillTime = 20.0;   // s, of the one wheel of a drive that is steered
constexpr double kWhole = 1.0;        // m, where the column never moves
constexpr double kContradicts = 0.2;  // misfit
constexpr double kHardly = 4.0 * std::numbers::pi;  // rad turned about a place on the wheel's axle

struct Stretch {
  std::size_t first = 0;
  std::size_t end = 0;
  double travel = 0.0;  ///< m, of the fastest other wheel
};

double fastest_other(const MotionRows& drive, std::size_t column, std::size_t row) {
  double fastest = 0.0;
  for (std::size_t k = 0; k < drive.wheels.size(); ++k) {
    if (k == column || drive.wheels[k].steers) continue;
    fastest = std::max(fastest, std::abs(drive.wheels[k].reading[row]));
  }
  return fastest;
}

/// The longest time in which the column does not move.
Stretch longest_still(const MotionRows& drive, std::size_t column) {
  const std::vector<double>& reading = drive.wheels[column].reading;
  Stretch longest;
  Stretch now;
  for (std::size_t row = 0; row < reading.size(); ++row) {
    if (reading[row] != 0.0) {
      now = {row + 1, row + 1, 0.0};
      continue;
    }
    now.end = row + 1;
    now.travel += fastest_other(drive, column, row);
    const bool longer =
        now.travel > longest.travel || (now.travel == 0.0 && longest.travel == 0.0 &&
                                        now.end - now.first > longest.end - longest.first);
    if (longer) longest = now;
  }
  return longest;
}

double turned(const MotionRows& drive, const Stretch& in) {
  double sum = 0.0;
  for (std::size_t row = in.first; row < in.end; ++row) {
    sum += std::abs(drive.turn[row]);
  }
  return sum;
}

/// The misfit of the witness that agrees least in the stretch; nothing where none tells.
std::optional<Misfit> contradiction(const Checked& checked, const Stretch& in) {
  const MotionRows& drive = checked.recording.drive;
  const double from = in.first == 0 ? drive.start() : drive.t[in.first - 1];
  const std::vector<Misfit> all =
      misfits(checked.recording, drive, {checked.angle_unit, from, drive.t[in.end - 1]});
  if (all.empty()) return std::nullopt;
  return *std::max_element(all.begin(), all.end(),
                           [](const Misfit& a, const Misfit& b) { return a.best < b.best; });
}

/// Where no other sensor tells: of wheels at the sides, as of two; of three, where the robot would
/// turn about places on the still one's axle all the time.
bool is_unlikely(const Checked& checked, const Stretch& in) {
  switch (checked.robot->drive) {
    case DriveKind::skid_steer:
      return true;
    case DriveKind::omni3:
      return turned(checked.recording.drive, in) > kHardly;
    default:
      return false;
  }
}

void ask_wheel(Checked& checked, std::size_t column) {
  const MotionRows& drive = checked.recording.drive;
  const bool only =
      checked.robot->drive == DriveKind::tricycle || checked.robot->drive == DriveKind::ackermann;
  const Stretch still = longest_still(drive, column);
  if (still.end == still.first) return;
  const bool whole = still.end - still.first == drive.rows();
  const double time = drive.t[still.end - 1] - drive.t[still.first];
  const double least = whole ? kWhole : std::max(kStillTravel, kStillTurns * checked.wheelbase);
  if (only ? time < kStillTime : still.travel < least) return;
  const std::optional<Misfit> worst = contradiction(checked, still);
  if (worst ? worst->best < kContradicts : !is_unlikely(checked, still)) return;
  const std::string& name = drive.wheels[column].name;
  checked.add(
      "drive.csv", name, "still wheel",
      text::joined(name, whole ? " never moves" : " stands still until t = ",
                   whole ? "" : figure(drive.t[still.end - 1], "s"),
                   only ? text::joined(" for ", figure(time, "s"))
                        : text::joined(", where another wheel goes ", figure(still.travel, "m")),
                   worst ? text::joined(", and the motion that is left is not that of ",
                                        name_of(worst->witness))
                         : ""),
      "look at the encoder's cable and at the column's source");
}

void ask_steering(Checked& checked, std::size_t column) {
  const MotionRows& drive = checked.recording.drive;
  const std::vector<double>& angle = drive.wheels[column].reading;
  const auto [least, most] = std::minmax_element(angle.begin(), angle.end());
  if (*least != *most) return;
  const std::optional<Misfit> worst = contradiction(checked, {0, drive.rows(), 0.0});
  if (!worst || worst->best < kContradicts) return;
  const std::string& name = drive.wheels[column].name;
  checked.add("drive.csv", name, "still steering",
              text::joined(name, " is ", figure(*most, "rad"),
                           " in every row, and the motion that is left is not that of ",
                           name_of(worst->witness)),
              "look at the angle sensor's cable and at the column's source");
}

}  // namespace

void check_still_columns(Checked& checked) {
  if (checked.wrong.contains("left") || checked.wrong.contains("t")) return;
  const MotionRows& drive = checked.recording.drive;
  for (std::size_t k = 0; k < drive.wheels.size(); ++k) {
    if (drive.wheels[k].steers) {
      ask_steering(checked, k);
    } else {
      ask_wheel(checked, k);
    }
  }
}

}  // namespace trussmap::check
