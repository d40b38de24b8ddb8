// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Search for the likeliest sizes of noise, all at once.
//
//   x       their logarithms (and those of lengths)
//   loss    -2 log of a likelihood there
//
// Quasi-Newton (BFGS, Nocedal & Wright, "Numerical Optimization", 2006, eq. 6.17) from slopes by
// differences; the first inverse Hessian is diagonal, by second differences.
#pragma once

#include <functional>

#include <Eigen/Core>

namespace trussmap::fitting {

using NoiseLoss = std::function<double(const Eigen::VectorXd&)>;

struct NoiseSearch {
  NoiseLoss loss;  ///< infinity where there is none
  /// Where logarithms may go.
  std::function<Eigen::VectorXd(Eigen::VectorXd)> bounded;
  int most_steps = 0;
  double least_gain = 0.0;  ///< of the loss, to go on for
};

struct LikeliestNoise {
  Eigen::VectorXd x;
  double loss = 0.0;
};

/// The minimum downhill from `start`, which has a component at least.
[[nodiscard]] LikeliestNoise likeliest_noise(const NoiseSearch& search,
                                             const Eigen::VectorXd& start);

/// Second derivatives of the loss, by differences.
[[nodiscard]] Eigen::MatrixXd curvatures(const NoiseLoss& loss, const Eigen::VectorXd& x);

}  // namespace trussmap::fitting
