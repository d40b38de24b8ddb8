// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/explanations.hpp"

#include "criticism/driven_variables.hpp"
#include "criticism/formulas.hpp"
#include "criticism/look_alikes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace trussmap::criticism {
namespace {

constexpr double kListedBehind = 6.0;   // of log evidence: odds of 400 to 1
constexpr double kLeastChance = 0.01;   // of an effect that is listed
constexpr std::size_t kMostLikeIt = 8;  // names of look-alikes

/// Sets of the same classes, and what speaks for each member of these.
struct SetOfClasses {
  std::vector<std::size_t> classes;
  std::vector<std::map<int, double>> members;  ///< block -> weight, one per class
  double weight = 0.0;                         ///< of evidence, the best set's is 1
  CandidateSet best;
};

class Explainer {
 public:
  Explainer(const std::vector<Tested>& tested, const std::vector<NamedEffect>& named,
            const SetGround& ground)
      : tested_(tested), ground_(ground) {
    std::vector<std::size_t> places;
    for (const NamedEffect& one : named) {
      places.push_back(one.tested);
      for (const LookAlike& rival : one.look_alikes) {
        const std::size_t at = place_of(rival.effect);
        if (at < tested.size()) places.push_back(at);
      }
    }
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    weighed_ = weigh_sets(tested, ground, places);
    for (const NamedEffect& one : named) {
      if (const auto block = weighed_.block_of(one.tested)) named_blocks_.push_back(*block);
    }
    std::sort(named_blocks_.begin(), named_blocks_.end());
    for (const NamedEffect& one : named) believe_fits(one);
    weighed_ = weigh_sets(std::move(weighed_.gram), std::move(weighed_.belief), ground);
    gather();
  }

  [[nodiscard]] Explanations run() {
    Explanations result;
    const double all = total();
    std::vector<const SetOfClasses*> listed_sets;
    for (const SetOfClasses& one : sets_) {
      const bool is_named = one.classes == named_classes_;
      const double behind = -std::log(one.weight / sets_.front().weight);
      if (one.classes.empty()) continue;
      // Occam's window (Madigan & Raftery 1994): what only adds to a likelier set belongs to it.
      const auto within =
          std::find_if(listed_sets.begin(), listed_sets.end(), [&one](const SetOfClasses* other) {
            return std::includes(one.classes.begin(), one.classes.end(), other->classes.begin(),
                                 other->classes.end());
          });
      if (within != listed_sets.end() && !is_named) {
        const auto at = static_cast<std::size_t>(within - listed_sets.begin());
        double& sum = result.sets[at].probability;
        sum = std::min(1.0, sum + one.weight / all);
        continue;
      }
      if (behind > kListedBehind && !is_named) continue;
      listed_sets.push_back(&one);
      result.sets.push_back(listed(one, std::max(0.0, behind), one.weight / all, is_named));
    }
    double sum = 0.0;
    for (const EffectSet& one : result.sets) sum += one.probability;
    result.none_of_these = std::clamp(1.0 - sum, 0.0, 1.0);
    result.effects = chances(all);
    for (EffectSet& one : result.sets) order(one, result.effects);
    return result;
  }

 private:
  /// The likeliest effect first.
  static void order(EffectSet& set, const std::vector<EffectChance>& chances) {
    const auto rank = [&chances](const ExplainingEffect& one) {
      return std::find_if(chances.begin(), chances.end(), [&one](const EffectChance& chance) {
        return chance.effect.name == one.effect.name;
      });
    };
    std::stable_sort(set.effects.begin(), set.effects.end(),
                     [&rank](const ExplainingEffect& a, const ExplainingEffect& b) {
                       return rank(a) < rank(b);
                     });
  }

  [[nodiscard]] std::size_t place_of(const Effect& effect) const {
    const auto found = std::find_if(tested_.begin(), tested_.end(), [&](const Tested& one) {
      return one.candidate.effect.name == effect.name && one.candidate.effect.shape == effect.shape;
    });
    return static_cast<std::size_t>(found - tested_.begin());
  }

  [[nodiscard]] const Candidate& candidate_of(int block) const {
    return tested_[weighed_.gram.blocks[idx(block)].candidate].candidate;
  }
  [[nodiscard]] std::size_t class_of(int block) const {
    return weighed_.belief.blocks[idx(block)].look_alikes;
  }
  [[nodiscard]] bool is_named(int block) const {
    return std::binary_search(named_blocks_.begin(), named_blocks_.end(), block);
  }

