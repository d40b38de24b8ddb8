// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The landmark graph is a graph to Boost: it has what the concepts ask for, and what its algorithms
// find in it is what they find in Boost's own graph of the same landmarks and routes.
#include "map/graph_model.hpp"

#include "geometry/index.hpp"
#include "linalg/connected_parts.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/breadth_first_search.hpp>
#include <boost/graph/connected_components.hpp>
#include <boost/graph/graph_concepts.hpp>
#include <boost/graph/kruskal_min_spanning_tree.hpp>
#include <boost/range/iterator_range.hpp>
#include <gtest/gtest.h>

namespace trussmap::graph_model_test {
using namespace map;
namespace {

using Position = Vector2 Landmark::*;
using Stretch = double Route::*;

BOOST_CONCEPT_ASSERT((boost::IncidenceGraphConcept<LandmarkGraph>));
BOOST_CONCEPT_ASSERT((boost::BidirectionalGraphConcept<LandmarkGraph>));
BOOST_CONCEPT_ASSERT((boost::AdjacencyGraphConcept<LandmarkGraph>));
BOOST_CONCEPT_ASSERT((boost::VertexListGraphConcept<LandmarkGraph>));
BOOST_CONCEPT_ASSERT((boost::EdgeListGraphConcept<LandmarkGraph>));
BOOST_CONCEPT_ASSERT((boost::VertexAndEdgeListGraphConcept<LandmarkGraph>));
BOOST_CONCEPT_ASSERT((boost::AdjacencyMatrixConcept<LandmarkGraph>));
BOOST_CONCEPT_ASSERT(
    (boost::ReadablePropertyGraphConcept<LandmarkGraph, int, boost::vertex_index_t>));
BOOST_CONCEPT_ASSERT(
    (boost::ReadablePropertyGraphConcept<LandmarkGraph, RouteFrom, boost::edge_index_t>));
BOOST_CONCEPT_ASSERT((boost::ReadablePropertyGraphConcept<LandmarkGraph, int, Position>));
BOOST_CONCEPT_ASSERT((boost::ReadablePropertyGraphConcept<LandmarkGraph, RouteFrom, Stretch>));
static_assert(boost::is_undirected_graph<LandmarkGraph>::value);
static_assert(!boost::is_multigraph<LandmarkGraph>::value);
static_assert(boost::is_adjacency_matrix<LandmarkGraph>::value);

constexpr int kLandmarks = 40;

/// Some landmarks alone, some in parts of several; stretches all different.
LandmarkGraph drawn(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<int> any(0, kLandmarks - 1);
  std::uniform_real_distribution<double> stretch(1.0, 9.0);
  LandmarkGraph graph;
  for (int k = 0; k < kLandmarks; ++k) {
    graph.add_landmark("L" + std::to_string(k), {1.0 * k, -2.0 * k});
  }
  for (int k = 0; k < kLandmarks; ++k) {
    const int a = any(random);
    const int b = any(random);
    if (a == b || graph.route_between(a, b)) continue;
    graph.route(graph.add_route(a, b)).stretch = stretch(random);
  }
  return graph;
}

/// The same, kept by Boost.
using Listed = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS,
                                     boost::no_property, boost::property<boost::edge_index_t, int>>;

Listed listed(const LandmarkGraph& graph) {
  Listed result(idx(graph.landmarks()));
  for (int k = 0; k < graph.routes(); ++k) {
    add_edge(idx(graph.route(k).source), idx(graph.route(k).target), k, result);
  }
  return result;
}

TEST(GraphModel, HasTheEdgesOfBoostsOwnGraph) {
  const LandmarkGraph graph = drawn(1);
  const Listed twin = listed(graph);
  ASSERT_EQ(num_vertices(graph), num_vertices(twin));
  ASSERT_EQ(num_edges(graph), num_edges(twin));
  int next = 0;
  for (const int v : boost::make_iterator_range(vertices(graph))) {
    EXPECT_EQ(v, next++);
    ASSERT_EQ(out_degree(v, graph), out_degree(idx(v), twin));
    auto theirs = out_edges(idx(v), twin).first;
    auto arriving = in_edges(v, graph).first;
    auto neighbour = adjacent_vertices(v, graph).first;
    for (const RouteFrom e : boost::make_iterator_range(out_edges(v, graph))) {
      EXPECT_EQ(e.route, get(boost::edge_index, twin, *theirs));
      EXPECT_EQ(source(e, graph), v);
      EXPECT_EQ(idx(target(e, graph)), target(*theirs++, twin));
      EXPECT_EQ(*neighbour++, target(e, graph));
      EXPECT_EQ(*arriving, e);  // the same route, seen from its other end
      EXPECT_EQ(source(*arriving, graph), target(e, graph));
      EXPECT_EQ(target(*arriving++, graph), v);
    }
    EXPECT_EQ(arriving, in_edges(v, graph).second);
    EXPECT_EQ(neighbour, adjacent_vertices(v, graph).second);
  }
  EXPECT_EQ(next, kLandmarks);
}

TEST(GraphModel, EveryRouteIsAnEdgeOnce) {
  const LandmarkGraph graph = drawn(2);
  int next = 0;
  for (const RouteFrom e : boost::make_iterator_range(edges(graph))) {
    EXPECT_EQ(get(boost::edge_index, graph, e), next);
    EXPECT_EQ(source(e, graph), graph.route(next).source);
    EXPECT_EQ(target(e, graph), graph.route(next).target);
    ++next;
  }
  EXPECT_EQ(next, graph.routes());
  for (int a = 0; a < kLandmarks; ++a) {
    for (int b = 0; b < kLandmarks; ++b) {
      const auto [e, there] = edge(a, b, graph);
      ASSERT_EQ(there, graph.route_between(a, b).has_value());
      if (!there) continue;
      EXPECT_EQ(e.route, graph.route_between(a, b));
      EXPECT_EQ(source(e, graph), a);
      EXPECT_EQ(target(e, graph), b);
      EXPECT_EQ(e, edge(b, a, graph).first);
    }
  }
}

TEST(GraphModel, FieldsAreReadWhereTheyAre) {
  LandmarkGraph graph = drawn(3);
  const auto stretches = get(&Route::stretch, graph);
  const auto positions = get(&Landmark::position, graph);
  const RouteFrom last{graph.routes() - 1, graph.route(graph.routes() - 1).target};
  graph.route(last.route).stretch = 77.0;
  graph.set_position(5, {3.0, 4.0});
  EXPECT_EQ(get(stretches, last), 77.0);
  EXPECT_EQ(get(&Route::stretch, graph, last), 77.0);
  EXPECT_EQ(get(positions, 5), Vector2(3.0, 4.0));
  EXPECT_EQ(&get(&Landmark::position, graph, 5), &graph.landmark(5).position);
}

/// Two algorithms for one thing: Boost's walk through the graph, and joined sets.
TEST(GraphModel, ConnectedComponentsAreTheConnectedParts) {
  int most = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const LandmarkGraph graph = drawn(seed);
    std::vector<int> component(idx(kLandmarks));
    const auto index = get(boost::vertex_index, graph);
    const int count = boost::connected_components(
        graph, boost::make_iterator_property_map(component.begin(), index));
    std::vector<linalg::NodePair> ties;
    ties.reserve(idx(graph.routes()));
    for (int k = 0; k < graph.routes(); ++k) {
      ties.push_back({graph.route(k).target, graph.route(k).source});
    }
    const std::vector<int> part = linalg::connected_parts(kLandmarks, ties);
    std::vector<int> lowest(idx(count), -1);  // of each component: met in ascending order
    for (int v = 0; v < kLandmarks; ++v) {
      int& named = lowest[idx(component[idx(v)])];
      if (named < 0) named = v;
      EXPECT_EQ(part[idx(v)], named);
    }
    most = std::max(most, count);
  }
  EXPECT_GT(most, 5);
}

TEST(GraphModel, BreadthFirstSearchFindsWhatItFindsInBoostsOwnGraph) {
  const LandmarkGraph graph = drawn(4);
  const Listed twin = listed(graph);
  const auto record = [](auto steps) {
    return boost::visitor(
        boost::make_bfs_visitor(boost::record_distances(steps, boost::on_tree_edge())));
  };
  std::vector<int> ours(idx(kLandmarks), 0);
  std::vector<int> theirs(idx(kLandmarks), 0);
  boost::breadth_first_search(graph, 0, record(ours.data()));
  boost::breadth_first_search(twin, 0, record(theirs.data()));
  EXPECT_EQ(ours, theirs);
  EXPECT_GT(*std::max_element(ours.begin(), ours.end()), 3);
}

/// All stretches differ, so there is one such forest.
TEST(GraphModel, ShortestSpanningForestLeavesOutTheLongestOfEachLoop) {
  const LandmarkGraph graph = drawn(5);
  std::vector<RouteFrom> forest;
  boost::kruskal_minimum_spanning_tree(graph, std::back_inserter(forest),
                                       boost::weight_map(get(&Route::stretch, graph)));
  std::vector<bool> kept(idx(graph.routes()), false);
  for (const RouteFrom e : forest) kept[idx(e.route)] = true;
  for (int left_out = 0; left_out < graph.routes(); ++left_out) {
    // Joined by shorter routes alone: then the route closes a loop in which it is the longest.
    linalg::DisjointSets shorter(kLandmarks);
    for (int k = 0; k < graph.routes(); ++k) {
      if (graph.route(k).stretch < graph.route(left_out).stretch) {
        shorter.join(graph.route(k).source, graph.route(k).target);
      }
    }
    const Route& route = graph.route(left_out);
    EXPECT_EQ(!kept[idx(left_out)], shorter.lowest(route.source) == shorter.lowest(route.target));
  }
}

TEST(GraphModel, AnEmptyMapIsAnEmptyGraph) {
  const LandmarkGraph graph;
  EXPECT_EQ(vertices(graph).first, vertices(graph).second);
  EXPECT_EQ(edges(graph).first, edges(graph).second);
}

}  // namespace
}  // namespace trussmap::graph_model_test
