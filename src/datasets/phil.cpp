// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A Turtlebot's wheels and gyro under motion capture (PHIL, Worcester Polytechnic Institute, 2018)
// as a recording.
//
//   FOLDER/kobuki_data.csv   left_ticks, right_ticks (65536 is 0 again), time_s, time_ns
//   FOLDER/rio_data.csv      raw_gyro_z [deg/s, counter-clockwise], navx time [ms], and others
//   FOLDER/mocap_robot.csv   frame (100 Hz), rotation vector [rad], position [mm]; # header
//
// Plain or .xz. Counts come late by up to 60 ms: rows are 0.2 s long, where the robot moves, and
// end where a count is fresh. The gyro's clock is set to the wheels', by their turns alone; the
// truth's stays as it is (effect `sighting delay`). Headings are the robot's, not the tracked
// body's.
#include "datasets/formats.hpp"
#include "datasets/number_rows.hpp"
#include "datasets/phil_frames.hpp"
#include "geometry/index.hpp"
#include "geometry/units.hpp"
#include "io/csv.hpp"
#include "trussmap/error.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace trussmap::datasets {
namespace {

namespace fs = std::filesystem;

constexpr double kWheelbase = 0.230;  // m
constexpr double kMetrePerTick = 2.0 * std::numbers::pi * 0.035 / 2578.33;
constexpr int kCounts = 65536;
constexpr double kFastestWheel = 3.0;  // m/s: four times what this base can do

// The base hands its counts on every 20 to 60 ms, and a row of the log does not say how old they
// are. Over a row that is not much longer than this the wheels would seem to run unevenly, and at
// their slowest they are believed most; over kShortestRow that is a tenth.
constexpr double kStale = 0.1;        // s
constexpr double kShortestRow = 0.2;  // s

constexpr double kLongestGap = 0.2;      // s between two samples of the gyro
constexpr double kLargestRate = 2000.0;  // deg/s, what the sensor can show

struct PhilRecording {
  Recording recording;

  double epoch = 0.0;          ///< s, Unix time of t = 0
  bool aligned = false;        ///< whether the clocks of wheels and gyro could be compared
  double gyro_late = 0.0;      ///< s that the gyro's times were set back by
  double gyro_likeness = 0.0;  ///< correlation of their turns over 0.3 s then, -1 to 1
  int tick_rows = 0;           ///< rows of counts, of which several make one of the drive
  int stale_samples = 0;       ///< rows that repeat a sample of the gyro
  int lost_frames = 0;         ///< frames without the robot, or where it jumps, left out
};

/// A quantity that grows along a log, between whose rows it goes straight.
struct Counter {
  std::vector<double> t;
  std::vector<double> value;

  [[nodiscard]] bool covers(double when) const { return when >= t.front() && when <= t.back(); }