  [[nodiscard]] CandidateSet named_set() const {
    CandidateSet set;
    for (const int one : named_blocks_) {
      if (set.size < static_cast<int>(kMostInSet)) set.members[idx(set.size++)] = one;
    }
    return set;
  }

  /// chi^2 that a look-alike explains less in the place of what it looks like is what fits say.
  void believe_fits(const NamedEffect& one) {
    const std::optional<int> own = weighed_.block_of(one.tested);
    if (!own) return;
    const SubsetSearch search(weighed_.gram, weighed_.belief, {weighed_.dispersion});
    CandidateSet with = named_set();
    if (!search.weigh(with)) return;
    for (const LookAlike& rival : one.look_alikes) {
      const std::size_t at = place_of(rival.effect);
      const std::optional<int> other = at < tested_.size() ? weighed_.block_of(at) : std::nullopt;
      if (!other || is_named(*other)) continue;
      CandidateSet instead = named_set();
      std::replace(instead.members.begin(), instead.members.begin() + instead.size, *own, *other);
      std::sort(instead.members.begin(), instead.members.begin() + instead.size);
      if (!search.weigh(instead)) continue;
      weighed_.belief.blocks[idx(*other)].offset =
          -0.5 * rival.behind - 0.5 * (instead.gain - with.gain) / weighed_.dispersion;
    }
  }

  /// Sets by their classes, the best first. The named one is among them in any case.
  void gather() {
    std::map<std::vector<std::size_t>, SetOfClasses> by_classes;
    std::vector<CandidateSet> sets = weighed_.sets;
    CandidateSet named = named_set();
    const bool there = std::any_of(sets.begin(), sets.end(), [&](const CandidateSet& one) {
      return one.size == named.size && one.members == named.members;
    });
    const SubsetSearch search(weighed_.gram, weighed_.belief, {weighed_.dispersion});
    if (!there && search.weigh(named)) sets.push_back(named);
    for (int m = 0; m < named.size; ++m) named_classes_.push_back(class_of(named.members[idx(m)]));
    std::sort(named_classes_.begin(), named_classes_.end());
    const double best = sets.empty() ? 0.0 : sets.front().log_evidence;
    for (const CandidateSet& set : sets) {
      std::vector<std::pair<std::size_t, int>> order;
      order.reserve(static_cast<std::size_t>(set.size));
      for (int m = 0; m < set.size; ++m) {
        order.emplace_back(class_of(set.members[idx(m)]), set.members[idx(m)]);
      }
      std::sort(order.begin(), order.end());
      std::vector<std::size_t> classes;
      classes.reserve(order.size());
      for (const auto& one : order) classes.push_back(one.first);
      SetOfClasses& sum = by_classes[classes];
      if (sum.weight == 0.0) {  // the best of its kind comes first
        sum.classes = classes;
        sum.members.resize(classes.size());
        sum.best = set;
      }
      const double weight = std::exp(set.log_evidence - best);
      sum.weight += weight;
      for (std::size_t c = 0; c < order.size(); ++c) sum.members[c][order[c].second] += weight;
    }
    for (auto& [classes, one] : by_classes) sets_.push_back(std::move(one));
    std::stable_sort(sets_.begin(), sets_.end(), [](const SetOfClasses& a, const SetOfClasses& b) {
      return a.weight > b.weight;
    });
  }

  [[nodiscard]] double total() const {
    double sum = 0.0;
    for (const SetOfClasses& one : sets_) sum += one.weight;
    return sum;
  }

  /// The one that is named, else the likeliest.
  [[nodiscard]] int lead_of(const std::map<int, double>& members) const {
    int lead = members.begin()->first;
    for (const auto& [block, weight] : members) {
      if (is_named(block)) return block;
      if (weight > members.at(lead)) lead = block;
    }
    return lead;
  }

  /// Names of the others that explain about as much; what is believed of them does not count.
  [[nodiscard]] std::vector<std::string> like(int lead,
                                              const std::map<int, double>& members) const {
    const auto explains = [&](int block, double weight) {
      return std::log(weight) - weighed_.belief.blocks[idx(block)].log_share;
    };
    std::vector<std::pair<double, int>> order;
    for (const auto& [block, weight] : members) {
      const double behind = explains(lead, members.at(lead)) - explains(block, weight);
      if (block != lead && behind < kListedBehind) order.emplace_back(-weight, block);
    }
    std::sort(order.begin(), order.end());
    std::vector<std::string> names;
    for (const auto& one : order) {
      if (names.size() == kMostLikeIt) break;
      names.push_back(candidate_of(one.second).effect.name);
    }
    return names;
  }

