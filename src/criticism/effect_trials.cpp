// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/effect_trials.hpp"

#include "criticism/effect_strength.hpp"
#include "criticism/refits.hpp"
#include "trussmap/error.hpp"
#include "validation/arrival_rise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trussmap::criticism {
namespace {

constexpr std::size_t kMostRivals = 4;
constexpr double kSame = 0.9999;  // cosine of what is the same effect

double arrival_of(Trial& trial, const std::vector<DrivenRecording>& recordings,
                  const LegOptions& legs) {
  if (!trial.held_out) {
    try {
      trial.legs = std::make_shared<const validation::HeldOutLegs>(recordings, trial.fit, legs);
      trial.held_out = trial.legs->metrics();
    } catch (const SolveError&) {  // what is left without those legs does not tell the effect
      trial.held_out = HeldOut{};
      trial.held_out->arrival_rms = std::numeric_limits<double>::infinity();
    }
  }
  return trial.held_out->arrival_rms;
}

/// Of the held-out legs, and beyond what chance makes of so few.
bool predicts_better(Trial& one, Trial& other, const std::vector<DrivenRecording>& recordings,
                     const LegOptions& legs) {
  constexpr double kBetter = 0.98;  // of the arrival error
  const double arrival = arrival_of(one, recordings, legs);
  const double than = arrival_of(other, recordings, legs);
  if (!(arrival < kBetter * than)) return false;
  return std::isinf(than) ||
         validation::rise_in_sds(*one.held_out, *other.held_out) > kBeyondChance;
}

}  // namespace

std::vector<std::size_t> contenders(const std::vector<Finding>& findings, std::size_t at) {
  const Finding& winner = findings[at];
  std::vector<std::size_t> chosen{at};
  for (std::size_t k = 0; k < findings.size(); ++k) {
    const Finding& one = findings[k];
    if (k == at || chosen.size() > kMostRivals) continue;
    const bool alike = std::any_of(
        winner.look_alikes.begin(), winner.look_alikes.end(), [&](const LookAlike& other) {
          // What is the same to first order, and acts elsewhere, may yet be told apart by a fit.
          return other.effect.name == one.effect.name &&
                 (other.cosine < kSame || one.effect.channel != winner.effect.channel);
        });
    if (alike && one.score > winner.score - 4.0 * kDecisive) chosen.push_back(k);
  }
  return chosen;
}

bool was_fitted(const ModelFit& fit) {
  return fit.effects.empty() || fit.effects.back().not_fitted.empty();
}

std::vector<LookAlike> rivals_of(const std::vector<Trial>& trials, std::size_t taken,
                                 const Finding& winner) {
  const ModelFit& fit = trials[taken].fit;
  const double noise = std::max(1.0, fit.chi2 / std::max(1, fit.dof));
  std::vector<LookAlike> rivals = winner.look_alikes;
  for (LookAlike& rival : rivals) {
    if (rival.effect.name == trials[taken].candidate.effect.name) rival.effect = winner.effect;
    for (const Trial& trial : trials) {
      if (trial.candidate.effect.name != rival.effect.name) continue;
      rival.behind = (chi2_of_all(trial.fit) - chi2_of_all(fit)) / noise;
    }
  }
  return rivals;
}

bool predicts_worse(const HeldOut& before, Trial& trial,
                    const std::vector<DrivenRecording>& recordings, const LegOptions& legs) {
  if (!(before.arrival_rms > 0.0)) return false;
  const double arrival = arrival_of(trial, recordings, legs);
  if (arrival <= kNoWorse * before.arrival_rms) return false;
  return std::isinf(arrival) || validation::rise_in_sds(before, *trial.held_out) > kBeyondChance;
}

std::size_t best_of(std::vector<Trial>& trials, const std::vector<DrivenRecording>& recordings,
                    const LegOptions& legs) {
  const auto cost = [](const Trial& one) {
    return chi2_of_all(one.fit) - 2.0 * one.candidate.log_prior +
           4.0 * static_cast<double>(one.candidate.effect.shape.size() +
                                     one.candidate.parameters.size());
  };
  std::size_t best = 0;
  for (std::size_t k = 1; k < trials.size(); ++k) {
    const double gain = cost(trials[best]) - cost(trials[k]);
    if (gain < -kDecisive) continue;
    if (gain < kDecisive && !predicts_better(trials[k], trials[best], recordings, legs)) continue;
    best = k;
  }
  return best;
}

}  // namespace trussmap::criticism
