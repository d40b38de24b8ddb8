// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/units.hpp"
#include "io/csv.hpp"
#include "trussmap/error.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/write_files.hpp"

#include <cmath>

#include <fmt/format.h>

namespace trussmap {
using namespace io;

namespace {

/// A column that need not be there.
class MaybeColumn {
 public:
  MaybeColumn(const CsvReader& table, const char* name) : column_(table.find(name)), name_(name) {}

  [[nodiscard]] bool is_there() const { return column_ >= 0; }

  /// kAbsent where there is none, or nothing in it.
  [[nodiscard]] double of(const CsvReader& table) const {
    if (column_ < 0 || table.field(column_).empty()) return kAbsent;
    return table.number(column_);
  }

  [[nodiscard]] double above_zero(const CsvReader& table, double size = 1.0) const {
    const double value = of(table);
    if (value <= 0.0) table.fail(fmt::format("{} is {:g}, expected more than 0", name_, value));
    return size * value;
  }

 private:
  int column_;
  const char* name_;
};

struct TapeColumns {
  explicit TapeColumns(const CsvReader& table)
      : kind(table.require("kind")),
        expected(table.require("expected")),
        odometry(table.require("odometry")),
        heading(table, "heading"),
        aside(table, "aside"),
        gyro(table, "gyro"),
        yaw_rate(table, "yaw_rate"),
        seconds(table, "seconds"),
        sd(table, "sd"),
        sd_odometry(table, "sd_odometry"),
        sd_heading(table, "sd_heading"),
        sd_gyro(table, "sd_gyro"),
        sd_start(table, "sd_start") {}

