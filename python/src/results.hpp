// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What every result has that a command prints and draws a page of.
#pragma once

#include "calls.hpp"
#include "fields.hpp"
#include "inputs.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/write_files.hpp"

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>
#include <string>

namespace trussmap::python {

/// Made when it is first asked for and then kept; copies share it, threads may ask at once. What a
/// page draws costs about as much as the result itself.
template <typename Value>
class Lazy {
 public:
  template <typename Make>
  [[nodiscard]] const Value& get(Make&& make) const {
    const std::scoped_lock lock(kept_->mutex);
    if (!kept_->value) kept_->value = make();
    return *kept_->value;
  }

 private:
  struct Kept {
    std::mutex mutex;
    std::optional<Value> value;
  };
  std::shared_ptr<Kept> kept_ = std::make_shared<Kept>();
};

/// print, the section in notebooks, the page as a file, its charts. `text` is the command's,
/// `page` touches no Python.
template <typename Result>
void show(py::class_<Result>& type, std::string (*text)(const Result&),
          Page (*page)(const Result&)) {
  type.def("__str__", [text](const Result& self) { return for_print(text(self)); })
      .def("_repr_html_",
           [page](const Result& self) {
             return unlocked([&] { return render_section(page(self)); });
           })
      .def(
          "write_html",
          [page](const Result& self, const std::filesystem::path& file) {
            unlocked([&] { write_file(file, render_plain_page(page(self))); });
          },
          py::arg("file"),
          "Writes what a notebook shows as a page of its own, one file, the charts as pictures. "
          "The command's --html has charts that can be zoomed.")
      .def(
          "charts",
          [page](const Result& self) {
            py::dict charts;
            for (const DrawnChart& one : unlocked([&] { return draw_charts(page(self)); })) {
              charts[py::str(one.id)] = one.svg;
            }
            return charts;
          },
          "The page's charts by name, as SVG files' text.");
}

/// Constants to paste. `constants` touches no Python.
template <typename Result>
void show_constants(py::class_<Result>& type, RobotConstants (*constants)(const Result&)) {
  type.def_property_readonly(
      "robot_constants",
      [constants](const Result& self) {
        return to_python(unlocked([&] { return constants(self); }).list);
      },
      "Constants to paste into the robot's software, a dict each: name, old, new, sd, unit, note.");
}

/// What helps on.
template <typename Result>
void show_next(py::class_<Result>& type, std::optional<NextCommand> (*next)(const Result&)) {
  type.def_property_readonly(
      "next_command",
      [next](const Result& self) -> py::object {
        const std::optional<NextCommand> one = next(self);
        if (!one) return py::none();
        std::string command(one->command);
        if (!one->options.empty()) command += " " + std::string(one->options);
        return py::make_tuple(std::move(command), std::string(one->what_for));
      },
      "What helps on, and what it does: (\"discover\", \"adds what is missing, and what shows "
      "behind it\"); None where a look at the floor, or at what happened, does.");
}

}  // namespace trussmap::python
