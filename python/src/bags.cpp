// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// read_bag, inspect_bag.
#include "calls.hpp"
#include "docs.hpp"
#include "parts.hpp"
#include "trussmap/log_files.hpp"

#include <memory>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <utility>
#include <variant>
#include <vector>

namespace trussmap::python {
namespace {

namespace fs = std::filesystem;

/// A bag as a recording, with the model that its map states.
struct ReadBag {
  std::shared_ptr<Recording> recording;
  Model model;
  std::string epoch;
  std::vector<std::pair<std::size_t, std::string>> counts;
  std::vector<std::string> warnings;
};

/// A path, or several.
using Logs = std::variant<fs::path, std::vector<fs::path>>;

std::vector<fs::path> listed(const Logs& logs) {
  if (const auto* one = std::get_if<fs::path>(&logs)) return {*one};
  return std::get<std::vector<fs::path>>(logs);
}

ReadBag read_bag(const Logs& log, const fs::path& map, const std::vector<fs::path>& definitions) {
  return unlocked([&] {
    LogRecording read = read_log_recording(listed(log), map, {definitions});
    ReadBag result{std::make_shared<Recording>(std::move(read.recording)),
                   std::move(read.model),
                   std::move(read.epoch),
                   {},
                   std::move(read.warnings)};
    for (LogCount& one : read.counts) result.counts.emplace_back(one.number, std::move(one.what));
    return result;
  });
}

}  // namespace

void add_bags(py::module_& module) {
  py::class_<ReadBag>(module, "Bag", "A bag or log as a recording, with the model of its map.toml.")
      .def_property_readonly(
          "recording", [](const ReadBag& self) { return self.recording; }, "The recording.")
      .def_property_readonly(
          "model", [](const ReadBag& self) { return self.model; }, doc("LogRecording.model"))
      .def_readonly("epoch", &ReadBag::epoch, doc("LogRecording.epoch"))
      .def_readonly("counts", &ReadBag::counts, doc("LogRecording.counts"))
      .def_readonly("warnings", &ReadBag::warnings, doc("LogRecording.warnings"))
      .def("__repr__", [](const ReadBag& self) {
        return "<trussmap.Bag of " + std::string(py::repr(py::cast(self.recording))) + ">";
      });
  module.def(
      "read_bag", read_bag, py::arg("log"), py::arg("map"), py::kw_only(),
      py::arg("definitions") = std::vector<fs::path>(),
      doc("A bag (MCAP, rosbag2, ROS 1), a WPILib or Road Runner log or a table, or several that "
          "belong together, read as their map.toml says (docs/logs.md).",
          "read_log_recording")
          .c_str());
  module.def(
      "inspect_bag",
      [](const Logs& log, const std::vector<fs::path>& definitions) {
        return unlocked([&] { return inspect_logs(listed(log), {definitions}).map; });
      },
      py::arg("log"), py::kw_only(), py::arg("definitions") = std::vector<fs::path>(),
      "A first map.toml for a bag, or for several logs that belong together, whose guesses are to "
      "be read once.");
}

}  // namespace trussmap::python
