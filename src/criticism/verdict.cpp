// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/verdict.hpp"

#include "statistics/multiple_tests.hpp"

#include <algorithm>

namespace trussmap::criticism {

Objection misfit_of(double p_value, const std::vector<Trend>& trends, double level) {
  constexpr double kQuestions = 2.0;
  double of_trends = 1.0;
  for (const Trend& one : trends) of_trends = std::min(of_trends, one.p_adjusted);
  if (statistics::bonferroni(p_value, kQuestions) < level) return Objection::chi2;
  return statistics::bonferroni(of_trends, kQuestions) < level ? Objection::trend : Objection::none;
}

}  // namespace trussmap::criticism

namespace trussmap {

bool is_slight_misfit(const Diagnosis& diagnosis) {
  constexpr double kSlight = 0.001;  // p
  return diagnosis.verdict == Diagnosis::Verdict::unexplained_misfit &&
         diagnosis.objection == Objection::chi2 && diagnosis.p_value > kSlight;
}

}  // namespace trussmap

namespace trussmap::criticism {

void object_to_noise(const FittedNoise& noise, Diagnosis& diagnosis) {
  if (diagnosis.verdict != Diagnosis::Verdict::nothing_missing) return;
  if (std::none_of(noise.sources.begin(), noise.sources.end(),
                   [](const NoiseSource& one) { return one.no_noise; })) {
    return;
  }
  diagnosis.verdict = Diagnosis::Verdict::unexplained_misfit;
  diagnosis.objection = Objection::noise;
}

}  // namespace trussmap::criticism

namespace trussmap {

std::vector<const Finding*> found_by(const Diagnosis& diagnosis) {
  std::vector<const Finding*> found;
  for (const Finding& one : diagnosis.findings) {
    if (one.status == Status::missing || one.status == Status::negligible) found.push_back(&one);
  }
  return found;
}

}  // namespace trussmap
