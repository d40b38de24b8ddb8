// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Estimates of the same thing from many members, each with a known standard error:
//
//   y_i = mu_g(i) + u_i + e_i,   u_i ~ N(0, tau^2),   e_i ~ N(0, s_i^2),   w_i = 1/(s_i^2 + tau^2)
//
//   tau   restricted likelihood (Patterson & Thompson 1971; DerSimonian & Laird 1986 for the model)
//   mu    weighted mean, variance max(1, q)/sum w, q = sum w (y - mu)^2/(n - groups): Hartung &
//         Knapp (2001), never below the plain one
//   tau = 0   restricted likelihood ratio, half chi^2(0) and half chi^2(1) (Self & Liang 1987)
//   groups    F = sum_g W_g (mu_g - mu)^2/(groups - 1)/max(1, q)
//
// Members that the model does not explain, by Holm over all members at a level, are left out and
// all is estimated anew, until none is new. The start is by medians, so that several cannot hide
// each other. Where they would be more than a fifth, none is left out: then it is no few outliers
// that the model lacks.
#pragma once

#include <cstddef>
#include <vector>

namespace trussmap::statistics {

struct MemberEstimate {
  double value = 0.0;
  double variance = 0.0;  ///< s^2, above 0
  std::size_t group = 0;
};

struct GroupMean {
  int members = 0;
  double mean = 0.0;
  double sd = 0.0;
  double p_value = 1.0;  ///< of mean 0
};

struct RandomEffects {
  std::vector<GroupMean> groups;
  double mean = 0.0;  ///< of all members as if in one group, with this tau
  double sd = 0.0;
  double p_mean = 1.0;
  double p_groups = 1.0;
  double tau = 0.0;
  double p_tau = 1.0;
  double Q = 0.0;  ///< Cochran's, of the groups
  int Q_dof = 0;
  std::vector<double> p_member;  ///< Holm
  std::vector<bool> outlying;
};

/// Groups count from 0 to `groups` - 1. Some members are needed.
[[nodiscard]] RandomEffects random_effects(const std::vector<MemberEstimate>& members,
                                           std::size_t groups, double level);

}  // namespace trussmap::statistics
