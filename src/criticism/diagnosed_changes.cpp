// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/diagnosed_changes.hpp"

#include "criticism/changing_coefficients.hpp"
#include "criticism/driven_variables.hpp"
#include "fit/fit_state.hpp"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

namespace trussmap::criticism {
namespace {

/// Takes over those of other fits in place of what is known of the same effects.
void take_over(std::vector<ChangingCoefficient> others,
               std::vector<ChangingCoefficient>& changing) {
  for (ChangingCoefficient& one : others) {
    std::erase_if(changing, [&](const ChangingCoefficient& other) {
      return other.effect.name == one.effect.name;
    });
    changing.push_back(std::move(one));
  }
}

}  // namespace

void tell_changes(const ModelFit& stated, const ModelFit& fit, const std::optional<ModelFit>& with,
                  const ScoreTest& about, Diagnosis& result) {
  constexpr double kAsMuch = 0.8;  // of what is missing
  const double level = std::min(kChangeLevel, result.level);
  const auto of = [level](const ModelFit& one) {
    return changing_coefficients(*one.state, ScoreTest(*one.state), level);
  };
  result.changing = changing_coefficients(with ? *with->state : *fit.state, about, level);
  double courses = 0.0;
  double others = 0.0;
  for (const Finding& one : result.findings) {
    if (one.joint.empty()) continue;
    (goes_with_only(one.effect, {"t", "distance"}) ? courses : others) += one.score;
  }
  const auto as_much = [&](std::vector<ChangingCoefficient> found) {
    std::erase_if(found, [&](const auto& one) { return one.chi2_decrease < kAsMuch * courses; });
    return found;
  };
  if (courses > 0.0) take_over(as_much(of(fit)), result.changing);
  if (!result.changing.empty() && others == 0.0 && !(stated.model.noise == fit.model.noise)) {
    std::vector<ChangingCoefficient> plain = of(stated);
    std::erase_if(plain, [&](const ChangingCoefficient& one) {
      return std::ranges::none_of(result.changing, [&](const ChangingCoefficient& other) {
        return other.effect.name == one.effect.name;
      });
    });
    take_over(std::move(plain), result.changing);
  }
  std::ranges::stable_sort(result.changing, {}, &ChangingCoefficient::p_value);
  if (result.changing.empty() || result.verdict != Diagnosis::Verdict::nothing_missing) return;
  result.verdict = Diagnosis::Verdict::unexplained_misfit;
  result.objection = Objection::change;
}

}  // namespace trussmap::criticism