  /// `when` within the log.
  [[nodiscard]] double at(double when) const {
    const auto after = std::upper_bound(t.begin(), t.end(), when);
    if (after == t.end()) return value.back();
    const std::size_t k = idx(after - t.begin());
    const double part = (when - t[k - 1]) / (t[k] - t[k - 1]);
    return value[k - 1] + part * (value[k] - value[k - 1]);
  }
};

// ----------------------------------------
// Wheels

struct Ticks {
  std::vector<double> t;
  std::vector<std::int64_t> left;  ///< since the first row, beyond the counter's range
  std::vector<std::int64_t> right;
};

int count_at(const io::CsvReader& csv, int column) {
  const double value = csv.number(column);
  if (value < 0.0 || value >= kCounts || value != std::floor(value)) {
    csv.fail("column " + csv.columns()[idx(column)] + " is " + std::string(csv.field(column)) +
             ", expected a whole number from 0 to 65535");
  }
  return static_cast<int>(value);
}

/// The counters run over; the way round is the shorter one.
int steps(int from, int to) {
  return (to - from + kCounts + kCounts / 2) % kCounts - kCounts / 2;
}

Ticks read_ticks(const fs::path& folder, double& epoch) {
  const fs::path file = require_plain_or_xz(folder / "kobuki_data.csv");
  const std::string text = read_file(file);
  io::CsvReader csv(text, file.string());
  const std::array counters{csv.require("left_ticks"), csv.require("right_ticks")};
  const int seconds = csv.require("time_s");
  const int nanoseconds = csv.require("time_ns");
  Ticks ticks;
  std::array<int, 2> last{};
  while (csv.next()) {
    const double whole = csv.number(seconds, 1e12);
    const std::array now{count_at(csv, counters[0]), count_at(csv, counters[1])};
    if (ticks.t.empty()) {
      epoch = whole + 1e-9 * csv.number(nanoseconds, 1e9);
      ticks = {{0.0}, {0}, {0}};
      last = now;
      continue;
    }
    const double t = since(epoch, whole + 1e-9 * csv.number(nanoseconds, 1e9));
    if (!(t > ticks.t.back())) csv.fail("time repeats or runs backwards, expected a later one");
    const std::array moved{steps(last[0], now[0]), steps(last[1], now[1])};
    for (std::size_t side = 0; side < 2; ++side) {
      if (std::abs(moved[side]) * kMetrePerTick <= kFastestWheel * (t - ticks.t.back() + kStale)) {
        continue;
      }
      csv.fail("column " + csv.columns()[idx(counters[side])] + " jumps by " +
               std::to_string(moved[side]) + " ticks, expected a wheel of 3 m/s at most");
    }
    ticks.t.push_back(t);
    ticks.left.push_back(ticks.left.back() + moved[0]);
    ticks.right.push_back(ticks.right.back() + moved[1]);
    last = now;
  }
  return ticks;
}

/// Rows of `shortest` s and more that end where the counts are fresh: where they change, or stand
/// still for longer than they are ever old.
Drive drive_of(const Ticks& ticks, double shortest) {
  Drive drive;
  std::size_t begin = 0;
  const auto end_row = [&](double t, std::size_t row) {
    drive.t.push_back(t);
    const auto metres = [&](const std::vector<std::int64_t>& counts) {
      return kMetrePerTick * static_cast<double>(counts[row] - counts[begin]);
    };
    drive.left.push_back(metres(ticks.left));
    drive.right.push_back(metres(ticks.right));
    begin = row;
  };
  double last = 0.0;     // end of the last row
  double changed = 0.0;  // when the counts changed last
  for (std::size_t k = 1; k < ticks.t.size(); ++k) {
    const double t = ticks.t[k];
    const bool changes = ticks.left[k] != ticks.left[k - 1] || ticks.right[k] != ticks.right[k - 1];
    if (changes) changed = t;
    const bool moved = ticks.left[k] != ticks.left[begin] || ticks.right[k] != ticks.right[begin];
    if ((changes && t - last >= shortest) || (moved && !changes && t - changed >= kStale)) {
      end_row(t, k);
      last = t;
    } else if (!moved && !changes && t - std::max(last, changed) >= shortest + kStale) {
      // What was held back belongs to the motion that may begin now.
      last = t - kStale;
      end_row(last, k);
    }
  }
  return drive;
}

Counter turn_of_wheels(const Ticks& ticks) {
  const Drive drive = drive_of(ticks, 0.0);
  Counter turn{{0.0}, {0.0}};
  for (std::size_t k = 0; k < drive.rows(); ++k) {
    turn.t.push_back(drive.t[k]);
    turn.value.push_back(turn.value.back() + (drive.right[k] - drive.left[k]) / kWheelbase);
  }
  return turn;
}

// ----------------------------------------
// Gyro

/// Its integral by the sensor's own clock: that of the computer says when a sample was fetched.
/// `raw_gyro_z` is counter-clockwise already (`yaw` is not).
Counter read_gyro(const fs::path& folder, int& stale) {
  const fs::path file = require_plain_or_xz(folder / "rio_data.csv");
  const std::string text = read_file(file);
  io::CsvReader csv(text, file.string());
  const int rate_column = csv.require("raw_gyro_z");
  const int time_column = csv.require("navx time");
  Counter turn;
  double epoch = 0.0;
  double before = 0.0;
  while (csv.next()) {
    const double rate = geometry::kDegree * csv.number(rate_column, kLargestRate);
    const double time = 1e-3 * csv.number(time_column, 1e12);
    if (turn.t.empty()) {
      epoch = time;
      turn = {{0.0}, {0.0}};
    } else {
      const double t = since(epoch, time);
      if (t < turn.t.back()) csv.fail("navx time runs backwards, expected a later one");
      if (t == turn.t.back()) {
        ++stale;
        continue;
      }
      turn.value.push_back(turn.value.back() + 0.5 * (before + rate) * (t - turn.t.back()));
      turn.t.push_back(t);
    }
    before = rate;
  }
  if (turn.t.size() < 2) {
    throw InputError(file.string(), 0, "fewer than two samples of the gyro, expected a drive");
  }
  return turn;
}

/// What the gyro turned from one time to another; none where it has no samples.
std::optional<double> turned(const Counter& gyro, double from, double to) {
  if (!gyro.covers(from) || !gyro.covers(to)) return {};
  const auto first = std::upper_bound(gyro.t.begin(), gyro.t.end(), from);
  const auto last = std::lower_bound(gyro.t.begin(), gyro.t.end(), to);
  for (auto k = first; k != gyro.t.end() && k <= last; ++k) {
    if (*k - *(k - 1) > kLongestGap) return {};
  }
  return gyro.at(to) - gyro.at(from);
}

/// Of turns over short windows; 0 without any.
double correlation(const Counter& wheels, const Counter& gyro, double lag) {
  constexpr double kWindow = 0.3;  // s
  double n = 0.0, a = 0.0, b = 0.0, aa = 0.0, ab = 0.0, bb = 0.0;
  for (const double t : wheels.t) {
    if (!wheels.covers(t + kWindow)) break;
    const std::optional<double> gyros = turned(gyro, t + lag, t + kWindow + lag);
    if (!gyros) continue;
    const double own = wheels.at(t + kWindow) - wheels.at(t);
    n += 1.0;
    a += own;
    b += *gyros;
    aa += own * own;
    ab += own * *gyros;
    bb += *gyros * *gyros;
  }
  const double spread = (n * aa - a * a) * (n * bb - b * b);
  return spread > 0.0 ? (n * ab - a * b) / std::sqrt(spread) : 0.0;
}

/// How much later the gyro's log has what the wheels' has: both begin together to within tenths of
/// a second. Needs turns; without, the clocks stay as they are.
void align(const Counter& wheels, const Counter& gyro, PhilRecording& result) {
  constexpr int kMost = 50;
  constexpr double kStep = 0.01;  // s
  constexpr double kClear = 0.7;
  std::vector<double> likeness;
  for (int k = -kMost; k <= kMost; ++k) likeness.push_back(correlation(wheels, gyro, k * kStep));
  const auto best = std::max_element(likeness.begin(), likeness.end());
  result.gyro_likeness = *best;
  if (*best < kClear || best == likeness.begin() || best + 1 == likeness.end()) return;
  const double bend = *(best - 1) - 2.0 * *best + *(best + 1);
  const double beside = bend < 0.0 ? 0.5 * (*(best - 1) - *(best + 1)) / bend : 0.0;
  const double lag = kStep * (static_cast<double>(best - likeness.begin()) - kMost + beside);
  result.gyro_late = std::round(1e3 * lag) / 1e3;
  result.aligned = true;
}

void add_gyro(const Counter& gyro, double late, Drive& drive) {
  double from = 0.0;
  for (const double to : drive.t) {
    const std::optional<double> turn = turned(gyro, from + late, to + late);
    drive.yaw_rate.push_back(turn ? *turn / (to - from) : kAbsent);
    from = to;
  }
}

/// The wheels' noise is mostly when their counts were taken, the truth's is a mast that sways. The
/// gyro's is the sensor's: three times what it shows at rest, and what a straight drive bears out;
/// where it is more, in turns, it is estimated.
Model turtlebot_model() {
  Model model;
  model.robot.wheelbase = kWheelbase;
  model.noise.left = model.noise.right = 0.007;
  model.noise.gyro = 0.0005;
  model.noise.truth = 0.003;
  model.noise.truth_heading = 0.003;
  return model;
}

std::string on_clocks(const PhilRecording& read) {
  if (read.aligned) {
    return fmt::format(
        "the gyro's log is {:.3f} s later than the wheels', by their turns (correlation {:.3f}): "
        "set back",
        read.gyro_late, read.gyro_likeness);
  }
  return fmt::format(
      "the gyro's clock stays as it is: its turns and the wheels' are too little alike "
      "(correlation {:.2f})",
      read.gyro_likeness);
}

}  // namespace

