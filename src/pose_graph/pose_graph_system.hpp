// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A pose graph seen as a truss: chi^2 and its normal equations at given estimates.
//
//   X = (t, theta)      pose of a vertex, additive steps (dx, dy, dtheta) in the map frame
//   d = t_j - t_i       the bar from i to j                                        m
//   J                   quarter turn;  q = J d
//   A                   turns map axes into the measurement's: R(theta_i + theta_Z)' for a pose
//                       edge, R(theta_i)' for a point seen, 1 for a displacement
//   B = A' Omega A      the bar's stiffness in map axes (A acting on x, y only)
//   f = A' Omega e      the force in the bar
//
// To first order an edge's error is changed by its far end alone and by the lever of its near end:
// de = A (dX_j - T dX_i), T = [1 q; 0 1]. So the bar's part of the normal equations H dX = -g is
//
//   H_jj = B    H_ij = -T' B    H_ii = T' B T    g_j = f    g_i = -T' f
//
// and no Jacobian is ever formed. g is half the gradient of chi^2.
#pragma once

#include "linalg/block_system.hpp"
#include "trussmap/pose_graph.hpp"

#include <cstdint>
#include <vector>

namespace trussmap::pose_graph {

class PoseGraphSystem {
 public:
  /// `held` per vertex, as choose_gauge gives it. The graph must be without faults.
  PoseGraphSystem(const PoseGraph& graph, const std::vector<std::uint8_t>& held);

  /// chi^2, H and g at `estimates` (one per vertex; a point's heading is ignored). With headings
  /// held, a step moves positions only, for which chi^2 is quadratic: one step is exact.
  double linearise(const std::vector<Pose>& estimates, bool hold_headings = false);
  [[nodiscard]] double chi_squared(const std::vector<Pose>& estimates);

  /// Multiplies the information of every edge, in the order of pairs(), from now on.
  void set_weights(const std::vector<double>& weights);

  struct Step {
    Eigen::VectorXd nodes;   ///< dX, in the normal equations' order
    double predicted = 0.0;  ///< decrease of chi^2 by the linear model
  };
  /// Solves (H + damping diag H) dX = -g (a diagonal of at least 1e-9 of its largest). Throws
  /// NotPositiveDefinite. May be called again with another damping for the same linearisation.
  [[nodiscard]] Step solve_step(double damping = 0.0);

  /// Twice the energy that a small displacement of all unknowns would store, to first order:
  /// sum (dX_j - T dX_i)' B (dX_j - T dX_i), bar by bar, which keeps digits that dX' H dX loses.
  [[nodiscard]] double strain_energy(const std::vector<Pose>& estimates,
                                     const Eigen::VectorXd& displacement) const;

  /// estimates + dX.
  [[nodiscard]] std::vector<Pose> moved(const std::vector<Pose>& estimates,
                                        const Eigen::VectorXd& step) const;

  [[nodiscard]] const Eigen::VectorXd& gradient() const { return gradient_; }
  [[nodiscard]] const linalg::BlockSystem& normal_equations() const { return normal_; }
  [[nodiscard]] linalg::BlockSystem& normal_equations() { return normal_; }
  [[nodiscard]] const std::vector<linalg::NodePair>& pairs() const { return pairs_; }
  [[nodiscard]] const std::vector<int>& order() const { return order_; }
  [[nodiscard]] const std::vector<std::uint8_t>& held() const { return held_; }
  /// The vertex that an unknown of the normal equations belongs to.
  [[nodiscard]] int vertex_of(int unknown) const { return vertex_of_[idx(unknown)]; }

 private:
  /// An edge as the inner loop wants it.
  struct Bar3 {
    int from, to;
    double heading, cos, sin;       ///< of Z
    double x, y;                    ///< Z's position seen in Z's own axes, R(theta_Z)' (x, y)
    double xx, xy, xt, yy, yt, tt;  ///< Omega
  };
  struct Bar2 {
    int from, to;
    bool from_pose;  ///< else from a point: measured in map axes
    double x, y;     ///< Z
    double xx, xy, yy;
  };
  struct Direction {
    double cos = 1.0, sin = 0.0;
  };

  template <bool kEquations>
  double evaluate(const std::vector<Pose>& estimates);
  template <bool kEquations>
  double add_bar(const Bar3& bar, int pair, const std::vector<Pose>& estimates);
  template <bool kEquations>
  double add_bar(const Bar2& bar, int pair, const std::vector<Pose>& estimates);
  void add_stiffness(const Bar3& bar, int pair, Matrix3& B, double dx, double dy);
  void add_force(int vertex, const Eigen::Vector3d& force);
  void add_force(int vertex, const Vector2& force);
  template <int N>
  void mask(int vertex, Eigen::Matrix<double, N, N>& diagonal) const;

  std::vector<std::uint8_t> held_;    ///< as given
  std::vector<std::uint8_t> pinned_;  ///< of the vertices in the system: what must not move now
  std::vector<Bar3> pose_bars_;
  std::vector<Bar2> vector_bars_;
  std::vector<Bar3> full_pose_bars_;  ///< the same with all weights 1
  std::vector<Bar2> full_vector_bars_;
  std::vector<Direction> directions_;    ///< of each pose's heading, at the present estimates
  std::vector<linalg::NodePair> pairs_;  ///< pose, point, then displacement edges
  std::vector<int> order_;
  std::vector<int> vertex_of_;
  linalg::BlockSystem normal_;
  Eigen::VectorXd gradient_;
};

}  // namespace trussmap::pose_graph
