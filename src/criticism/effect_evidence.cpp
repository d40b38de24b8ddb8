// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/effect_evidence.hpp"

#include "criticism/response.hpp"
#include "effects/place.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace trussmap::criticism {
namespace {

/// The smallest size that would have been seen, as the largest |g| that it makes; 0 where none
/// would have been.
double seen_from(const Finding& finding, ShapeRanges& ranges) {
  Effect effect = finding.effect;
  double most = 0.0;
  for (std::size_t k = 0; k < finding.minimal_detectable.size(); ++k) {
    if (!std::isfinite(finding.minimal_detectable[k])) return 0.0;
    std::vector<double> alone(effect.coefficients.size(), 0.0);
    alone.at(k) = finding.minimal_detectable[k];
    effect.coefficients = std::move(alone);
    const EffectRange range = ranges.of(effect);
    most = std::max({most, std::abs(range.least), std::abs(range.most)});
  }
  return most;
}

}  // namespace

EffectEvidence seen_effect(const EffectEstimate& estimate, std::vector<Effect> rivals,
                           const fitting::FitState& fit, const ScoreTest& tests,
                           const Eigen::VectorXd& rows) {
  const Effect& effect = estimate.effect;
  EffectEvidence one{estimate, {}, range_of(effect, tests.context()), std::move(rivals)};
  const std::string variable = effects::place_of(effect) ? kPlace : natural_variable(effect);
  if (!variable.empty()) {
    one.response = response_along(variable, effect, fit, tests, one.rivals, rows);
  }
  if (one.response.curve.empty() && !one.response.bins.empty()) {
    one.response.curve =
        effect_curve(effect, variable, one.response.bins.front().at, one.response.bins.back().at);
  }
  return one;
}

std::vector<FindingSize> sizes_of(const Diagnosis& diagnosis,
                                  const fitting::ShapeContext& context) {
  ShapeRanges ranges(context);
  std::vector<FindingSize> sizes;
  for (const Finding& one : diagnosis.findings) {
    Effect effect = one.effect;
    if (!one.joint.empty()) effect.coefficients = one.joint;
    sizes.push_back({ranges.of(effect), seen_from(one, ranges)});
  }
  return sizes;
}

}  // namespace trussmap::criticism
