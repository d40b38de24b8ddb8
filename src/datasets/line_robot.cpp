// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A robot that drives to and fro on a line (Barfoot, "State Estimation for Robotics", 2017, data
// of the exercises: "dataset1") as a recording.
//
//   dataset1.csv   t [s], x_true [m], v [m/s] by the wheels, r [m]: range to a post by laser; a
//                  line of # at the top; plain or .xz
//
// A speed holds from its row's time until the next row's, and is both wheels'; the line is the x
// axis, the landmark "post" stands on it where the authors state it. Its ranges have no bearing,
// for none was measured.
#include "datasets/formats.hpp"
#include "datasets/nominal_wheelbase.hpp"
#include "datasets/number_rows.hpp"
#include "io/csv.hpp"
#include "io/recording_limits.hpp"
#include "trussmap/error.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace trussmap::datasets {
namespace {

namespace fs = std::filesystem;

// As the authors give them beside the columns.
constexpr double kPost = 4.42848;              // m, where it stands
constexpr double kRangeVariance = 3.6692e-4;   // m^2
constexpr double kSpeedVariance = 2.26134e-3;  // m^2/s^2, of a row

/// t, x_true, v, r
struct Row {
  double t;      ///< s
  double truth;  ///< m
  double speed;  ///< m/s
  double range;  ///< m
  std::size_t line;
};

std::vector<Row> rows_of(const fs::path& file) {
  std::vector<Row> rows;
  for (const NumberRow& one : read_number_rows(file, 4, kCommas)) {
    const Row row{one[0], one[1], one[2], one[3], one.line};
    if (!rows.empty() && !(row.t > rows.back().t)) {
      throw InputError(file.string(), row.line,
                       "time repeats or runs backwards at " + io::csv_number(row.t) +
                           ", expected rows in order of time");
    }
    if (!(row.range >= 0.0)) {
      throw InputError(
          file.string(), row.line,
          "a negative range at time " + io::csv_number(row.t) + ", expected 0 or more");
    }
    rows.push_back(row);
  }
  if (rows.size() < 3) {
    throw InputError(file.string(), 0, "has fewer than three rows, expected a drive");
  }
  return rows;
}

}  // namespace

bool is_line_robot(const fs::path& file) {
  return file.filename() == "dataset1.csv" || file.filename() == "dataset1.csv.xz";
}

Dataset read_line_robot(const fs::path& file) {
  const std::vector<Row> rows = rows_of(file);
  Dataset result;
  Recording& recording = result.recording;
  recording.name = file.string();
  recording.survey.push_back({"post", kPost, 0.0});
  Drive& drive = recording.drive;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const io::SourceLine source(recording.name, rows[k].line);
    recording.truth.push_back({rows[k].t, rows[k].truth, 0.0, 0.0});
    source.expect(recording.truth.back());
    if (k == 0) continue;
    const double travel = rows[k - 1].speed * (rows[k].t - rows[k - 1].t);
    drive.t.push_back(rows[k].t);
    drive.left.push_back(travel);
    drive.right.push_back(travel);
    recording.sightings.push_back({rows[k].t, "post", rows[k].range, kAbsent});
    source.expect_last_row(drive);
    source.expect(recording.sightings.back());
  }
  const double step = (rows.back().t - rows.front().t) / static_cast<double>(drive.rows());
  Model& model = result.model;
  model.robot.wheelbase = kNominalWheelbase;
  // An error of the same size in every row, whatever the wheels turn.
  model.noise.travel_per_s = std::sqrt(kSpeedVariance * step);
  model.noise.left = model.noise.right = 0.001;
  model.noise.range = std::sqrt(kRangeVariance);
  model.noise.truth = 0.001;
  model.noise.truth_heading = 0.001;
  result.comment = "a robot on a line, " + file.string();
  result.figures = {counted("rows", drive.rows(), "drive rows, as of a wheelbase of 1 m"),
                    counted("ranges", recording.sightings.size(), "ranges to the post"),
                    counted("truth", recording.truth.size(), "truth rows")};
  return result;
}

}  // namespace trussmap::datasets