  [[nodiscard]] EffectSet listed(const SetOfClasses& one, double behind, double probability,
                                 bool is_named_set) const {
    EffectSet result;
    result.behind = behind;
    result.probability = probability;
    result.named = is_named_set;
    CandidateSet set;
    std::vector<std::vector<std::string>> alike;
    std::vector<std::pair<int, std::size_t>> leads;  // block, class
    for (std::size_t c = 0; c < one.members.size(); ++c) {
      leads.emplace_back(lead_of(one.members[c]), c);
    }
    std::sort(leads.begin(), leads.end());
    for (const auto& lead : leads) set.members[idx(set.size++)] = lead.first;
    const SubsetSearch search(weighed_.gram, weighed_.belief, {weighed_.dispersion});
    if (!search.weigh(set)) set = one.best;  // leads of different sets that do not go together
    result.chi2_decrease = set.gain;
    const SubsetSearch::Sizes sizes = search.sizes(set);
    Eigen::Index at = 0;
    for (int m = 0; m < set.size; ++m) {
      const int block = set.members[idx(m)];
      const ColumnBlock& own = weighed_.gram.blocks[idx(block)];
      ExplainingEffect effect;
      effect.effect = candidate_of(block).effect;
      const Eigen::VectorXd coefficients = -own.weights * sizes.u.segment(at, own.size);
      const Eigen::MatrixXd covariance = own.weights *
                                         sizes.covariance.block(at, at, own.size, own.size) *
                                         own.weights.transpose() * weighed_.dispersion;
      effect.effect.coefficients.assign(coefficients.begin(), coefficients.end());
      for (Eigen::Index k = 0; k < covariance.rows(); ++k) {
        effect.sd.push_back(std::sqrt(std::max(0.0, covariance(k, k))));
      }
      for (std::size_t c = 0; c < one.classes.size(); ++c) {
        if (one.classes[c] == class_of(block)) effect.otherwise = like(block, one.members[c]);
      }
      result.effects.push_back(std::move(effect));
      at += own.size;
    }
    return result;
  }

  /// Of each class, over all sets.
  [[nodiscard]] std::vector<EffectChance> chances(double all) const {
    std::map<std::size_t, std::map<int, double>> members;
    std::map<std::size_t, double> sums;
    for (const SetOfClasses& one : sets_) {
      for (std::size_t c = 0; c < one.classes.size(); ++c) {
        sums[one.classes[c]] += one.weight;
        for (const auto& [block, weight] : one.members[c]) {
          members[one.classes[c]][block] += weight;
        }
      }
    }
    std::vector<EffectChance> result;
    for (const auto& [number, sum] : sums) {
      const int lead = lead_of(members.at(number));
      if (sum / all < kLeastChance && !is_named(lead)) continue;
      result.push_back(
          {candidate_of(lead).effect, like(lead, members.at(number)), std::min(1.0, sum / all)});
    }
    std::stable_sort(
        result.begin(), result.end(),
        [](const EffectChance& a, const EffectChance& b) { return a.probability > b.probability; });
    return result;
  }

  const std::vector<Tested>& tested_;
  SetGround ground_;
  WeighedSets weighed_;
  std::vector<int> named_blocks_;
  std::vector<std::size_t> named_classes_;
  std::vector<SetOfClasses> sets_;
};

bool is_of_load(const Candidate& one, const std::vector<std::string>& covariates) {
  const Shape& shape = one.effect.shape.front();
  const bool motion = shape.speaks_of("speed") || shape.speaks_of("turn_rate");
  return motion && std::any_of(covariates.begin(), covariates.end(),
                               [&](const std::string& name) { return shape.speaks_of(name); });
}

}  // namespace

std::vector<Tested> interactions(const std::vector<Tested>& tested,
                                 const std::vector<NamedEffect>& named,
                                 const fitting::FitState& fit, const ScoreTest& tests) {
  const FormulaGrammar grammar(fit, tests.context());
  const std::vector<std::string> covariates = covariates_of(tests.context());
  std::vector<Tested> result;
  const auto add = [&](Channel channel, bool all) {
    for (Candidate& one : grammar.of(channel)) {
      if (!one.family.empty() || (!all && !is_of_load(one, covariates))) continue;
      const auto same = [&one](const Tested& other) {
        return other.candidate.effect.channel == one.effect.channel &&
               other.candidate.effect.shape == one.effect.shape;
      };
      if (std::any_of(tested.begin(), tested.end(), same)) continue;
      if (std::any_of(result.begin(), result.end(), same)) continue;
      result.emplace_back();
      result.back().candidate = std::move(one);
    }
  };
  for (const NamedEffect& one : named) add(tested[one.tested].candidate.effect.channel, true);
  for (const Channel channel : {Channel::travel, Channel::turn, Channel::wheels}) {
    const bool driven = std::any_of(tested.begin(), tested.end(), [channel](const Tested& one) {
      return one.candidate.effect.channel == channel;
    });
    if (driven) add(channel, false);
  }
  return result;
}

