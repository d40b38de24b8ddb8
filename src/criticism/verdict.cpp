// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/verdict.hpp"

#include "statistics/multiple_tests.hpp"

#include <algorithm>

namespace trussmap {

Objection misfit_of(double p_value, const std::vector<Trend>& trends, double level) {
  constexpr double kQuestions = 2.0;
  double of_trends = 1.0;
  for (const Trend& one : trends) of_trends = std::min(of_trends, one.p_adjusted);
  if (bonferroni(p_value, kQuestions) < level) return Objection::chi2;
  return bonferroni(of_trends, kQuestions) < level ? Objection::trend : Objection::none;
}

}  // namespace trussmap
