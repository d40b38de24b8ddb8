// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A square of four routes that does not close: its last corner is pulled 0.4 m over to where the
// first one is, and the bars, all equal, share that out.
#include "trussmap/truss.hpp"

#include <cmath>
#include <cstdio>

int main() {
  using namespace trussmap;
  const Matrix2 covariance = 0.01 * Matrix2::Identity();
  const Matrix2 stiffness = bar_stiffness(StiffnessLaw::variance, covariance, 0.0, 1.0);
  const Vector2 misclosure(0.4, -0.2);
  const Deflection deflection =
      solve_truss(5, {{0, 1, stiffness}, {1, 2, stiffness}, {2, 3, stiffness}, {3, 4, stiffness}},
                  {{0, Vector2::Zero()}, {4, misclosure}}, {});

  for (int joint = 0; joint < 5; ++joint) {
    const Vector2& moved = deflection.displacements[static_cast<std::size_t>(joint)];
    std::printf("joint %d moves by (%.3f, %.3f) m\n", joint, moved.x(), moved.y());
    if ((moved - misclosure * joint / 4.0).norm() > 1e-12) return 1;
  }
  // Four springs in series, each of 100 per square metre: energy = |d|^2 * (100/4) / 2.
  return std::abs(deflection.strain_energy - 12.5 * misclosure.squaredNorm()) < 1e-12 ? 0 : 1;
}
