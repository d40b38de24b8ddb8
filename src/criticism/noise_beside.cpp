// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/noise_beside.hpp"

#include "criticism/best_set.hpp"
#include "criticism/candidates.hpp"
#include "criticism/refits.hpp"
#include "criticism/tested_candidate.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <optional>

namespace trussmap::criticism {
namespace {

constexpr std::size_t kMostSuspects = 3;
constexpr double kAllows = 0.05;      // p of chi^2
constexpr double kSuspicious = 1e-4;  // p, times the effects asked of

/// Those without a place or threshold to be sought.
std::vector<Candidate> plain_candidates(const fitting::FitState& fit, const ScoreTest& tests) {
  std::vector<Candidate> candidates = candidates_for(fit, tests.context());
  std::erase_if(candidates, [](const Candidate& one) { return !one.family.empty(); });
  return candidates;
}

bool was_sought(const Candidate& one) {
  if (one.form == Form::formula) return true;
  return std::any_of(one.effect.shape.begin(), one.effect.shape.end(),
                     [](const Shape& shape) { return !shape.parameters().empty(); });
}

/// Two that hide each other, where no candidate by itself is suspicious.
std::vector<std::size_t> suspicious_pair(const ScoreTest& tests,
                                         const std::vector<Candidate>& candidates, int dof) {
  GramBuilder builder(tests.residuals().size());
  std::vector<Tested> asked;
  for (const Candidate& one : candidates) {
    asked.emplace_back();
    asked.back().candidate = one;
  }
  visit_scores(tests, candidates, Resolution::quick, [&](std::size_t k, const Score& score) {
    builder.add(k, candidates[k].effect, score);
  });
  return masked_pair(builder.gram(tests.residuals()), asked, {tests, dof, 2, 0.0}, kSuspicious);
}

/// What explains most, each conditioned on those before it.
std::vector<Effect> suspects(const fitting::FitState& fit) {
  ScoreTest tests(fit);
  const std::vector<Candidate> candidates = plain_candidates(fit, tests);
  std::vector<Effect> found;
  int dof = fit.adjustment.dof;
  for (std::size_t round = 0; round < kMostSuspects; ++round) {
    const double chi2 = tests.residuals().squaredNorm();
    std::optional<std::size_t> best;
    double most = 0.0;
    visit_scores(tests, candidates, Resolution::quick, [&](std::size_t k, Score& score) {
      if (score.dof == 0 || dof <= score.dof) return;
      const double left = std::max(1.0, (chi2 - score.score) / (dof - score.dof));
      const double net = score.score / left;
      if (statistics::chi2_p_value(net, score.dof) * static_cast<double>(candidates.size()) >=
          kSuspicious) {
        return;
      }
      // By evidence: p of what is large is 0 for many.
      Tested one;
      one.candidate = candidates[k];
      one.score.dof = score.dof;
      const double evidence = evidence_at(one, net);
      if (best && evidence <= most) return;
      most = evidence;
      best = k;
    });
    if (!best) {
      if (round + 1 == kMostSuspects) break;
      for (const std::size_t k : suspicious_pair(tests, candidates, dof)) {
        found.push_back(candidates[k].effect);
      }
      break;
    }
    const Effect& suspect = candidates[*best].effect;
    const Score score = tests.test({suspect}).front();
    if (score.dof == 0) break;
    found.push_back(suspect);
    tests.condition_on(score.columns);
    dof -= score.dof;
  }
  return found;
}

/// The fit with its suspects as effects: large ones bend the rows, and what a plane leaves of them
/// would look like noise. Those that cannot be fitted together are left out from the last on.
ModelFit with_suspects(const std::vector<DrivenRecording>& recordings, const ModelFit& fit) {
  std::vector<Effect> found = suspects(*fit.state);
  for (; !found.empty(); found.pop_back()) {
    if (std::optional<ModelFit> with = if_fitted_with(recordings, fit, found)) {
      return *std::move(with);
    }
  }
  return fit;
}

}  // namespace

FitWithNoise with_noise_beside(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
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
    const ModelFit beside = with_suspects(recordings, result.fit);
    fitting::NoiseReml reml(*beside.state, stated);
    FittedNoise next = fitting::fit_noise(reml, {}, options);
    if (round > 0 && next.gain < gain + kStillBetter) break;
    next.tried = std::max(next.tried, result.noise.tried);
    result.noise = std::move(next);
    gain = result.noise.gain;
    if (result.noise.noise == result.fit.model.noise) break;
    result.fit = refit_under(recordings, result.fit, result.noise.noise);
    if (!result.noise.changed()) break;
  }
  return result;
}

std::optional<FitWithNoise> with_noise_beside_found(const std::vector<DrivenRecording>& recordings,
                                                    const FitWithNoise& under,
                                                    const std::optional<ModelFit>& with,
                                                    const std::vector<Candidate>& found,
                                                    const Noise& stated) {
  if (!std::any_of(found.begin(), found.end(), was_sought) || !under.noise.changed() || !with) {
    return std::nullopt;
  }
  NoiseFitOptions options;
  options.errors = false;
  try {
    fitting::NoiseReml reml(*with->state, stated);
    FittedNoise noise = fitting::fit_noise(reml, {}, options);
    if (noise.noise == under.noise.noise) return std::nullopt;
    noise.tried = std::max(noise.tried, under.noise.tried);
    ModelFit fit = refit_under(recordings, under.fit, noise.noise);
    return FitWithNoise{std::move(fit), std::move(noise)};
  } catch (const SolveError&) {  // together they cannot be fitted
    return std::nullopt;
  }
}

}  // namespace trussmap::criticism
