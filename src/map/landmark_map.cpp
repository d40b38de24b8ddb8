// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/landmark_map.hpp"

#include "geometry/index.hpp"
#include "geometry/make_room.hpp"

#include <stdexcept>
#include <utility>

namespace trussmap {

int LandmarkGraph::add_landmark(const std::string& name, const Vector2& position) {
  if (name.empty()) throw std::invalid_argument("a landmark needs a name");
  const int number = landmarks();
  geometry::make_room(landmarks_);
  geometry::make_room(routes_at_);
  Landmark landmark{name, position, std::nullopt};
  if (!numbers_.emplace(name, number).second) {
    throw std::invalid_argument("landmark " + name + " is in the map already");
  }
  landmarks_.push_back(std::move(landmark));
  routes_at_.emplace_back();
  return number;
}

int LandmarkGraph::add_landmark(const std::string& name, int from, const Traversal& traversal) {
  if (from < 0 || from >= landmarks()) {
    throw std::invalid_argument("a route starts at a landmark of the map");
  }
  Route route;
  route.source = from;
  route.target = landmarks();
  average_in(route, traversal);
  std::vector<int> only_route{routes()};
  geometry::make_room(routes_);
  geometry::make_room(routes_at_[idx(from)]);
  const int number = add_landmark(name, landmark(from).position + traversal.displacement);
  routes_at_[idx(from)].push_back(routes());
  routes_at_[idx(number)] = std::move(only_route);
  routes_.push_back(route);
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
  geometry::make_room(routes_);
  geometry::make_room(routes_at_[idx(source)]);
  geometry::make_room(routes_at_[idx(target)]);
  routes_.push_back(route);
  routes_at_[idx(source)].push_back(number);
  routes_at_[idx(target)].push_back(number);
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
  landmarks_[idx(landmark)].position = position;
}

void LandmarkGraph::set_covariance(int landmark, const Matrix2& covariance) {
  landmarks_[idx(landmark)].covariance = covariance;
}

void LandmarkGraph::set_heading(int landmark, double heading, std::optional<double> sd) {
  landmarks_[idx(landmark)].heading = heading;
  landmarks_[idx(landmark)].sd_heading = sd;
}

const Landmark& LandmarkGraph::landmark(int number) const {
  return landmarks_[idx(number)];
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
  if (std::min(a, b) < 0 || std::max(a, b) >= landmarks()) return std::nullopt;
  const bool fewer = routes_at(a).size() <= routes_at(b).size();
  for (const int number : routes_at(fewer ? a : b)) {
    if (other_end(route(number), fewer ? a : b) == (fewer ? b : a)) return number;
  }
  return std::nullopt;
}

const std::vector<int>& LandmarkGraph::routes_at(int landmark) const {
  return routes_at_[idx(landmark)];
}

int other_end(const Route& route, int landmark) {
  return route.source == landmark ? route.target : route.source;
}

}  // namespace trussmap
