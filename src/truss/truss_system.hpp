// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The equations of a plane truss, K u = f over the joints that are not held: assembled, factorised
// and solved here, for single load cases (trussmap/truss.hpp) and for measured trusses
// (measured_truss.hpp).
//
//   K   sum over bars of [B -B; -B B], two unknowns per free joint
//
// What a held joint does to its neighbours is the caller's part of f. A solution is refined once
// where rounding shows in it: where a row of K u = f is off by more than rounding of its terms
// explains (componentwise backward error; Arioli, Demmel & Duff, "Solving sparse linear systems
// with sparse backward error", 1989). So stiffnesses of many magnitudes do no harm.
#pragma once

#include "linalg/block_system.hpp"
#include "trussmap/truss.hpp"

#include <vector>

namespace trussmap::truss {

class TrussSystem {
 public:
  /// `held`: per joint. `ends`: of each bar, its two joints. `order`: of elimination, all joints.
  TrussSystem(const std::vector<bool>& held, std::vector<linalg::NodePair> ends,
              const std::vector<int>& order, linalg::Kernel kernel = linalg::Kernel::frontal);

  /// Makes a bar stiffer by this much.
  void add_bar(int bar, const Matrix2& stiffness);
  /// Ties a joint to the ground.
  void add_ground(int joint, const Matrix2& stiffness) { K_.add_diagonal(joint, stiffness); }

  /// Throws UnsupportedJoint where bars leave a joint free to slide, or all but free.
  void factorise();

  /// Displacements of all joints under these forces, zero where held. Call after factorise. Throws
  /// UnsupportedJoint where the answer is not finite.
  [[nodiscard]] std::vector<Vector2> solve(const std::vector<Vector2>& forces);

  /// Diagonal blocks of K^-1 per joint, zero where held. Call after factorise.
  [[nodiscard]] std::vector<Matrix2> flexibilities() const;

  /// Lower triangle of K, and where a free joint's two unknowns begin in it.
  [[nodiscard]] const linalg::SparseMatrix& matrix() const { return K_.matrix(); }
  [[nodiscard]] int offset(int joint) const { return K_.offset(joint); }

 private:
  [[nodiscard]] int joint_of(Eigen::Index unknown) const;

  std::vector<linalg::NodePair> ends_;
  std::size_t joints_;
  std::vector<int> free_;  ///< joints that are not held
  linalg::BlockSystem K_;
};

}  // namespace trussmap::truss
