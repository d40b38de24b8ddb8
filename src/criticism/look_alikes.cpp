// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/look_alikes.hpp"

#include "criticism/effect_strength.hpp"
#include "fit/fit_state.hpp"
#include "linalg/dense.hpp"

#include <algorithm>
#include <numeric>

namespace trussmap {
using namespace criticism;

namespace {

constexpr double kLeastCosine = 0.95;
constexpr std::size_t kMost = 12;

/// A free form that happens to hold the winner's shape is no rival to a catalogue effect.
bool is_rival(const Candidate& one, const Candidate& winner) {
  if (one.form == Form::catalogue || one.form == Form::line) return true;
  if (winner.form == Form::formula && one.form == Form::curve) return true;
  return winner.form != Form::catalogue && winner.form != Form::line && one.form == winner.form;
}

}  // namespace

}  // namespace trussmap

namespace trussmap::criticism {

std::vector<LookAlike> look_alikes_of(std::size_t at, const std::vector<Tested>& tested,
                                      const std::vector<std::size_t>& others,
                                      const ScoreTest& tests, int dof) {
  std::vector<LookAlike> alike;
  const Score winner = tests.test({tested[at].candidate.effect}).front();
  Eigen::VectorXd trace = Eigen::VectorXd::Zero(winner.projected.rows());
  for (std::size_t k = 0; k < winner.coefficients.size(); ++k) {
    trace += winner.coefficients[k] * winner.projected.col(static_cast<Eigen::Index>(k));
  }
  const double length = trace.norm();
  if (length == 0.0) return alike;
  std::vector<Candidate> rivals;
  for (std::size_t k = 0; k < tested.size(); ++k) {
    const Candidate& one = tested[k].candidate;
    if (k != at && is_rival(one, tested[at].candidate)) rivals.push_back(one);
  }
  visit_scores(tests, rivals, Resolution::exact, [&](std::size_t k, const Score& score) {
    if (score.dof == 0) return;
    const Eigen::VectorXd nearest = linalg::least_squares(score.projected, trace);
    const double cosine = (score.projected * nearest).norm() / length;
    if (cosine >= kLeastCosine) alike.push_back({rivals[k].effect, std::min(1.0, cosine)});
  });
  std::stable_sort(alike.begin(), alike.end(),
                   [](const LookAlike& a, const LookAlike& b) { return a.cosine > b.cosine; });
  if (alike.size() > kMost) alike.resize(kMost);
  std::vector<Effect> effects;
  effects.reserve(alike.size());
  for (const LookAlike& one : alike) effects.push_back(one.effect);
  ScoreTest beside = tests;
  for (const std::size_t k : others) {
    if (k != at) beside.condition_on(tests.columns(tested[k].candidate.effect));
  }
  const std::vector<double> behind = chi2_behind(tested[at].candidate.effect, effects, beside, dof);
  for (std::size_t k = 0; k < alike.size(); ++k) alike[k].behind = behind[k];
  return alike;
}

std::vector<double> chi2_behind(const Effect& effect, const std::vector<Effect>& rivals,
                                const ScoreTest& tests, int dof) {
  std::vector<Effect> asked{effect};
  asked.insert(asked.end(), rivals.begin(), rivals.end());
  std::vector<double> scores;
  for (const Score& one : tests.test(asked)) scores.push_back(one.score);
  const double left = tests.residuals().squaredNorm() - scores.front();
  const double noise = std::max(1.0, left / std::max(1, dof));
  std::vector<double> behind;
  for (std::size_t k = 1; k < scores.size(); ++k) {
    behind.push_back((scores.front() - scores[k]) / noise);
  }
  return behind;
}

}  // namespace trussmap::criticism

namespace trussmap {

const LookAlike* closest_rival(const std::vector<LookAlike>& alike) {
  const auto found = std::find_if(alike.begin(), alike.end(),
                                  [](const LookAlike& one) { return !one.told_apart(); });
  return found == alike.end() ? nullptr : &*found;
}

namespace {

constexpr std::size_t kMostFits = 6;
constexpr std::size_t kFitsOfMany = 2;
constexpr std::size_t kMany = 20000;    // measurements, of which a fit takes seconds
constexpr std::size_t kMostShapes = 8;  // of a rival: a map of the floor is no cause

/// Places of those that the tests have nearest, nearest first.
std::vector<std::size_t> nearest_of(const std::vector<LookAlike>& alike, std::size_t most) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < alike.size(); ++k) {
    if (alike[k].effect.shape.size() <= kMostShapes) order.push_back(k);
  }
  std::stable_sort(order.begin(), order.end(), [&alike](std::size_t a, std::size_t b) {
    return alike[a].behind < alike[b].behind;
  });
  if (order.size() > most) order.resize(most);
  return order;
}

bool all_fitted(const ModelFit& fit) {
  return std::all_of(fit.effects.begin(), fit.effects.end(),
                     [](const EffectEstimate& one) { return one.not_fitted.empty(); });
}

}  // namespace

}  // namespace trussmap

namespace trussmap::criticism {

void weigh_by_fits(std::vector<LookAlike>& alike, const Effect& effect, const ScoreTest& tests,
                   const FitWith& with) {
  if (alike.empty()) return;
  const std::optional<ModelFit> winner = with(effect);
  if (!winner || !all_fitted(*winner)) return;
  const double noise = std::max(1.0, winner->chi2 / std::max(1, winner->dof));
  const bool many = winner->state->problem.measurements.size() > kMany;
  for (const std::size_t k : nearest_of(alike, many ? kFitsOfMany : kMostFits)) {
    Effect rival = alike[k].effect;
    rival.coefficients = tests.test({rival}).front().coefficients;
    const std::optional<ModelFit> fit = with(rival);
    if (!fit || !all_fitted(*fit)) continue;
    alike[k].behind = (chi2_of_all(*fit) - chi2_of_all(*winner)) / noise;
  }
}

const LookAlike* better_fitting(const std::vector<LookAlike>& alike, const Effect& effect) {
  constexpr double kClearly = 4.0;  // of chi^2, and for each coefficient
  const auto cost = [&effect](const LookAlike& one) {
    return one.behind + kClearly * (static_cast<double>(one.effect.shape.size()) -
                                    static_cast<double>(effect.shape.size()));
  };
  const auto best = std::min_element(
      alike.begin(), alike.end(),
      [&cost](const LookAlike& a, const LookAlike& b) { return cost(a) < cost(b); });
  return best == alike.end() || cost(*best) > -kClearly ? nullptr : &*best;
}

const LookAlike* find_among(const Effect& effect, const std::vector<LookAlike>& rivals) {
  const auto found = std::find_if(rivals.begin(), rivals.end(), [&](const LookAlike& one) {
    return one.effect.name == effect.name && one.effect.shape == effect.shape;
  });
  return found == rivals.end() ? nullptr : &*found;
}

std::optional<Status> status_beside(const Effect& effect,
                                    const std::vector<std::vector<LookAlike>>& rivals) {
  std::optional<Status> status;
  for (const std::vector<LookAlike>& one : rivals) {
    const LookAlike* same = find_among(effect, one);
    if (same == nullptr) continue;
    if (!same->told_apart()) return Status::cannot_tell;
    status = Status::absent;
  }
  return status;
}

}  // namespace trussmap::criticism
