// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Clocks: times in another unit, a clock that was set while the robot drove, files whose times are
// not the drive's.
//
//   unit   a row lasts long and the robot creeps, and in a smaller unit both are what robots do
//   set    the time jumps by a day or more in a row that travels as its neighbours do
//   other  a file's rows lie outside of the drive, or all in a small part of it, and in another
//          unit, or counted from another start, they would fill it
#include "check/findings.hpp"
#include "recording/time_units.hpp"
#include "statistics/median.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace trussmap::check {
namespace {

constexpr double kCreeps = 0.004;       // m/s
constexpr double kLongRow = 2.0;        // s
constexpr double kOrdinary = 0.02;      // m/s that robots drive at least, once times are right
constexpr double kFast = 10.0;          // m/s
constexpr double kShortestRow = 2e-4;   // s
constexpr double kLongestRow = 30.0;    // s
constexpr double kLongestTravel = 2.0;  // m in a row
constexpr double kDay = 86400.0;        // s
constexpr double kSince1970 = 5e8;      // s: no clock that began with the drive shows so much

/// The unit in which a row that long, at that speed, is a robot's.
const recording::TimeUnit* unit_of_rows(double duration, double speed) {
  for (const recording::TimeUnit& one : recording::kTimeUnits) {
    const double row = duration / one.per_second;
    const double drives = speed * one.per_second;
    if (row > kShortestRow && row < kLongestRow && drives > kOrdinary && drives < kFast) {
      return &one;
    }
  }
  return nullptr;
}

void check_time_unit(Checked& checked, const UsualRow& usual) {
  if (!(usual.speed < kCreeps && usual.duration > kLongRow) ||
      usual.speed * usual.duration > kLongestTravel) {
    return;
  }
  const recording::TimeUnit* const unit = unit_of_rows(usual.duration, usual.speed);
  if (unit == nullptr) return;
  checked.add("drive.csv", "t", "time unit",
              text::joined("a row lasts ", figure(usual.duration, "s"), " and the robot drives at ",
                           figure(usual.speed, "m/s"), " (medians): times look like ", unit->name),
              "convert all times to seconds, of sightings and truth too");
}

void check_clock_set(Checked& checked, const UsualRow& usual) {
  const MotionRows& drive = checked.recording.drive;
  const std::vector<std::size_t> jumps = clock_jumps(drive, usual);
  if (jumps.empty()) return;
  const std::size_t row = jumps.front();
  const double before = drive.t[row - 1];
  const double after = drive.t[row];
  const bool epoch = std::abs(before) < kSince1970 && after > kSince1970;
  const double jump = after - before - usual.duration;
  checked.note(
      "drive.csv", "t", "clock set",
      text::joined("the time jumps from ", text::shortest_text(before), " s to ",
                   text::shortest_text(after), " s in row ", row + 1,
                   epoch ? ", from seconds of its own to those since 1970"
                         : text::joined(", by ", figure(jump / kDay), " days"),
                   jumps.size() > 1 ? text::joined("; ", jumps.size(), " jumps like it") : "",
                   ": the clock was set, or the rest is of another day"),
      text::joined("take ", text::shortest_text(std::round(jump)),
                   " s off all later times, of all "
                   "files, or split the recording there"));
}

/// Of a file's rows.
struct FileTimes {
  const char* file;
  std::vector<double> t = {};
};

template <typename Rows>
FileTimes times_of(const char* file, const Rows& rows) {
  FileTimes times{file};
  for (const auto& one : rows) times.t.push_back(one.t);
  return times;
}

double share_within(const std::vector<double>& t, double from, double to) {
  const auto count =
      std::count_if(t.begin(), t.end(), [&](double one) { return one >= from && one <= to; });
  return static_cast<double>(count) / static_cast<double>(t.size());
}

/// By how much times are too large (or, below 1, too small) to fill the drive; 0: by no unit.
double unit_that_fills(const std::vector<double>& t, double from, double to) {
  constexpr double kFills = 0.3;  // of the drive
  constexpr double kIn = 0.9;     // of the rows
  for (const double per : {1e3, 1e6, 1e9, 1e-3, 1e-6, 1e-9}) {
    std::vector<double> scaled = t;
    for (double& one : scaled) one /= per;
    const double slack = 0.01 * (to - from);
    if (share_within(scaled, from - slack, to + slack) < kIn) continue;
    if (scaled.back() - scaled.front() > kFills * (to - from)) return per;
  }
  return 0.0;
}

std::string unit_words(double per) {
  for (const recording::TimeUnit& one : recording::kTimeUnits) {
    if (one.per_second == per) return text::joined("in ", one.name);
    if (one.per_second == 1.0 / per)
      return text::joined("in a unit ", figure(1.0 / per), " times as long as the drive's");
  }
  return {};
}

void check_file_times(Checked& checked, const FileTimes& times) {
  constexpr std::size_t kFewest = 3;
  constexpr std::size_t kFewestTimes = 8;  // where rows lie within the drive
  constexpr double kSmallPart = 0.005;     // of the drive's time
  constexpr double kHardlyAny = 0.05;
  if (times.t.size() < kFewest) return;
  const MotionRows& drive = checked.recording.drive;
  const double from = drive.start();
  const double to = drive.t.back();
  const double inside = share_within(times.t, from, to);
  const bool squeezed = inside > kHardlyAny;
  if (squeezed && (times.t.back() - times.t.front() > kSmallPart * (to - from) ||
                   std::set<double>(times.t.begin(), times.t.end()).size() < kFewestTimes)) {
    return;
  }
  const double per = unit_that_fills(times.t, from, to);
  if (inside > 0.0 && per == 0.0) return;
  const std::string seen =
      text::joined("its times go from ", text::shortest_text(times.t.front()), " to ",
                   text::shortest_text(times.t.back()), ", the drive's from ",
                   text::shortest_text(from), " to ", text::shortest_text(to));
  if (per != 0.0) {
    checked.add(times.file, "t", "time unit",
                text::joined(seen, ": they look as if ", unit_words(per)),
                "give all files their times in seconds of one clock");
    return;
  }
  checked.add(times.file, "t", "other clock", text::joined(seen, ": no row lies within the drive"),
              "give all files their times in seconds of one clock");
}

}  // namespace

std::vector<std::size_t> clock_jumps(const DriveColumns& drive, const UsualRow& usual) {
  constexpr std::size_t kMost = 3;
  const double least = std::max(kDay, 1e6 * usual.duration);
  std::vector<std::size_t> jumps;
  for (std::size_t row = 1; row < drive.rows(); ++row) {
    if (drive.duration(row) > least) jumps.push_back(row);
  }
  if (jumps.size() > kMost) jumps.clear();
  return jumps;
}

void check_clocks(Checked& checked, const UsualRow& usual) {
  check_time_unit(checked, usual);
  const bool unit = checked.wrong.contains("t");
  if (!unit) check_clock_set(checked, usual);
  const DrivenRecording& recording = checked.recording;
  for (const FileTimes& times :
       {times_of("sightings.csv", recording.sightings), times_of("fixes.csv", recording.fixes),
        times_of("truth.csv", recording.truth)}) {
    check_file_times(checked, times);
  }
}

}  // namespace trussmap::check
