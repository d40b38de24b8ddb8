// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// adjust_pose_graph.
#include "arrays.hpp"
#include "calls.hpp"
#include "docs.hpp"
#include "inputs.hpp"
#include "parts.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/pose_graph.hpp"
#include "trussmap/texts.hpp"

#include <chrono>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <utility>

namespace trussmap::python {
namespace {

namespace fs = std::filesystem;

struct GraphResult {
  PoseGraph graph;
  PoseGraphAdjustment found;
  std::optional<std::vector<int>> left_out;  ///< places in pose_edges
  double seconds = 0.0;
};

StartFrom start_named(const std::string& name) {
  if (name == "best") return StartFrom::best;
  if (name == "file") return StartFrom::file;
  if (name == "odometry") return StartFrom::odometry;
  throw py::value_error("start: \"" + name + "\": expected best, file or odometry");
}

GraphResult run_adjust(const fs::path& graph, const std::string& start, bool robust, double gate,
                       const py::object& progress) {
  AdjustmentOptions how;
  how.start = start_named(start);
  if (!(gate > 0.0)) throw py::value_error("gate: expected more than 0");
  CallProgress told(progress, {{"reading", 20}, {"adjusting", 80}});
  GraphResult result;
  unlocked([&] {
    told.next();
    result.graph = read_g2o(graph.string());
    told.next();
    const auto begin = std::chrono::steady_clock::now();
    if (robust) {
      RobustAdjustment found = adjust_robustly(result.graph, {how, gate});
      result.found = std::move(found.adjustment);
      result.left_out = std::move(found.left_out);
    } else {
      result.found = adjust(result.graph, how);
    }
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  });
  told.end();
  return result;
}

const GraphResult& held(const py::object& self) {
  return self.cast<const GraphResult&>();
}

/// x, y, heading of all vertices: a view.
py::array estimates(const py::object& self) {
  const std::vector<Pose>& poses = held(self).found.estimates;
  static_assert(sizeof(Pose) == 3 * sizeof(double));
  static const double nothing = 0.0;
  return view(
      poses.empty() ? &nothing : &poses.front().x, {static_cast<py::ssize_t>(poses.size()), 3},
      {static_cast<py::ssize_t>(sizeof(Pose)), static_cast<py::ssize_t>(sizeof(double))}, self);
}

py::list table(const GraphResult& self) {
  py::list rows;
  for (std::size_t k = 0; k < self.graph.vertices.size(); ++k) {
    const Pose& at = self.found.estimates[k];
    py::dict row;
    row["id"] = self.graph.vertices[k].id;
    row["x"] = at.x;
    row["y"] = at.y;
    if (is_pose(self.graph.vertices[k])) row["heading"] = at.heading;
    rows.append(row);
  }
  return rows;
}

std::vector<std::pair<std::int64_t, std::int64_t>> left_out(const GraphResult& self) {
  std::vector<std::pair<std::int64_t, std::int64_t>> ids;
  if (!self.left_out) return ids;
  for (const int k : *self.left_out) {
    const PoseEdge& edge = self.graph.pose_edges.at(static_cast<std::size_t>(k));
    ids.emplace_back(self.graph.vertices.at(static_cast<std::size_t>(edge.from)).id,
                     self.graph.vertices.at(static_cast<std::size_t>(edge.to)).id);
  }
  return ids;
}

std::string text(const GraphResult& self) {
  const auto count = self.left_out ? std::optional(self.left_out->size()) : std::nullopt;
  return for_print(pose_graph_text(self.graph, self.found, count, self.seconds));
}

void write(const GraphResult& self, const fs::path& file) {
  PoseGraph graph = self.graph;
  for (std::size_t k = 0; k < graph.vertices.size(); ++k) {
    graph.vertices[k].estimate = self.found.estimates[k];
  }
  write_g2o(graph, file.string());
}

}  // namespace

void add_pose_graph(py::module_& module) {
  py::class_<GraphResult>(module, "PoseGraphFit", "The best fit of a pose graph.")
      .def_property_readonly("estimates", estimates,
                             "x, y [m], heading [rad] of all vertices, n x 3, without a copy; a "
                             "point's heading is 0.")
      .def_property_readonly(
          "ids",
          [](const GraphResult& self) {
            std::vector<std::int64_t> ids;
            for (const GraphVertex& one : self.graph.vertices) ids.push_back(one.id);
            return ids;
          },
          "Of the vertices, in the order of estimates.")
      .def_property_readonly(
          "chi2", [](const GraphResult& self) { return self.found.chi2; },
          doc("PoseGraphAdjustment.chi2"))
      .def_property_readonly(
          "dof", [](const GraphResult& self) { return self.found.dof; },
          doc("PoseGraphAdjustment.dof"))
      .def_property_readonly(
          "iterations", [](const GraphResult& self) { return self.found.iterations; },
          doc("PoseGraphAdjustment.iterations"))
      .def_property_readonly(
          "gradient_norm", [](const GraphResult& self) { return self.found.gradient_norm; },
          doc("PoseGraphAdjustment.gradient_norm"))
      .def_property_readonly(
          "converged", [](const GraphResult& self) { return self.found.converged; },
          "Whether a minimum was reached.")
      .def_property_readonly(
          "start", [](const GraphResult& self) { return self.found.start; },
          doc("PoseGraphAdjustment.start"))
      .def_property_readonly("left_out", left_out,
                             "Loop closures that a robust adjustment left out, by ids.")
      .def_property_readonly(
          "warnings", [](const GraphResult& self) { return self.found.warnings; }, "In words.")
      .def("table", table, "A list of dicts: id, x, y, heading.")
      .def("write", write, py::arg("file"), "Writes the adjusted graph as g2o.")
      .def("__str__", text)
      .def("__repr__", [](const GraphResult& self) {
        return "<trussmap.PoseGraphFit of " + std::to_string(self.graph.vertices.size()) +
               " vertices: chi2 " + std::to_string(self.found.chi2) + ">";
      });
  module.def("adjust_pose_graph", run_adjust, py::arg("graph"), py::kw_only(),
             py::arg("start") = "best", py::arg("robust") = false,
             py::arg("gate") = RobustOptions().gate, py::arg("progress") = py::none(),
             "The best fit of a pose graph (a file: g2o, TORO or iSAM, plain or .xz); `robust`: "
             "without loop closures that contradict the rest by more than `gate` (squared standard "
             "deviations).");
}

}  // namespace trussmap::python
