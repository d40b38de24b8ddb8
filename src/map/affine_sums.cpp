// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/affine_sums.hpp"

#include "geometry/index.hpp"

namespace trussmap::map {
namespace {

/// Sums over places: sum of x_i becomes that of (L x)_i.
template <typename Value>
std::array<Value, 2> turned(const Matrix2& L, const std::array<Value, 2>& s) {
  return {Value(L(0, 0) * s[0] + L(0, 1) * s[1]), Value(L(1, 0) * s[0] + L(1, 1) * s[1])};
}

/// Of symmetric second moments: xx, xy, yy.
std::array<Stiffness3, 3> turned(const Matrix2& L, const std::array<Stiffness3, 3>& m) {
  const std::array<Stiffness3, 2> x = turned(L, std::array{m[0], m[1]});
  const std::array<Stiffness3, 2> y = turned(L, std::array{m[1], m[2]});
  return {Stiffness3(L(0, 0) * x[0] + L(0, 1) * y[0]), Stiffness3(L(0, 0) * x[1] + L(0, 1) * y[1]),
          Stiffness3(L(1, 0) * x[1] + L(1, 1) * y[1])};
}

/// Second moments about another origin: `s` are the first ones, turned already.
void shift(std::array<Stiffness3, 3>& m, const Stiffness3& n, const std::array<Stiffness3, 2>& s,
           const Vector2& t) {
  m[0] += t[0] * t[0] * n + 2.0 * t[0] * s[0];
  m[1] += t[0] * t[1] * n + t[0] * s[1] + t[1] * s[0];
  m[2] += t[1] * t[1] * n + 2.0 * t[1] * s[1];
}

std::array<Stiffness3, 3> products(const Stiffness3& B, const Vector2& x) {
  return {Stiffness3(B * (x[0] * x[0])), Stiffness3(B * (x[0] * x[1])),
          Stiffness3(B * (x[1] * x[1]))};
}

template <typename Value, std::size_t N>
void add_to(std::array<Value, N>& sum, const std::array<Value, N>& more) {
  for (std::size_t k = 0; k < N; ++k) sum[k] += more[k];
}

template <typename Value, std::size_t N>
void zero(std::array<Value, N>& sum) {
  for (Value& one : sum) one.setZero();
}

}  // namespace

void InnerSums::clear() {
  zero(dd);
  zero(d);
}

void InnerSums::add_bar(const Matrix2& B, const Vector2& w, const Vector2& between) {
  add_to(dd, products(three_of(B), between));
  const Vector2 Bw = B * w;
  for (std::size_t i = 0; i < 2; ++i) d[i] += Bw * between[static_cast<Eigen::Index>(i)];
}

void InnerSums::add_inner(const InnerSums& of, const Affine& frame) {
  add_to(dd, turned(frame.L, of.dd));
  add_to(d, turned(frame.L, of.d));
}

void TieSums::clear() {
  n.setZero();
  w.setZero();
  zero(a);
  zero(b);
  zero(aa);
  zero(bb);
  zero(ab);
  zero(wa);
  zero(wb);
}

void TieSums::add_bar(const Matrix2& B, const Vector2& rest, const Vector2& at_a,
                      const Vector2& at_b) {
  const Stiffness3 three = three_of(B);
  const Vector2 Bw = B * rest;
  n += three;
  w += Bw;
  for (std::size_t i = 0; i < 2; ++i) {
    const double of_a = at_a[static_cast<Eigen::Index>(i)];
    const double of_b = at_b[static_cast<Eigen::Index>(i)];
    a[i] += of_a * three;
    b[i] += of_b * three;
    wa[i] += of_a * Bw;
    wb[i] += of_b * Bw;
    for (std::size_t k = 0; k < 2; ++k) {
      ab[2 * i + k] += of_a * at_b[static_cast<Eigen::Index>(k)] * three;
    }
  }
  add_to(aa, products(three, at_a));
  add_to(bb, products(three, at_b));
}

void TieSums::add(const TieSums& other) {
  n += other.n;
  w += other.w;
  add_to(a, other.a);
  add_to(b, other.b);
  add_to(aa, other.aa);
  add_to(bb, other.bb);
  add_to(ab, other.ab);
  add_to(wa, other.wa);
  add_to(wb, other.wb);
}

TieSums turned_round(const TieSums& tie) {
  TieSums result = tie;
  std::swap(result.a, result.b);
  std::swap(result.aa, result.bb);
  std::swap(result.ab[1], result.ab[2]);
  std::swap(result.wa, result.wb);
  result.w = -result.w;
  for (std::size_t i = 0; i < 2; ++i) {
    result.wa[i] = -result.wa[i];
    result.wb[i] = -result.wb[i];
  }
  return result;
}

TieSums in_frames(const TieSums& tie, const Affine& frame_a, const Affine& frame_b) {
  TieSums result = tie;
  const std::array<Stiffness3, 2> a = turned(frame_a.L, tie.a);
  const std::array<Stiffness3, 2> b = turned(frame_b.L, tie.b);
  result.aa = turned(frame_a.L, tie.aa);
  result.bb = turned(frame_b.L, tie.bb);
  shift(result.aa, tie.n, a, frame_a.t);
  shift(result.bb, tie.n, b, frame_b.t);
  result.wa = turned(frame_a.L, tie.wa);
  result.wb = turned(frame_b.L, tie.wb);
  // Each row of ab by the frame of b, then the rows by that of a.
  const auto row_x = turned(frame_b.L, std::array{tie.ab[0], tie.ab[1]});
  const auto row_y = turned(frame_b.L, std::array{tie.ab[2], tie.ab[3]});
  for (std::size_t i = 0; i < 2; ++i) {
    const auto r = static_cast<Eigen::Index>(i);
    for (std::size_t k = 0; k < 2; ++k) {
      const auto s = static_cast<Eigen::Index>(k);
      result.ab[2 * i + k] = frame_a.L(r, 0) * row_x[k] + frame_a.L(r, 1) * row_y[k] +
                             frame_a.t[r] * frame_b.t[s] * tie.n + frame_a.t[r] * b[k] +
                             frame_b.t[s] * a[i];
    }
    result.a[i] = a[i] + frame_a.t[r] * tie.n;
    result.b[i] = b[i] + frame_b.t[r] * tie.n;
    result.wa[i] += frame_a.t[r] * tie.w;
    result.wb[i] += frame_b.t[r] * tie.w;
  }
  return result;
}

void add_tie(InnerSums& inner, const TieSums& tie) {
  inner.dd[0] += tie.aa[0] + tie.bb[0] - 2.0 * tie.ab[0];
  inner.dd[1] += tie.aa[1] + tie.bb[1] - tie.ab[1] - tie.ab[2];
  inner.dd[2] += tie.aa[2] + tie.bb[2] - 2.0 * tie.ab[3];
  for (std::size_t i = 0; i < 2; ++i) inner.d[i] += tie.wb[i] - tie.wa[i];
}

GroupForce pull_within(const InnerSums& inner, const Matrix2& L) {
  GroupForce pull = GroupForce::Zero();
  for (int i = 0; i < 2; ++i) {
    pull.col(i + 1) =
        inner.d[idx(i)] - times(inner.at(i, 0), L.col(0)) - times(inner.at(i, 1), L.col(1));
  }
  return pull;
}

TiePulls pulls_of(const TieSums& tie, const Affine& at_a, const Affine& at_b) {
  // Of the bars' vectors what both have in common drops out before it can round.
  const Vector2 between = at_b.t - at_a.t;
  const auto symmetric = [](const std::array<Stiffness3, 3>& m, int i, int k) -> const Stiffness3& {
    return m[idx(i + k)];
  };
  TiePulls pulls;
  Vector2 sum = times(tie.n, between);
  for (int j = 0; j < 2; ++j) {
    sum += times(tie.b[idx(j)], at_b.L.col(j)) - times(tie.a[idx(j)], at_a.L.col(j));
  }
  pulls.on_b.col(0) = tie.w - sum;
  pulls.on_a.col(0) = sum - tie.w;
  for (int i = 0; i < 2; ++i) {
    Vector2 by_a = times(tie.a[idx(i)], between);
    Vector2 by_b = times(tie.b[idx(i)], between);
    for (int j = 0; j < 2; ++j) {
      by_a += times(tie.ab_at(i, j), at_b.L.col(j)) - times(symmetric(tie.aa, i, j), at_a.L.col(j));
      by_b += times(symmetric(tie.bb, i, j), at_b.L.col(j)) - times(tie.ab_at(j, i), at_a.L.col(j));
    }
    pulls.on_a.col(i + 1) = by_a - tie.wa[idx(i)];
    pulls.on_b.col(i + 1) = tie.wb[idx(i)] - by_b;
  }
  return pulls;
}

}  // namespace trussmap::map
