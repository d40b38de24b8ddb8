// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/weighed_sets.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace trussmap::criticism {
namespace {

constexpr std::size_t kMostExact = 150;  // candidates

/// Catalogue before free forms, then as tested.
std::vector<std::size_t> by_belief(const CandidateGram& gram, const std::vector<Tested>& tested) {
  std::vector<std::size_t> order(gram.blocks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return tested[gram.blocks[a].candidate].candidate.log_prior >
           tested[gram.blocks[b].candidate].candidate.log_prior;
  });
  return order;
}

/// Places of those in any of the sets, and of `also`, the likeliest sets first.
std::vector<std::size_t> candidates_in(const WeighedSets& weighed,
                                       const std::vector<std::size_t>& also) {
  std::vector<std::size_t> places = also;
  const auto add = [&places](std::size_t one) {
    if (std::find(places.begin(), places.end(), one) == places.end()) places.push_back(one);
  };
  for (const CandidateSet& set : weighed.sets) {
    if (places.size() >= kMostExact) break;
    for (int m = 0; m < set.size; ++m) {
      add(weighed.gram.blocks[idx(set.members[idx(m)])].candidate);
    }
  }
  std::sort(places.begin(), places.end());
  return places;
}

CandidateGram gram_of(const std::vector<Tested>& tested, const std::vector<std::size_t>& places,
                      const ScoreTest& tests, Resolution resolution) {
  std::vector<Candidate> candidates;
  candidates.reserve(places.size());
  for (const std::size_t k : places) candidates.push_back(tested[k].candidate);
  GramBuilder builder(tests.residuals().size());
  visit_scores(tests, candidates, resolution, [&](std::size_t k, const Score& score) {
    builder.add(places[k], candidates[k].effect, score);
  });
  return builder.gram(tests.residuals());
}

/// The belief of some of the candidates, classes and all as they are among all of them.
SetBelief belief_of_some(const CandidateGram& some, const CandidateGram& all,
                         const SetBelief& belief) {
  SetBelief result;
  result.log_sets = belief.log_sets;
  for (const ColumnBlock& one : some.blocks) {
    const auto same = std::find_if(all.blocks.begin(), all.blocks.end(), [&](const auto& other) {
      return other.candidate == one.candidate;
    });
    result.blocks.push_back(belief.blocks[static_cast<std::size_t>(same - all.blocks.begin())]);
  }
  return result;
}

}  // namespace

std::optional<int> WeighedSets::block_of(std::size_t tested) const {
  for (std::size_t k = 0; k < gram.blocks.size(); ++k) {
    if (gram.blocks[k].candidate == tested) return static_cast<int>(k);
  }
  return std::nullopt;
}

SetBelief belief_in(const CandidateGram& gram, const std::vector<Tested>& tested, int most) {
  SetBelief belief;
  const std::vector<std::size_t> classes = look_alike_classes(gram, by_belief(gram, tested));
  const std::size_t count =
      classes.empty() ? 0 : *std::max_element(classes.begin(), classes.end()) + 1;
  std::vector<double> largest(count, -1e300);
  std::vector<double> sum(count, 0.0);
  const auto prior = [&](std::size_t k) {
    return tested[gram.blocks[k].candidate].candidate.log_prior;
  };
  for (std::size_t k = 0; k < classes.size(); ++k) {
    largest[classes[k]] = std::max(largest[classes[k]], prior(k));
    sum[classes[k]] += std::exp(prior(k));
  }
  for (std::size_t k = 0; k < classes.size(); ++k) {
    const Tested& one = tested[gram.blocks[k].candidate];
    BlockBelief block;
    block.look_alikes = classes[k];
    block.log_share = largest[classes[k]] + prior(k) - std::log(sum[classes[k]]);
    block.tried = one.tried;
    block.constants = static_cast<int>(one.candidate.parameters.size());
    belief.blocks.push_back(block);
  }
  belief.log_sets = log_symmetric(largest, static_cast<std::size_t>(most));
  // Numbers of effects by Poisson's law of mean 1.
  for (std::size_t k = 0; k < belief.log_sets.size(); ++k) {
    belief.log_sets[k] += std::lgamma(static_cast<double>(k) + 1.0);
  }
  return belief;
}

double dispersion_beside(const CandidateGram& gram, const CandidateSet& set,
                         const SetGround& ground) {
  int dof = ground.dof;
  for (int m = 0; m < set.size; ++m) {
    dof -= static_cast<int>(gram.blocks[idx(set.members[idx(m)])].size);
  }
  const double chi2 = ground.tests.residuals().squaredNorm() - set.gain;
  return std::max(1.0, chi2 / std::max(1, dof));
}

WeighedSets weigh_sets(CandidateGram gram, SetBelief belief, const SetGround& ground) {
  constexpr double kSame = 0.98;
  WeighedSets result;
  result.gram = std::move(gram);
  result.belief = std::move(belief);
  // The noise is what the best set leaves: of pairs first, which cost little.
  SubsetOptions options{1.0, 0.0, std::min(2, ground.most)};
  options.dispersion = dispersion_beside(
      result.gram, SubsetSearch(result.gram, result.belief, options).run().front(), ground);
  options.window = ground.window;
  options.most = ground.most;
  result.sets = SubsetSearch(result.gram, result.belief, options).run();
  const double beside = dispersion_beside(result.gram, result.sets.front(), ground);
  if (beside < kSame * options.dispersion) {
    options.dispersion = beside;
    result.sets = SubsetSearch(result.gram, result.belief, options).run();
  }
  result.dispersion = options.dispersion;
  return result;
}

WeighedSets weigh_sets(const std::vector<Tested>& tested, const SetGround& ground,
                       const std::vector<std::size_t>& also) {
  std::vector<std::size_t> places(tested.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  CandidateGram all = gram_of(tested, places, ground.tests, Resolution::screening);
  const SetBelief belief = belief_in(all, tested, ground.most);
  const WeighedSets screened = weigh_sets(all, belief, ground);
  CandidateGram some =
      gram_of(tested, candidates_in(screened, also), ground.tests, Resolution::exact);
  // What may be seen exactly but not at a second of driving at a time has no belief.
  std::erase_if(some.blocks, [&](const ColumnBlock& one) {
    return !std::any_of(all.blocks.begin(), all.blocks.end(),
                        [&](const ColumnBlock& other) { return other.candidate == one.candidate; });
  });
  SetBelief of_some = belief_of_some(some, all, belief);
  return weigh_sets(std::move(some), std::move(of_some), ground);
}

}  // namespace trussmap::criticism
