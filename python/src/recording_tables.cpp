// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "recording_tables.hpp"

#include "arrays.hpp"
#include "trussmap/recording_files.hpp"

#include <algorithm>
#include <pybind11/stl.h>
#include <set>
#include <utility>
#include <vector>

namespace trussmap::python {
namespace {

/// A table of named columns: a dict of arrays, a data frame, an array of records.
class Frame {
 public:
  Frame(py::object table, const char* what) : table_(std::move(table)), what_(what) {
    if (py::hasattr(table_, "dtype") && !table_.attr("dtype").attr("names").is_none()) {
      names_ = py::list(table_.attr("dtype").attr("names")).cast<std::vector<std::string>>();
    } else if (py::hasattr(table_, "keys")) {
      for (const py::handle name : table_.attr("keys")()) {
        names_.push_back(py::str(name).cast<std::string>());
      }
    } else {
      throw py::type_error(what_ + ": expected a dict of columns or a data frame");
    }
  }

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] bool has(const std::string& name) const {
    return std::find(names_.begin(), names_.end(), name) != names_.end();
  }
  [[nodiscard]] py::object column(const std::string& name) const {
    if (!has(name)) throw py::value_error(what_ + ": column " + name + " is missing");
    return table_[py::str(name)];
  }
  [[nodiscard]] std::vector<double> numbers(const std::string& name) const {
    return python::numbers(column(name), name + " of " + what_);
  }

  /// Columns beyond these are refused, a misspelt one must not be ignored in silence.
  void expect(const std::vector<std::string>& known) const {
    for (const std::string& name : names_) {
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      std::string expected;
      for (const std::string& one : known) expected += (expected.empty() ? "" : ",") + one;
      throw py::value_error(what_ + ": column \"" + name + "\" is unknown, expected " + expected);
    }
  }

  /// How many rows all columns have.
  [[nodiscard]] std::size_t rows() const {
    return names_.empty() ? 0 : py::len(column(names_.front()));
  }

  /// Sets a member of each row, where there is such a column.
  template <typename Row>
  void read(const char* name, double Row::*member, std::vector<Row>& rows, bool must) const {
    if (!must && !has(name)) return;
    const std::vector<double> values = numbers(name);
    if (values.size() != rows.size()) {
      throw py::value_error(what_ + ": column " + name + " has " + std::to_string(values.size()) +
                            " rows, expected " + std::to_string(rows.size()));
    }
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k].*member = values[k];
  }

  /// Names of landmarks; numbers become texts.
  template <typename Row>
  void read_landmarks(std::vector<Row>& rows) const {
    std::size_t k = 0;
    for (const py::handle one : py::iter(column("landmark"))) {
      if (k >= rows.size()) break;
      rows[k].landmark = py::str(one).cast<std::string>();
      if (rows[k].landmark.empty()) {
        throw py::value_error(what_ + ": a landmark's name is empty in row " + std::to_string(k));
      }
      ++k;
    }
    if (k < rows.size()) {
      throw py::value_error(what_ + ": column landmark has " + std::to_string(k) +
                            " rows, expected " + std::to_string(rows.size()));
    }
  }

 private:
  py::object table_;
  std::string what_;
  std::vector<std::string> names_;
};

Drive drive_of(const Frame& frame) {
  Drive drive;
  drive.t = frame.numbers("t");
  if (frame.has("left") || frame.has("right")) {
    drive.left = frame.numbers("left");
    drive.right = frame.numbers("right");
  }
  if (frame.has("heading")) drive.heading = frame.numbers("heading");
  if (frame.has("yaw_rate")) drive.yaw_rate = frame.numbers("yaw_rate");
  static const std::set<std::string> kKnown{"t", "left", "right", "heading", "yaw_rate"};
  for (const std::string& name : frame.names()) {
    if (kKnown.contains(name)) continue;
    if (!is_covariate_name(name)) {
      throw py::value_error("drive: column \"" + name +
                            "\" cannot be a covariate, expected a name of letters, digits and _ "
                            "that no variable of shapes has");
    }
    drive.covariates.push_back({name, frame.numbers(name)});
  }
  for (const std::string& name : frame.names()) {
    const std::size_t rows = py::len(frame.column(name));
    if (rows == drive.rows()) continue;
    throw py::value_error("drive: column " + name + " has " + std::to_string(rows) +
                          " rows, expected " + std::to_string(drive.rows()) + " as t has");
  }
  if (drive.rows() < 2) throw py::value_error("drive: expected two rows at least");
  return drive;
}

