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

#include <pybind11/stl/filesystem.h>
#include <utility>

namespace trussmap::python {
namespace {

namespace fs = std::filesystem;

MapBuilderOptions options_of(const std::string& method, const py::object& eta, double gain_limit,
                             double gate) {
  MapBuilderOptions options;
  options.method = method_named(method);
  options.eta = eta_of(eta, true);
  options.gain_limit = gain_limit;
  options.gate = gate;
  return options;
}

Traversal leg_of(const py::object& displacement, const py::object& covariance) {
  return {matrix<Vector2>(displacement, "displacement"), matrix<Matrix2>(covariance, "covariance")};
}

std::string kind_of(const Arrival& arrival) {
  switch (arrival.kind) {
    case Arrival::Kind::new_landmark:
      return "new landmark";
    case Arrival::Kind::first_sight:
      return "first sight";
    case Arrival::Kind::new_route:
      return "new route";
    case Arrival::Kind::refinement:
      return "refinement";
    case Arrival::Kind::left_out:
      break;
  }
  return "left out";
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
            const std::optional<int> number = builder(self).find(landmark);
            if (!number) throw py::key_error("the map has no landmark \"" + landmark + "\"");
            return array_of(builder(self).position(*number));
          },
          py::arg("landmark"), "Where a landmark is now, m. KeyError on one that is not there.")
      .def_property_readonly(
          "here",
          [builder](const Self& self) -> py::object {
            const int here = builder(self).here();
            if (here < 0) return py::none();
            return py::str(builder(self).map().landmark(here).name);
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
      .def("settle", &Self::settle, py::arg("gain_limit"), doc("MapBuilder.settle"))
      .def("rest", &Self::rest, doc("MapBuilder.rest"));
}

void add_store(py::module_& module) {
  py::class_<MapStore> type(module, "MapStore",
                            doc("A map builder whose memory is a file: what a call has returned "
                                "from survives the end of the program.",
                                "MapStore")
                                .c_str());
  type.def(py::init([](const fs::path& file, const py::object& method, const py::object& eta,
                       double gain_limit, double gate) {
             std::optional<MapBuilderOptions> options;
             if (!method.is_none()) {
               options = options_of(method.cast<std::string>(), eta, gain_limit, gate);
             }
             return std::make_unique<MapStore>(file, options);
           }),
           py::arg("file"), py::kw_only(), py::arg("method") = py::none(), py::arg("eta") = 50,
           py::arg("gain_limit") = MapBuilderOptions().gain_limit,
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
  RowClass<Arrival>(module, "Arrival", "Arrival")
      .value(
          "kind", [](const Arrival& self) { return kind_of(self); },
          "new landmark, first sight, new route, refinement or left out.")
      .field("landmark", &Arrival::landmark)
      .field("route", &Arrival::route)
      .field("landmarks_moved", &Arrival::landmarks_moved)
      .field("largest_move", &Arrival::largest_move)
      .field("eta", &Arrival::eta)
      .field("back", &Arrival::back)
      .aside("misfit", [](const Arrival& self) { return array_of(self.misfit); });
  py::class_<MapBuilder> type(module, "MapBuilder",
                              "Corrects the map at every landmark that the robot reaches. A leg is "
                              "a displacement [m, map axes] with its covariance [m^2, 2 x 2].");
  type.def(py::init([](const std::string& method, const py::object& eta, double gain_limit,
                       double gate, bool refine) {
             MapBuilderOptions options = options_of(method, eta, gain_limit, gate);
             options.refine = refine;
             return std::make_unique<MapBuilder>(options);
           }),
           py::arg("method") = "elastic", py::kw_only(), py::arg("eta") = 50,
           py::arg("gain_limit") = MapBuilderOptions().gain_limit,
           py::arg("gate") = MapBuilderOptions().gate, py::arg("refine") = true)
      .def("__repr__", [](const MapBuilder& self) {
        return "<trussmap.MapBuilder of " + std::to_string(self.landmarks()) + " landmarks>";
      });
  add_calls(type);
  add_questions(type, [](const MapBuilder& self) -> const MapBuilder& { return self; });
  add_store(module);
}

}  // namespace trussmap::python