  int kind;
  int expected;
  int odometry;
  MaybeColumn heading, aside, gyro, yaw_rate, seconds;
  MaybeColumn sd, sd_odometry, sd_heading, sd_gyro, sd_start;
};

TapedKind kind_of(const CsvReader& table, int column) {
  const std::string_view text = table.field(column);
  if (text == "straight") return TapedKind::straight;
  if (text == "spin") return TapedKind::spin;
  if (text == "rest") return TapedKind::rest;
  table.fail("kind is " + shown_field(text) + ", expected straight, spin or rest");
}

/// A factor that only units make: "centimetres, 100 times too long"; empty: none.
std::string unit_of_factor(double factor) {
  const auto near = [factor](double one) { return factor > 0.6 * one && factor < 1.6 * one; };
  if (near(100.0)) return "centimetres, 100 times too long";
  if (near(1000.0)) return "millimetres, 1000 times too long";
  if (near(1.0 / 1000.0)) return "kilometres";
  if (near(100.0 / 2.54)) return "inches";
  return "";
}

void require_metres(const CsvReader& table, const char* name, double value) {
  constexpr double kLongest = 100.0;    // m: a tape's
  constexpr double kHundreds = 2500.0;  // up to this many centimetres are driven
  if (!(value > 0.0)) table.fail(fmt::format("{} is {:g}, expected metres above 0", name, value));
  if (value > kLongest) {
    table.fail(fmt::format("{} is {:g} m, longer than any tape, expected metres (are these {}?)",
                           name, value,
                           value <= kHundreds ? "centimetres, 100 times too long"
                                              : "millimetres, 1000 times too long"));
  }
}

void check_straight(const CsvReader& table, const TapedRun& run) {
  constexpr double kFarOff = 12.0;  // no gear, radius or count is mistaken by that much
  const double factor = run.expected / run.odometry;
  if (run.expected > 0.0 && run.odometry > 0.0 && (factor > kFarOff || factor < 1.0 / kFarOff)) {
    const bool tape = factor > 1.0;
    const std::string unit = unit_of_factor(tape ? factor : 1.0 / factor);
    table.fail(fmt::format(
        "expected is {:g} and odometry {:g}, expected metres for both{}", run.expected,
        run.odometry,
        unit.empty() ? std::string()
                     : fmt::format(" (is {} in {}?)", tape ? "expected" : "odometry", unit)));
  }
  require_metres(table, "expected", run.expected);
  require_metres(table, "odometry", run.odometry);
  if (std::abs(run.heading) > geometry::kQuarterTurn) {
    table.fail(
        fmt::format("heading is {:.3g} rad after a straight run, expected less than a "
                    "quarter turn (are these degrees? --degrees says so)",
                    run.heading));
  }
  if (std::abs(run.aside) > run.expected) {
    table.fail(fmt::format(
        "aside is {:g} m after a run of {:g} m, expected metres (are these centimetres?)",
        run.aside, run.expected));
  }
}

/// Degrees are told from radians by being round, or by more turns than anybody counts.
bool looks_like_degrees(double turn) {
  constexpr double kMostTurns = 100.0;
  constexpr double kRound = 45.0;
  const double size = std::abs(turn);
  return size > kMostTurns * geometry::kFullTurn ||
         (size >= 2.0 * kRound && std::abs(std::remainder(size, kRound)) < 1e-9);
}

void check_turn(const CsvReader& table, const TapedRun& run, bool degrees) {
  constexpr double kFarOff = 4.5;
  if (run.expected == 0.0 || run.odometry == 0.0) {
    table.fail("a turn of 0, expected radians above or below 0 (left: above)");
  }
  if (!degrees && looks_like_degrees(run.expected)) {
    table.fail(fmt::format(
        "expected is {:g} rad, {:.0f} full turns, expected radians (are these degrees? --degrees "
        "says so)",
        run.expected, std::abs(run.expected) / geometry::kFullTurn));
  }
  for (const auto& [name, value] :
       {std::pair("odometry", run.odometry), std::pair("gyro", run.gyro)}) {
    const double factor = run.expected / value;
    if (factor < 0.0) {
      table.fail(
          fmt::format("expected and {} have opposite signs, expected turns to the left "
                      "above 0 and to the right below, of all",
                      name));
    }
    if (std::isnan(factor) || (factor < kFarOff && factor > 1.0 / kFarOff)) continue;
    const double size = degrees ? geometry::kDegrees : 1.0;
    table.fail(
        fmt::format("expected is {:g} and {} {:g}, expected {} for both (is one in turns, "
                    "or in {}?)",
                    size * run.expected, name, size * value, degrees ? "degrees" : "radians",
                    degrees ? "radians" : "degrees"));
  }
}

/// What the gyro says of a turn or a rest, rad over its seconds.
void read_gyro_of_run(const CsvReader& table, const TapeColumns& columns, double angle,
                      TapedRun& run) {
  run.gyro = angle * columns.gyro.of(table);
  // A heading beside a turn or a rest can be an instrument's alone.
  if (!columns.gyro.is_there()) run.gyro = angle * columns.heading.of(table);
  run.sd_gyro = columns.sd_gyro.above_zero(table, angle);
  const double rate = angle * columns.yaw_rate.of(table);
  if (std::isfinite(rate)) {
    if (std::isfinite(run.gyro)) {
      table.fail("both gyro and yaw_rate are given, expected one of them");
    }
    if (std::isnan(run.seconds) && run.kind == TapedKind::spin) {
      table.fail("yaw_rate is given without seconds, expected both for a spin");
    }
    if (std::isnan(run.seconds)) run.seconds = 1.0;
    run.gyro = rate * run.seconds;
    run.sd_gyro *= run.seconds;
  }
  if (run.kind == TapedKind::rest && std::isfinite(run.gyro) && std::isnan(run.seconds)) {
    table.fail("a rest without seconds, expected how long the gyro was read (or yaw_rate)");
  }
}

double number_or_zero(const CsvReader& table, int column) {
  return table.field(column).empty() ? 0.0 : table.number(column);
}

TapedRun read_run(const CsvReader& table, const TapeColumns& columns, bool degrees) {
  const double angle = degrees ? geometry::kDegree : 1.0;
  TapedRun run;
  run.line = table.line();
  run.kind = kind_of(table, columns.kind);
  const double size = run.kind == TapedKind::spin ? angle : 1.0;
  const bool rest = run.kind == TapedKind::rest;
  run.expected =
      size * (rest ? number_or_zero(table, columns.expected) : table.number(columns.expected));
  run.odometry =
      size * (rest ? number_or_zero(table, columns.odometry) : table.number(columns.odometry));
  run.seconds = columns.seconds.above_zero(table);
  run.sd = columns.sd.above_zero(table, size);
  run.sd_odometry = columns.sd_odometry.above_zero(table, size);
  if (run.kind == TapedKind::straight) {
    run.heading = angle * columns.heading.of(table);
    run.aside = columns.aside.of(table);
    run.sd_heading = columns.sd_heading.above_zero(table, angle);
    run.sd_start = columns.sd_start.above_zero(table, angle);
    check_straight(table, run);
    return run;
  }
  read_gyro_of_run(table, columns, angle, run);
  if (!rest) check_turn(table, run, degrees);
  return run;
}

}  // namespace

std::vector<TapedRun> read_taped_runs(const std::filesystem::path& file, bool degrees) {
  const std::string text = read_file(file);
  CsvReader table(text, file.string(), CsvForm::by_hand);
  const TapeColumns columns(table);
  std::vector<TapedRun> runs;
  while (table.next()) runs.push_back(read_run(table, columns, degrees));
  if (runs.empty()) throw InputError(file.string(), 0, "no run, expected one or more");
  return runs;
}

std::string format_taped_runs(const std::vector<TapedRun>& runs) {
  std::string text = "kind,expected,odometry,heading,gyro,seconds\n";
  for (const TapedRun& run : runs) {
    text += run.kind == TapedKind::straight ? "straight" : "";
    text += run.kind == TapedKind::spin ? "spin" : "";
    text += run.kind == TapedKind::rest ? "rest" : "";
    for (const double value : {run.expected, run.odometry, run.heading, run.gyro, run.seconds}) {
      text += "," + csv_number(value);
    }
    text += "\n";
  }
  return text;
}

}  // namespace trussmap
