// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "maps.hpp"

#include "arrays.hpp"

#include <algorithm>
#include <vector>

namespace trussmap::python {

Method method_named(const std::string& name) {
  std::string plain = name;
  std::replace(plain.begin(), plain.end(), '-', '_');
  for (const Method one :
       {Method::adjustment, Method::elastic, Method::elastic_printed, Method::gauss_markov}) {
    if (name_of(one) == plain) return one;
  }
  throw py::value_error("method: \"" + name +
                        "\" is unknown, expected adjustment, elastic, elastic-printed or "
                        "gauss-markov");
}

std::string command_name(Method method) {
  std::string name = name_of(method);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

RefinementScope scope_of(py::handle eta, bool groups) {
  RefinementScope scope;
  scope.groups = groups;
  if (!py::isinstance<py::str>(eta)) {
    scope.kind = RefinementScope::Kind::nearest;
    scope.eta = eta.cast<int>();
    return scope;
  }
  const std::string text = eta.cast<std::string>();
  if (text == "all") {
    scope.kind = RefinementScope::Kind::all;
  } else if (text == "estimated") {
    scope.kind = RefinementScope::Kind::estimated;
  } else if (text != "auto") {
    throw py::value_error("eta: \"" + text + "\": expected a number, all, estimated or auto");
  }
  return scope;
}

std::optional<StiffnessLaw> law_named(const std::optional<std::string>& law) {
  if (!law) return std::nullopt;
  if (*law == "mean-error") return StiffnessLaw::mean_error;
  if (*law == "variance") return StiffnessLaw::variance;
  throw py::value_error("law: \"" + *law + "\": expected mean-error or variance");
}

py::list landmark_names(const LandmarkGraph& map) {
  py::list names;
  for (int k = 0; k < map.landmarks(); ++k) names.append(map.landmark(k).name);
  return names;
}

py::array landmark_positions(const LandmarkGraph& map) {
  std::vector<Vector2> points;
  for (int k = 0; k < map.landmarks(); ++k) points.push_back(map.landmark(k).position);
  return array_of(points);
}

py::list landmark_rows(const LandmarkGraph& map) {
  py::list rows;
  for (int k = 0; k < map.landmarks(); ++k) {
    const Landmark& one = map.landmark(k);
    py::dict row;
    row["landmark"] = one.name;
    row["x"] = one.position.x();
    row["y"] = one.position.y();
    if (one.covariance) {
      row["c_xx"] = (*one.covariance)(0, 0);
      row["c_xy"] = (*one.covariance)(0, 1);
      row["c_yy"] = (*one.covariance)(1, 1);
    }
    if (one.heading) row["heading"] = *one.heading;
    if (one.sd_heading) row["sd_heading"] = *one.sd_heading;
    rows.append(row);
  }
  return rows;
}

py::list route_rows(const LandmarkGraph& map) {
  py::list rows;
  for (int k = 0; k < map.routes(); ++k) {
    const Route& one = map.route(k);
    py::dict row;
    row["source"] = map.landmark(one.source).name;
    row["target"] = map.landmark(one.target).name;
    row["traversals"] = one.traversals;
    row["stretch"] = one.stretch;
    row["orientation"] = one.orientation;
    row["dx"] = one.displacement.x();
    row["dy"] = one.displacement.y();
    rows.append(row);
  }
  return rows;
}

}  // namespace trussmap::python
