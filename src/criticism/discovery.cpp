// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/diagnosis.hpp"
#include "criticism/effect_strength.hpp"
#include "criticism/effect_trials.hpp"
#include "criticism/grown_model.hpp"
#include "criticism/refits.hpp"
#include "fit/fit_state.hpp"
#include "linalg/dense.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/error.hpp"
#include "validation/dead_reckoned_horizons.hpp"
#include "validation/held_out_legs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace trussmap {
using namespace criticism;

namespace {

constexpr int kFewestWindows = 20;
constexpr double kLess = 0.98;  // of the error after 30 s, to be better

/// m; nothing of too few windows.
std::optional<double> shown(const validation::HorizonError& error) {
  if (error.windows < kFewestWindows) return std::nullopt;
  return error.rms;
}

/// The systematic errors that nearly every robot has.
bool is_common_motion(const Candidate& one) {
  const effects::CatalogueRecord* record = record_of(one);
  return record != nullptr && record->common_motion;
}

/// Of dead reckoning: with an effect that explains much, beyond chance only.
bool reckons_worse(const validation::HorizonChange& change, const Finding& with) {
  constexpr double kPlain = 1e-6;  // p
  return change.share > kNoWorse &&
         (with.p_adjusted > kPlain || change.rise_in_sds > kBeyondChance);
}

/// Dead reckoning over the longer horizon with another fit beside the present one, as the other's
/// path judges both; none where there are too few windows.
validation::HorizonChange reckoned_change(const ModelFit& present, const ModelFit& other) {
  const validation::HorizonChange change =
      validation::horizon_change(*present.state, *other.state, 30.0);
  return change.windows < kFewestWindows ? validation::HorizonChange{} : change;
}

void tell_fit(const ModelFit& fit, DiscoveryStep& step) {
  step.chi2 = fit.chi2;
  step.dof = fit.dof;
  step.left_out = fit.left_out.size();
}

/// Adds what is found, one effect after the other.
class Discoverer {
 public:
  Discoverer(const std::vector<DrivenRecording>& recordings, const DiscoverOptions& options,
             ModelFit given)
      : recordings_(recordings),
        options_(options),
        stated_(given.model.noise),
        grown_(recordings, std::move(given)) {
    result_.given = grown_.fit();
    record();
  }

  Discovery run() {
    while (true) {
      if (result_.steps.size() > 1 && options_.go_on && !options_.go_on(grown_.fit())) {
        stop(StopReason::told_to, {});
        return finished(false);
      }
      const std::optional<GrossConstants> gross = diagnose_present();
      if (gross) {
        take_constants(*gross);
        continue;
      }
      if (grown_.added() < options_.most_effects && add_for_reckoning()) continue;
      if (result_.last.verdict != Diagnosis::Verdict::missing) break;
      if (grown_.added() >= options_.most_effects) {
        result_.stopped = {StopReason::limit_reached, {}, options_.most_effects};
        break;
      }
      if (!(result_.last.findings.front().only_together ? add_together() : add_best())) break;
    }
    return finished(result_.last.verdict == Diagnosis::Verdict::nothing_missing);
  }

 private:
  Discovery finished(bool consistent) {
    result_.consistent = consistent;
    result_.found = std::move(grown_).finished();
    return std::move(result_);
  }

  void tell(const DiscoveryStage& stage) const {
    if (options_.progress) options_.progress(stage);
  }

  /// The constants that come before all else, if any.
  std::optional<GrossConstants> diagnose_present() {
    tell({DiscoveryStage::Kind::searching, {}});
    DiagnosisRun diagnosis =
        run_diagnosis(recordings_, grown_.fit(), stated_, options_.diagnosis, legs_);
    legs_ = {};
    result_.last = std::move(diagnosis.result);
    take_noise();
    candidates_ = std::move(diagnosis.candidates);
    if (result_.steps.size() == 1) result_.first = result_.last;
    result_.steps.back().held_out = result_.last.held_out;
    result_.stopped = {};
    return std::move(diagnosis.gross);
  }

