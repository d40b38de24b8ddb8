// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/formula_search.hpp"

#include "statistics/distributions.hpp"
#include "statistics/multiple_tests.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace trussmap::criticism {
namespace {

constexpr std::size_t kMostChannels = 4;
constexpr double kNearly = 0.4;       // of the best score, of a channel that formulas are sought in
constexpr std::size_t kRefined = 6;   // formulas
constexpr double kListed = 12.0;      // of evidence behind the best formula
constexpr double kWithinBand = 0.05;  // p of what a curve explains beyond a formula

/// Channels of what explains nearly as much as the best, best first.
std::vector<Channel> channels_of(const std::vector<Tested>& still, double best) {
  std::map<Channel, double> most;
  for (const Tested& one : still) {
    const Channel channel = one.candidate.effect.channel;
    if (one.score.dof == 0 || !FormulaGrammar::speaks_of(channel)) continue;
    most[channel] = std::max(most[channel], one.score.score);
  }
  std::vector<std::pair<double, Channel>> order;
  for (const auto& [channel, score] : most) {
    if (score >= kNearly * best) order.emplace_back(-score, channel);
  }
  std::sort(order.begin(), order.end());
  if (order.size() > kMostChannels) order.resize(kMostChannels);
  std::vector<Channel> channels;
  channels.reserve(order.size());
  for (const auto& one : order) channels.push_back(one.second);
  return channels;
}

/// A family, or a formula without constants.
std::string form_of(const Candidate& one) {
  return one.family.empty() ? one.effect.name : one.family;
}

/// All formulas of the channels that were not tried yet.
std::vector<Candidate> formulas_in(const std::vector<Channel>& channels,
                                   const FormulaGrammar& grammar,
                                   const std::vector<Tested>& still) {
  std::vector<Candidate> all;
  for (const Channel channel : channels) {
    for (Candidate& one : grammar.of(channel)) {
      const bool tried = std::any_of(still.begin(), still.end(), [&one](const Tested& other) {
        return other.candidate.effect.channel == one.effect.channel &&
               other.candidate.effect.shape == one.effect.shape;
      });
      if (!tried) all.push_back(std::move(one));
    }
  }
  return all;
}

/// The best of each form by a quick look, that of most evidence first.
std::vector<Tested> most_promising(const std::vector<Candidate>& all, const ScoreTest& left,
                                   double noise) {
  std::map<std::string, Tested> best;
  visit_scores(left, all, Resolution::quick, [&](std::size_t k, Score& score) {
    const auto [place, first] = best.try_emplace(form_of(all[k]));
    Tested& one = place->second;
    if (!first) ++one.tried;
    if (!first && score.score <= one.score.score) return;
    drop_columns(score);
    one.candidate = all[k];
    one.score = score;
  });
  std::vector<Tested> order;
  for (auto& [name, one] : best) {
    one.evidence = evidence_at(one, one.score.score / noise);
    order.push_back(std::move(one));
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const Tested& a, const Tested& b) { return a.evidence > b.evidence; });
  if (order.size() > kRefined) order.resize(kRefined);
  return order;
}

/// Of what a curve explains beyond a formula of its channel, whether noise could.
bool is_within_band(const Tested& formula, const Tested& curve, double noise) {
  if (curve.candidate.form != Form::curve) return false;
  const int more = curve.score.dof - formula.score.dof;
  if (more <= 0) return false;
  const double beyond = std::max(0.0, curve.score.score - formula.score.score) / noise;
  return statistics::chi2_p_value(beyond, more) > kWithinBand;
}

}  // namespace

FormulasTried formulas_beside(const Tested& best, const std::vector<Tested>& still,
                              const FormulaGrammar& grammar, const FormulaGround& ground) {
  FormulasTried result;
  const std::vector<Candidate> all =
      formulas_in(channels_of(still, best.score.score), grammar, still);
  result.tried = static_cast<int>(all.size());
  const double chi2 = ground.left.residuals().squaredNorm();
  double most = best.score.score;
  const auto noise = [&] {
    return std::max(1.0, (chi2 - most) / std::max(1, ground.dof - best.score.dof));
  };
  std::vector<Tested> promising = most_promising(all, ground.left, noise());
  const LocalDispersion local(ground.fit, ground.left);
  for (Tested& one : promising) {
    const double found = one.score.score;
    one.candidate = refined(ground.left, one.candidate);
    Score score = ground.left.test({one.candidate.effect}).front();
    one.dispersion = dispersion_of(score, local);
    drop_columns(score);
    one.score = std::move(score);
    one.share_found = std::min(1.0, found / std::max(one.score.score, 1e-300));
    most = std::max(most, one.score.score);
  }
  const auto weigh = [&](Tested& one) {
    one.evidence = evidence_at(one, one.score.score / noise());
  };
  for (Tested& one : promising) {
    weigh(one);
    const double by = std::max(noise(), one.dispersion);
    one.p_value = statistics::chi2_p_value(one.share_found * one.score.score / by, one.score.dof);
    one.p_adjusted = statistics::bonferroni(one.p_value, 2.0 * (ground.tried + result.tried));
  }
  std::erase_if(promising, [&](const Tested& one) {
    return one.score.dof == 0 || one.p_adjusted >= ground.level;
  });
  std::stable_sort(promising.begin(), promising.end(), [](const Tested& a, const Tested& b) {
    return plausible_evidence(a) > plausible_evidence(b);
  });
  if (promising.empty()) return result;
  Tested rival = best;
  weigh(rival);
  const double ahead = plausible_evidence(promising.front());
  if (ahead <= plausible_evidence(rival) && !is_within_band(promising.front(), rival, noise())) {
    return result;
  }
  std::erase_if(promising,
                [&](const Tested& one) { return plausible_evidence(one) < ahead - kListed; });
  result.better = std::move(promising);
  return result;
}

}  // namespace trussmap::criticism
