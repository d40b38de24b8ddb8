// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/known_causes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace trussmap::criticism {
namespace {

constexpr std::size_t kFirsts = 6;  // that a set is begun with
/// Of the chi^2 that large effects explain, what tests of a model without them are out by: less is
/// no third cause, and no reason for an odd shape of more coefficients than the known causes have.
constexpr double kOutBy = 0.02;
constexpr int kRounds = 3;  // of parameters, each with the others there

/// A set of effects, and what speaks for it.
struct Set {
  std::vector<KnownCause> causes;
  std::vector<Score> scores;  ///< each with those before it there; without columns
  double left = 0.0;          ///< chi^2 with all of them
  int dof = 0;                ///< then
};

Set set_of(std::vector<KnownCause> causes, const SearchGround& ground) {
  Set set;
  set.causes = std::move(causes);
  ScoreTest left = ground.tests;
  set.dof = ground.dof;
  for (const KnownCause& one : set.causes) {
    Score score = left.test({one.candidate.effect}).front();
    left.condition_on(score.columns);
    set.dof -= score.dof;
    drop_columns(score);
    set.scores.push_back(std::move(score));
  }
  set.left = left.residuals().squaredNorm();
  return set;
}

/// By the noise that is left where most is explained.
double evidence_for(const Set& set, const std::vector<Tested>& tested, double noise) {
  double sum = 0.0;
  for (std::size_t k = 0; k < set.causes.size(); ++k) {
    Tested one;
    one.candidate = set.causes[k].candidate;
    one.tried = tested[set.causes[k].tested].tried;
    one.score = set.scores[k];
    sum += evidence_at(one, one.score.score / noise);
  }
  return sum;
}

std::size_t coefficients_of(const Set& set) {
  std::size_t count = 0;
  for (const KnownCause& one : set.causes) count += one.candidate.effect.shape.size();
  return count;
}

double noise_left(const Set& set) {
  return std::max(1.0, set.left / std::max(1, set.dof));
}

/// Asked of what these leave, but for one of them.
ScoreTest beside(const ScoreTest& tests, const std::vector<KnownCause>& causes,
                 const KnownCause* but = nullptr) {
  ScoreTest left = tests;
  for (const KnownCause& one : causes) {
    if (&one != but) left.condition_on(tests.columns(one.candidate.effect));
  }
  return left;
}

/// Each one's parameters anew, with the others there, until they stay.
void refine_jointly(std::vector<KnownCause>& causes, const ScoreTest& tests) {
  for (int round = 0; round < kRounds; ++round) {
    bool moved = false;
    for (KnownCause& one : causes) {
      if (one.candidate.parameters.empty()) continue;
      Candidate better = refined(beside(tests, causes, &one), one.candidate);
      moved = moved || better.parameters != one.candidate.parameters;
      one.candidate = std::move(better);
    }
    if (!moved) return;
  }
}

/// Begun with one, and each next the best beside those before it.
Set begun_with(std::size_t first, const std::vector<std::size_t>& places,
               const std::vector<Tested>& known, const SearchGround& ground) {
  std::vector<KnownCause> causes{{places[first], known[first].candidate}};
  std::vector<Tested> still = known;
  const double at_first = ground.tests.residuals().squaredNorm();
  while (causes.size() < ground.most) {
    const ScoreTest left = beside(ground.tests, causes);
    test_again(ground.fit, left, still);
    const int dof = ground.dof - static_cast<int>(causes.size());
    const double chi2 = left.residuals().squaredNorm();
    judge(still, chi2, dof, ground.tried);
    const Tested* best = best_of(still, ground.next_level);
    if (best == nullptr || best->score.score < ground.next_share * (at_first - chi2)) break;
    const std::size_t at = places[static_cast<std::size_t>(best - still.data())];
    const auto same = [at](const KnownCause& one) { return one.tested == at; };
    if (std::any_of(causes.begin(), causes.end(), same)) break;
    causes.push_back({at, best->candidate});
    refine_jointly(causes, ground.tests);
  }
  return set_of(std::move(causes), ground);
}

/// One that was found early may be what those found later make together.
Set without(const Set& set, std::size_t cause, const SearchGround& ground) {
  std::vector<KnownCause> causes = set.causes;
  causes.erase(causes.begin() + static_cast<std::ptrdiff_t>(cause));
  refine_jointly(causes, ground.tests);
  return set_of(std::move(causes), ground);
}

/// Whether each, with the others there, is of a possible size and does something.
bool all_plausible(const Set& set, const ScoreTest& tests) {
  return std::all_of(set.causes.begin(), set.causes.end(), [&](const KnownCause& one) {
    Tested alone;
    alone.candidate = one.candidate;
    alone.score = beside(tests, set.causes, &one).test({one.candidate.effect}).front();
    return alone.score.dof > 0 && !is_implausible(alone);
  });
}

}  // namespace