std::vector<Sighting> sightings_of(const Frame& frame) {
  frame.expect({"t", "landmark", "range", "bearing", "yaw", "dx", "dy"});
  std::vector<Sighting> rows(frame.rows());
  frame.read("t", &Sighting::t, rows, true);
  frame.read_landmarks(rows);
  frame.read("range", &Sighting::range, rows, false);
  frame.read("bearing", &Sighting::bearing, rows, false);
  frame.read("yaw", &Sighting::yaw, rows, false);
  frame.read("dx", &Sighting::dx, rows, false);
  frame.read("dy", &Sighting::dy, rows, false);
  return rows;
}

std::vector<Fix> fixes_of(const Frame& frame) {
  frame.expect({"t", "x", "y", "sd", "quality"});
  std::vector<Fix> rows(frame.rows());
  frame.read("t", &Fix::t, rows, true);
  frame.read("x", &Fix::x, rows, true);
  frame.read("y", &Fix::y, rows, true);
  frame.read("sd", &Fix::sd, rows, false);
  frame.read("quality", &Fix::quality, rows, false);
  return rows;
}

std::vector<Loop> loops_of(const Frame& frame) {
  frame.expect({"t", "t2", "dx", "dy", "dtheta", "sd", "sd_heading"});
  std::vector<Loop> rows(frame.rows());
  frame.read("t", &Loop::t, rows, true);
  frame.read("t2", &Loop::t2, rows, true);
  frame.read("dx", &Loop::dx, rows, true);
  frame.read("dy", &Loop::dy, rows, true);
  frame.read("dtheta", &Loop::dtheta, rows, true);
  frame.read("sd", &Loop::sd, rows, false);
  frame.read("sd_heading", &Loop::sd_heading, rows, false);
  return rows;
}

std::vector<SurveyPoint> survey_of(const Frame& frame) {
  frame.expect({"landmark", "x", "y", "sd", "heading"});
  std::vector<SurveyPoint> rows(frame.rows());
  frame.read_landmarks(rows);
  frame.read("x", &SurveyPoint::x, rows, true);
  frame.read("y", &SurveyPoint::y, rows, true);
  frame.read("sd", &SurveyPoint::sd, rows, false);
  frame.read("heading", &SurveyPoint::heading, rows, false);
  return rows;
}

std::vector<TruthRow> truth_of(const Frame& frame) {
  frame.expect({"t", "x", "y", "heading"});
  std::vector<TruthRow> rows(frame.rows());
  frame.read("t", &TruthRow::t, rows, true);
  frame.read("x", &TruthRow::x, rows, true);
  frame.read("y", &TruthRow::y, rows, true);
  frame.read("heading", &TruthRow::heading, rows, true);
  return rows;
}

}  // namespace

std::shared_ptr<Recording> recording_of(const py::object& drive, const py::object& sightings,
                                        const py::object& fixes, const py::object& loops,
                                        const py::object& survey, const py::object& truth,
                                        const std::string& name) {
  auto recording = std::make_shared<Recording>();
  recording->name = name;
  recording->drive = drive_of(Frame(drive, "drive"));
  if (!sightings.is_none()) recording->sightings = sightings_of(Frame(sightings, "sightings"));
  if (!fixes.is_none()) recording->fixes = fixes_of(Frame(fixes, "fixes"));
  if (!loops.is_none()) recording->loops = loops_of(Frame(loops, "loops"));
  if (!survey.is_none()) recording->survey = survey_of(Frame(survey, "survey"));
  if (!truth.is_none()) recording->truth = truth_of(Frame(truth, "truth"));
  return recording;
}

}  // namespace trussmap::python
