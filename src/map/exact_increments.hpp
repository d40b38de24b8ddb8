// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The exact increment: recursive least squares in the language of the truss.
//
//   for each traversal with measured vector z and covariance C, first sight included:
//     K: the route's bar becomes stiffer by C^-1
//     K u = f,  f = C^-1 (z - (p_j - p_i)) on j and -f on i,  the first joint held
//     p += u
//
// After every traversal p is the least-squares map of all measurements so far. Or *pooled*, with C
// the mean over the route's t traversals and the bar's stiffness t C^-1: for errors that grow with
// the measured length, where measurements that came out short would otherwise count for more and
// shrink the map; least squares to first order.
//
// K's factor is kept alive: a traversal is a rank-2 update, a new joint a row that is added in a
// place kept free at the end. When these places are used up the factor is built again with new
// ones, in a new order: a step costs one pass over the factor on average, however the map grows.
// The factor only saves time: where a change of it fails, it is dropped and built anew when next
// needed.
#pragma once

#include "geometry/index.hpp"
#include "linalg/sparse_cholesky.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/truss.hpp"

#include <optional>
#include <vector>

namespace trussmap {

class ExactIncrements {
 public:
  /// Joint 0 is held. Each further joint comes with the bar that ties it.
  ExactIncrements() = default;

  /// A truss that is there already: `joints` (1 at least), all tied together by the bars.
  ExactIncrements(int joints, std::vector<Bar> bars);

  /// Makes room for one more joint and bar: adding them cannot fail then.
  void reserve();

  /// Joint `joints()` is tied to joint i. Bars are numbered in the order in which they come. The
  /// calls that change something throw std::invalid_argument on joints out of range; one that
  /// throws changes nothing.
  void add_joint(int i, const Matrix2& stiffness);

  /// Joins two joints.
  void add_bar(int i, int j, const Matrix2& stiffness);

  [[nodiscard]] const Matrix2& stiffness(int bar) const;

  /// Changes the stiffness of a bar; both the old and the new one are positive definite.
  void set_stiffness(int bar, const Matrix2& stiffness);

  /// Undoes the last call of add_bar or set_stiffness, once.
  void take_back() noexcept;

  /// Displacements of all joints under `force` on j and its opposite on i. Throws SolveError where
  /// the stiffnesses span too many magnitudes for an answer.
  [[nodiscard]] std::vector<Vector2> pull(int i, int j, const Vector2& force);

  [[nodiscard]] int joints() const { return joints_; }

 private:
  void check(int i, int j) const;
  [[nodiscard]] int unknown(int joint) const { return unknown_[idx(joint)]; }
  template <typename Change>
  void follow(const Change& change) noexcept;
  void change_factor(const Bar& change);
  void add_to_factor(const Bar& tie);
  void factorise();

  int joints_ = 1;
  int places_ = 0;         ///< joints that the factor has room for; 0: there is no factor
  bool factored_ = false;  ///< the factor is that of all bars
  std::vector<Bar> bars_;
  int changed_ = -1;                       ///< the bar last added or changed; -1: taken back
  std::optional<Matrix2> stiffness_then_;  ///< its stiffness before; none: it was not there
  std::vector<int> unknown_;               ///< per place: its joint's first unknown; negative: held
  SparseCholesky cholesky_{Ordering::fixed};
};

}  // namespace trussmap
