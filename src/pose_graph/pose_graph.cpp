// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/pose_graph.hpp"

#include "geometry/index.hpp"
#include "linalg/dense.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/LU>

namespace trussmap {
namespace {

// A text file rounds each entry by itself, which can push a zero eigenvalue below zero.
constexpr double kRounding = 1e-9;

template <int N>
bool semidefinite(const Eigen::Matrix<double, N, N>& matrix) {
  if (!matrix.allFinite()) return false;
  const double size = matrix.cwiseAbs().maxCoeff();
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > kRounding * size) return false;
  return linalg::symmetric_eigenvalues(matrix).minCoeff() >= -kRounding * size;
}

/// Sylvester's criterion, clear of rounding: the quick answer for nearly every edge.
template <int N>
bool has_positive_minors(const Eigen::Matrix<double, N, N>& m) {
  if (!m.allFinite() || m != m.transpose()) return false;
  const double minor = m(0, 0) * m(1, 1) - m(0, 1) * m(0, 1);
  if (!(m(0, 0) > 0.0 && minor > kRounding * m(0, 0) * m(1, 1))) return false;
  if constexpr (N == 3) {
    const double product = m(0, 0) * m(1, 1) * m(2, 2);
    return m.determinant() > kRounding * product && m(2, 2) > 0.0;
  }
  return true;
}

bool is_finite(const Pose& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.heading);
}
bool is_finite(const Vector2& vector) {
  return vector.allFinite();
}

/// The faults that all three kinds of edges share.
template <typename Edge>
std::optional<std::string> find_edge_fault(const PoseGraph& graph, const Edge& edge, int from,
                                           int to, VertexKind from_kind, VertexKind to_kind) {
  const int count = static_cast<int>(graph.vertices.size());
  if (from < 0 || to < 0 || from >= count || to >= count) return "leaves the list of vertices";
  const GraphVertex& a = graph.vertices[idx(from)];
  const GraphVertex& b = graph.vertices[idx(to)];
  if (from == to) return "joins vertex " + std::to_string(a.id) + " to itself";
  if (a.kind != from_kind || b.kind != to_kind) {
    return "joins vertices " + std::to_string(a.id) + " and " + std::to_string(b.id) +
           ", which are not of the kinds it is for";
  }
  if (!is_finite(edge.measured)) return "measures something that is not finite";
  if (!is_information(edge.information)) return "has information that is not semidefinite";
  return std::nullopt;
}

}  // namespace

bool is_pose(const GraphVertex& vertex) {
  return vertex.kind == VertexKind::pose;
}

int count_poses(const PoseGraph& graph) {
  return static_cast<int>(std::count_if(graph.vertices.begin(), graph.vertices.end(), is_pose));
}

int count_points(const PoseGraph& graph) {
  return static_cast<int>(graph.vertices.size()) - count_poses(graph);
}

Eigen::Vector3d edge_error(const PoseEdge& edge, const Pose& from, const Pose& to) {
  const Vector2 moved = rotation(from.heading).transpose() * (to.position() - from.position());
  const Vector2 e =
      rotation(edge.measured.heading).transpose() * (moved - edge.measured.position());
  return {e.x(), e.y(), wrap_angle(to.heading - from.heading - edge.measured.heading)};
}

Vector2 edge_error(const PointEdge& edge, const Pose& pose, const Vector2& point) {
  return rotation(pose.heading).transpose() * (point - pose.position()) - edge.measured;
}

double chi_squared(const PoseGraph& graph, const std::vector<Pose>& estimates) {
  if (estimates.size() != graph.vertices.size()) {
    throw std::invalid_argument("one estimate per vertex of the graph is needed");
  }
  double sum = 0.0;
  for (const PoseEdge& edge : graph.pose_edges) {
    const Eigen::Vector3d e = edge_error(edge, estimates[idx(edge.from)], estimates[idx(edge.to)]);
    sum += e.dot(edge.information * e);
  }
  for (const PointEdge& edge : graph.point_edges) {
    const Vector2 e =
        edge_error(edge, estimates[idx(edge.pose)], estimates[idx(edge.point)].position());
    sum += e.dot(edge.information * e);
  }
  for (const DisplacementEdge& edge : graph.displacement_edges) {
    const Vector2 e =
        estimates[idx(edge.to)].position() - estimates[idx(edge.from)].position() - edge.measured;
    sum += e.dot(edge.information * e);
  }
  return sum;
}

bool is_information(const Matrix2& matrix) {
  return has_positive_minors(matrix) || semidefinite<2>(matrix);
}
bool is_information(const Matrix3& matrix) {
  return has_positive_minors(matrix) || semidefinite<3>(matrix);
}

std::optional<std::string> find_fault(const PoseGraph& graph) {
  for (const GraphVertex& vertex : graph.vertices) {
    const std::string name = "vertex " + std::to_string(vertex.id);
    if (vertex.fixed && !vertex.estimate) return name + " is fixed but has no estimate";
    if (vertex.estimate && !is_finite(*vertex.estimate)) return name + " is not finite";
  }
  int number = 0;
  const auto check = [&](const auto& edge, int from, int to, VertexKind a, VertexKind b) {
    ++number;
    std::optional<std::string> fault = find_edge_fault(graph, edge, from, to, a, b);
    if (fault) fault = "edge " + std::to_string(number) + " " + *fault;
    return fault;
  };
  for (const PoseEdge& edge : graph.pose_edges) {
    auto fault = check(edge, edge.from, edge.to, VertexKind::pose, VertexKind::pose);
    if (fault) return fault;
  }
  for (const PointEdge& edge : graph.point_edges) {
    auto fault = check(edge, edge.pose, edge.point, VertexKind::pose, VertexKind::point);
    if (fault) return fault;
  }
  for (const DisplacementEdge& edge : graph.displacement_edges) {
    auto fault = check(edge, edge.from, edge.to, VertexKind::point, VertexKind::point);
    if (fault) return fault;
  }
  return std::nullopt;
}

}  // namespace trussmap
