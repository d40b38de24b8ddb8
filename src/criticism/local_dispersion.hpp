// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How noisy are the very rows that speak for an effect? Where noise follows another law than the
// model's, or a single leg is bad, chi^2/dof as a whole says too little: an effect that lives where
// the noise is too large would be named for it.
//
//   u      whitened trace of the effect, as estimated     e = r + u   what it leaves
//   x_k  = u_k' e_k                                       of measurement k
//   v_k  = u_k' P_kk u_k - (u_k' u_k)^2/(u'u)             variance of x_k under the model's noise
//   lambda = sum x_k^2 / sum v_k,    n = (sum v_k)^2 / sum v_k^2   measurements it rests on
//
// n lambda is about chi^2(n) where the model's noise is right (Satterthwaite 1946). The sandwich
// estimate of the score's variance (White 1982) against the model's, no more; so that chance costs
// no power, lambda counts only where p < 0.001.
#pragma once

#include "criticism/score_test.hpp"

#include <vector>

namespace trussmap::criticism {

class LocalDispersion {
 public:
  /// Keeps a reference to the tests, whose present state counts.
  LocalDispersion(const fitting::FitState& fit, const ScoreTest& tests);

  /// lambda, or 1 where that could be chance; where it is less, what it is at most (95 %). The
  /// score has its columns.
  [[nodiscard]] double operator()(const Score& score) const;

 private:
  const ScoreTest& tests_;
  std::vector<Eigen::MatrixXd> own_;  ///< P_kk of each measurement
};

}  // namespace trussmap::criticism
