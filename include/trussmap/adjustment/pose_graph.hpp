// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A pose graph: poses and points in the plane, tied by relative measurements.
//
//   X = (t, theta)   pose of a vertex: position and heading                 m, rad   map frame
//   p                position of a point                                    m        map frame
//   Z                measured relative pose, measured vector                m, rad
//   Omega            information of a measurement, the inverse of its covariance
//   e                error of a measurement, chi^2 = sum e' Omega e
//
//   pose i -> pose j     e = t2v(Z^-1 (X_i^-1 X_j))   EDGE_SE2: the translation part is turned by
//                                                     Z's inverse, the angle lies in [-pi, pi]
//   pose i -> point j    e = R_i' (p_j - t_i) - Z     EDGE_SE2_XY: Z in the robot's frame
//   point i -> point j   e = p_j - p_i - Z            EDGE_POINTXY: Z in the map frame
//
// Edges speak of vertices by their place in `vertices`; ids are the user's names for them.
#pragma once

#include "trussmap/core/planar.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

enum class VertexKind { pose, point };

struct GraphVertex {
  std::int64_t id = 0;
  VertexKind kind = VertexKind::pose;
  std::optional<Pose> estimate;  ///< map frame; a point's heading is 0
  bool fixed = false;            ///< stays at its estimate
};

struct PoseEdge {
  int from = 0;
  int to = 0;
  Pose measured;                          ///< `to` as seen from `from`, m and rad
  Matrix3 information = Matrix3::Zero();  ///< of (x, y, heading), 1/m^2, 1/(m rad), 1/rad^2
};

struct PointEdge {
  int pose = 0;
  int point = 0;
  Vector2 measured = Vector2::Zero();     ///< the point in the robot's frame, m
  Matrix2 information = Matrix2::Zero();  ///< robot's frame, 1/m^2
};

struct DisplacementEdge {
  int from = 0;
  int to = 0;
  Vector2 measured = Vector2::Zero();     ///< from one point to the other, map frame, m
  Matrix2 information = Matrix2::Zero();  ///< map frame, 1/m^2
};

struct PoseGraph {
  std::vector<GraphVertex> vertices;
  std::vector<PoseEdge> pose_edges;
  std::vector<PointEdge> point_edges;
  std::vector<DisplacementEdge> displacement_edges;

  [[nodiscard]] std::size_t edges() const {
    return pose_edges.size() + point_edges.size() + displacement_edges.size();
  }
};

[[nodiscard]] bool is_pose(const GraphVertex& vertex);
[[nodiscard]] int count_poses(const PoseGraph& graph);
[[nodiscard]] int count_points(const PoseGraph& graph);

/// Errors of single measurements at given estimates (a point's heading is ignored).
[[nodiscard]] Eigen::Vector3d edge_error(const PoseEdge& edge, const Pose& from, const Pose& to);
[[nodiscard]] Vector2 edge_error(const PointEdge& edge, const Pose& pose, const Vector2& point);

/// chi^2 of the whole graph at `estimates`, one per vertex. Throws std::invalid_argument on a
/// wrong number of estimates.
[[nodiscard]] double chi_squared(const PoseGraph& graph, const std::vector<Pose>& estimates);

/// Symmetric and positive semidefinite, but for rounding of the last digits of a text file.
[[nodiscard]] bool is_information(const Matrix2& matrix);
[[nodiscard]] bool is_information(const Matrix3& matrix);

/// What makes the graph no graph at all, in words ("edge 7 joins vertex 3 to itself"), if
/// anything: edges that leave the vertex list, join a vertex to itself or the wrong kinds, numbers
/// that are not finite, information that is not semidefinite, fixed vertices without an estimate.
[[nodiscard]] std::optional<std::string> find_fault(const PoseGraph& graph);

}  // namespace trussmap
