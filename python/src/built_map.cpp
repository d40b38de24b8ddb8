// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// build_map.
#include "arrays.hpp"
#include "calls.hpp"
#include "fits.hpp"
#include "maps.hpp"
#include "parts.hpp"
#include "results.hpp"
#include "results/maps.hpp"
#include "rows.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/check.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <cmath>
#include <pybind11/stl/filesystem.h>
#include <utility>

namespace trussmap::python {
namespace {

struct MapResult {
  BuiltMap built;
  bool several = false;
  std::string subject;
  std::vector<std::string> mistakes;
};

MapResult run_build_map(const py::object& recordings, const py::object& model,
                        const std::string& method, const py::object& eta, double min_drive,
                        std::optional<double> gate, const py::object& progress) {
  const Given given = python::given(recordings, model);
  BuildMapOptions options;
  options.method = method_named(method);
  options.scope = scope_of(eta, true);
  options.min_drive = min_drive;
  options.gate = gate;
  if (!(min_drive >= 0.0)) throw py::value_error("min_drive: expected 0 or more metres");
  if (gate && !(*gate > 0.0)) throw py::value_error("gate: expected more than 0");
  CallProgress told(progress, {{"reading", 30}, {"building the map", 70}});
  MapResult result;
  result.several = given.held.size() > 1;
  result.subject = subject_of(given) + ", method " + command_name(options.method);
  unlocked([&] {
    told.next();
    Read input = read(given);
    for (const CheckFinding& one :
         check_read_recordings(input.recordings, &input.model, input.model_name)) {
      result.mistakes.push_back(in_words(one));
    }
    told.next();
    result.built = build_map(input.recordings, input.model, options);
  });
  warn(result.mistakes);
  told.end();
  return result;
}

std::string text(const MapResult& self) {
  return map_text(self.built, command_name(self.built.method), self.several);
}

Page page(const MapResult& self) {
  return map_page(self.built, self.subject);
}

py::list table(const MapResult& self, const std::string& what) {
  if (what == "landmarks") return landmark_rows(self.built.map);
  if (what == "routes") return route_rows(self.built.map);
  if (what == "left out") return table_of(self.built.rejected);
  no_table(what, {"landmarks", "routes", "left out"});
}

/// n x 2 x 2; NaN where a landmark's is not known.
py::array covariances(const MapResult& self) {
  std::vector<Matrix2> result;
  for (int k = 0; k < self.built.map.landmarks(); ++k) {
    result.push_back(self.built.map.landmark(k).covariance.value_or(Matrix2::Constant(kAbsent)));
  }
  return array_of(result);
}

py::array points(const std::vector<Vector2>& path) {
  return array_of(path);
}

void add_rows(py::module_& module) {
  RowClass<RejectedSighting>(module, "RejectedSighting");
  RowClass<FreedError>(module, "FreedError")
      .value(
          "in_words", [](const FreedError& self) { return in_words(self.effect, self.sd); },
          "In a sentence.");
  RowClass<MapQuality>(module, "MapQuality");
  RowClass<BuiltPath>(module, "BuiltPath")
      .value("adjusted", [](const BuiltPath& self) { return points(self.adjusted); })
      .value("dead_reckoned", [](const BuiltPath& self) { return points(self.dead_reckoned); });
}

template <auto kMember>
auto get(const MapResult& self) {
  return self.built.*kMember;
}

template <auto kMember>
py::tuple list(const MapResult& self) {
  return py::tuple(py::cast(self.built.*kMember));
}

}  // namespace

void add_map(py::module_& module) {
  add_rows(module);
  py::class_<MapResult> type(module, "Map",
                             "A landmark map, what was left out of it and how good it is; of "
                             "recordings without landmarks, their paths.");
  show(type, text, page);
  type.def_property_readonly(
          "verdict", [](const MapResult& self) { return std::string(verdict_of(self.built)); },
          "good or doubtful.")
      .def_property_readonly(
          "good", [](const MapResult& self) { return self.built.good(); }, doc("BuiltMap.good"))
      .def_property_readonly(
          "method", [](const MapResult& self) { return command_name(self.built.method); },
          "How it was built.")
      .def_property_readonly(
          "landmarks", [](const MapResult& self) { return landmark_names(self.built.map); },
          "Names, in the order of positions.")
      .def_property_readonly(
          "positions", [](const MapResult& self) { return landmark_positions(self.built.map); },
          "m, n x 2.")
      .def_property_readonly("covariances", covariances, "m^2, n x 2 x 2; NaN where not known.")
      .def_property_readonly(
          "routes", [](const MapResult& self) { return route_rows(self.built.map); },
          "A dict per route: its ends, how often it was driven, its averages [m, rad].")
      .def_property_readonly(
          "dead_reckoned",
          [](const MapResult& self) {
            py::dict places;
            for (const auto& [name, at] : self.built.dead_reckoned) {
              places[name.c_str()] = py::make_tuple(at.x(), at.y());
            }
            return places;
          },
          doc("BuiltMap.dead_reckoned"))
      .def_property_readonly("legs", get<&BuiltMap::legs>, "How many.")
      .def_property_readonly("first_sight", get<&BuiltMap::first_sight>,
                             doc("BuiltMap.first_sight"))
      .def_property_readonly("refinements", get<&BuiltMap::refinements>,
                             doc("BuiltMap.refinements"))
      .def_property_readonly("side_sightings", get<&BuiltMap::side_sightings>,
                             doc("BuiltMap.side_sightings"))
      .def_property_readonly("rejected", list<&BuiltMap::rejected>, "Sightings left out.")
      .def_property_readonly("freed", list<&BuiltMap::freed>, doc("BuiltMap.freed"))
      .def_property_readonly("unconfirmed", get<&BuiltMap::unconfirmed>,
                             doc("BuiltMap.unconfirmed"))
      .def_property_readonly("paths", list<&BuiltMap::paths>, doc("BuiltMap.paths"))
      .def_property_readonly("quality", get<&BuiltMap::quality>, doc("MapQuality"))
      .def_property_readonly(
          "chi2", [](const MapResult& self) { return self.built.fit.chi2; }, doc("MapFit.chi2"))
      .def_property_readonly(
          "dof", [](const MapResult& self) { return self.built.fit.dof; }, "Of the adjustment.")
      .def_property_readonly(
          "p_value", [](const MapResult& self) { return self.built.fit.p_value; },
          doc("MapFit.p_value"))
      .def_property_readonly(
          "survey_rms",
          [](const MapResult& self) -> py::object {
            if (!self.built.on_survey) return py::none();
            return py::float_(self.built.on_survey->comparison.rigid.rms);
          },
          "m, of the map from the survey, after rotation and translation; None without one.")
      .def_property_readonly("warnings", get<&BuiltMap::warnings>, doc("BuiltMap.warnings"))
      .def_property_readonly("notes", get<&BuiltMap::notes>, doc("BuiltMap.notes"))
      .def(
          "write",
          [](const MapResult& self, const std::filesystem::path& file) {
            write_file(file, format_map(self.built.map, file,
                                        "trussmap, method " + command_name(self.built.method)));
          },
          py::arg("file"), "Writes the map: .graphml, .g2o, .geojson, .dot or .yaml.")
      .def(
          "svg",
          [](const MapResult& self) {
            return map_picture(self.built, self.built.paths.empty() ? "Landmark map" : "Path");
          },
          "A picture: before and after, over the survey where there is one.")
      .def("table", table, py::arg("what") = "landmarks",
           "A list of dicts: landmarks, routes or left out.")
      .def("__repr__", [](const MapResult& self) {
        return "<trussmap.Map of " + std::to_string(self.built.map.landmarks()) +
               " landmarks: " + verdict_in_words(self.built) + ">";
      });
  module.def("build_map", run_build_map, py::arg("recordings"), py::arg("model"), py::kw_only(),
             py::arg("method") = "adjustment", py::arg("eta") = "auto",
             py::arg("min_drive") = kDefaultMinDrive, py::arg("gate") = py::none(),
             py::arg("progress") = py::none(),
             doc("A landmark map from recordings, one per session.", "build_map").c_str());
}

}  // namespace trussmap::python
