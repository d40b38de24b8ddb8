// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/csv.hpp"
#include "trussmap/error.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap {
namespace {

double coordinate(const CsvReader& table, int column, const char* name, double longest) {
  const double value = table.number(column);
  if (std::abs(value) > longest) {
    table.fail(
        fmt::format("{} is {:g} m, more than the whole path of {:g} m, expected metres "
                    "(are these millimetres?)",
                    name, value, longest));
  }
  return value;
}

std::string runs_text(std::size_t count, const std::string& of) {
  return (count == 0 ? "no run" : "1 run") + of + ", expected two or more";
}

}  // namespace

SquareRuns read_square_runs(const std::filesystem::path& file, double longest) {
  const std::string text = read_file(file);
  CsvReader table(text, file.string());
  const int direction = table.require("direction");
  const int x = table.require("x");
  const int y = table.require("y");
  SquareRuns runs;
  while (table.next()) {
    const std::string_view sense = table.field(direction);
    if (sense != "cw" && sense != "ccw") {
      table.fail("direction is \"" + std::string(sense) + "\", expected cw or ccw");
    }
    const double ahead = coordinate(table, x, "x", longest);
    const double left = coordinate(table, y, "y", longest);
    (sense == "cw" ? runs.cw : runs.ccw).push_back({ahead, left});
  }
  for (const auto& [name, sample] : {std::pair("cw", &runs.cw), std::pair("ccw", &runs.ccw)}) {
    if (sample->size() >= 2) continue;
    throw InputError(file.string(), 0,
                     runs_text(sample->size(), std::string(" in direction ") + name));
  }
  return runs;
}

EndErrors read_end_errors(const std::filesystem::path& file, double longest) {
  const std::string text = read_file(file);
  CsvReader table(text, file.string());
  const int x = table.require("x");
  const int y = table.require("y");
  const int heading = table.require("heading");
  EndErrors errors;
  while (table.next()) {
    errors.push_back({coordinate(table, x, "x", longest), coordinate(table, y, "y", longest),
                      wrap_angle(table.number(heading))});
  }
  const auto equals_first = [&errors](const Eigen::Vector3d& e) { return e == errors.front(); };
  if (errors.size() >= 2 && std::all_of(errors.begin(), errors.end(), equals_first)) {
    throw InputError(file.string(), 0,
                     "all runs ended with the same errors, expected scatter to learn from");
  }
  if (errors.size() < 2) throw InputError(file.string(), 0, runs_text(errors.size(), ""));
  return errors;
}

std::string format_square_runs(const SquareRuns& runs) {
  std::string text = "direction,x,y\n";
  for (const auto& [name, sample] : {std::pair("cw", &runs.cw), std::pair("ccw", &runs.ccw)}) {
    for (const Eigen::Vector2d& e : *sample) {
      text += std::string(name) + "," + csv_number(e.x()) + "," + csv_number(e.y()) + "\n";
    }
  }
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
