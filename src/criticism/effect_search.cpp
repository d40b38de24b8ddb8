// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/effect_search.hpp"

#include "criticism/best_set.hpp"
#include "criticism/formula_search.hpp"
#include "linalg/dense.hpp"
#include "statistics/distributions.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>

namespace trussmap::criticism {
namespace {

constexpr double kSecondLevel = 0.02;   // of the level
constexpr double kSecondShare = 0.002;  // of the chi^2 that the first explain
constexpr std::size_t kFamiliesRefined = 3;
constexpr double kLawLevel = 0.01;
/// Of the chi^2 that the others explain, what tests of a model without them may be out by.
constexpr double kOutByLarge = 0.02;
constexpr double kStays = 0.001;  // p, with the others there
constexpr std::size_t kMostEvents = 8;

}  // namespace

EffectSearch::EffectSearch(const fitting::FitState& fit, const ScoreTest& tests,
                           const SearchOptions& options, const validation::HeldOutLegs* legs)
    : fit_(fit),
      tests_(tests),
      options_(options),
      legs_(legs),
      dispersion_(fit, tests),
      events_(tests.residuals().size(), 0) {
  if (legs_ != nullptr && !legs_->has_slopes()) legs_ = nullptr;
}

void EffectSearch::run() {
  test_all();
  judge(tested_, fit_.adjustment.chi2, fit_.adjustment.dof, tried_);
  refine_families();
  judge(tested_, fit_.adjustment.chi2, fit_.adjustment.dof, tried_);
  find_missing();
}

void EffectSearch::test_all() {
  const std::vector<Candidate> candidates = candidates_for(fit_, tests_.context());
  tried_ = static_cast<int>(candidates.size());
  std::vector<Candidate> members;
  std::vector<Candidate> tested;
  for (const Candidate& one : candidates) (one.family.empty() ? tested : members).push_back(one);
  struct Best {
    std::size_t member = 0;
    double score = -1.0;
    int tried = 0;
  };
  std::map<std::string, Best> families;
  visit_scores(tests_, members, Resolution::quick, [&](std::size_t k, const Score& score) {
    Best& best = families[members[k].family];
    ++best.tried;
    if (score.score > best.score) best = {k, score.score, best.tried};
  });
  for (const auto& [name, best] : families) tested.push_back(members[best.member]);
  // Those of one shape together: it is evaluated once.
  std::vector<std::size_t> order(tested.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&tested](std::size_t a, std::size_t b) {
    return tested[a].effect.shape < tested[b].effect.shape;
  });
  std::vector<Candidate> by_shape;
  by_shape.reserve(tested.size());
  for (const std::size_t k : order) by_shape.push_back(tested[k]);
  tested_.resize(tested.size());
  visit_scores(tests_, by_shape, Resolution::screening, [&](std::size_t k, Score& score) {
    Tested& one = tested_[order[k]];
    take(one, by_shape[k], score);
    if (!by_shape[k].family.empty()) one.tried = families[by_shape[k].family].tried;
  });
}

void EffectSearch::take(Tested& tested, const Candidate& candidate, Score& score) {
  tested.candidate = candidate;
  tested.dispersion = dispersion_of(score, dispersion_);
  if (legs_ != nullptr && score.dof > 0) {
    tested.slopes = legs_->slopes(candidate.effect, score.columns, score.landmarks);
  }
  drop_columns(score);
  tested.score = score;
}

/// Looks for better shape parameters of the most promising families.
void EffectSearch::refine_families() {
  std::vector<Tested*> families;
  for (Tested& one : tested_) {
    if (!one.candidate.parameters.empty() && one.score.dof > 0 && one.p_adjusted < 0.5) {
      families.push_back(&one);
    }
  }
  std::stable_sort(families.begin(), families.end(),
                   [](const Tested* a, const Tested* b) { return a->evidence > b->evidence; });
  // What refining may add to a score is bounded: a place that explains little is not the one.
  double best = 0.0;
  for (const Tested& one : tested_) best = std::max(best, one.score.score);
  std::erase_if(families, [&](const Tested* one) { return 2.0 * one->score.score < best; });
  if (families.size() > kFamiliesRefined) families.resize(kFamiliesRefined);
  for (Tested* one : families) refine(*one);
}

void EffectSearch::refine(Tested& tested) {
  const Candidate better = refined(tests_, tested.candidate);
  if (better.parameters == tested.candidate.parameters) return;
  Score score = tests_.test({better.effect}).front();
  const double found = tested.score.score;
  take(tested, better, score);
  tested.share_found = std::min(1.0, found / std::max(tested.score.score, 1e-300));
}

