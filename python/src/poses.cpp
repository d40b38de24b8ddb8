// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// apply: where the robot was, by a model.
#include "arrays.hpp"
#include "calls.hpp"
#include "docs.hpp"
#include "inputs.hpp"
#include "parts.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"
#include "trussmap/write_files.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <utility>

namespace trussmap::python {
namespace {

struct Poses {
  std::vector<TimedPose> rows;
  bool adjusted = false;
  std::vector<std::string> warnings;
  std::vector<std::string> left_out;
  Noise noise;
};

Poses run_apply(const py::object& recording, const py::object& model, bool adjusted,
                const std::vector<std::string>& without, double gate, const py::object& progress) {
  const Given given = python::given(recording, model);
  if (given.held.size() != 1) throw py::value_error("recording: expected one");
  const LegOptions legs;
  const SessionOptions use =
      use_options(without, gate, 0.0, legs.share, legs.min_drive, legs.leg, kSignificance);
  std::vector<Stage> steps{{"reading", 1}, {"reckoning", 1}};
  if (adjusted) steps = {{"reading", 1}, {"fitting", 10}};
  CallProgress told(progress, steps);
  Poses result;
  result.adjusted = adjusted;
  std::vector<std::string> mistakes;
  unlocked([&] {
    told.next();
    Prepared input = prepared(given, use);
    mistakes = input.mistakes;
    result.noise = input.model().noise;
    result.warnings = unfitted_in_words(input.model());
    told.next();
    if (!adjusted) {
      result.rows = dead_reckoned_poses(input.recordings().front(), input.model());
      return;
    }
    FitOptions how = use.fit;
    how.fit_effects = false;
    const ModelFit fit = fit_model(input.recordings(), input.model(), how);
    result.warnings.insert(result.warnings.end(), fit.warnings.begin(), fit.warnings.end());
    result.left_out = fit.left_out;
    result.rows = adjusted_poses(fit);
  });
  warn(mistakes);
  told.end();
  return result;
}

std::string text(const Poses& self) {
  std::string text;
  for (const std::string& one : self.warnings) text += warning_text(one, TextStyle::plain);
  for (const std::string& one : self.left_out) text += "left out: " + one + "\n";
  text += poses_text(self.rows, self.adjusted);
  if (!self.adjusted) text += lasting_noise_text(self.noise);
  return for_print(text);
}

const Poses& held(const py::object& self) {
  return self.cast<const Poses&>();
}

/// A view of a number that every pose has at the same place.
template <typename Get>
py::array column(const py::object& self, const Get& get) {
  const std::vector<TimedPose>& rows = held(self).rows;
  return view(&get(rows.front()), {static_cast<py::ssize_t>(rows.size())},
              {static_cast<py::ssize_t>(sizeof(TimedPose))}, self);
}

py::array covariances(const py::object& self) {
  const std::vector<TimedPose>& rows = held(self).rows;
  const Matrix3& first = rows.front().estimate.covariance;
  constexpr auto kNumber = static_cast<py::ssize_t>(sizeof(double));
  return view(first.data(), {static_cast<py::ssize_t>(rows.size()), 3, 3},
              {static_cast<py::ssize_t>(sizeof(TimedPose)), kNumber, 3 * kNumber}, self);
}

py::list table(const Poses& self) {
  py::list rows;
  for (const TimedPose& one : self.rows) {
    const Matrix3& c = one.estimate.covariance;
    py::dict row;
    row["t"] = one.t;
    row["x"] = one.estimate.pose.x;
    row["y"] = one.estimate.pose.y;
    row["heading"] = one.estimate.pose.heading;
    row["c_xx"] = c(0, 0);
    row["c_xy"] = c(0, 1);
    row["c_xh"] = c(0, 2);
    row["c_yy"] = c(1, 1);
    row["c_yh"] = c(1, 2);
    row["c_hh"] = c(2, 2);
    rows.append(row);
  }
  return rows;
}

void write(const Poses& self, const std::filesystem::path& file, const std::string& format) {
  unlocked([&] {
    if (format == "csv") return write_file(file, format_poses(self.rows));
    if (format == "tum") return write_file(file, format_tum(self.rows));
    if (format == "kitti") return write_file(file, format_kitti(self.rows));
    throw std::invalid_argument("format: \"" + format + "\": expected csv, tum or kitti");
  });
}

}  // namespace

void add_poses(py::module_& module) {
  py::class_<Poses>(module, "Poses",
                    "Where the robot was: at the start of the drive and at the end of every row. "
                    "Columns are arrays that cannot be written, without a copy.")
      .def("__len__", [](const Poses& self) { return self.rows.size(); })
      .def_readonly("adjusted", &Poses::adjusted, "Else dead reckoned.")
      .def_property_readonly(
          "t",
          [](const py::object& self) {
            return column(self, [](const TimedPose& one) -> const double& { return one.t; });
          },
          "s.")
      .def_property_readonly(
          "x",
          [](const py::object& self) {
            return column(
                self, [](const TimedPose& one) -> const double& { return one.estimate.pose.x; });
          },
          "m.")
      .def_property_readonly(
          "y",
          [](const py::object& self) {
            return column(
                self, [](const TimedPose& one) -> const double& { return one.estimate.pose.y; });
          },
          "m.")
      .def_property_readonly(
          "heading",
          [](const py::object& self) {
            return column(self, [](const TimedPose& one) -> const double& {
              return one.estimate.pose.heading;
            });
          },
          "rad, not wrapped: it goes on from row to row.")
      .def_property_readonly("covariance", covariances, "Of (x, y, heading), n x 3 x 3; m, rad.")
      .def_readonly("left_out", &Poses::left_out, doc("ModelFit.left_out"))
      .def_readonly("warnings", &Poses::warnings, "In words.")
      .def("table", table, "A list of dicts.")
      .def("write", write, py::arg("file"), py::arg("format") = "csv",
           "Writes them as csv (t, pose, covariances), tum or kitti.")
      .def("__str__", text)
      .def("__repr__", [](const Poses& self) {
        return "<trussmap.Poses: " + std::to_string(self.rows.size()) + ", " +
               (self.adjusted ? "adjusted" : "dead reckoned") + ">";
      });
  module.def("apply", run_apply, py::arg("recording"), py::arg("model"), py::kw_only(),
             py::arg("adjusted") = false, py::arg("without") = std::vector<std::string>(),
             py::arg("gate") = kAdjustmentGate, py::arg("progress") = py::none(),
             "Where the robot was, by a model: dead reckoned by the wheels, the compass and the "
             "model's effects from (0, 0, 0), or adjusted to everything that was measured, in the "
             "map's frame.");
}

}  // namespace trussmap::python
