// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/tested_candidate.hpp"

#include "statistics/distributions.hpp"
#include "statistics/multiple_tests.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::criticism {
namespace {

constexpr double kLargestPriorSd = 3.0;
constexpr double kNoEvidence = -1e300;
constexpr double kWorthALook = 0.01;  // p

/// Log of what an effect of unknown size pays for having been fitted: sizes from the smallest that
/// shows to a hundred times that are equally likely on a logarithmic scale, so that no unit and no
/// belief about a size comes between look-alikes.
double penalty(double score, int dof) {
  constexpr double kLogRange = 1.3;  // log(2 log(100) / sqrt(2 pi))
  return dof * (kLogRange + 0.5 * std::log(1.0 + score / std::max(1, dof)));
}

/// The same for shape parameters: found on a grid, then refined.
double parameter_penalty(double score, const Tested& one) {
  return std::log(static_cast<double>(one.tried)) +
         0.5 * static_cast<double>(one.candidate.parameters.size()) * std::log(1.0 + score);
}

double dispersion_left(double chi2, int dof, const Score& score) {
  return std::max(1.0, (chi2 - score.score) / std::max(1, dof - score.dof));
}

/// What physics is known to make, without a place or threshold to be sought: few, and likelier than
/// all that can be written down besides.
bool is_known(const Tested& one) {
  return one.candidate.form == Form::catalogue && one.candidate.parameters.empty();
}

/// Holm's, among the known effects and among the others; each half of the tests has half of the
/// level (Bonferroni).
void adjust_p_values(std::vector<Tested>& tested, int tried) {
  const auto known = std::count_if(tested.begin(), tested.end(), is_known);
  for (const bool group : {true, false}) {
    std::vector<double> p_values;
    std::vector<int> tests;
    for (const Tested& one : tested) {
      if (is_known(one) != group) continue;
      p_values.push_back(one.p_value);
      tests.push_back(one.tried);
    }
    const auto all = static_cast<double>(group ? known : tried - known);
    const std::vector<double> adjusted = statistics::holm(p_values, tests, all);
    auto next = adjusted.begin();
    for (Tested& one : tested) {
      if (is_known(one) == group) one.p_adjusted = statistics::bonferroni(*next++, 2.0);
    }
  }
}

}  // namespace

void visit_scores(const ScoreTest& tests, const std::vector<Candidate>& candidates,
                  Resolution resolution,
                  const std::function<void(std::size_t candidate, Score& score)>& visit) {
  const std::size_t sessions = tests.context().recordings().size();
  const auto batch = static_cast<std::size_t>(tests.batch());
  for (std::size_t first = 0; first < candidates.size();) {
    std::vector<Effect> effects;
    std::size_t columns = 0;
    for (std::size_t k = first; k < candidates.size() && columns < batch; ++k) {
      effects.push_back(candidates[k].effect);
      columns += fitting::coefficient_count(effects.back(), sessions);
    }
    std::vector<Score> scores = tests.test(effects, resolution);
    for (std::size_t k = 0; k < scores.size(); ++k) visit(first + k, scores[k]);
    first += effects.size();
  }
}

void drop_columns(Score& score) {
  score.columns.resize(0, 0);
  score.projected.resize(0, 0);
  score.landmarks.resize(0, 0);
}

void judge(std::vector<Tested>& tested, double chi2, int dof, int tried) {
  double least = std::max(1.0, chi2 / std::max(1, dof));
  for (Tested& one : tested) {
    one.p_value = 1.0;
    if (one.score.dof > 0) {
      const double left = dispersion_left(chi2, dof, one.score);
      // Where its own rows show less noise than is stated, that is what it stands out from.
      const double noise =
          one.dispersion < 1.0 && left == 1.0 ? one.dispersion : std::max(left, one.dispersion);
      one.p_value =
          statistics::chi2_p_value(one.share_found * one.score.score / noise, one.score.dof);
      least = std::min(least, left);
    }
  }
  adjust_p_values(tested, tried);
  for (Tested& one : tested) {
    // What noise in these very rows would claim is a matter of p: an effect whose rows another
    // effect moves as well is as large as it is.
    one.evidence = evidence_at(one, one.score.score / least);
  }
}

double evidence_at(const Tested& one, double net) {
  if (one.score.dof == 0) return kNoEvidence;
  const double evidence = 0.5 * net - penalty(net, one.score.dof) + one.candidate.log_prior;
  return one.candidate.parameters.empty() ? evidence : evidence - parameter_penalty(net, one);
}

double dispersion_of(const Score& score, const LocalDispersion& local) {
  return score.dof > 0 && score.p_value < kWorthALook ? local(score) : 1.0;
}

void test_again(const fitting::FitState& fit, const ScoreTest& left, std::vector<Tested>& still,
                const std::function<bool(const Tested&)>& wanted) {
  std::vector<std::size_t> places;
  std::vector<Candidate> candidates;
  for (std::size_t k = 0; k < still.size(); ++k) {
    if (wanted && !wanted(still[k])) continue;
    places.push_back(k);
    candidates.push_back(still[k].candidate);
  }
  const LocalDispersion local(fit, left);
  visit_scores(left, candidates, Resolution::screening, [&](std::size_t k, Score& score) {
    Tested& one = still[places[k]];
    one.dispersion = dispersion_of(score, local);
    drop_columns(score);
    one.score = score;
  });
}

namespace {

/// Its largest value in standard deviations of what is known of its channel.
double size_in_priors(const Tested& one) {
  if (one.candidate.effect.is_constant()) return 0.0;
  const double prior_sd = facts_of(one.candidate.effect.channel).prior_sd;
  double most = 0.0;
  for (std::size_t k = 0; k < one.score.coefficients.size(); ++k) {
    most = std::max(most, std::abs(one.score.coefficients[k]) * one.score.largest[k] / prior_sd);
  }
  return most;
}

}  // namespace

double plausible_evidence(const Tested& one) {
  const double size = size_in_priors(one);
  return one.evidence - std::max(0.0, size * size - kLargestPriorSd * kLargestPriorSd);
}

bool is_implausible(const Tested& one) {
  return size_in_priors(one) > kLargestPriorSd;
}

const Tested* best_of(const std::vector<Tested>& tested, double level) {
  const Tested* best = nullptr;
  for (const Tested& one : tested) {
    if (one.score.dof == 0 || one.p_adjusted >= level) continue;
    if (best == nullptr || plausible_evidence(one) > plausible_evidence(*best)) best = &one;
  }
  return best;
}

}  // namespace trussmap::criticism
