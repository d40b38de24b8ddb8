// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/adjustment/linear_truss.hpp"

#include "trussmap/core/index.hpp"
#include "trussmap/truss/stiffness_law.hpp"
#include "trussmap/truss/truss.hpp"

namespace trussmap {

LandmarkGraph adjust_linear(const LandmarkGraph& map) {
  std::vector<Bar> bars;
  std::vector<Load> loads;
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    const Matrix2 B =
        bar_stiffness(StiffnessLaw::gauss_markov, route.covariance, 0.0, route.traversals);
    const Vector2 force = B * (route.displacement - (map.landmark(route.target).position -
                                                     map.landmark(route.source).position));
    bars.push_back({route.source, route.target, B});
    loads.push_back({route.target, force});
    loads.push_back({route.source, -force});
  }
  const Deflection moved = solve_truss(map.landmarks(), bars, {{0, Vector2::Zero()}}, loads);
  LandmarkGraph result = map;
  for (int k = 0; k < map.landmarks(); ++k) {
    result.set_position(k, map.landmark(k).position + moved.displacements[idx(k)]);
  }
  return result;
}

}  // namespace trussmap
