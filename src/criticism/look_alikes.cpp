// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/look_alikes.hpp"

#include "linalg/dense.hpp"

#include <algorithm>

namespace trussmap {
namespace {

constexpr double kLeastCosine = 0.95;
constexpr std::size_t kMost = 12;

/// A free form that happens to hold the winner's shape is no rival to a catalogue effect.
bool is_rival(const Candidate& one, const Candidate& winner) {
  if (one.form == Form::catalogue || one.form == Form::line) return true;
  return winner.form != Form::catalogue && winner.form != Form::line && one.form == winner.form;
}

}  // namespace

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
    const Eigen::VectorXd nearest = least_squares(score.projected, trace);
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

const LookAlike* closest_rival(const std::vector<LookAlike>& alike) {
  const auto found = std::find_if(alike.begin(), alike.end(),
                                  [](const LookAlike& one) { return !one.told_apart(); });
  return found == alike.end() ? nullptr : &*found;
}

bool is_among(const Effect& effect, const std::vector<LookAlike>& rivals) {
  return std::any_of(rivals.begin(), rivals.end(), [&](const LookAlike& one) {
    return one.effect.name == effect.name && one.effect.shape == effect.shape;
  });
}

}  // namespace trussmap
