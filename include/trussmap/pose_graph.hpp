// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// A pose graph in the plane, and its best fit from any start.
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
// adjust() finds the estimates of least chi^2:
//   1. Several sets of headings are drawn from the measurements alone: linear fits whose whole
//      turns come from different trees, and the chordal relaxation. Positions given headings are
//      one linear solve.
//   2. The best start descends (Levenberg-Marquardt) until the next step would take less than
//      `tolerance` of chi^2, and takes that step too.
//   3. Whatever start has other windings than what was found, or lies lower, descends as well, and
//      if chi^2 is too large for its degrees of freedom so do all others. The best is kept.
//
// adjust_robustly() does without wrong loop closures: it minimises sum min(e' Omega e, gate) over
// the loop closures plus the plain squares of all else, by graduated non-convexity (Yang,
// Antonante, Tzoumas & Carlone, "Graduated non-convexity for robust spatial perception", 2020),
// leaves out those that end outside the gate and adjusts the rest as usual. A loop closure is a
// pose edge between poses that do not follow each other in the list of vertices; odometry and
// points are believed, and an edge without which the graph would fall apart is kept. The gate takes
// the information at its word: where it claims too much, right edges fall.
//
// What fails: a graph in several parts, a vertex that its measurements leave free. Both are
// SolveErrors that name vertices; nothing is hidden by damping. Local minima: with heading errors
// of some 0.3 rad per edge and few loops, no one can say that a lower minimum does not exist;
// `warnings` says what is suspicious.
#pragma once

#include "trussmap/gate.hpp"
#include "trussmap/planar.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

enum class VertexKind { pose, point };

/// Edges speak of vertices by their place in PoseGraph::vertices; ids are the user's names for
/// them.
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

/// How a file gave the information of its edges; it is read already.
struct GraphSource {
  std::size_t roots = 0;     ///< edges whose information was given as its square root (iSAM)
  bool other_order = false;  ///< entries stood in TORO's order for g2o's, or the reverse
};

struct PoseGraph {
  std::vector<GraphVertex> vertices;
  std::vector<PoseEdge> pose_edges;
  std::vector<PointEdge> point_edges;
  std::vector<DisplacementEdge> displacement_edges;
  GraphSource source = {};

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

enum class StartFrom {
  best,     ///< the file's estimates, if any, and the measurements
  file,     ///< the same, but the file's estimates must be there, and descend in any case
  odometry  ///< the measurements alone: estimates serve to place the held vertex only
};

struct AdjustmentOptions {
  StartFrom start = StartFrom::best;
  int max_iterations = 200;  ///< per descent
  double tolerance = 1e-13;  ///< relative decrease of chi^2 that a next step may still promise
};

struct PoseGraphAdjustment {
  std::vector<Pose> estimates;  ///< per vertex, map frame; headings in (-pi, pi]
  double chi2 = 0.0;            ///< sum of e' Omega e
  int dof = 0;                  ///< measured values less unknowns
  int iterations = 0;           ///< of the descent that found it
  double gradient_norm = 0.0;   ///< 2-norm of the gradient of chi^2, 1/m and 1/rad
  bool converged = false;
  std::string start;  ///< which start led there, in words
  std::vector<std::string> warnings;
};

/// Throws std::invalid_argument on a graph with a fault (find_fault), SolveError on one that has
/// no single best fit.
[[nodiscard]] PoseGraphAdjustment adjust(const PoseGraph& graph,
                                         const AdjustmentOptions& options = {});

/// Covariance of each of the chosen vertices (by place in the list) at `estimates`: 3x3 for a
/// pose, 2x2 for a point, in map axes, zero where held. By columns of the inverse normal matrix:
/// one factorisation and a solve per unknown. Throws like adjust.
[[nodiscard]] std::vector<Eigen::MatrixXd> marginal_covariances(const PoseGraph& graph,
                                                                const std::vector<Pose>& estimates,
                                                                const std::vector<int>& vertices);

struct RobustOptions {
  AdjustmentOptions adjustment;
  /// Largest e' Omega e that a right edge should have: one in a thousand has more (chi^2, 3 dof).
  double gate = kPoseGraphGate;
};

struct RobustAdjustment {
  PoseGraphAdjustment adjustment;  ///< of the edges kept: chi2, dof and warnings are theirs
  std::vector<int> left_out;       ///< places in graph.pose_edges, ascending
};

/// Throws like adjust.
[[nodiscard]] RobustAdjustment adjust_robustly(const PoseGraph& graph,
                                               const RobustOptions& options = {});

}  // namespace trussmap
