// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/noise_beside.hpp"

#include "criticism/candidates.hpp"
#include "criticism/tested_candidate.hpp"
#include "linalg/dense.hpp"
#include "statistics/distributions.hpp"

#include <algorithm>
#include <optional>

namespace trussmap {
namespace {

constexpr std::size_t kMostSuspects = 3;
constexpr double kAllows = 0.05;      // p of chi^2
constexpr double kSuspicious = 1e-4;  // p, times the effects asked of

/// Those without a place or threshold to be sought.
std::vector<Candidate> plain_candidates(const FitState& fit, const ScoreTest& tests) {
  std::vector<Candidate> candidates = candidates_for(fit, tests.context());
  std::erase_if(candidates, [](const Candidate& one) { return !one.family.empty(); });
  return candidates;
}

/// Whitened columns of what explains most, each conditioned on those before it.
Eigen::MatrixXd suspects(const FitState& fit) {
  ScoreTest tests(fit);
  const std::vector<Candidate> candidates = plain_candidates(fit, tests);
  Eigen::MatrixXd columns(tests.system().rows(), 0);
  int dof = fit.adjustment.dof;
  for (std::size_t round = 0; round < kMostSuspects; ++round) {
    const double chi2 = tests.residuals().squaredNorm();
    std::optional<std::size_t> best;
    double least = kSuspicious / static_cast<double>(candidates.size());
    visit_scores(tests, candidates, Resolution::quick, [&](std::size_t k, const Score& score) {
      if (score.dof == 0 || dof <= score.dof) return;
      const double left = std::max(1.0, (chi2 - score.score) / (dof - score.dof));
      const double p = chi2_p_value(score.score / left, score.dof);
      if (p >= least) return;
      least = p;
      best = k;
    });
    if (!best) break;
    const Score found = tests.test({candidates[*best].effect}).front();
    if (found.dof == 0) break;
    append_columns(columns, found.columns);
    tests.condition_on(found.columns);
    dof -= found.dof;
  }
  return columns;
}

}  // namespace

FitWithNoise with_noise_beside(const std::vector<Recording>& recordings, const ModelFit& fit,
                               const Noise& stated) {
  constexpr int kMostRounds = 2;
  constexpr double kStillBetter = 2.0;  // of -2 log R
  FitWithNoise result{fit, {}};
  result.noise.noise = stated;
  if (fit.model.noise == stated && fit.p_value > kAllows) return result;
  NoiseFitOptions options;
  options.errors = false;
  double gain = 0.0;
  for (int round = 0; round < kMostRounds; ++round) {
    // Which processes there are is asked once.
    if (round > 0) options.most_processes = 0;
    NoiseReml reml(*result.fit.state, stated);
    FittedNoise next = fit_noise(reml, suspects(*result.fit.state), options);
    if (round > 0 && next.gain < gain + kStillBetter) break;
    next.tried = std::max(next.tried, result.noise.tried);
    result.noise = std::move(next);
    gain = result.noise.gain;
    if (result.noise.noise == result.fit.model.noise) break;
    Model model = result.fit.model;
    model.noise = result.noise.noise;
    result.fit = refit(recordings, model, result.fit);
    if (!result.noise.changed()) break;
  }
  return result;
}

}  // namespace trussmap
