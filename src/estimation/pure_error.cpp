// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/pure_error.hpp"

#include "geometry/index.hpp"
#include "map/linear_truss.hpp"
#include "statistics/distributions.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace trussmap::estimation {
namespace {

Matrix2 information(const Matrix2& covariance) {
  if (Eigen::LLT<Matrix2>(covariance).info() != Eigen::Success) {
    throw std::invalid_argument("a traversal's covariance is not positive definite");
  }
  return covariance.inverse();
}

/// The traversal in the direction of its merged route.
Vector2 along(const MergedRoute& route, const Repeat& repeat) {
  return repeat.from == route.source ? repeat.traversal.displacement
                                     : Vector2(-repeat.traversal.displacement);
}

}  // namespace

std::vector<MergedRoute> merge_repeats(const std::vector<Repeat>& repeats) {
  std::vector<MergedRoute> routes;
  std::map<std::pair<int, int>, std::size_t> number;
  std::vector<std::size_t> route_of;
  for (const Repeat& repeat : repeats) {
    const auto [at, fresh] = number.try_emplace(std::minmax(repeat.from, repeat.to), routes.size());
    if (fresh) routes.push_back({repeat.from, repeat.to});
    route_of.push_back(at->second);
    MergedRoute& route = routes[at->second];
    const Matrix2 weight = information(repeat.traversal.covariance);
    ++route.count;
    route.stiffness += weight;
    route.mean += weight * along(route, repeat);  // divided by the stiffness below
  }
  for (MergedRoute& route : routes) route.mean = route.stiffness.inverse() * route.mean;
  // About the mean, in a second pass: sums of squares less squares of sums would cancel.
  for (std::size_t k = 0; k < repeats.size(); ++k) {
    MergedRoute& route = routes[route_of[k]];
    const Vector2 off = along(route, repeats[k]) - route.mean;
    route.scatter += off.dot(information(repeats[k].traversal.covariance) * off);
  }
  return routes;
}

PureErrorSplit split_pure_error(const LandmarkGraph& map, const std::vector<Repeat>& repeats) {
  LandmarkGraph merged;
  for (int k = 0; k < map.landmarks(); ++k) {
    merged.add_landmark(map.landmark(k).name, map.landmark(k).position);
  }
  PureErrorSplit result;
  for (const MergedRoute& one : merge_repeats(repeats)) {
    Route route;
    route.source = one.source;
    route.target = one.target;
    route.traversals = one.count;
    route.displacement = one.mean;
    route.stretch = one.mean.norm();
    route.orientation = direction(one.mean);
    route.covariance = one.count * one.stiffness.inverse();  // of one traversal, on average
    merged.set_route(merged.add_route(one.source, one.target), route);
    result.pure_error += one.scatter;
    result.pure_error_dof += 2 * (one.count - 1);
  }
  map::LinearAdjustment fit = map::adjust_linear(merged);
  result.lack_of_fit = fit.chi2;
  result.lack_of_fit_dof = fit.dof;
  result.map = std::move(fit.map);
  if (result.pure_error_dof > 0 && result.lack_of_fit_dof > 0 && result.pure_error > 0.0) {
    result.F =
        (result.lack_of_fit / result.lack_of_fit_dof) / (result.pure_error / result.pure_error_dof);
    result.p_value =
        statistics::fisher_p_value(result.F, result.lack_of_fit_dof, result.pure_error_dof);
  }
  return result;
}

}  // namespace trussmap::estimation
