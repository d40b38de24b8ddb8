// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Rows that are missing. Loggers are silent where nothing happens, too: the wheels come to rest
// before such a gap and start after it, and truth or compass are on both sides what they were.
#include "check/findings.hpp"
#include "drive/legs.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace trussmap::check {
namespace {

constexpr double kLongGap = 5.0;    // s
constexpr double kGapRows = 20.0;   // of the usual length of a row
constexpr double kSummedUp = 0.3;   // of the usual speed: the row has the travels of all
constexpr double kSlow = 0.5;       // of the usual speed: coming to rest, or starting
constexpr double kSlower = 0.9;     // than the row that is farther from the gap
constexpr double kOnTheSpot = 0.2;  // travel by difference
constexpr double kBeside = 2.0;     // s from the gap, of readings that tell of its ends
constexpr double kNoWay = 0.05;     // m
constexpr double kSamePlace = 0.2;  // m
constexpr double kSameTurn = 0.3;   // rad

/// The first of them from that time on, s.
template <typename Timed>
auto first_from(const std::vector<Timed>& all, double t) {
  return std::lower_bound(all.begin(), all.end(), t,
                          [](const Timed& one, double time) { return one.t < time; });
}

/// The way of the faster wheel to the end of each row, m: on the spot the axle's centre has none.
std::vector<double> way_of(const MotionRows& drive, double wheelbase) {
  std::vector<double> way;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    way.push_back(larger_travel(drive, row, wheelbase) + (row == 0 ? 0.0 : way.back()));
  }
  return way;
}

/// The wheels slow down before the row and gather speed from it on, or turn the robot on the spot,
/// if they move at all.
bool rests_in(const MotionRows& drive, std::size_t row, const UsualRow& usual, double wheelbase) {
  const auto speed = [&](std::size_t k) {
    return larger_travel(drive, k, wheelbase) / std::min(drive.duration(k), usual.duration);
  };
  const auto comes_from = [&](double one, double farther) {
    return one < kSlow * usual.speed && one < kSlower * farther;
  };
  const double before = speed(row - 1);
  // In two rows: a drive's end within a row looks slow in one.
  const bool stops = before == 0.0 || (row >= 3 && comes_from(before, speed(row - 2)) &&
                                       speed(row - 2) < kSlower * speed(row - 3));
  if (!stops) return false;
  const bool spins =
      2.0 * std::abs(drive.forward[row]) < kOnTheSpot * wheelbase * std::abs(drive.turn[row]);
  return spins || speed(row) == 0.0 ||
         (row + 1 < drive.rows() && comes_from(speed(row), speed(row + 1)));
}

/// Whether truth is where it was; nothing where it has no row on both sides, or in the gap, between
/// which the wheels have gone nowhere.
std::optional<bool> stands_by_truth(const DrivenRecording& recording,
                                    const std::vector<double>& path, double from, double to) {
  const MotionRows& drive = recording.drive;
  const double here = drive::path_at(drive, path, from);
  const TruthRow* first = nullptr;
  bool late = false;
  for (auto at = first_from(recording.truth, std::max(from - kBeside, drive.start()));
       at != recording.truth.end(); ++at) {
    const TruthRow& one = *at;
    if (one.t > std::min(to + kBeside, drive.t.back())) break;
    if (std::abs(drive::path_at(drive, path, one.t) - here) > kNoWay) continue;
    if (first == nullptr || one.t <= from) {
      first = &one;
      continue;
    }
    late = one.t >= to - kBeside;
    if (std::hypot(one.x - first->x, one.y - first->y) > kSamePlace ||
        std::abs(wrap_angle(one.heading - first->heading)) > kSameTurn) {
      return false;
    }
    if (one.t >= to) break;
  }
  if (!late || first->t > from + kBeside) return std::nullopt;
  return true;
}

/// The same of the compass: the last reading before the row and the first from it on, less what the
/// wheels have turned in between.
std::optional<bool> stands_by_compass(const MotionRows& drive, std::size_t row) {
  if (!drive.has_compass()) return std::nullopt;
  std::size_t before = row - 1;
  std::size_t after = row;
  while (before > 0 && std::isnan(drive.heading[before])) --before;
  while (after + 1 < drive.rows() && std::isnan(drive.heading[after])) ++after;
  double turn = drive.heading[after] - drive.heading[before];
  for (std::size_t k = before + 1; k <= after; ++k) turn -= drive.turn[k];
  const bool near =
      drive.t[row - 1] - drive.t[before] < kBeside && drive.t[after] - drive.t[row] < kBeside;
  if (std::isnan(turn) || !near) return std::nullopt;
  return std::abs(wrap_angle(turn)) < kSameTurn;
}

/// It has stood on one landmark on this side and on another one on that.
bool stands_elsewhere(const DrivenRecording& recording, double from, double to) {
  const Sighting* first = nullptr;
  for (auto at = first_from(recording.sightings, from - kBeside);
       at != recording.sightings.end() && at->t <= to + kBeside; ++at) {
    if (!at->standing()) continue;
    if (first != nullptr && first->landmark != at->landmark) return true;
    first = &*at;
  }
  return false;
}

bool stands_still_over(const Checked& checked, const std::vector<double>& path, std::size_t row,
                       const UsualRow& usual) {
  const DrivenRecording& recording = checked.recording;
  const MotionRows& drive = recording.drive;
  if (!rests_in(drive, row, usual, checked.wheelbase)) return false;
  const double from = drive.t[row - 1];
  const double to = std::max(from, drive.t[row] - usual.duration);
  if (stands_elsewhere(recording, from, to)) return false;
  const std::optional<bool> by_truth = stands_by_truth(recording, path, from, to);
  const std::optional<bool> by_compass = stands_by_compass(drive, row);
  if (!by_truth && !by_compass) return false;
  return by_truth.value_or(true) && by_compass.value_or(true);
}

}  // namespace

void check_gaps(Checked& checked, const UsualRow& usual) {
  if (checked.wrong.contains("t")) return;
  const MotionRows& drive = checked.recording.drive;
  const double longest = std::max(kLongGap, kGapRows * usual.duration);
  const std::vector<double> path = way_of(drive, checked.wheelbase);
  const std::vector<std::size_t> jumps = clock_jumps(drive, usual);
  std::vector<std::size_t> gaps;
  for (std::size_t row = 1; row < drive.rows(); ++row) {
    const double duration = drive.duration(row);
    if (duration <= longest) continue;
    if (std::find(jumps.begin(), jumps.end(), row) != jumps.end()) continue;
    // Travels that a long row has summed up are no gap.
    if (larger_travel(drive, row, checked.wheelbase) > kSummedUp * usual.speed * duration) continue;
    if (!stands_still_over(checked, path, row, usual)) gaps.push_back(row);
  }
  if (gaps.empty()) return;
  const std::size_t first = gaps.front();
  checked.note(
      "drive.csv", "t", "gap",
      text::joined("no row for ", figure(drive.duration(first), "s"), " before t = ",
                   figure(drive.t[first], "s"), ", where a row lasts ", figure(usual.duration, "s"),
                   gaps.size() > 1 ? text::joined("; ", gaps.size(), " gaps like it") : ""),
      "find out whether the clock jumped or rows were lost; split the recording there if "
      "the robot may have moved");
}

}  // namespace trussmap::check
