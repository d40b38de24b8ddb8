// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/csv.hpp"
#include "io/run_rows.hpp"
#include "trussmap/error.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace trussmap {
using namespace io;

namespace {

double coordinate(const CsvReader& table, int column, const char* name, double longest) {
  const double value = table.number(column);
  require_shorter(table, name, value, longest);
  return value;
}

std::string runs_text(std::size_t count, const std::string& of) {
  return (count == 0 ? "no run" : "1 run") + of + ", expected two or more";
}

/// Whole turns do not count: odometry has them after a square, whoever measures has not.
double return_heading(const CsvReader& table, int column) {
  const double heading = wrap_angle(table.number(column));
  if (std::abs(heading) > std::numbers::pi / 2.0) {
    table.fail(
        fmt::format("heading is off by {:.3g} rad after a square, expected less than a quarter "
                    "turn (are these degrees?)",
                    heading));
  }
  return heading;
}

/// Distances to walls need to know where the sensors are.
void refuse_wall_distances(const std::filesystem::path& file, const CsvReader& table) {
  if (table.find("start1") < 0 || table.find("x") >= 0) return;
  throw InputError(file.string(), 1,
                   "distances to walls, expected --wall-sensors FILE beside them, or the columns "
                   "x and y");
}

}  // namespace

}  // namespace trussmap

namespace trussmap::io {

void require_shorter(const CsvReader& table, const std::string& name, double value,
                     double longest) {
  constexpr double kHundreds = 6.25;  // of the path: up to a square's side in centimetres
  if (std::abs(value) <= longest) return;
  table.fail(fmt::format(
      "{} is {:g} m, more than the whole path of {:g} m, expected metres (are these {}?)", name,
      value, longest,
      std::abs(value) <= kHundreds * longest ? "centimetres, 100 times too long, or millimetres"
                                             : "millimetres, 1000 times too long"));
}

bool turns_right(const CsvReader& table, int column) {
  const std::string_view sense = table.field(column);
  if (sense != "cw" && sense != "ccw") {
    table.fail("direction is " + shown_field(sense) + ", expected cw or ccw");
  }
  return sense == "cw";
}

void require_both_ways(const SquareRuns& runs, const std::filesystem::path& file) {
  for (const auto& [name, sample] : {std::pair("cw", &runs.cw), std::pair("ccw", &runs.ccw)}) {
    if (sample->size() >= 2) continue;
    throw InputError(file.string(), 0,
                     runs_text(sample->size(), std::string(" in direction ") + name));
  }
}

void require_scatter(const EndErrors& errors, const std::filesystem::path& file) {
  const auto equals_first = [&errors](const Eigen::Vector3d& e) { return e == errors.front(); };
  if (errors.size() >= 2 && std::all_of(errors.begin(), errors.end(), equals_first)) {
    throw InputError(file.string(), 0,
                     "all runs ended with the same errors, expected scatter to learn from");
  }
  if (errors.size() < 2) throw InputError(file.string(), 0, runs_text(errors.size(), ""));
}

}  // namespace trussmap::io

namespace trussmap {

SquareRuns read_square_runs(const std::filesystem::path& file, double longest) {
  const std::string text = read_file(file);
  CsvReader table(text, file.string(), CsvForm::by_hand);
  refuse_wall_distances(file, table);
  const int direction = table.require("direction");
  const int x = table.require("x");
  const int y = table.require("y");
  const int heading = table.find("heading");
  SquareRuns runs;
  while (table.next()) {
    const bool cw = turns_right(table, direction);
    const double ahead = coordinate(table, x, "x", longest);
    const double left = coordinate(table, y, "y", longest);
    (cw ? runs.cw : runs.ccw).push_back({ahead, left});
    if (heading < 0) continue;
    (cw ? runs.cw_headings : runs.ccw_headings).push_back(return_heading(table, heading));
  }
  require_both_ways(runs, file);
  return runs;
}

EndErrors read_end_errors(const std::filesystem::path& file, double longest) {
  const std::string text = read_file(file);
  CsvReader table(text, file.string(), CsvForm::by_hand);
  refuse_wall_distances(file, table);
  const int x = table.require("x");
  const int y = table.require("y");
  const int heading = table.require("heading");
  EndErrors errors;
  while (table.next()) {
    errors.push_back({coordinate(table, x, "x", longest), coordinate(table, y, "y", longest),
                      wrap_angle(table.number(heading))});
  }
  require_scatter(errors, file);
  return errors;
}

std::string format_square_runs(const SquareRuns& runs) {
  const bool with_heading = !runs.cw_headings.empty() && !runs.ccw_headings.empty();
  std::string text = with_heading ? "direction,x,y,heading\n" : "direction,x,y\n";
  const auto add = [&](const char* name, const std::vector<Eigen::Vector2d>& ends,
                       const std::vector<double>& headings) {
    for (std::size_t k = 0; k < ends.size(); ++k) {
      text += std::string(name) + "," + csv_number(ends[k].x()) + "," + csv_number(ends[k].y());
      text += with_heading ? "," + csv_number(headings[k]) + "\n" : "\n";
    }
  };
  add("cw", runs.cw, runs.cw_headings);
  add("ccw", runs.ccw, runs.ccw_headings);
  return text;
}

std::string format_end_errors(const EndErrors& errors) {
  std::string text = "x,y,heading\n";
  for (const Eigen::Vector3d& e : errors) {
    text += csv_number(e[0]) + "," + csv_number(e[1]) + "," + csv_number(e[2]) + "\n";
  }
  return text;
}

}  // namespace trussmap