  /// The model found goes by the noise that the diagnosis estimated.
  void take_noise() {
    DiscoveryStep& step = result_.steps.back();
    if (result_.last.under) {
      grown_.take_fit(result_.last.under->fit);
      if (result_.steps.size() == 1) result_.given = grown_.fit();
      tell_fit(grown_.fit(), step);
    }
    tell_reckoning(step);
  }

  void tell_reckoning(DiscoveryStep& step) {
    step.reckoned_10 = shown(grown_.horizons().after_10);
    step.reckoned_30 = shown(grown_.horizons().after_30);
  }

  /// A line of the ladder for the present fit; its diagnosis, which is next, has the held-out legs.
  DiscoveryStep& record() {
    DiscoveryStep step;
    tell_fit(grown_.fit(), step);
    result_.steps.push_back(std::move(step));
    return result_.steps.back();
  }

  /// Those that explain most, one step each; their sizes are fitted already.
  void take_constants(const GrossConstants& gross) {
    const std::vector<Effect>& all = gross.fit.model.effects;
    std::vector<Effect> together;
    std::vector<Candidate> added;
    for (std::size_t count = gross.first + 1; count <= all.size(); ++count) {
      const std::size_t place = count - 1 - gross.first;
      added.push_back(candidates_[place]);
      const double before = grown_.fit().chi2;
      Model model = gross.fit.model;
      model.effects.resize(count);
      try {
        grown_.add(added,
                   count == all.size() ? gross.fit : fitting::refit(recordings_, model, gross.fit));
      } catch (const SolveError&) {  // lost without those that come next
        together.push_back(all[count - 1]);
        continue;
      }
      added.clear();
      DiscoveryStep& step = record();
      step.added = grown_.fit().model.effects.back();
      step.together = std::exchange(together, {});
      step.predicted_decrease = before - grown_.fit().chi2;
      step.held_out = predict_held_out(recordings_, grown_.fit(), options_.diagnosis.legs);
      step.predicted = validation::metrics_of(step.held_out);
      tell_reckoning(step);
      step.look_alikes = result_.last.findings[place].look_alikes;
    }
  }

  /// The first finding and, where it cannot be had, the next that is missing.
  bool add_best() {
    for (std::size_t k = 0; k < result_.last.findings.size(); ++k) {
      if (k > 0 && result_.last.findings[k].status != Status::missing) continue;
      if (add(k)) return true;
    }
    return false;
  }

  /// Those that can be fitted beside what the model has.
  [[nodiscard]] std::vector<Trial> tried(const std::vector<std::size_t>& contenders) const {
    std::vector<Trial> trials;
    for (const std::size_t k : contenders) {
      tell({DiscoveryStage::Kind::fitting_effect, candidates_[k].effect.name});
      std::vector<Effect> effects = grown_.fit().model.effects;
      effects.push_back(candidates_[k].effect);
      try {
        ModelFit fit = grown_.fitted(effects);
        if (was_fitted(fit)) trials.push_back({candidates_[k], std::move(fit)});
      } catch (const SolveError&) {
        continue;
      }
    }
    return trials;
  }

  bool add(std::size_t at) {
    const Finding& winner = result_.last.findings[at];
    std::vector<Trial> trials = tried(contenders(result_.last.findings, at));
    if (trials.empty()) {
      stop(StopReason::cannot_be_fitted, winner.effect.name);
      return false;
    }
    const std::size_t best = best_of(trials, recordings_, options_.diagnosis.legs);
    const validation::HorizonChange reckoned = reckoned_change(grown_.fit(), trials[best].fit);
    const bool worse = predicts_worse(result_.steps.back().held_out, trials[best], recordings_,
                                      options_.diagnosis.legs);
    if ((worse && reckoned.share >= kLess) || reckons_worse(reckoned, winner)) {
      stop(StopReason::predicts_worse, trials[best].candidate.effect.name);
      return false;
    }
    std::vector<LookAlike> look_alikes = rivals_of(trials, best, winner);
    legs_ = {trials[best].fit.state, trials[best].legs};
    grown_.add({trials[best].candidate}, std::move(trials[best].fit));
    grown_.seek_parameters_anew();
    std::vector<std::string> dropped = grown_.eliminate_backward();
    DiscoveryStep& step = record();
    step.added = grown_.fit().model.effects.back();
    step.dropped = std::move(dropped);
    step.predicted_decrease = winner.score;
    step.predicted = winner.held_out;
    step.look_alikes = std::move(look_alikes);
    return true;
  }

