// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a group of joints that moves as one has to know of its bars: sums over them, so that no bar
// is looked at again. A joint of group g lies at
//
//   p = A_g(c) = t + L c             c  its place in the group's own frame
//
// and a bar from v of group a to w of group b pulls with  B (w_rest - (A_b(c_w) - A_a(c_v))):  its
// energy is quadratic in A_a and A_b, with the moments of B over the places c as coefficients. A
// coarser group's sums are its members' sums, carried into its frame and added up.
#pragma once

#include "trussmap/planar.hpp"

#include <array>

#include <Eigen/Core>

namespace trussmap::map {

struct Affine {
  Vector2 t = Vector2::Zero();
  Matrix2 L = Matrix2::Identity();

  [[nodiscard]] Vector2 operator()(const Vector2& c) const { return t + L * c; }
};

[[nodiscard]] inline Affine shift_by(const Vector2& t) {
  return {t, Matrix2::Identity()};
}
/// First b, then a.
[[nodiscard]] inline Affine after(const Affine& a, const Affine& b) {
  return {a.t + a.L * b.t, a.L * b.L};
}
[[nodiscard]] inline Affine inverse_of(const Affine& a) {
  const Matrix2 inverse = a.L.inverse();
  return {-(inverse * a.t), inverse};
}

/// A symmetric stiffness as three numbers.
using Stiffness3 = Eigen::Vector3d;

[[nodiscard]] inline Stiffness3 three_of(const Matrix2& B) {
  return {B(0, 0), B(0, 1), B(1, 1)};
}
[[nodiscard]] inline Vector2 times(const Stiffness3& B, const Vector2& x) {
  return {B[0] * x[0] + B[1] * x[1], B[1] * x[0] + B[2] * x[1]};
}

/// Bars within a group: only differences d of places count.
struct InnerSums {
  std::array<Stiffness3, 3> dd;  ///< sum of B d_x d_x, B d_x d_y, B d_y d_y
  std::array<Vector2, 2> d;      ///< sum of B w d_x, B w d_y

  InnerSums() { clear(); }
  void clear();
  void add_bar(const Matrix2& B, const Vector2& w, const Vector2& d);
  /// Of a member whose places c are `frame`(c) here.
  void add_inner(const InnerSums& of, const Affine& frame);
  [[nodiscard]] const Stiffness3& at(int i, int k) const {
    return dd[static_cast<std::size_t>(i + k)];
  }
};

/// Bars from group a to group b.
struct TieSums {
  Stiffness3 n;                  ///< sum of B
  std::array<Stiffness3, 2> a;   ///< of B x_a, B y_a
  std::array<Stiffness3, 2> b;   ///< likewise of b
  std::array<Stiffness3, 3> aa;  ///< of B x_a x_a, B x_a y_a, B y_a y_a
  std::array<Stiffness3, 3> bb;  ///< likewise of b
  std::array<Stiffness3, 4> ab;  ///< of B x_a x_b, B x_a y_b, B y_a x_b, B y_a y_b
  Vector2 w;                     ///< of B w
  std::array<Vector2, 2> wa;     ///< of B w x_a, B w y_a
  std::array<Vector2, 2> wb;     ///< likewise of b

  TieSums() { clear(); }
  void clear();
  void add_bar(const Matrix2& B, const Vector2& w, const Vector2& at_a, const Vector2& at_b);
  void add(const TieSums& other);
  [[nodiscard]] const Stiffness3& ab_at(int i, int k) const {
    return ab[static_cast<std::size_t>(2 * i + k)];
  }
};

/// The same bars from b to a.
[[nodiscard]] TieSums turned_round(const TieSums& tie);
/// The same bars, where places c are frame(c).
[[nodiscard]] TieSums in_frames(const TieSums& tie, const Affine& frame_a, const Affine& frame_b);
/// Bars between two members of one group, in its frame, are bars within it.
void add_tie(InnerSums& inner, const TieSums& tie);

/// Forces and stiffnesses by a group's six numbers: displacement q_0 + q_1 c_x + q_2 c_y.
using GroupForce = Eigen::Matrix<double, 2, 3>;

/// Pull of the bars within a group on its numbers (the first two are not pulled).
[[nodiscard]] GroupForce pull_within(const InnerSums& inner, const Matrix2& L);
/// Pull of the bars between two groups on those of a and of b.
struct TiePulls {
  GroupForce on_a;
  GroupForce on_b;
};
[[nodiscard]] TiePulls pulls_of(const TieSums& tie, const Affine& at_a, const Affine& at_b);

}  // namespace trussmap::map
