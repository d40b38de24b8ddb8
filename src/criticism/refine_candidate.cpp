// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/candidates.hpp"
#include "text/number_text.hpp"
#include "trussmap/catalogue.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace trussmap::criticism {
namespace {

constexpr int kQuickRounds = 10;
constexpr int kExactRounds = 7;

std::vector<double> values_of(const std::vector<ShapeParameter>& parameters) {
  std::vector<double> values;
  values.reserve(parameters.size());
  for (const ShapeParameter& one : parameters) values.push_back(one.value);
  return values;
}

/// Goes to better parameters, `step` apart, and halves the step where there are none.
Candidate climbed(const ScoreTest& tests, const Candidate& candidate, std::vector<double> step,
                  int rounds, Resolution resolution) {
  Candidate best = candidate;
  double score = tests.test({candidate.effect}, resolution).front().score;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Candidate> around;
    std::vector<Effect> effects;
    for (std::size_t k = 0; k < step.size(); ++k) {
      for (const double sign : {-1.0, 1.0}) {
        std::vector<double> values = values_of(best.parameters);
        values[k] = std::clamp(values[k] + sign * step[k], candidate.search[k].least,
                               candidate.search[k].most);
        Candidate next = with_parameters(candidate, values);
        if (next.parameters == best.parameters) continue;
        effects.push_back(next.effect);
        around.push_back(std::move(next));
      }
    }
    bool better = false;
    const std::vector<Score> scores = tests.test(effects, resolution);
    for (std::size_t k = 0; k < scores.size(); ++k) {
      if (scores[k].score <= score * (1.0 + 1e-9)) continue;
      score = scores[k].score;
      best = around[k];
      better = true;
    }
    if (better) continue;
    for (double& s : step) s *= 0.5;
  }
  return best;
}

/// The search's steps, times a factor.
std::vector<double> steps_of(const Candidate& candidate, double factor) {
  std::vector<double> steps;
  for (const SearchRange& one : candidate.search) steps.push_back(factor * one.step);
  return steps;
}

/// As the pattern has them.
std::vector<ShapeParameter> written(const Candidate& one) {
  if (one.writing == Writing::as_they_are) return one.parameters;
  const double angle = one.parameters[0].value;
  const double size = one.parameters[1].value;
  const Vector2 along(std::cos(angle), std::sin(angle));
  if (one.writing == Writing::line) {
    constexpr double kShortest = 1.0;  // of a normal's axes
    const double a = text::rounded_within(along.x(), kShortest);
    const double b = text::rounded_within(along.y(), kShortest);
    const double c = size + one.pivot.dot(Vector2(a, b));
    return {{"a", a}, {"b", b}, {"c", text::rounded_within(c, kShortest)}};
  }
  const double k = 2.0 * std::numbers::pi / size;
  return {{"kx", text::rounded_within(k * along.x(), k)},
          {"ky", text::rounded_within(k * along.y(), k)}};
}

}  // namespace

Candidate with_parameters(const Candidate& candidate, const std::vector<double>& values) {
  Candidate one = candidate;
  for (std::size_t k = 0; k < values.size(); ++k) {
    one.parameters[k].value = text::rounded_within(values[k], candidate.search[k].step);
  }
  if (one.form == Form::catalogue) {
    one.effect = catalogue_effect(*find_entry(candidate.effect.name), one.parameters);
    return one;
  }
  one.effect.shape.clear();
  const std::vector<ShapeParameter> filled_in = written(one);
  for (const std::string& pattern : candidate.pattern) {
    one.effect.shape.emplace_back(pattern, filled_in);
  }
  return one;
}

Candidate refined(const ScoreTest& tests, const Candidate& candidate) {
  if (candidate.parameters.empty()) return candidate;
  const Candidate near =
      climbed(tests, candidate, steps_of(candidate, 0.5), kQuickRounds, Resolution::quick);
  return climbed(tests, near, steps_of(candidate, 0.0625), kExactRounds, Resolution::exact);
}

}  // namespace trussmap::criticism