bool is_phil(const fs::path& folder) {
  return !plain_or_xz(folder / "kobuki_data.csv").empty() ||
         !plain_or_xz(folder / "rio_data.csv").empty();
}

Dataset read_phil(const fs::path& folder) {
  PhilRecording result;
  result.recording.name = folder.string();
  const Ticks ticks = read_ticks(folder, result.epoch);
  Drive& drive = result.recording.drive;
  drive = drive_of(ticks, kShortestRow);
  if (drive.rows() < 2) {
    throw InputError(require_plain_or_xz(folder / "kobuki_data.csv").string(), 0,
                     "less than half a second of ticks, expected a drive");
  }
  result.tick_rows = static_cast<int>(ticks.t.size());
  const Counter gyro = read_gyro(folder, result.stale_samples);
  align(turn_of_wheels(ticks), gyro, result);
  add_gyro(gyro, result.gyro_late, drive);
  result.recording.truth = read_phil_frames(folder, drive.t.back(), result.lost_frames);
  std::vector<DatasetFigure> figures{
      counted("tick_rows", result.tick_rows, "rows of ticks, of which were made"),
      counted("rows", drive.rows(), "drive rows"),
      counted("truth", result.recording.truth.size(), "truth rows"),
      counted("stale_samples", result.stale_samples,
              "rows that repeat a sample of the gyro skipped"),
      counted("lost_frames", result.lost_frames,
              "frames without the robot, or where it jumps, left out"),
      {"gyro_late", result.gyro_late, ""},
      {"gyro_likeness", result.gyro_likeness, ""}};
  const std::string clocks = on_clocks(result);
  return {std::move(result.recording),
          turtlebot_model(),
          result.epoch,
          fmt::format("t = 0 is {:.3f} s, Unix time\n{}", result.epoch, clocks),
          std::move(figures),
          {clocks}};
}

}  // namespace trussmap::datasets
