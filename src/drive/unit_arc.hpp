// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The arcs that a drive's rows are. A row turns little, and there are very many: short series serve
// it, and the heading's sine and cosine go on from row to row without being asked for anew.
#pragma once

#include "trussmap/planar.hpp"

#include <cmath>

namespace trussmap::drive {

/// Direction of an arc's chord times chord/path, (sin a/a, (1 - cos a)/a), and its derivative.
struct UnitArc {
  Vector2 end;
  Vector2 slope;
};

/// 1 - b/n (1 - b/n2 (1 - ...)).
template <int n, int... more>
[[nodiscard]] constexpr double alternating(double b) {
  constexpr double kShare = 1.0 / n;
  if constexpr (sizeof...(more) == 0) {
    return 1.0 - kShare * b;
  } else {
    return 1.0 - kShare * b * alternating<more...>(b);
  }
}

[[nodiscard]] inline UnitArc unit_arc(double a) {
  constexpr double kShort = 0.25;  // rad: the series are exact to rounding
  if (std::abs(a) < kShort) {
    const double b = a * a;
    return {
        {alternating<6, 20, 42, 72, 110, 156>(b), 0.5 * a * alternating<12, 30, 56, 90, 132>(b)},
        {-a / 3.0 * alternating<10, 28, 54, 88, 130>(b),
         0.5 * alternating<4, 18, 40, 70, 108, 154>(b)}};
  }
  const double s = std::sin(a);
  const double c = std::cos(a);
  return {{s / a, (1.0 - c) / a}, {(a * c - s) / (a * a), (a * s - 1.0 + c) / (a * a)}};
}

/// A heading that rows turn on from 0.
class RowHeading {
 public:
  [[nodiscard]] Vector2 operator*(const Vector2& along) const {
    return {cos_ * along.x() - sin_ * along.y(), sin_ * along.x() + cos_ * along.y()};
  }
  /// By `a`, whose arc this is.
  void turn(double a, const UnitArc& arc) {
    const double sine = a * arc.end.x();
    const double less = a * arc.end.y();  // 1 - cos a
    const double c = cos_;
    cos_ -= less * cos_ + sine * sin_;
    sin_ += sine * c - less * sin_;
  }

 private:
  double cos_ = 1.0;
  double sin_ = 0.0;
};

}  // namespace trussmap::drive
