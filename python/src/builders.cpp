// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// MapBuilder and MapStore: a map during exploration.
#include "arrays.hpp"
#include "calls.hpp"
#include "maps.hpp"
#include "parts.hpp"
#include "rows.hpp"
#include "trussmap/map_builder.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/map_store.hpp"
#include "trussmap/write_files.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <utility>

namespace trussmap::python {
namespace {

namespace fs = std::filesystem;

MapBuilderOptions options_of(const std::string& method, const py::object& eta, bool groups,
                             const std::optional<std::string>& law, double gate) {
  MapBuilderOptions options;
  options.method = method_named(method);
  options.scope = scope_of(eta, groups);
  options.law = law_named(law);
  options.gate = gate;
  return options;
}

Traversal leg_of(const py::object& displacement, const py::object& covariance) {
  return {matrix<Vector2>(displacement, "displacement"), matrix<Matrix2>(covariance, "covariance")};
}

int number_of(const MapBuilder& builder, const std::string& landmark) {
  const std::optional<int> number = builder.find(landmark);
  if (!number) throw py::key_error("the map has no landmark \"" + landmark + "\"");
  return *number;
}

std::vector<std::string> names_of(const MapBuilder& builder, const std::vector<int>& landmarks) {
  std::vector<std::string> names;
  for (const int landmark : landmarks) names.push_back(builder.name(landmark));
  return names;
}

PathBy path_by(const std::string& name) {
  if (name == "length") return PathBy::length;
  if (name == "uncertainty") return PathBy::uncertainty;
  throw py::value_error("by: there is no \"" + name + "\", expected length or uncertainty");
}

/// What a planner asks of a builder, landmarks by their names.
template <typename Class, typename Get>
void add_planning(Class& type, const Get& builder) {
  using Self = typename Class::type;
  type.def(
          "nearest",
          [builder](const Self& self, const py::object& point, int count) {
            return names_of(builder(self),
                            builder(self).nearest(matrix<Vector2>(point, "point"), count));
          },
          py::arg("point"), py::arg("count") = 1, doc("MapBuilder.nearest"))
      .def(
          "path",
          [builder](const Self& self, const std::string& from, const std::string& to,
                    const std::string& by) {
            const MapBuilder& asked = builder(self);
            return names_of(asked,
                            asked.path(number_of(asked, from), number_of(asked, to), path_by(by)));
          },
          py::arg("start"), py::arg("end"), py::kw_only(), py::arg("by") = "length",
          "The landmarks along the shortest way over known routes, by=\"uncertainty\" the surest; "
          "none where there is no way.")
      .def(
          "covariance_between",
          [builder](const Self& self, const std::string& a, const std::string& b) {
            const MapBuilder& asked = builder(self);
            return array_of(asked.covariance_between(number_of(asked, a), number_of(asked, b)));
          },
          py::arg("a"), py::arg("b"), doc("MapBuilder.covariance_between"))
      .def(
          "covariances",
          [builder](const Self& self) { return array_of(builder(self).covariances()); },
          doc("MapBuilder.covariances"))
      .def(
          "expected_falls",
          [builder](const Self& self, const std::vector<std::vector<std::string>>& ways) {
            const MapBuilder& asked = builder(self);
            std::vector<std::vector<int>> numbers;
            for (const std::vector<std::string>& way : ways) {
              std::vector<int>& along = numbers.emplace_back();
              for (const std::string& landmark : way) along.push_back(number_of(asked, landmark));
            }
            return asked.expected_falls(numbers);
          },
          py::arg("ways"), doc("MapBuilder.expected_falls"));
}

/// What both have, by what gives the builder.
template <typename Class, typename Get>
void add_questions(Class& type, const Get& builder) {
  using Self = typename Class::type;
  type.def_property_readonly(
          "landmarks", [builder](const Self& self) { return landmark_names(builder(self).map()); },
          "Names, in the order of positions.")
      .def_property_readonly(
          "positions",
          [builder](const Self& self) { return landmark_positions(builder(self).map()); },
          "m, n x 2.")
      .def(
          "position",
          [builder](const Self& self, const std::string& landmark) {
            return array_of(builder(self).position(number_of(builder(self), landmark)));
          },
          py::arg("landmark"), "Where a landmark is now, m. KeyError on one that is not there.")
      .def_property_readonly(
          "here",
          [builder](const Self& self) -> py::object {
            const int here = builder(self).here();
            if (here < 0) return py::none();
            return py::str(builder(self).name(here));
          },
          "The landmark that the robot stands on; None before start().")
      .def("__len__", [builder](const Self& self) { return builder(self).landmarks(); })
      .def(
          "table",
          [builder](const Self& self, const std::string& what) {
            if (what == "landmarks") return landmark_rows(builder(self).map());
            if (what == "routes") return route_rows(builder(self).map());
            throw py::value_error("table: there is none called \"" + what +
                                  "\", expected landmarks or routes");
          },
          py::arg("what") = "landmarks", "A list of dicts: landmarks or routes.")
      .def(
          "write",
          [builder](const Self& self, const fs::path& file) {
            write_file(file, format_map(builder(self).map(), file));
          },
          py::arg("file"), "Writes the map: .graphml, .g2o, .geojson, .dot or .yaml.");
  add_planning(type, builder);
}

/// What both can do.
template <typename Class>
void add_calls(Class& type) {
  using Self = typename Class::type;
  type.def(
          "start",
          [](Self& self, const std::string& landmark, const py::object& position) {
            self.start(landmark, matrix<Vector2>(position, "position"));
          },
          py::arg("landmark"), py::arg("position") = py::make_tuple(0.0, 0.0),
          doc("MapBuilder.start"))
      .def(
          "arrive",
          [](Self& self, const std::string& landmark, const py::object& displacement,
             const py::object& covariance) {
            return self.arrive(landmark, leg_of(displacement, covariance));
          },
          py::arg("landmark"), py::arg("displacement"), py::arg("covariance"),
          doc("MapBuilder.arrive"))
      .def(
          "observe",
          [](Self& self, const std::string& landmark, const py::object& displacement,
             const py::object& covariance) {
            return self.observe(landmark, leg_of(displacement, covariance));
          },
          py::arg("landmark"), py::arg("displacement"), py::arg("covariance"),
          doc("MapBuilder.observe"))
      .def(
          "arrive_by_motion",
          [](Self& self, const std::string& landmark, const py::object& motion,
             const py::object& covariance, const py::object& seen,
             const py::object& seen_covariance) {
            const auto moved = matrix<Eigen::Vector3d>(motion, "motion");
            Motion given;
            given.displacement = {moved[0], moved[1], moved[2]};
            given.covariance = matrix<Matrix3>(covariance, "covariance");
            LandmarkOffset offset;
            if (!seen.is_none()) offset.offset_robot = matrix<Vector2>(seen, "seen");
            if (!seen_covariance.is_none()) {
              offset.covariance_robot = matrix<Matrix2>(seen_covariance, "seen_covariance");
            }
            return self.arrive(landmark, given, offset);
          },
          py::arg("landmark"), py::arg("motion"), py::arg("covariance"), py::kw_only(),
          py::arg("seen") = py::none(), py::arg("seen_covariance") = py::none(),
          "The same by a motion in the robot's own axes: x [m], y [m] and turn [rad], with their "
          "covariance; the landmark is seen at an offset [m] from where it ended.")
      .def("compass", &Self::compass, py::arg("reading"), py::arg("sd"), doc("MapBuilder.compass"))
      .def("relax", &Self::relax, doc("MapBuilder.relax"));
}

void add_store(py::module_& module) {
  py::class_<MapStore> type(module, "MapStore",
                            doc("A map builder whose memory is a file: what a call has returned "
                                "from survives the end of the program.",
                                "MapStore")
                                .c_str());
  type.def(py::init([](const fs::path& file, const py::object& method, const py::object& eta,
                       bool groups, const std::optional<std::string>& law, double gate) {
             std::optional<MapBuilderOptions> options;
             if (!method.is_none()) {
               options = options_of(method.cast<std::string>(), eta, groups, law, gate);
             }
             return std::make_unique<MapStore>(file, options);
           }),
           py::arg("file"), py::kw_only(), py::arg("method") = py::none(), py::arg("eta") = "auto",
           py::arg("groups") = true, py::arg("law") = py::none(),
           py::arg("gate") = MapBuilderOptions().gate)
      .def_property_readonly("legs", &MapStore::legs, doc("MapStore.legs"))
      .def("note", &MapStore::note, py::arg("name"), doc("MapStore.note"))
      .def("set_note", &MapStore::set_note, py::arg("name"), py::arg("text"),
           "Keeps a text under a name.")
      .def("__repr__", [](const MapStore& self) {
        return "<trussmap.MapStore of " + std::to_string(self.builder().landmarks()) +
               " landmarks, " + std::to_string(self.legs()) + " calls kept>";
      });
  add_calls(type);
  add_questions(type, [](const MapStore& store) -> const MapBuilder& { return store.builder(); });
}

}  // namespace

void add_map_builder(py::module_& module) {
  RowClass<Arrival>(module, "Arrival")
      .value(
          "kind", [](const Arrival& self) { return name_of(self.kind); },
          "new landmark, loop closed, new route, known route, left out or found again.")
      .field("landmark", &Arrival::landmark)
      .field("route", &Arrival::route)
      .field("landmarks_moved", &Arrival::landmarks_moved)
      .field("largest_move", &Arrival::largest_move)
      .field("eta", &Arrival::eta)
      .field("back", &Arrival::back)
      .value("misfit", [](const Arrival& self) { return array_of(self.misfit); });
  py::class_<MapBuilder> type(module, "MapBuilder",
                              "Corrects the map at every landmark that the robot reaches. A leg is "
                              "a displacement [m, map axes] with its covariance [m^2, 2 x 2].");
  type.def(py::init([](const std::string& method, const py::object& eta, bool groups,
                       const std::optional<std::string>& law, double gate, bool refine) {
             MapBuilderOptions options = options_of(method, eta, groups, law, gate);
             options.refine = refine;
             return std::make_unique<MapBuilder>(options);
           }),
           py::arg("method") = "elastic", py::kw_only(), py::arg("eta") = "auto",
           py::arg("groups") = true, py::arg("law") = py::none(),
           py::arg("gate") = MapBuilderOptions().gate, py::arg("refine") = true)
      .def("save", &MapBuilder::save, py::arg("file"), doc("MapBuilder.save"))
      .def_static("load", &MapBuilder::load, py::arg("file"), doc("MapBuilder.load"))
      .def("__repr__", [](const MapBuilder& self) {
        return "<trussmap.MapBuilder of " + std::to_string(self.landmarks()) + " landmarks>";
      });
  add_calls(type);
  add_questions(type, [](const MapBuilder& self) -> const MapBuilder& { return self; });
  add_store(module);
}

}  // namespace trussmap::python
