// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/index.hpp"
#include "map/graph_model.hpp"
#include "trussmap/landmark_map.hpp"

#include <cassert>
#include <functional>
#include <limits>
#include <stdexcept>

#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <boost/graph/dijkstra_shortest_paths_no_color_map.hpp>
#include <boost/range/iterator_range.hpp>

namespace trussmap {
using namespace map;

namespace {

/// Of a route or a chain of them: the number of routes decides between chains of the same weight.
struct Cost {
  double weight = 0.0;
  int routes = 0;

  friend bool operator==(const Cost& a, const Cost& b) {
    return a.weight == b.weight && a.routes == b.routes;
  }
  friend bool operator<(const Cost& a, const Cost& b) {
    return a.weight < b.weight || (a.weight == b.weight && a.routes < b.routes);
  }
  friend Cost operator+(const Cost& a, const Cost& b) {
    return {a.weight + b.weight, a.routes + b.routes};
  }
};

constexpr Cost kNoWay{std::numeric_limits<double>::infinity(), 0};

/// What a route adds to a chain.
struct RouteCost {
  using key_type = RouteFrom;
  using value_type = Cost;
  using reference = Cost;
  using category = boost::readable_property_map_tag;

  const LandmarkGraph* graph;
  PathBy by;

  friend Cost get(const RouteCost& map, const RouteFrom& edge) {
    const Route& route = map.graph->route(edge.route);
    if (route.traversals == 0) return kNoWay;
    return {map.by == PathBy::length ? route.stretch : route.covariance.trace(), 1};
  }
};

/// Ends the search where it was to lead; Boost's algorithms are left by an exception.
struct Arrived {};

class StopAt : public boost::dijkstra_visitor<> {
 public:
  explicit StopAt(int landmark) : landmark_(landmark) {}

  void examine_vertex(int landmark, const LandmarkGraph& /*graph*/) const {
    if (landmark == landmark_) throw Arrived();
  }

 private:
  int landmark_;
};

/// From each landmark to `to`, as far as they are no more than from `from`.
std::vector<Cost> costs_to(int to, int from, const LandmarkGraph& graph, const RouteCost& cost) {
  std::vector<Cost> costs(num_vertices(graph), kNoWay);
  costs[idx(to)] = Cost();
  const auto index = get(boost::vertex_index, graph);
  const auto so_far = boost::make_iterator_property_map(costs.begin(), index);
  try {
    boost::dijkstra_shortest_paths_no_color_map_no_init(
        graph, to, boost::dummy_property_map(), so_far, cost, index, std::less<>(), std::plus<>(),
        kNoWay, Cost(), StopAt(from));
  } catch (const Arrived&) {
  }
  return costs;
}

}  // namespace

std::vector<int> path(const LandmarkGraph& graph, int from, int to, PathBy by) {
  const int count = graph.landmarks();
  if (from < 0 || to < 0 || from >= count || to >= count) {
    throw std::invalid_argument("a path leads from a landmark of the map to one of the map");
  }
  const RouteCost cost{&graph, by};
  const std::vector<Cost> costs = costs_to(to, from, graph, cost);
  if (!(costs[idx(from)] < kNoWay)) return {};
  std::vector<int> way{from};
  while (way.back() != to) {
    const int here = way.back();
    int next = -1;
    for (const RouteFrom exit : boost::make_iterator_range(out_edges(here, graph))) {
      const int there = target(exit, graph);
      const bool best = get(cost, exit) + costs[idx(there)] == costs[idx(here)];
      if (best && (next < 0 || there < next)) next = there;
    }
    assert(next >= 0 && "a landmark that was reached has one before it");
    way.push_back(next);
  }
  return way;
}

}  // namespace trussmap