const NoiseTest* leading_law(const std::vector<NoiseTest>& laws, const std::vector<Tested>& tested,
                             double level) {
  double most = 0.0;
  for (const Tested& one : tested) {
    if (one.p_adjusted < level) most = std::max(most, one.score.score);
  }
  for (const NoiseTest& law : laws) {
    if (law.unit.empty() || law.p_adjusted >= kLawLevel) continue;  // a shape, or chance
    return law.score > most ? &law : nullptr;
  }
  return nullptr;
}

/// The likeliest event, if it has a better claim than any effect. A whole session that is out of
/// line is not among them: what goes with a session's load is an effect.
std::optional<TestedEvent> EffectSearch::claiming_event(const fitting::FitState& ground,
                                                        const ScoreTest& left,
                                                        const std::vector<Tested>& still,
                                                        const Eigen::MatrixXd& nuisance) const {
  if (best_of(still, options_.level) == nullptr) return std::nullopt;
  double p = 1.0;
  for (const Tested& one : still) p = std::min(p, one.p_adjusted);
  std::vector<TestedEvent> events = test_events(ground, left, nuisance);
  const auto event = std::find_if(events.begin(), events.end(), [](const TestedEvent& one) {
    return one.kind != EventKind::session && one.projected.cols() > 0;
  });
  if (event == events.end() || event->p_adjusted >= p) return std::nullopt;
  return std::move(*event);
}

/// Laws of noise and single events that have a better claim than any effect come before them.
/// `still`: the effects, asked of what is left.
void EffectSearch::weigh_noise_and_events(ScoreTest& left, const fitting::FitState& ground,
                                          std::vector<Tested>& still) {
  const auto significant = [this](const Tested& one) {
    return one.score.dof > 0 && one.p_adjusted < options_.level;
  };
  int dof = fit_.adjustment.dof;
  if (&ground != &fit_) {
    test_again(ground, left, still);
    judge(still, left.residuals().squaredNorm(), dof, tried_);
  }
  for (std::size_t k = 0; k < kMostEvents; ++k) {
    const std::optional<TestedEvent> event = claiming_event(ground, left, still, events_);
    if (!event) return;
    left.condition_on(event->projected);
    linalg::append_columns(events_, event->projected);
    dof -= event->dof;
    std::vector<double> p_before;
    p_before.reserve(still.size());
    for (const Tested& one : still) p_before.push_back(one.p_adjusted);
    test_again(ground, left, still, significant);
    judge(still, left.residuals().squaredNorm(), dof, tried_);
    // Those not tested again cannot have become better.
    for (std::size_t j = 0; j < still.size(); ++j) {
      still[j].p_adjusted = std::max(still[j].p_adjusted, p_before[j]);
    }
  }
}

void EffectSearch::find_missing() {
  if (best_of(tested_, options_.level) == nullptr) return take_masked();
  const std::vector<NoiseTest> laws = test_noise_laws(fit_, tests_);
  const NoiseTest* law = leading_law(laws, tested_, options_.level);
  const std::optional<fitting::FitState> noisier =
      law != nullptr ? std::optional(with_noise(fit_, tests_, *law)) : std::nullopt;
  const fitting::FitState& ground = noisier ? *noisier : fit_;
  ScoreTest left = noisier ? ScoreTest(ground) : tests_;
  std::vector<Tested> still = tested_;
  weigh_noise_and_events(left, ground, still);
  for (std::size_t k = 0; k < still.size(); ++k) {
    tested_[k].p_value = still[k].p_value;
    tested_[k].p_adjusted = still[k].p_adjusted;
  }
  const ScoreTest at_first = left;
  select(left, ground, still);
  take_known_causes(ground, at_first);
  take_best_set(ground, at_first);
  std::stable_sort(
      missing_.begin(), missing_.end(), [this](const MissingEffect& a, const MissingEffect& b) {
        return plausible_evidence(tested_[a.tested]) > plausible_evidence(tested_[b.tested]);
      });
  estimate_jointly();
  eliminate_backward();
}

/// Among all that was tested, asked of the fit as it is.
void EffectSearch::take_formula(const Tested& formula, std::vector<Tested>& still) {
  still.push_back(formula);
  tested_.push_back(formula);
  Score score = tests_.test({formula.candidate.effect}).front();
  take(tested_.back(), formula.candidate, score);
}

