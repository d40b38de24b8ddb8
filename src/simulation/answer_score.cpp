// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/catalogue.hpp"
#include "trussmap/simulated_recording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trussmap {
namespace {

bool same_shapes(const Effect& a, const Effect& b) {
  return a.shape.size() == b.shape.size() &&
         std::equal(
             a.shape.begin(), a.shape.end(), b.shape.begin(),
             [](const Shape& one, const Shape& other) { return one.text() == other.text(); });
}

/// One entry of the catalogue, of the same variables: places and thresholds may differ.
bool same_entry(const Effect& a, const Effect& b) {
  const CatalogueEntry* entry = find_entry(a.name);
  return entry != nullptr && entry == find_entry(b.name) && a.shape.size() == b.shape.size() &&
         std::equal(a.shape.begin(), a.shape.end(), b.shape.begin(),
                    [](const Shape& one, const Shape& other) {
                      return one.variables() == other.variables();
                    });
}

bool says_something(const Effect& effect) {
  return std::any_of(effect.coefficients.begin(), effect.coefficients.end(),
                     [](double one) { return one != 0.0; });
}

std::vector<double> deviations(const Effect& truth, const Effect& estimate,
                               const std::vector<double>& sd) {
  const std::size_t count = estimate.coefficients.size();
  std::vector<double> z(count, std::numeric_limits<double>::quiet_NaN());
  if (truth.coefficients.size() != count || sd.size() != count) return z;
  for (std::size_t k = 0; k < count; ++k) {
    if (!(sd[k] > 0.0) || !std::isfinite(sd[k])) continue;
    z[k] = (estimate.coefficients[k] - truth.coefficients[k]) / sd[k];
  }
  return z;
}

}  // namespace

AnswerScore score_answer(const std::vector<Effect>& truth, const std::vector<Effect>& estimate,
                         const std::vector<std::vector<double>>& sd) {
  AnswerScore score;
  std::vector<bool> taken(estimate.size(), false);
  const auto sd_of = [&](std::size_t k) { return k < sd.size() ? sd[k] : std::vector<double>(); };
  const auto claim = [&](const Effect& one, bool (*same)(const Effect&, const Effect&)) {
    for (std::size_t k = 0; k < estimate.size(); ++k) {
      const bool free = !taken[k] && says_something(estimate[k]);
      if (free && estimate[k].channel == one.channel && same(one, estimate[k])) return k;
    }
    return estimate.size();
  };
  for (const Effect& one : truth) {
    ScoredEffect row;
    row.truth = one;
    std::size_t k = claim(one, same_shapes);
    if (k == estimate.size()) k = claim(one, same_entry);
    if (k < estimate.size()) {
      taken[k] = true;
      row.outcome = ScoredEffect::Outcome::found;
      row.estimate = estimate[k];
      row.sd = sd_of(k);
      row.z = deviations(one, estimate[k], row.sd);
    }
    ++(row.estimate ? score.found : score.missed);
    score.effects.push_back(std::move(row));
  }
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    if (taken[k] || !says_something(estimate[k])) continue;
    ScoredEffect row;
    row.outcome = ScoredEffect::Outcome::false_alarm;
    row.estimate = estimate[k];
    row.sd = sd_of(k);
    score.effects.push_back(std::move(row));
    ++score.false_alarms;
  }
  return score;
}

}  // namespace trussmap
