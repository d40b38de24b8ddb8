// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/findings.hpp"
#include "drive/body_motion.hpp"
#include "statistics/median.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::check {
namespace {

constexpr double kFastest = 10.0;     // m/s that a robot drives
constexpr double kFastestCar = 60.0;  // m/s
constexpr double kSlowest = 0.004;    // m/s
constexpr double kSpike = 10.0;       // times the speed that 99 of 100 rows stay below
constexpr double kSpikeTravel = 0.5;  // m

struct Rows {
  double duration = 0.0;        ///< s, median
  std::vector<double> speeds;   ///< m/s of the faster wheel, of rows that move, ascending
  std::vector<double> driving;  ///< those that are no jitter at rest
  bool whole = true;            ///< all travels are whole numbers

  [[nodiscard]] double speed(double share) const {
    return speeds[static_cast<std::size_t>(share * static_cast<double>(speeds.size() - 1))];
  }
};

bool travels_are_whole(const MotionRows& drive, std::size_t row) {
  const auto whole = [](double travel) { return travel == std::round(travel); };
  if (drive.of_two_wheels()) return whole(drive.pair.left[row]) && whole(drive.pair.right[row]);
  if (drive.wheels.empty()) return whole(drive.forward[row]);
  return std::all_of(drive.wheels.begin(), drive.wheels.end(),
                     [&](const WheelColumn& one) { return one.steers || whole(one.reading[row]); });
}

Rows rows_of(const MotionRows& drive, double wheelbase) {
  Rows rows;
  std::vector<double> durations;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    durations.push_back(drive.duration(row));
    const double travel = larger_travel(drive, row, wheelbase);
    const double speed = travel / durations.back();
    if (travel > 0.0) rows.speeds.push_back(speed);
    if (speed > kSlowest) rows.driving.push_back(speed);
    rows.whole = rows.whole && travels_are_whole(drive, row);
  }
  rows.duration = statistics::median(std::move(durations));
  std::sort(rows.speeds.begin(), rows.speeds.end());
  std::sort(rows.driving.begin(), rows.driving.end());
  return rows;
}

void check_units(Checked& checked, const Rows& rows) {
  const double speed = rows.speed(0.5);
  const bool car = checked.robot != nullptr && checked.robot->drive == DriveKind::ackermann;
  if (speed > (car ? kFastestCar : kFastest)) {
    const char* unit = rows.whole ? "ticks" : speed > 100.0 ? "mm" : "cm";
    checked.add("drive.csv", wheel_columns(checked.recording.drive), "travel unit",
                text::joined("the robot drives at ", figure(speed, "m/s"), " (median)",
                             rows.whole ? ", and all travels are whole numbers" : "",
                             ": travels look like ", unit),
                rows.whole ? "multiply them by the metres per tick" : "convert them to metres");
  }
}

void check_spikes(Checked& checked, const Rows& rows) {
  if (checked.wrong.contains("left") || rows.driving.size() < 20) return;
  const MotionRows& drive = checked.recording.drive;
  const double usual = rows.driving[rows.driving.size() * 99 / 100];
  std::vector<std::size_t> spikes;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const auto jumps = [&](std::size_t k) {
      return larger_travel(drive, k, checked.wheelbase) > kSpikeTravel &&
             larger_travel(drive, k, checked.wheelbase) / drive.duration(k) > kSpike * usual;
    };
    const bool alone =
        (row == 0 || !jumps(row - 1)) && (row + 1 == drive.rows() || !jumps(row + 1));
    if (jumps(row) && alone) spikes.push_back(row);
  }
  if (spikes.empty()) return;
  const std::size_t first = spikes.front();
  checked.note(
      "drive.csv", wheel_columns(checked.recording.drive), "spike",
      text::joined("the row at t = ", figure(drive.t[first], "s"), " travels ",
                   figure(larger_travel(drive, first, checked.wheelbase), "m"),
                   ", where 99 of 100 stay below ", figure(usual * drive.duration(first), "m"),
                   spikes.size() > 1 ? text::joined("; ", spikes.size(), " rows like it") : ""),
      "correct or remove the row: an encoder's jump, or an overflow of its counter");
}

}  // namespace

double larger_travel(const MotionRows& drive, std::size_t row, double wheelbase) {
  const auto [left, right] =
      drive.pair.empty() ? drive::wheel_travel(drive.motion(row), wheelbase) : drive.pair.at(row);
  const double ahead = std::max(std::abs(left), std::abs(right));
  return drive.sideways.empty() ? ahead : std::hypot(ahead, drive.sideways[row]);
}

void check_drive_values(Checked& checked) {
  const Rows rows = rows_of(checked.recording.drive, checked.wheelbase);
  if (rows.speeds.empty()) {
    checked.add("drive.csv", wheel_columns(checked.recording.drive), "no motion",
                "no row has any travel", "record a drive, or look at the columns' source");
    return;
  }
  const UsualRow usual{rows.duration, rows.speed(0.5)};
  check_units(checked, rows);
  check_clocks(checked, usual);
  check_spikes(checked, rows);
  check_gaps(checked, usual);
  if (checked.recording.drive.of_two_wheels()) check_still_wheels(checked);
}

}  // namespace trussmap::check
