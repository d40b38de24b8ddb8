// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/counter_jumps.hpp"

#include "check/findings.hpp"
#include "statistics/median.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace trussmap::check {
namespace {

constexpr double kLeastJump = 0.3;         // m, and
constexpr double kExcess = 1.8;            // times what such a row travels at most, beside its own,
constexpr double kLargerExcess = 1.3;      // and the larger of the two, as it stands
constexpr std::size_t kLongestWrong = 50;  // samples
constexpr std::size_t kFewestRows = 20;

/// m/s that 99 of 100 rows stay below, and no more than a few times those in the middle.
double usual_speed(const std::vector<double>& travel, const MotionRows& drive) {
  constexpr double kTimesMiddle = 4.0;
  std::vector<double> speeds;
  for (std::size_t row = 0; row < travel.size(); ++row) {
    if (travel[row] != 0.0) speeds.push_back(std::abs(travel[row]) / drive.duration(row));
  }
  if (speeds.size() < kFewestRows) return 0.0;
  std::sort(speeds.begin(), speeds.end());
  return std::min(speeds[speeds.size() * 99 / 100], kTimesMiddle * speeds[speeds.size() / 2]);
}

/// m/s of the rows beside it, in the middle.
double speed_beside(const std::vector<double>& travel, const MotionRows& drive, std::size_t row) {
  constexpr std::size_t kBeside = 3;
  std::vector<double> speeds;
  const std::size_t first = row > kBeside ? row - kBeside : 0;
  for (std::size_t k = first; k <= std::min(row + kBeside, travel.size() - 1); ++k) {
    if (k != row) speeds.push_back(travel[k] / drive.duration(k));
  }
  return statistics::median(std::move(speeds));
}

/// m that a row is beyond what is usual beside it, where it is beyond all that is usual; else 0.
double excess_of(const std::vector<double>& travel, const MotionRows& drive, std::size_t row,
                 double usual) {
  const double most = usual * drive.duration(row);
  if (std::abs(travel[row]) < 0.5 * most) return 0.0;
  const double excess = travel[row] - speed_beside(travel, drive, row) * drive.duration(row);
  return std::abs(excess) > std::max(kLeastJump, kExcess * most) ? excess : 0.0;
}

/// The row in which the counter is right again.
std::optional<std::size_t> row_back(const std::vector<double>& travel, const MotionRows& drive,
                                    std::size_t row, double usual) {
  const std::size_t end = std::min(travel.size(), row + kLongestWrong + 1);
  for (std::size_t k = row + 1; k < end; ++k) {
    const bool opposite = (travel[row] > 0.0) != (travel[k] > 0.0);
    if (!opposite || excess_of(travel, drive, k, usual) == 0.0) continue;
    const double most = usual * (drive.duration(row) + drive.duration(k));
    const double larger = std::max(std::abs(travel[row]), std::abs(travel[k]));
    const double least = usual * std::max(drive.duration(row), drive.duration(k));
    if (std::abs(travel[row] + travel[k]) > 1.5 * most || larger < kLargerExcess * least) {
      return std::nullopt;
    }
    return k;
  }
  return std::nullopt;
}

void share(std::vector<double>& travel, const CounterJump& jump, const DriveColumns& drive) {
  const double both = travel[jump.row] + travel[jump.back];
  const double part =
      drive.duration(jump.row) / (drive.duration(jump.row) + drive.duration(jump.back));
  travel[jump.row] = part * both;
  travel[jump.back] = (1.0 - part) * both;
}

}  // namespace

std::vector<WheelReadings> wheel_readings(const MotionRows& drive) {
  if (drive.of_two_wheels()) return {{"left", &drive.pair.left}, {"right", &drive.pair.right}};
  if (!drive.unicycle.empty()) return {{drive.unicycle.front(), &drive.forward}};
  std::vector<WheelReadings> all;
  for (const WheelColumn& one : drive.wheels) {
    if (!one.steers) all.push_back({one.name, &one.reading});
  }
  return all;
}

std::vector<CounterJump> counter_glitches(const MotionRows& drive) {
  std::vector<CounterJump> jumps;
  const std::vector<WheelReadings> all = wheel_readings(drive);
  for (std::size_t column = 0; column < all.size(); ++column) {
    const std::vector<double>& travel = *all[column].travel;
    const double usual = usual_speed(travel, drive);
    if (!(usual > 0.0)) continue;
    for (std::size_t row = 0; row + 1 < travel.size(); ++row) {
      if (excess_of(travel, drive, row, usual) == 0.0) continue;
      const auto back = row_back(travel, drive, row, usual);
      if (!back) continue;
      jumps.push_back({column, row, *back, usual * drive.duration(row)});
      row = *back;
    }
  }
  return jumps;
}

std::vector<std::string> names_of_wheels(const MotionRows& drive) {
  std::vector<std::string> names;
  for (const WheelReadings& one : wheel_readings(drive)) names.push_back(one.name);
  return names;
}

Recording without_glitches(Recording recording, const std::vector<CounterJump>& glitches,
                           const std::vector<std::string>& names) {
  Drive& drive = recording.drive;
  for (const CounterJump& jump : glitches) {
    const std::string& name = names[jump.column];
    if (name == "left") share(drive.left, jump, drive);
    if (name == "right") share(drive.right, jump, drive);
    for (Covariate& one : drive.covariates) {
      if (one.name == name) share(one.values, jump, drive);
    }
  }
  return recording;
}

void check_glitches(Checked& checked, const std::vector<CounterJump>& jumps) {
  if (jumps.empty()) return;
  const MotionRows& drive = checked.recording.drive;
  const std::vector<WheelReadings> all = wheel_readings(drive);
  const CounterJump& first = jumps.front();
  const std::vector<double>& travel = *all[first.column].travel;
  const auto row_words = [&](std::size_t row) {
    return text::joined("row ", row + 1, " (t = ", text::shortest_text(drive.t[row]), " s)");
  };
  std::string others;
  constexpr std::size_t kNamed = 4;
  for (std::size_t k = 1; k < std::min(jumps.size(), kNamed); ++k) {
    others += text::joined(k == 1 ? "; so are " : ", ", all[jumps[k].column].name, " in rows ",
                           jumps[k].row + 1, " and ", jumps[k].back + 1);
  }
  if (jumps.size() > kNamed) others += text::joined(" and ", jumps.size() - kNamed, " more");
  std::set<std::string> names;
  for (const CounterJump& one : jumps) names.insert(all[one.column].name);
  std::string columns;
  for (const std::string& one : names) columns += (columns.empty() ? "" : ",") + one;
  checked.findings.push_back(
      {checked.recording.name + "/drive.csv", columns, "counter glitch",
       text::joined(all[first.column].name, " travels ", text::short_text(travel[first.row]), " m",
                    " in ", row_words(first.row), " and ", text::short_text(travel[first.back]),
                    " m", " in ", row_words(first.back), ", where 99 of 100 rows stay below ",
                    figure(first.usual, "m"), ": a counter that was wrong in ",
                    first.back == first.row + 1 ? std::string("one sample")
                                                : text::joined(first.back - first.row, " samples"),
                    others),
       "both rows together are right: check with --mend OUT writes the recording with that travel "
       "shared evenly; or leave the rows out with --exclude"});
}

}  // namespace trussmap::check
