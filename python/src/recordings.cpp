// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recording: from columns, folders and bags, and its columns as arrays.
#include "arrays.hpp"
#include "calls.hpp"
#include "docs.hpp"
#include "inputs.hpp"
#include "parts.hpp"
#include "trussmap/log_files.hpp"
#include "trussmap/recording_files.hpp"

#include <algorithm>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <set>
#include <utility>

namespace trussmap::python {
namespace {

namespace fs = std::filesystem;

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

const Recording& held(const py::object& self) {
  return self.cast<const Recording&>();
}

template <typename Row>
py::list landmarks_of(const std::vector<Row>& rows) {
  py::list names;
  for (const Row& row : rows) names.append(row.landmark);
  return names;
}

py::dict drive_columns(const py::object& self) {
  const Drive& drive = held(self).drive;
  py::dict columns;
  const auto add = [&](const char* name, const std::vector<double>& column) {
    if (!column.empty()) columns[name] = view(column, self);
  };
  add("t", drive.t);
  add("left", drive.left);
  add("right", drive.right);
  add("heading", drive.heading);
  add("yaw_rate", drive.yaw_rate);
  for (const Covariate& one : drive.covariates) columns[one.name.c_str()] = view(one.values, self);
  return columns;
}

py::dict sighting_columns(const py::object& self) {
  const std::vector<Sighting>& rows = held(self).sightings;
  py::dict columns;
  columns["t"] = view(rows, &Sighting::t, self);
  columns["landmark"] = landmarks_of(rows);
  columns["range"] = view(rows, &Sighting::range, self);
  columns["bearing"] = view(rows, &Sighting::bearing, self);
  columns["yaw"] = view(rows, &Sighting::yaw, self);
  columns["dx"] = view(rows, &Sighting::dx, self);
  columns["dy"] = view(rows, &Sighting::dy, self);
  return columns;
}

py::dict fix_columns(const py::object& self) {
  const std::vector<Fix>& rows = held(self).fixes;
  py::dict columns;
  columns["t"] = view(rows, &Fix::t, self);
  columns["x"] = view(rows, &Fix::x, self);
  columns["y"] = view(rows, &Fix::y, self);
  columns["sd"] = view(rows, &Fix::sd, self);
  columns["quality"] = view(rows, &Fix::quality, self);
  return columns;
}

py::dict loop_columns(const py::object& self) {
  const std::vector<Loop>& rows = held(self).loops;
  py::dict columns;
  columns["t"] = view(rows, &Loop::t, self);
  columns["t2"] = view(rows, &Loop::t2, self);
  columns["dx"] = view(rows, &Loop::dx, self);
  columns["dy"] = view(rows, &Loop::dy, self);
  columns["dtheta"] = view(rows, &Loop::dtheta, self);
  columns["sd"] = view(rows, &Loop::sd, self);
  columns["sd_heading"] = view(rows, &Loop::sd_heading, self);
  return columns;
}

py::dict survey_columns(const py::object& self) {
  const std::vector<SurveyPoint>& rows = held(self).survey;
  py::dict columns;
  columns["landmark"] = landmarks_of(rows);
  columns["x"] = view(rows, &SurveyPoint::x, self);
  columns["y"] = view(rows, &SurveyPoint::y, self);
  columns["sd"] = view(rows, &SurveyPoint::sd, self);
  columns["heading"] = view(rows, &SurveyPoint::heading, self);
  return columns;
}

py::dict truth_columns(const py::object& self) {
  const std::vector<TruthRow>& rows = held(self).truth;
  py::dict columns;
  columns["t"] = view(rows, &TruthRow::t, self);
  columns["x"] = view(rows, &TruthRow::x, self);
  columns["y"] = view(rows, &TruthRow::y, self);
  columns["heading"] = view(rows, &TruthRow::heading, self);
  return columns;
}

/// None where there is no such column.
template <std::vector<double> Drive::*kColumn>
py::object drive_column(const py::object& self) {
  const std::vector<double>& column = held(self).drive.*kColumn;
  return column.empty() ? py::object(py::none()) : view(column, self);
}

std::string repr(const Recording& self) {
  std::string text =
      "<trussmap.Recording \"" + self.name + "\": " + std::to_string(self.drive.rows()) + " rows";
  const auto add = [&text](std::size_t count, const char* what) {
    if (count > 0) text += ", " + std::to_string(count) + " " + what;
  };
  add(self.sightings.size(), "sightings");
  add(self.fixes.size(), "fixes");
  add(self.loops.size(), "loops");
  add(self.survey.size(), "surveyed landmarks");
  add(self.truth.size(), "truth rows");
  return text + ">";
}

std::shared_ptr<Recording> read_folder(const fs::path& folder) {
  return unlocked([&] { return std::make_shared<Recording>(read_recording(folder)); });
}

/// A bag as a recording, with the model that its map states.
struct ReadBag {
  std::shared_ptr<Recording> recording;
  Model model;
  std::string epoch;
  std::vector<std::pair<std::size_t, std::string>> counts;
  std::vector<std::string> warnings;
};

ReadBag read_bag(const fs::path& log, const fs::path& map) {
  return unlocked([&] {
    LogRecording read = read_log_recording(log, map);
    ReadBag result{std::make_shared<Recording>(std::move(read.recording)),
                   std::move(read.model),
                   std::move(read.epoch),
                   {},
                   std::move(read.warnings)};
    for (LogCount& one : read.counts) result.counts.emplace_back(one.number, std::move(one.what));
    return result;
  });
}

void add_bags(py::module_& module) {
  py::class_<ReadBag>(module, "Bag", "A bag or log as a recording, with the model of its map.toml.")
      .def_property_readonly(
          "recording", [](const ReadBag& self) { return self.recording; }, "The recording.")
      .def_property_readonly(
          "model", [](const ReadBag& self) { return self.model; }, doc("LogRecording.model"))
      .def_readonly("epoch", &ReadBag::epoch, doc("LogRecording.epoch"))
      .def_readonly("counts", &ReadBag::counts, doc("LogRecording.counts"))
      .def_readonly("warnings", &ReadBag::warnings, doc("LogRecording.warnings"))
      .def("__repr__",
           [](const ReadBag& self) { return "<trussmap.Bag of " + repr(*self.recording) + ">"; });
  module.def("read_bag", read_bag, py::arg("log"), py::arg("map"),
             doc("A bag (MCAP, rosbag2), a WPILib or Road Runner log or a table, read as its "
                 "map.toml says (docs/logs.md).",
                 "read_log_recording")
                 .c_str());
  module.def(
      "inspect_bag",
      [](const fs::path& log) { return unlocked([&] { return inspect_log(log).map; }); },
      py::arg("log"), "A first map.toml for a bag, whose guesses are to be read once.");
}

}  // namespace

void add_recordings(py::module_& module) {
  py::class_<Recording, std::shared_ptr<Recording>> type(
      module, "Recording",
      "What a robot recorded, and nothing of it changes any more.\n\n"
      "Recording(drive, sightings=None, ...) takes tables of columns: dicts of arrays, data frames "
      "or arrays of records, with the columns of the files (docs/formats.md):\n\n"
      "  drive      t [s], left, right [m]; heading [rad], yaw_rate [rad/s], covariates\n"
      "  sightings  t [s], landmark; range [m], bearing, yaw [rad], dx, dy [m]\n"
      "  fixes      t [s], x, y [m]; sd [m], quality\n"
      "  loops      t, t2 [s], dx, dy [m], dtheta [rad]; sd [m], sd_heading [rad]\n"
      "  survey     landmark, x, y [m]; sd [m], heading [rad]\n"
      "  truth      t [s], x, y [m], heading [rad]\n\n"
      "Absent values are NaN. Columns are copied once; they come back as arrays that cannot be "
      "written, without a copy. Each call that uses a recording checks it (ValueError).");
  type.def(py::init(&recording_of), py::arg("drive"), py::arg("sightings") = py::none(),
           py::kw_only(), py::arg("fixes") = py::none(), py::arg("loops") = py::none(),
           py::arg("survey") = py::none(), py::arg("truth") = py::none(),
           py::arg("name") = "recording")
      .def_static("read", read_folder, py::arg("folder"), doc("read_recording"))
      .def_static(
          "from_bag",
          [](const fs::path& log, const fs::path& map) { return read_bag(log, map).recording; },
          py::arg("log"), py::arg("map"), "The recording of read_bag(log, map).")
      .def(
          "write",
          [](const Recording& self, const fs::path& folder) {
            unlocked([&] { write_recording(folder, self); });
          },
          py::arg("folder"), doc("write_recording"))
      .def_readonly("name", &Recording::name, doc("Recording.name"))
      .def("__len__", [](const Recording& self) { return self.drive.rows(); })
      .def_property_readonly("t", drive_column<&Drive::t>, doc("Drive.t"))
      .def_property_readonly("left", drive_column<&Drive::left>, doc("Drive.left"))
      .def_property_readonly("right", drive_column<&Drive::right>, doc("Drive.right"))
      .def_property_readonly("heading", drive_column<&Drive::heading>, doc("Drive.heading"))
      .def_property_readonly("yaw_rate", drive_column<&Drive::yaw_rate>, doc("Drive.yaw_rate"))
      .def_property_readonly("drive", drive_columns,
                             "Columns by name, as pandas.DataFrame takes them.")
      .def_property_readonly("sightings", sighting_columns, "Columns by name; NaN: absent.")
      .def_property_readonly("fixes", fix_columns, "Columns by name; NaN: absent.")
      .def_property_readonly("loops", loop_columns, "Columns by name; NaN: absent.")
      .def_property_readonly("survey", survey_columns, "Columns by name; NaN: absent.")
      .def_property_readonly("truth", truth_columns, "Columns by name.")
      .def_property_readonly(
          "fingerprint", [](const Recording& self) { return fingerprint(self); },
          doc("fingerprint"))
      .def("__repr__", repr);
  add_bags(module);
}

}  // namespace trussmap::python
