// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/csv.hpp"
#include "io/run_rows.hpp"
#include "trussmap/error.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/write_files.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace trussmap {
using namespace io;

namespace {

Faces faces_of(const CsvReader& table, int column) {
  const std::string_view text = table.field(column);
  if (text == "ahead") return Faces::ahead;
  if (text == "left") return Faces::left;
  if (text == "behind") return Faces::behind;
  if (text == "right") return Faces::right;
  table.fail("faces is " + shown_field(text) + ", expected ahead, left, behind or right");
}

/// The columns of a run that starts and ends in a corner.
class WallColumns {
 public:
  explicit WallColumns(const CsvReader& table)
      : x_(table.require("odometry_x")),
        y_(table.require("odometry_y")),
        heading_(table.require("odometry_heading")) {
    for (std::size_t k = 0; k < 3; ++k) {
      start_[k] = table.require(fmt::format("start{}", k + 1));
      end_[k] = table.require(fmt::format("end{}", k + 1));
    }
  }

  [[nodiscard]] WallError error(const CsvReader& table, const WallSensors& sensors,
                                double longest) const {
    WallRun run;
    for (std::size_t k = 0; k < 3; ++k) {
      run.start[k] = distance(table, start_[k], fmt::format("start{}", k + 1));
      run.end[k] = distance(table, end_[k], fmt::format("end{}", k + 1));
    }
    run.odometry = {table.number(x_), table.number(y_), table.number(heading_)};
    WallError result;
    try {
      result = end_error(sensors, run);
    } catch (const std::invalid_argument& error) {
      table.fail(error.what());
    }
    require_shorter(table, "x of the end error", result.error.x(), longest);
    require_shorter(table, "y of the end error", result.error.y(), longest);
    return result;
  }

 private:
  static double distance(const CsvReader& table, int column, const std::string& name) {
    const double value = table.number(column);
    if (!(value > 0.0)) {
      table.fail(fmt::format("{} is {:g}, expected a distance above 0 m", name, value));
    }
    return value;
  }

  int x_;
  int y_;
  int heading_;
  std::array<int, 3> start_ = {};
  std::array<int, 3> end_ = {};
};

}  // namespace

WallSensors read_wall_sensors(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  CsvReader table(text, file.string(), CsvForm::by_hand);
  const int faces = table.require("faces");
  const int x = table.require("x");
  const int y = table.require("y");
  const int sd = table.find("sd");
  WallSensors sensors;
  std::size_t count = 0;
  while (table.next()) {
    if (count < sensors.size()) {
      sensors[count] = {faces_of(table, faces),
                        {table.number(x), table.number(y)},
                        sd < 0 ? 0.0 : table.number(sd)};
      if (sensors[count].sd < 0.0) table.fail("sd is below 0, expected metres");
    }
    ++count;
  }
  if (count != sensors.size()) {
    throw InputError(file.string(), 0,
                     fmt::format("{} sensors, expected three: two that face one wall, and one "
                                 "that faces a wall at right angles to it",
                                 count));
  }
  try {
    check_wall_sensors(sensors);
  } catch (const std::invalid_argument& error) {
    throw InputError(file.string(), 0, error.what());
  }
  return sensors;
}

SquareRuns read_square_wall_runs(const std::filesystem::path& file, const WallSensors& sensors,
                                 double longest) {
  const std::string text = read_file(file);
  CsvReader table(text, file.string(), CsvForm::by_hand);
  const int direction = table.require("direction");
  const WallColumns columns(table);
  SquareRuns runs;
  while (table.next()) {
    const bool cw = turns_right(table, direction);
    const Eigen::Vector3d error = columns.error(table, sensors, longest).error;
    (cw ? runs.cw : runs.ccw).emplace_back(error.head<2>());
    (cw ? runs.cw_headings : runs.ccw_headings).push_back(error[2]);
  }
  require_both_ways(runs, file);
  return runs;
}

MeasuredEnds read_wall_end_errors(const std::filesystem::path& file, const WallSensors& sensors,
                                  double longest) {
  const std::string text = read_file(file);
  CsvReader table(text, file.string(), CsvForm::by_hand);
  const WallColumns columns(table);
  MeasuredEnds ends;
  while (table.next()) {
    const WallError one = columns.error(table, sensors, longest);
    ends.errors.push_back(one.error);
    ends.covariance += one.covariance;
  }
  require_scatter(ends.errors, file);
  ends.covariance /= static_cast<double>(ends.errors.size());
  return ends;
}

}  // namespace trussmap