  /// Effects that hide each other, all at once.
  bool add_together() {
    std::vector<Candidate> added;
    std::vector<Effect> effects;
    for (std::size_t k = 0; k < result_.last.findings.size(); ++k) {
      if (!result_.last.findings[k].only_together) continue;
      added.push_back(candidates_[k]);
      effects.push_back(candidates_[k].effect);
    }
    std::optional<ModelFit> fit = if_fitted_with(recordings_, grown_.fit(), effects);
    if (!fit || !was_fitted(*fit)) {
      stop(StopReason::cannot_be_fitted, effects.front().name);
      return false;
    }
    Trial trial{added.back(), *std::move(fit)};
    if (predicts_worse(result_.steps.back().held_out, trial, recordings_,
                       options_.diagnosis.legs)) {
      stop(StopReason::predicts_worse, effects.front().name);
      return false;
    }
    legs_ = {trial.fit.state, trial.legs};
    grown_.add(added, std::move(trial.fit));
    DiscoveryStep& step = record();
    effects = grown_.fit().model.effects;
    step.added = effects.back();
    step.together.assign(effects.end() - static_cast<std::ptrdiff_t>(added.size()),
                         effects.end() - 1);
    for (const EffectSet& one : result_.last.explanations.sets) {
      if (one.named) step.predicted_decrease = one.chi2_decrease;
    }
    step.predicted = result_.last.with_missing;
    return true;
  }

  /// What the tests of all effects together are too many for may yet be plain where a known error
  /// of the motion is asked for by itself: a wheelbase beside a loss in arcs. It has to be surely
  /// there and to make dead reckoning better; of several the one that explains most is taken. Only
  /// beside something found: nothing is sought so in recordings that the model explains.
  bool add_for_reckoning() {
    if (grown_.added() == 0) return false;
    if (grown_.horizons().after_30.windows < kFewestWindows) return false;
    std::optional<Trial> best;
    const Finding* asked = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < result_.last.findings.size(); ++k) {
      if (!is_common_motion(candidates_[k]) ||
          result_.last.findings[k].score < 0.25 * kWorthKeeping) {
        continue;
      }
      std::vector<Trial> trials = tried({k});
      if (trials.empty()) continue;
      const ModelFit& fit = trials.front().fit;
      if (wald(fit, fit.model.effects.size() - 1) < kWorthKeeping) continue;
      if (chi2_of_all(fit) >= least || reckoned_change(grown_.fit(), fit).share >= kLess) continue;
      least = chi2_of_all(fit);
      best = std::move(trials.front());
      asked = &result_.last.findings[k];
    }
    if (!best) return false;
    grown_.add({best->candidate}, std::move(best->fit));
    DiscoveryStep& step = record();
    step.added = grown_.fit().model.effects.back();
    step.predicted_decrease = asked->score;
    step.predicted = asked->held_out;
    return true;
  }

  /// The first reason counts.
  void stop(StopReason reason, const std::string& effect) {
    if (result_.stopped.effect.empty()) result_.stopped = {reason, effect, 0};
  }

  const std::vector<DrivenRecording>& recordings_;
  const DiscoverOptions& options_;
  const Noise stated_;
  GrownModel grown_;
  std::vector<Candidate> candidates_;  ///< one per finding of the last diagnosis
  KnownLegs legs_;                     ///< of what was added last
  Discovery result_;
};

}  // namespace

Discovery discover(const std::vector<DrivenRecording>& recordings, const Model& model,
                   const DiscoverOptions& options) {
  if (options.progress) options.progress({DiscoveryStage::Kind::fitting_given, {}});
  return Discoverer(recordings, options, fit_model(recordings, model, options.diagnosis.fit)).run();
}

}  // namespace trussmap