/// The best, then the best of what is left when conditioned on it, and so on.
void EffectSearch::select(ScoreTest& left, const fitting::FitState& ground,
                          std::vector<Tested>& still) {
  int dof = fit_.adjustment.dof;
  const double at_first = left.residuals().squaredNorm();
  const FormulaGrammar grammar(ground, left.context());
  while (missing_.size() < options_.most_missing) {
    // What a first effect leaves for being so large is no second one.
    const double level = missing_.empty() ? options_.level : kSecondLevel * options_.level;
    const Tested* best = best_of(still, level);
    if (best == nullptr) break;
    const double chi2 = left.residuals().squaredNorm();
    if (!missing_.empty() && best->score.score < kSecondShare * (at_first - chi2)) break;
    const FormulasTried formulas =
        formulas_beside(*best, still, grammar, {ground, left, dof, tried_, level});
    const std::size_t at =
        formulas.better.empty() ? static_cast<std::size_t>(best - still.data()) : still.size();
    for (const Tested& one : formulas.better) take_formula(one, still);
    missing_.push_back({at, {}});
    const Score whole = tests_.test({tested_[at].candidate.effect}).front();
    left.condition_on(left.columns(tested_[at].candidate.effect));
    linalg::append_columns(nuisance_, whole.projected);
    dof -= whole.dof;
    if (missing_.size() == options_.most_missing) break;
    test_again(ground, left, still);
    judge(still, left.residuals().squaredNorm(), dof, tried_);
  }
}

std::vector<std::size_t> EffectSearch::missing_places() const {
  std::vector<std::size_t> places;
  places.reserve(missing_.size());
  for (const MissingEffect& one : missing_) places.push_back(one.tested);
  return places;
}

SearchGround EffectSearch::ground_of(const fitting::FitState& fit, const ScoreTest& left,
                                     double next_share) const {
  return {fit,
          left,
          fit_.adjustment.dof,
          tried_,
          options_.level,
          kSecondLevel * options_.level,
          next_share,
          options_.most_missing};
}

/// Known effects come in the place of a free form that they explain together.
void EffectSearch::take_known_causes(const fitting::FitState& ground, const ScoreTest& left) {
  const std::vector<KnownCause> causes =
      known_causes_of(missing_places(), tested_, ground_of(ground, left, kSecondShare));
  if (causes.empty()) return;
  missing_.clear();
  nuisance_.resize(nuisance_.rows(), 0);
  for (const KnownCause& one : causes) {
    Tested& tested = tested_[one.tested];
    Score score = tests_.test({one.candidate.effect}).front();
    linalg::append_columns(nuisance_, score.projected);
    if (one.candidate.parameters != tested.candidate.parameters) {
      take(tested, one.candidate, score);
    }
    missing_.push_back({one.tested, {}});
  }
}

void EffectSearch::take_all(const std::vector<std::size_t>& places) {
  missing_.clear();
  nuisance_.resize(nuisance_.rows(), 0);
  for (const std::size_t one : places) {
    linalg::append_columns(nuisance_,
                           tests_.test({tested_[one].candidate.effect}).front().projected);
    missing_.push_back({one, {}});
  }
}

/// Among all that was tested, formulas that were taken included.
void EffectSearch::take_best_set(const fitting::FitState& ground, const ScoreTest& left) {
  if (missing_.empty()) return;
  SearchGround beside_events = ground_of(ground, left, kOutByLarge);
  beside_events.dof -= static_cast<int>(events_.cols());
  const std::vector<std::size_t> best = better_set(missing_places(), tested_, beside_events);
  if (best != missing_places()) take_all(best);
}

/// Nothing is significant by itself. What hides much leaves a chi^2 that is hardly small.
void EffectSearch::take_masked() {
  constexpr double kHides = 0.2;  // p
  if (statistics::chi2_p_value(fit_.adjustment.chi2, fit_.adjustment.dof) > kHides) return;
  const MaskedSet masked = masked_set(tested_, ground_of(fit_, tests_, kSecondShare));
  if (masked.tested.empty()) return;
  take_all(masked.tested);
  for (const std::size_t one : masked.tested) {
    tested_[one].p_adjusted = std::min(tested_[one].p_adjusted, masked.p_adjusted);
  }
  estimate_jointly();
  only_together_ = true;
}

void EffectSearch::exchange(std::size_t rank, std::size_t tested) {
  std::vector<std::size_t> places = missing_places();
  places.at(rank) = tested;
  take_all(places);
  estimate_jointly();
}

/// Sizes of all that is missing, each with the others there.
void EffectSearch::estimate_jointly() {
  for (MissingEffect& one : missing_) {
    const Tested& tested = tested_[one.tested];
    ScoreTest others = tests_;
    for (const MissingEffect& other : missing_) {
      if (&other == &one) continue;
      others.condition_on(tests_.columns(tested_[other.tested].candidate.effect));
    }
    one.joint = others.test({tested.candidate.effect}).front();
    if (one.joint.dof == 0) one.joint = tested.score;
    drop_columns(one.joint);
  }
}

/// Of effects that are found one after the other, a later one may be all that there is.
void EffectSearch::eliminate_backward() {
  while (missing_.size() > 1) {
    const auto weakest = std::max_element(missing_.begin(), missing_.end(),
                                          [](const MissingEffect& a, const MissingEffect& b) {
                                            return a.joint.p_value < b.joint.p_value;
                                          });
    if (weakest->joint.p_value < kStays) return;
    missing_.erase(weakest);
    estimate_jointly();
  }
}

}  // namespace trussmap::criticism
