// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/linear_truss.hpp"

#include "geometry/index.hpp"
#include "truss/measured_truss.hpp"
#include "trussmap/error.hpp"
#include "trussmap/truss.hpp"

namespace trussmap::map {
LinearAdjustment adjust_linear(const LandmarkGraph& map) {
  LinearAdjustment result;
  result.map = map;
  if (map.landmarks() == 0) return result;
  truss::MeasuredTruss truss;
  std::vector<Matrix2> stiffnesses;
  for (int k = 0; k < map.landmarks(); ++k) truss.add_joint(map.landmark(k).position);
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    stiffnesses.push_back(
        bar_stiffness(StiffnessLaw::variance, route.covariance, 0.0, route.traversals));
    truss.add(route.source, route.target, route.displacement, stiffnesses.back());
  }
  try {
    const truss::MeasuredTruss::Fit fit = truss.fit();
    for (int k = 0; k < map.landmarks(); ++k) result.map.set_position(k, fit.positions[idx(k)]);
    result.chi2 = fit.chi2;
    result.dof = fit.dof;
  } catch (const UnsupportedJoint& error) {
    throw SolveError("landmark " + map.landmark(error.joint()).name +
                     " is tied to nothing: no chain of routes leads to it from landmark " +
                     map.landmark(0).name);
  }
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    const Vector2 between =
        result.map.landmark(route.target).position - result.map.landmark(route.source).position;
    result.bar_forces.emplace_back(stiffnesses[idx(number)] * (between - route.displacement));
  }
  return result;
}

}  // namespace trussmap::map
