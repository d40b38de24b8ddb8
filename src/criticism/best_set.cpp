// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/best_set.hpp"

#include "criticism/event_tests.hpp"
#include "linalg/dense.hpp"
#include "statistics/distributions.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::criticism {
namespace {

constexpr double kMaskedLevel = 0.2;  // of the level
constexpr int kMostMasked = 3;
constexpr double kAhead = 3.0;  // of log evidence

/// Sets of `size` among so many.
double log_sets_of(double tried, int size) {
  double sum = 0.0;
  for (int k = 0; k < size; ++k) sum += std::log(std::max(1.0, tried - k) / (k + 1));
  return sum;
}

double p_of_set(double gain, int dof, int tried, int size) {
  return std::min(1.0, statistics::chi2_p_value(gain, dof) * std::exp(log_sets_of(tried, size)));
}

std::vector<std::size_t> tested_in(const CandidateSet& set, const CandidateGram& gram) {
  std::vector<std::size_t> places;
  places.reserve(static_cast<std::size_t>(set.size));
  for (int m = 0; m < set.size; ++m) {
    places.push_back(gram.blocks[idx(set.members[idx(m)])].candidate);
  }
  return places;
}

int columns_in(const CandidateSet& set, const CandidateGram& gram) {
  Eigen::Index count = 0;
  for (int m = 0; m < set.size; ++m) count += gram.blocks[idx(set.members[idx(m)])].size;
  return static_cast<int>(count);
}

/// Whether each explains more beside the others than chance would among all that were tried, and
/// than a large effect leaves for being large.
bool each_is_there(const CandidateSet& set, const WeighedSets& weighed,
                   const SearchGround& ground) {
  const SubsetSearch search(weighed.gram, weighed.belief, {weighed.dispersion});
  for (int m = 0; m < set.size; ++m) {
    CandidateSet others = set;
    std::copy(set.members.begin() + m + 1, set.members.begin() + set.size,
              others.members.begin() + m);
    others.members[idx(set.size - 1)] = 0;
    others.size = set.size - 1;
    if (!search.weigh(others)) return false;
    const double own = set.gain - others.gain;
    const auto dof = static_cast<int>(weighed.gram.blocks[idx(set.members[idx(m)])].size);
    const double p = statistics::chi2_p_value(own / weighed.dispersion, dof) * ground.tried;
    if (p >= ground.next_level || own < ground.next_share * others.gain) return false;
  }
  return true;
}

/// How the rows scatter that speak for a set.
double dispersion_of_set(const std::vector<std::size_t>& places, const std::vector<Tested>& tested,
                         const SearchGround& ground) {
  Score joint;
  joint.dof = 1;
  joint.p_value = 0.0;
  joint.projected.resize(ground.tests.residuals().size(), 0);
  for (const std::size_t k : places) {
    linalg::append_columns(joint.projected,
                           ground.tests.test({tested[k].candidate.effect}).front().projected);
  }
  const Eigen::VectorXd estimate =
      -linalg::least_squares(joint.projected, ground.tests.residuals());
  joint.coefficients.assign(estimate.begin(), estimate.end());
  joint.columns = joint.projected;
  return dispersion_of(joint, LocalDispersion(ground.fit, ground.tests));
}

}  // namespace

MaskedSet masked_set(const std::vector<Tested>& tested, const SearchGround& ground) {
  const WeighedSets weighed = weigh_sets(tested, {ground.tests, ground.dof, kMostMasked, 6.0});
  const double level = kMaskedLevel * ground.level;
  const auto found = std::find_if(weighed.sets.begin(), weighed.sets.end(),
                                  [](const CandidateSet& one) { return one.size > 1; });
  // One that explains as much by itself was not significant, and nor is what comes with it.
  if (found == weighed.sets.end() || found != weighed.sets.begin()) return {};
  const int dof = columns_in(*found, weighed.gram);
  const auto p_at = [&](double noise) {
    return p_of_set(found->gain / noise, dof, ground.tried, found->size);
  };
  if (p_at(weighed.dispersion) >= level || !each_is_there(*found, weighed, ground)) return {};
  MaskedSet result{tested_in(*found, weighed.gram), 1.0};
  result.p_adjusted =
      p_at(std::max(weighed.dispersion, dispersion_of_set(result.tested, tested, ground))) /
      kMaskedLevel;
  if (result.p_adjusted >= ground.level) return {};
  const std::vector<TestedEvent> events = test_events(ground.fit, ground.tests);
  const bool event = std::any_of(events.begin(), events.end(), [&](const TestedEvent& one) {
    return one.kind != EventKind::session && one.p_adjusted < result.p_adjusted;
  });
  return event ? MaskedSet{} : result;
}

std::vector<std::size_t> better_set(const std::vector<std::size_t>& found,
                                    const std::vector<Tested>& tested, const SearchGround& ground) {
  const WeighedSets weighed = weigh_sets(
      tested, {ground.tests, ground.dof, static_cast<int>(std::min(ground.most, kMostInSet)), 6.0},
      found);
  CandidateSet own;
  for (const std::size_t one : found) {
    const std::optional<int> block = weighed.block_of(one);
    if (!block || own.size == static_cast<int>(kMostInSet)) return found;
    own.members[idx(own.size++)] = *block;
  }
  std::sort(own.members.begin(), own.members.begin() + own.size);
  const SubsetSearch search(weighed.gram, weighed.belief, {weighed.dispersion});
  if (!search.weigh(own)) return found;
  for (const CandidateSet& one : weighed.sets) {
    if (one.log_evidence < own.log_evidence + kAhead) break;
    if (one.size > 0 && each_is_there(one, weighed, ground)) return tested_in(one, weighed.gram);
  }
  return found;
}

std::vector<std::size_t> masked_pair(CandidateGram gram, const std::vector<Tested>& tested,
                                     const SetGround& ground, double level) {
  SetBelief belief = belief_in(gram, tested, 2);
  const WeighedSets weighed = weigh_sets(std::move(gram), std::move(belief), ground);
  const CandidateSet& best = weighed.sets.front();
  if (best.size < 2) return {};
  const double p = p_of_set(best.gain / weighed.dispersion, columns_in(best, weighed.gram),
                            static_cast<int>(tested.size()), best.size);
  return p < level ? tested_in(best, weighed.gram) : std::vector<std::size_t>();
}

}  // namespace trussmap::criticism
