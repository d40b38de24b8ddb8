// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How far apart drives hold two explanations, from the Gram matrix of their columns alone.
//
//   a        sizes of the effect that is true           A   its columns
//   N        columns of the other explanation and of all that is fitted beside
//   lambda   = a' (G_AA - G_AN G_NN^+ G_NA) a / phi
//
// is by what chi^2 grows on average where the other explanation is fitted in place of the true one;
// the effect is then tested beside the other by a chi^2 of noncentrality lambda. The power is the
// chance that this exceeds what is asked for, the mean over what the size is known to.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace trussmap::planning {

/// What a drive is to tell: that an effect is there, where the others might be instead.
struct Question {
  std::vector<Eigen::Index> columns;  ///< of the effect that is there
  Eigen::VectorXd sizes;              ///< of these
  double sd_share = 0.0;              ///< of the size that its standard error is
  std::vector<Eigen::Index> others;   ///< columns of the other explanation
  double threshold = 0.0;             ///< that the chi^2 has to exceed
  double wanted = 0.0;                ///< lambda at which it does by the wished power
};

/// `gram` over all columns, `beside`: of what is fitted in any case; phi: the noise's dispersion.
[[nodiscard]] double separation(const Eigen::MatrixXd& gram, const Question& question,
                                const std::vector<Eigen::Index>& beside, double phi);

/// At lambda; the size known to a share.
[[nodiscard]] double power_of(const Question& question, double lambda);

/// Fills in `wanted` for this power, of columns, share and threshold.
void want_power(Question& question, double power);

}  // namespace trussmap::planning
