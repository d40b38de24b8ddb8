// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recording: from tables, folders and bags, and its columns as arrays.
#include "arrays.hpp"
#include "calls.hpp"
#include "docs.hpp"
#include "parts.hpp"
#include "recording_tables.hpp"
#include "trussmap/log_files.hpp"
#include "trussmap/recording_files.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <utility>

namespace trussmap::python {
namespace {

namespace fs = std::filesystem;

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
template <auto kColumn>
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
          [](const fs::path& log, const fs::path& map) {
            return unlocked([&] {
              return std::make_shared<Recording>(read_log_recording(log, map).recording);
            });
          },
          py::arg("log"), py::arg("map"), "The recording of read_bag(log, map).")
      .def(
          "write",
          [](const Recording& self, const fs::path& folder) {
            unlocked([&] { write_recording(folder, self); });
          },
          py::arg("folder"), doc("write_recording"))
      .def_readonly("name", &Recording::name, doc("Observations.name"))
      .def("__len__", [](const Recording& self) { return self.drive.rows(); })
      .def_property_readonly("t", drive_column<&Drive::t>, doc("DriveColumns.t"))
      .def_property_readonly("left", drive_column<&Drive::left>, doc("Drive.left"))
      .def_property_readonly("right", drive_column<&Drive::right>, doc("Drive.right"))
      .def_property_readonly("heading", drive_column<&Drive::heading>, doc("DriveColumns.heading"))
      .def_property_readonly("yaw_rate", drive_column<&Drive::yaw_rate>,
                             doc("DriveColumns.yaw_rate"))
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
}

}  // namespace trussmap::python
