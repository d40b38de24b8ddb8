// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Restricted likelihood of a fit (restricted_likelihood.hpp) under a noise law, whose covariance of
// the rows is the stated one + l V.
#pragma once

#include "criticism/noise_laws.hpp"
#include "estimation/recording_system.hpp"

namespace trussmap::criticism {

class NoiseLikelihood {
 public:
  /// `nuisance`: whitened columns of further unknowns. Keeps a reference to the fit.
  NoiseLikelihood(const fitting::FitState& fit, const Eigen::MatrixXd& nuisance);

  /// -2 log R under the law with this variance, less that of the stated noise. Afterwards problem
  /// and system are those under the law.
  double deviance(const NoiseLaw& law, double variance);

  struct Best {
    double variance = 0.0;
    double gain = 0.0;  ///< fall of the deviance
  };
  /// The law's likeliest variance, to some 10 %, sought from a first guess.
  [[nodiscard]] Best best(const NoiseLaw& law, double guess);

  [[nodiscard]] const estimation::RecordingProblem& problem() const { return problem_; }
  [[nodiscard]] const estimation::RecordingSystem& system() const { return system_; }
  /// The further columns, whitened as the problem is.
  [[nodiscard]] const Eigen::MatrixXd& nuisance() const { return nuisance_; }

 private:
  [[nodiscard]] double minus_two_log();

  const fitting::FitState& fit_;
  Eigen::MatrixXd nuisance_stated_;
  Eigen::MatrixXd nuisance_;
  estimation::RecordingProblem problem_;
  estimation::RecordingSystem system_;
  std::vector<estimation::Matrix4> colour_;  ///< inverse of the stated whitener
  double stated_ = 0.0;
};

}  // namespace trussmap::criticism
