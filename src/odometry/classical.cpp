// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "odometry/classical.hpp"

#include <cmath>

namespace trussmap::odometry {

Motion classical_step(ClassicalModel model, const ClassicalStep& step) {
  const double share = model == ClassicalModel::midpoint ? 0.5 : 1.0;
  const double c = std::cos(share * step.turn);
  const double s = std::sin(share * step.turn);
  Motion motion;
  motion.displacement = {step.distance * c, step.distance * s, step.turn};
  Eigen::Matrix<double, 3, 2> G;       // d(x, y, heading)/d(D, a)
  G << c, -share * step.distance * s,  //
      s, share * step.distance * c,    //
      0.0, 1.0;
  motion.covariance =
      G * Vector2(step.distance_variance, step.turn_variance).asDiagonal() * G.transpose();
  return motion;
}

}  // namespace trussmap::odometry
