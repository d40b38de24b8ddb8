// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The equilibrium of a whole truss, joint 0 held, again and again while the truss grows.
//
//   K u = f    K  stiffness of all elements as they lie       f  what strain is left at the joints
//
// CHOLMOD factorises K; after that the factor is kept alive: an element that changes is an update
// of rank 1 (a bar: 2), a new joint a row added in a place kept free at the end, until these places
// are used up and K is factorised anew, in a new order. Elements other than bars are linearised
// anew where they have turned noticeably since. The factor only saves time: where a change of it
// fails, it is dropped and built anew when next needed.
//
// Bars alone: one solution is exact. Cost: one pass over the factor and one over the elements.
#pragma once

#include "linalg/sparse_cholesky.hpp"
#include "truss/elastic_truss.hpp"

#include <array>
#include <vector>

namespace trussmap::truss {

class Equilibrium {
 public:
  /// An element that was added, or whose stiffness may have changed.
  void changed(int element);

  /// Joints were moved that did not come to equilibrium.
  void disturbed() noexcept { sparse_ = kMostSparse; }

  /// The truss is another one, or was rolled back.
  void drop() noexcept;

  /// Brings the truss to equilibrium. Its energy does not rise. Throws NotPositiveDefinite where
  /// stiffnesses span too many magnitudes for an answer, and leaves moves to the truss to roll
  /// back.
  void relax(ElasticTruss& truss, const Enough& enough = {});

  /// Displacements of all joints under loads: joints, and the force on each. Throws likewise,
  /// and where rounding has eaten the digits of the answer.
  [[nodiscard]] std::vector<Vector2> displacements(
      const ElasticTruss& truss, const std::vector<std::pair<int, Vector2>>& loads);

 private:
  /// An element as the factor has it.
  struct Term {
    Matrix2 B = Matrix2::Zero();
    double k = 0.0;
    std::array<Vector2, 3> gradient{Vector2::Zero(), Vector2::Zero(), Vector2::Zero()};
  };
  struct Column {
    std::vector<std::pair<int, Vector2>> parts;  ///< joint, value
  };

  [[nodiscard]] static Term term_of(const ElasticTruss& truss, int element);
  [[nodiscard]] bool held(int joint) const { return joint == 0; }
  void follow(const ElasticTruss& truss);
  void take_in_joint(const ElasticTruss& truss, int joint, const std::vector<int>& elements);
  void change_term(const ElasticTruss& truss, int element, const Term& now);
  void update(const std::vector<Column>& columns, bool add);
  void factorise(const ElasticTruss& truss);
  /// Solutions have digits that are right: rounding has not eaten a pivot.
  [[nodiscard]] bool is_sound() const;
  double evaluate(const ElasticTruss& truss);
  void evaluate_changes(const ElasticTruss& truss);

  std::vector<Term> terms_;               ///< of the elements in the factor
  std::vector<int> changed_;              ///< since then
  std::vector<int> unrest_;               ///< elements that changed since the last equilibrium
  std::vector<char> seen_;                ///< per joint, of evaluate_changes
  static constexpr int kMostSparse = 64;  // then rounding is swept up
  int sparse_ = kMostSparse;              ///< evaluations of changes alone since the last whole one
  std::vector<int> turned_;               ///< elements noticeably, by the last evaluation
  std::vector<int> unknown_;              ///< per place: its joint's first unknown
  int joints_ = 0;                        ///< in the factor
  double nonzeros_ = 0.0;                 ///< of the factor when it was made
  bool factored_ = false;
  bool linear_ = true;  ///< bars alone
  bool sound_ = true;   ///< as the factor was last looked at
  Eigen::VectorXd f_;
  Eigen::VectorXd diagonal_;  ///< of K as the factor has it
  linalg::SparseCholesky cholesky_{linalg::Ordering::fixed};
};

/// Diagonal blocks of K^-1 per joint, as the truss lies; zero of joint 0, which is held. Throws
/// NotPositiveDefinite. Cost: two factorisations.
[[nodiscard]] std::vector<Matrix2> flexibilities(const ElasticTruss& truss);

}  // namespace trussmap::truss
