// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The landmark graph as a graph of Boost.Graph: its algorithms take a LandmarkGraph as it is, and
// nothing is copied.
//
//   vertex    a landmark, by its number; none: -1
//   edge      a route as seen from one of its ends (RouteFrom); the same from either end
//
// It models IncidenceGraph, BidirectionalGraph, AdjacencyGraph, VertexListGraph, EdgeListGraph and
// AdjacencyMatrix, undirected and without parallel edges. Vertices, edges, and the edges at a
// vertex come in the order in which they were added. Readable properties, all without a copy:
//
//   get(boost::vertex_index, graph)   the landmark's number
//   get(boost::edge_index, graph)     the route's number
//   get(&Landmark::position, graph)   any field of the landmarks
//   get(&Route::stretch, graph)       any field of the routes
//
// It is changed by its own calls alone (no MutableGraph): a landmark needs a name, a route
// averages. Iterators hold until it is; numbers and edges stay what they are.
//
// Why no boost::adjacency_list holds the map: callers have routes by their numbers and the numbers
// of the routes at a landmark. With these beside it adjacency_list (vecS, edges vecS) grows a map
// of 10^6 landmarks 1.4 times slower and takes 1.5 times the memory; alone 1.27 and 1.29 times,
// reads as fast, and a call that throws leaves it halfway (bench/README.md).
//
// Cost: constant time each; edge(a, b, graph): the fewer of the routes at a and at b.
#pragma once

#include "trussmap/landmark_map.hpp"

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <boost/graph/graph_traits.hpp>
#include <boost/graph/properties.hpp>
#include <boost/iterator/counting_iterator.hpp>
#include <boost/iterator/transform_iterator.hpp>
#include <boost/property_map/property_map.hpp>

namespace trussmap::map {

/// A route, and the end that one stands at.
struct RouteFrom {
  int route = -1;
  int from = -1;  ///< landmark

  friend bool operator==(const RouteFrom& a, const RouteFrom& b) { return a.route == b.route; }
};

/// How the numbers of routes become what an iterator points to.
struct LeavingFrom {
  int from = -1;
  RouteFrom operator()(int route) const { return {route, from}; }
};
struct ArrivingAt {
  const LandmarkGraph* graph = nullptr;
  int to = -1;
  RouteFrom operator()(int route) const { return {route, other_end(graph->route(route), to)}; }
};
struct OtherEndFrom {
  const LandmarkGraph* graph = nullptr;
  int from = -1;
  int operator()(int route) const { return other_end(graph->route(route), from); }
};
struct FromItsSource {
  const LandmarkGraph* graph = nullptr;
  RouteFrom operator()(int route) const { return {route, graph->route(route).source}; }
};

/// A field of all landmarks.
template <typename Value>
struct LandmarkField {
  using key_type = int;
  using value_type = Value;
  using reference = const Value&;
  using category = boost::readable_property_map_tag;

  const LandmarkGraph* graph = nullptr;
  Value Landmark::*field = nullptr;

  friend const Value& get(const LandmarkField& map, int landmark) {
    return map.graph->landmark(landmark).*map.field;
  }
};

/// A field of all routes.
template <typename Value>
struct RouteField {
  using key_type = RouteFrom;
  using value_type = Value;
  using reference = const Value&;
  using category = boost::readable_property_map_tag;

  const LandmarkGraph* graph = nullptr;
  Value Route::*field = nullptr;

  friend const Value& get(const RouteField& map, const RouteFrom& edge) {
    return map.graph->route(edge.route).*map.field;
  }
};

struct RouteNumber {
  using key_type = RouteFrom;
  using value_type = int;
  using reference = int;
  using category = boost::readable_property_map_tag;

  friend int get(const RouteNumber& /*map*/, const RouteFrom& edge) { return edge.route; }
};

}  // namespace trussmap::map

namespace boost {

template <>
struct graph_traits<trussmap::LandmarkGraph> {
  using Routes = std::vector<int>::const_iterator;

  struct traversal_category : virtual bidirectional_graph_tag,
                              virtual adjacency_graph_tag,
                              virtual vertex_list_graph_tag,
                              virtual edge_list_graph_tag,
                              virtual adjacency_matrix_tag {};
  using directed_category = undirected_tag;
  using edge_parallel_category = disallow_parallel_edge_tag;

  using vertex_descriptor = int;
  using edge_descriptor = trussmap::map::RouteFrom;
  using vertex_iterator = counting_iterator<int>;
  using edge_iterator = transform_iterator<trussmap::map::FromItsSource, counting_iterator<int>>;
  using out_edge_iterator = transform_iterator<trussmap::map::LeavingFrom, Routes>;
  using in_edge_iterator = transform_iterator<trussmap::map::ArrivingAt, Routes>;
  using adjacency_iterator = transform_iterator<trussmap::map::OtherEndFrom, Routes>;
  using vertices_size_type = std::size_t;
  using edges_size_type = std::size_t;
  using degree_size_type = std::size_t;

