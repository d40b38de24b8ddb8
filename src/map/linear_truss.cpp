// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/linear_truss.hpp"

#include "geometry/index.hpp"
#include "truss/truss.hpp"
#include "trussmap/error.hpp"
#include "trussmap/stiffness_law.hpp"

namespace trussmap {
namespace {

Vector2 in_map(const LandmarkGraph& map, const Route& route) {
  return map.landmark(route.target).position - map.landmark(route.source).position;
}

}  // namespace

LinearAdjustment adjust_linear(const LandmarkGraph& map) {
  LinearAdjustment result;
  result.map = map;
  if (map.landmarks() == 0) return result;
  std::vector<Bar> bars;
  std::vector<Load> loads;
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    const Matrix2 B =
        bar_stiffness(StiffnessLaw::gauss_markov, route.covariance, 0.0, route.traversals);
    const Vector2 force = B * (route.displacement - in_map(map, route));
    bars.push_back({route.source, route.target, B});
    loads.push_back({route.target, force});
    loads.push_back({route.source, -force});
  }
  try {
    const Deflection moved = solve_truss(map.landmarks(), bars, {{0, Vector2::Zero()}}, loads);
    for (int k = 0; k < map.landmarks(); ++k) {
      result.map.set_position(k, map.landmark(k).position + moved.displacements[idx(k)]);
    }
  } catch (const UnsupportedJoint& error) {
    throw SolveError("landmark " + map.landmark(error.joint()).name +
                     " is tied to nothing: no chain of routes leads to it from landmark " +
                     map.landmark(0).name);
  }
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    const Vector2 misfit = in_map(result.map, route) - route.displacement;
    result.bar_forces.emplace_back(bars[idx(number)].stiffness * misfit);
    result.chi2 += misfit.dot(result.bar_forces.back());
  }
  result.dof = 2 * (map.routes() - map.landmarks() + 1);
  return result;
}

}  // namespace trussmap
