// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/landmark_conversion.hpp"

#include "geometry/index.hpp"
#include "trussmap/truss.hpp"

#include <charconv>
#include <stdexcept>

#include <Eigen/LU>

namespace trussmap::io {
namespace {

/// The name as a whole number, if it is one and reads back the same.
std::optional<std::int64_t> whole_number(const std::string& name) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), value);
  if (error != std::errc() || end != name.data() + name.size()) return std::nullopt;
  if (std::to_string(value) != name) return std::nullopt;
  return value;
}

std::vector<std::int64_t> ids_of(const LandmarkGraph& map) {
  std::vector<std::int64_t> ids;
  for (int k = 0; k < map.landmarks(); ++k) {
    const std::optional<std::int64_t> number = whole_number(map.landmark(k).name);
    if (!number) break;
    ids.push_back(*number);
  }
  if (ids.size() == idx(map.landmarks())) return ids;
  ids.clear();
  for (int k = 0; k < map.landmarks(); ++k) ids.push_back(k);
  return ids;
}

Matrix2 covariance_of(const Matrix2& information, const PoseGraph& graph,
                      const DisplacementEdge& edge) {
  Matrix2 covariance = information.inverse();
  if (!(information(0, 0) > 0.0 && information.determinant() > 0.0) || !covariance.allFinite()) {
    throw std::invalid_argument(
        "the edge from vertex " + std::to_string(graph.vertices[idx(edge.from)].id) + " to " +
        std::to_string(graph.vertices[idx(edge.to)].id) +
        " has information without an inverse, which a route's covariance must be");
  }
  return covariance;
}

}  // namespace

PoseGraph to_pose_graph(const LandmarkGraph& map) {
  PoseGraph graph;
  const std::vector<std::int64_t> ids = ids_of(map);
  for (int k = 0; k < map.landmarks(); ++k) {
    const Vector2& at = map.landmark(k).position;
    graph.vertices.push_back({ids[idx(k)], VertexKind::point, Pose{at.x(), at.y(), 0.0}, k == 0});
  }
  for (int k = 0; k < map.routes(); ++k) {
    const Route& route = map.route(k);
    const Matrix2 omega = bar_stiffness(StiffnessLaw::variance, route.covariance, route.orientation,
                                        route.traversals);
    graph.displacement_edges.push_back(
        {route.source, route.target, route.displacement, 0.5 * (omega + omega.transpose())});
  }
  return graph;
}

LandmarkGraph to_landmark_graph(const PoseGraph& graph) {
  if (count_poses(graph) > 0) {
    throw std::invalid_argument(
        "is a graph of poses, expected a map: points (VERTEX_XY) and displacements (EDGE_POINTXY) "
        "alone");
  }
  LandmarkGraph map;
  for (const GraphVertex& vertex : graph.vertices) {
    if (!vertex.estimate) {
      throw std::invalid_argument("vertex " + std::to_string(vertex.id) +
                                  " has no position, which a landmark needs");
    }
    map.add_landmark(std::to_string(vertex.id), vertex.estimate->position());
  }
  for (const DisplacementEdge& edge : graph.displacement_edges) {
    const Matrix2 covariance = covariance_of(edge.information, graph, edge);
    const std::optional<int> known = map.route_between(edge.from, edge.to);
    if (!known) {
      map.add_traversal(edge.from, edge.to, {edge.measured, covariance});
      continue;
    }
    Route& route = map.route(*known);
    const Vector2 measured = route.source == edge.from ? edge.measured : Vector2(-edge.measured);
    const Matrix2 before = route.traversals * route.covariance.inverse();
    const Matrix2 joint = (before + edge.information).inverse();
    const Vector2 mean = joint * (before * route.displacement + edge.information * measured);
    average_in(route, {measured, covariance});
    route.displacement = mean;
    route.covariance = route.traversals * joint;
  }
  return map;
}

}  // namespace trussmap::io
