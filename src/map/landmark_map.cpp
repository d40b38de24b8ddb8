// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/landmark_map.hpp"

#include "geometry/index.hpp"

#include <stdexcept>

namespace trussmap {

int LandmarkGraph::add_landmark(const std::string& name, const Vector2& position) {
  if (name.empty()) throw std::invalid_argument("a landmark needs a name");
  const int number = landmarks();
  if (!numbers_.emplace(name, number).second) {
    throw std::invalid_argument("landmark " + name + " is in the map already");
  }
  boost::add_vertex(Landmark{name, position, std::nullopt}, graph_);
  return number;
}

int LandmarkGraph::add_route(int source, int target) {
  const int count = landmarks();
  if (source < 0 || target < 0 || source >= count || target >= count || source == target) {
    throw std::invalid_argument("a route joins two different landmarks of the map");
  }
  if (route_between(source, target)) {
    throw std::invalid_argument("landmarks " + landmark(source).name + " and " +
                                landmark(target).name + " are joined by a route already");
  }
  Route route;
  route.source = source;
  route.target = target;
  const int number = routes();
  boost::add_edge(idx(source), idx(target), RouteNumber{number}, graph_);
  routes_.push_back(route);
  return number;
}

int LandmarkGraph::add_traversal(int from, int to, const Traversal& traversal) {
  const std::optional<int> known = route_between(from, to);
  const int number = known ? *known : add_route(from, to);
  Route& route = routes_[idx(number)];
  average_in(route, route.source == from ? traversal : reversed(traversal));
  return number;
}

void LandmarkGraph::set_route(int number, const Route& route) {
  Route& present = routes_[idx(number)];
  if (present.source != route.source || present.target != route.target) {
    throw std::invalid_argument("a route keeps its ends");
  }
  present = route;
}

void LandmarkGraph::set_position(int landmark, const Vector2& position) {
  graph_[idx(landmark)].position = position;
}

void LandmarkGraph::set_covariance(int landmark, const Matrix2& covariance) {
  graph_[idx(landmark)].covariance = covariance;
}

int LandmarkGraph::landmarks() const {
  return static_cast<int>(boost::num_vertices(graph_));
}

const Landmark& LandmarkGraph::landmark(int number) const {
  return graph_[idx(number)];
}
const Route& LandmarkGraph::route(int number) const {
  return routes_[idx(number)];
}
Route& LandmarkGraph::route(int number) {
  return routes_[idx(number)];
}

std::optional<int> LandmarkGraph::find(const std::string& name) const {
  const auto found = numbers_.find(name);
  if (found == numbers_.end()) return std::nullopt;
  return found->second;
}

std::optional<int> LandmarkGraph::route_between(int a, int b) const {
  const auto [edge, exists] = boost::edge(idx(a), idx(b), graph_);
  if (!exists) return std::nullopt;
  return graph_[edge].route;
}

std::vector<int> LandmarkGraph::routes_at(int landmark) const {
  std::vector<int> result;
  const auto [first, last] = boost::out_edges(idx(landmark), graph_);
  for (auto edge = first; edge != last; ++edge) result.push_back(graph_[*edge].route);
  return result;
}

int other_end(const Route& route, int landmark) {
  return route.source == landmark ? route.target : route.source;
}

}  // namespace trussmap