  static vertex_descriptor null_vertex() { return -1; }
};

template <>
struct property_map<trussmap::LandmarkGraph, vertex_index_t> {
  using type = typed_identity_property_map<int>;
  using const_type = type;
};
template <>
struct property_map<trussmap::LandmarkGraph, edge_index_t> {
  using type = trussmap::map::RouteNumber;
  using const_type = type;
};
template <typename Value>
struct property_map<trussmap::LandmarkGraph, Value trussmap::Landmark::*> {
  using type = trussmap::map::LandmarkField<Value>;
  using const_type = type;
};
template <typename Value>
struct property_map<trussmap::LandmarkGraph, Value trussmap::Route::*> {
  using type = trussmap::map::RouteField<Value>;
  using const_type = type;
};
template <typename Property>
struct property_map<const trussmap::LandmarkGraph, Property>
    : property_map<trussmap::LandmarkGraph, Property> {};

}  // namespace boost

namespace trussmap::map {

using GraphTraits = boost::graph_traits<LandmarkGraph>;

template <typename Iterator>
using IteratorPair = std::pair<Iterator, Iterator>;

}  // namespace trussmap::map

// Beside the graph's type, where Boost's algorithms look for them.
namespace trussmap {

inline std::size_t num_vertices(const LandmarkGraph& graph) {
  return static_cast<std::size_t>(graph.landmarks());
}
inline std::size_t num_edges(const LandmarkGraph& graph) {
  return static_cast<std::size_t>(graph.routes());
}

inline map::IteratorPair<map::GraphTraits::vertex_iterator> vertices(const LandmarkGraph& graph) {
  using Iterator = map::GraphTraits::vertex_iterator;
  return {Iterator(0), Iterator(graph.landmarks())};
}
/// Each from its source.
inline map::IteratorPair<map::GraphTraits::edge_iterator> edges(const LandmarkGraph& graph) {
  using Number = boost::counting_iterator<int>;
  const map::FromItsSource seen{&graph};
  return {{Number(0), seen}, {Number(graph.routes()), seen}};
}

inline std::size_t degree(int landmark, const LandmarkGraph& graph) {
  return graph.routes_at(landmark).size();
}
inline std::size_t out_degree(int landmark, const LandmarkGraph& graph) {
  return degree(landmark, graph);
}
inline std::size_t in_degree(int landmark, const LandmarkGraph& graph) {
  return degree(landmark, graph);
}
inline map::IteratorPair<map::GraphTraits::out_edge_iterator> out_edges(
    int landmark, const LandmarkGraph& graph) {
  const std::vector<int>& routes = graph.routes_at(landmark);
  const map::LeavingFrom seen{landmark};
  return {{routes.begin(), seen}, {routes.end(), seen}};
}
inline map::IteratorPair<map::GraphTraits::in_edge_iterator> in_edges(int landmark,
                                                                      const LandmarkGraph& graph) {
  const std::vector<int>& routes = graph.routes_at(landmark);
  const map::ArrivingAt seen{&graph, landmark};
  return {{routes.begin(), seen}, {routes.end(), seen}};
}
inline map::IteratorPair<map::GraphTraits::adjacency_iterator> adjacent_vertices(
    int landmark, const LandmarkGraph& graph) {
  const std::vector<int>& routes = graph.routes_at(landmark);
  const map::OtherEndFrom seen{&graph, landmark};
  return {{routes.begin(), seen}, {routes.end(), seen}};
}

inline int source(const map::RouteFrom& edge, const LandmarkGraph& /*graph*/) {
  return edge.from;
}
inline int target(const map::RouteFrom& edge, const LandmarkGraph& graph) {
  return other_end(graph.route(edge.route), edge.from);
}
/// From a to b, and whether there is one.
inline std::pair<map::RouteFrom, bool> edge(int a, int b, const LandmarkGraph& graph) {
  const std::optional<int> route = graph.route_between(a, b);
  return {{route.value_or(-1), a}, route.has_value()};
}

inline boost::typed_identity_property_map<int> get(boost::vertex_index_t /*which*/,
                                                   const LandmarkGraph& /*graph*/) {
  return {};
}
inline int get(boost::vertex_index_t /*which*/, const LandmarkGraph& /*graph*/, int landmark) {
  return landmark;
}
inline map::RouteNumber get(boost::edge_index_t /*which*/, const LandmarkGraph& /*graph*/) {
  return {};
}
inline int get(boost::edge_index_t /*which*/, const LandmarkGraph& /*graph*/,
               const map::RouteFrom& edge) {
  return edge.route;
}
template <typename Value>
map::LandmarkField<Value> get(Value Landmark::*field, const LandmarkGraph& graph) {
  return {&graph, field};
}
template <typename Value>
const Value& get(Value Landmark::*field, const LandmarkGraph& graph, int landmark) {
  return graph.landmark(landmark).*field;
}
template <typename Value>
map::RouteField<Value> get(Value Route::*field, const LandmarkGraph& graph) {
  return {&graph, field};
}
template <typename Value>
const Value& get(Value Route::*field, const LandmarkGraph& graph, const map::RouteFrom& edge) {
  return graph.route(edge.route).*field;
}

}  // namespace trussmap