Explanations explanations_of(const std::vector<Tested>& tested,
                             const std::vector<NamedEffect>& named, const SetGround& ground) {
  if (named.empty()) return {};
  // What has too many columns for sets is in all of them.
  std::vector<NamedEffect> weighed;
  std::vector<ExplainingEffect> certain;
  ScoreTest tests = ground.tests;
  int dof = ground.dof;
  for (const NamedEffect& one : named) {
    const Score score = ground.tests.test({tested[one.tested].candidate.effect}).front();
    GramBuilder builder(score.projected.rows());
    builder.add(one.tested, one.effect, score);
    if (!builder.empty()) {
      weighed.push_back(one);
      continue;
    }
    tests.condition_on(score.columns);
    dof -= score.dof;
    certain.push_back({one.effect, one.sd, {}});
  }
  Explanations result;
  if (weighed.empty()) {
    result.sets.push_back({{}, 0.0, 1.0, 0.0, true});
  } else {
    result = Explainer(tested, weighed, {tests, dof, ground.most, ground.window}).run();
  }
  put_before(result, certain);
  return result;
}

namespace {

std::vector<NamedEffect> named_in(const Diagnosis& diagnosis, const SearchedEffects& searched) {
  std::vector<NamedEffect> named;
  for (const Finding& one : diagnosis.findings) {
    if (one.joint.empty()) continue;
    for (const std::size_t k : searched.missing) {
      const Effect& effect = searched.tested[k].candidate.effect;
      if (effect.name != one.effect.name || effect.shape != one.effect.shape) continue;
      Effect sized = one.effect;
      sized.coefficients = one.joint;
      named.push_back({k, one.look_alikes, std::move(sized), one.joint_sd});
    }
  }
  return named;
}

/// Not less likely than one in twenty: it has to be possible.
void allow_what_is_likely(Diagnosis& diagnosis) {
  constexpr double kLikely = 0.05;
  for (Finding& one : diagnosis.findings) {
    if (one.status != Status::absent) continue;
    for (const EffectChance& chance : diagnosis.explanations.effects) {
      if (chance.probability >= kLikely && chance.effect.name == one.effect.name) {
        one.status = Status::cannot_tell;
      }
    }
  }
}

}  // namespace

void explain(Diagnosis& diagnosis, const SearchedEffects& searched, const ModelFit& fit,
             const std::optional<ModelFit>& with, const ScoreTest& about) {
  constexpr double kFirstOrder = 3.0;  // chi^2/dof
  const std::vector<NamedEffect> named = named_in(diagnosis, searched);
  if (named.empty()) return;
  // Beside errors far larger than noise no tests to first order weigh what is smaller.
  if (with && with->dof > 0 && with->chi2 > kFirstOrder * with->dof) return;
  std::vector<Effect> added;
  for (std::size_t k = fit.effects.size(); with && k < with->effects.size(); ++k) {
    added.push_back(with->effects[k].effect);
  }
  ScoreTest tests = with ? about.lacking(fit.effects.size(), added) : about;
  tests.condition_on(searched.events);
  std::vector<Tested> tested = searched.tested;
  for (Tested& one : interactions(tested, named, *fit.state, tests)) {
    tested.push_back(std::move(one));
  }
  const int dof = fit.dof - static_cast<int>(searched.events.cols());
  diagnosis.explanations = explanations_of(tested, named, {tests, dof});
  allow_what_is_likely(diagnosis);
}

void put_before(Explanations& explanations, const std::vector<ExplainingEffect>& certain) {
  for (EffectSet& one : explanations.sets) {
    one.effects.insert(one.effects.begin(), certain.begin(), certain.end());
  }
  std::vector<EffectChance> chances;
  chances.reserve(certain.size());
  for (const ExplainingEffect& one : certain) chances.push_back({one.effect, one.otherwise, 1.0});
  explanations.effects.insert(explanations.effects.begin(), chances.begin(), chances.end());
}

}  // namespace trussmap::criticism