std::vector<KnownCause> known_causes_of(const std::vector<std::size_t>& found,
                                        const std::vector<Tested>& tested,
                                        const SearchGround& ground) {
  std::vector<KnownCause> free;
  bool any = false;
  for (const std::size_t k : found) {
    free.push_back({k, tested[k].candidate});
    any = any || tested[k].candidate.form != Form::catalogue;
  }
  if (!any) return {};

  std::vector<std::size_t> places;
  std::vector<Tested> known;
  for (std::size_t k = 0; k < tested.size(); ++k) {
    if (tested[k].candidate.form != Form::catalogue || tested[k].score.dof == 0) continue;
    places.push_back(k);
    known.push_back(tested[k]);
  }
  std::vector<std::size_t> firsts(known.size());
  std::iota(firsts.begin(), firsts.end(), std::size_t{0});
  std::erase_if(firsts, [&](std::size_t k) { return known[k].p_adjusted >= ground.level; });
  std::stable_sort(firsts.begin(), firsts.end(), [&known](std::size_t a, std::size_t b) {
    return plausible_evidence(known[a]) > plausible_evidence(known[b]);
  });
  if (firsts.size() > kFirsts) firsts.resize(kFirsts);

  const Set odd = set_of(std::move(free), ground);
  const double at_first = ground.tests.residuals().squaredNorm();
  std::vector<Set> sets;
  for (const std::size_t first : firsts) {
    sets.push_back(begun_with(first, places, known, ground));
    for (std::size_t k = 0; k < sets.back().causes.size() && sets.back().causes.size() > 1;) {
      Set fewer = without(sets.back(), k, ground);
      const double noise = std::min(noise_left(fewer), noise_left(sets.back()));
      const bool better =
          evidence_for(fewer, tested, noise) > evidence_for(sets.back(), tested, noise) ||
          (fewer.causes.size() >= 2 &&
           fewer.left - sets.back().left < kOutBy * (at_first - sets.back().left));
      if (better) sets.back() = std::move(fewer);
      k = better ? 0 : k + 1;
    }
  }
  double noise = noise_left(odd);
  for (const Set& one : sets) noise = std::min(noise, noise_left(one));
  const double explained = (at_first - odd.left) / noise;
  const Set* best = nullptr;
  double most = evidence_for(odd, tested, noise);
  for (const Set& one : sets) {
    double evidence = evidence_for(one, tested, noise);
    if (coefficients_of(one) < coefficients_of(odd)) evidence += 0.5 * kOutBy * explained;
    // A plain form pays for its oddness; so do further causes, for all that there are.
    if (coefficients_of(odd) <= coefficients_of(one) && one.causes.size() > odd.causes.size()) {
      evidence -= static_cast<double>(one.causes.size() - odd.causes.size()) *
                  std::log(static_cast<double>(known.size()));
    }
    if (evidence <= most || !all_plausible(one, ground.tests)) continue;
    most = evidence;
    best = &one;
  }
  return best == nullptr ? std::vector<KnownCause>() : best->causes;
}

}  // namespace trussmap::criticism
