// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#pragma once

#include "trussmap/planar.hpp"

#include <cmath>

namespace trussmap::drive {

/// Direction of an arc's chord times chord/path, (sin a/a, (1 - cos a)/a), and its derivative.
struct UnitArc {
  Vector2 end;
  Vector2 slope;
};

[[nodiscard]] inline UnitArc unit_arc(double a) {
  if (std::abs(a) < 1e-4) {
    return {{1.0 - a * a / 6.0, 0.5 * a - a * a * a / 24.0}, {-a / 3.0, 0.5 - a * a / 8.0}};
  }
  const double s = std::sin(a);
  const double c = std::cos(a);
  return {{s / a, (1.0 - c) / a}, {(a * c - s) / (a * a), (a * s - 1.0 + c) / (a * a)}};
}

}  // namespace trussmap::drive
