// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/discovery.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr std::size_t kMostRivals = 4;
constexpr double kDecisive = 6.0;       // of chi^2
constexpr double kWorthKeeping = 15.0;  // Wald statistic per coefficient that keeps an effect
constexpr double kNoWorse = 1.05;       // of the arrival error
constexpr double kBetter = 0.98;        // of the arrival error, to be preferred

class Discoverer {
 public:
  Discoverer(const std::vector<Recording>& recordings, const Model& model,
             const DiscoveryOptions& options)
      : recordings_(recordings), options_(options), how_(fit_options(options.diagnosis)) {
    given_ = model.effects.size();
    tell("fitting the model given");
    result_.fit = fit_model(recordings, model, how_);
    found_.resize(given_);
    record();
  }

  Discovery run() {
    while (true) {
      tell(fmt::format("looking for what is missing, step {}", result_.steps.size()));
      result_.last = diagnose(recordings_, result_.fit, options_.diagnosis);
      if (result_.steps.size() == 1) result_.first = result_.last;
      result_.steps.back().held_out = result_.last.held_out;
      if (result_.last.verdict != Diagnosis::Verdict::missing) {
        result_.stopped = "nothing more is significant";
        break;
      }
      if (found_.size() >= given_ + options_.most_effects) {
        result_.stopped =
            fmt::format("{} effects are as many as are looked for", options_.most_effects);
        break;
      }
      result_.stopped.clear();
      if (!add_best()) break;
    }
    judge();
    return std::move(result_);
  }

 private:
  void tell(const std::string& what) const {
    if (options_.progress) options_.progress(what);
  }

  [[nodiscard]] ModelFit fitted(const std::vector<Effect>& effects) const {
    Model model = result_.fit.model;
    model.effects = effects;
    ModelFitOptions how = how_;
    how.near = &result_.fit;
    return fit_model(recordings_, model, how);
  }

  /// A line of the ladder for the present fit; its diagnosis, which is next, has the held-out legs.
  DiscoveryStep& record() {
    DiscoveryStep step;
    step.chi2 = result_.fit.adjustment.chi2;
    step.dof = result_.fit.adjustment.dof;
    result_.steps.push_back(std::move(step));
    return result_.steps.back();
  }

  /// A finding, added and fitted.
  struct Trial {
    Candidate candidate;
    ModelFit fit;
    std::optional<double> arrival = std::nullopt;  ///< of the held-out legs, m; once asked for
  };

  double arrival_of(Trial& trial) const {
    if (trial.arrival) return *trial.arrival;
    try {
      trial.arrival =
          predict_held_out(recordings_, trial.fit, how_, options_.diagnosis.legs).arrival_rms;
    } catch (const SolveError&) {  // what is left without those legs does not tell the effect
      trial.arrival = std::numeric_limits<double>::infinity();
    }
    return *trial.arrival;
  }

  [[nodiscard]] static bool was_fitted(const ModelFit& fit) {
    return fit.effects.empty() || fit.effects.back().not_fitted.empty();
  }

  /// The first finding and, where it cannot be had, the next that is missing.
  bool add_best() {
    for (const Finding& one : result_.last.findings) {
      if (&one != &result_.last.findings.front() && one.status != Status::missing) continue;
      if (add(one)) return true;
    }
    return false;
  }

  bool add(const Finding& winner) {
    std::vector<Trial> trials;
    std::vector<const Finding*> chosen{&winner};
    for (const Finding& one : result_.last.findings) {
      if (&one == &winner || chosen.size() > kMostRivals) continue;
      const bool same_layout = std::any_of(
          winner.look_alikes.begin(), winner.look_alikes.end(), [&](const LookAlike& other) {
            return other.effect.name == one.candidate.effect.name && other.cosine < 0.9999;
          });
      if (same_layout && one.score > winner.score - 4.0 * kDecisive) chosen.push_back(&one);
    }
    for (const Finding* one : chosen) {
      tell(fmt::format("fitting \"{}\"", one->candidate.effect.name));
      std::vector<Effect> effects = result_.fit.model.effects;
      effects.push_back(one->candidate.effect);
      try {
        ModelFit fit = fitted(effects);
        if (was_fitted(fit)) trials.push_back({one->candidate, std::move(fit)});
      } catch (const SolveError&) {
        continue;  // nor can it be fitted
      }
    }
    if (trials.empty()) {
      stop(fmt::format("\"{}\" cannot be fitted beside what the model has",
                       winner.candidate.effect.name));
      return false;
    }
    const std::size_t best = best_of(trials);
    const double before = result_.steps.back().held_out.arrival_rms;
    if (before > 0.0 && arrival_of(trials[best]) > kNoWorse * before) {
      stop(fmt::format("\"{}\" fits these legs, but predicts others worse",
                       trials[best].candidate.effect.name));
      return false;
    }
    found_.push_back(trials[best].candidate);
    result_.fit = std::move(trials[best].fit);
    seek_parameters_anew();
    std::vector<std::string> dropped = eliminate_backward();
    DiscoveryStep& step = record();
    step.added = result_.fit.model.effects.back();
    step.dropped = std::move(dropped);
    step.predicted_chi2 = winner.score;
    step.predicted = winner.held_out;
    step.look_alikes = winner.look_alikes;
    return true;
  }

  void stop(const std::string& why) {
    if (result_.stopped.empty()) result_.stopped = why;
  }

  /// chi^2 decides where it can, else held-out legs, else the order of the diagnosis.
  [[nodiscard]] std::size_t best_of(std::vector<Trial>& trials) const {
    const auto cost = [](const Trial& one) {
      return one.fit.adjustment.chi2 - 2.0 * one.candidate.log_prior +
             4.0 * static_cast<double>(one.candidate.effect.shape.size() +
                                       one.candidate.parameters.size());
    };
    std::size_t best = 0;
    for (std::size_t k = 1; k < trials.size(); ++k) {
      const double gain = cost(trials[best]) - cost(trials[k]);
      if (gain < -kDecisive) continue;
      if (gain < kDecisive && !(arrival_of(trials[k]) < kBetter * arrival_of(trials[best]))) {
        continue;
      }
      best = k;
    }
    return best;
  }

  /// Places and thresholds of all effects found, each with the others in the model.
  void seek_parameters_anew() {
    for (std::size_t k = given_; k < found_.size(); ++k) {
      if (found_[k].parameters.empty()) continue;
      std::vector<Effect> others = result_.fit.model.effects;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
      const ModelFit without = fitted(others);
      const Candidate better = refined(ScoreTest(without), found_[k]);
      if (better.parameters == found_[k].parameters) continue;
      std::vector<Effect> effects = result_.fit.model.effects;
      effects[k] = better.effect;
      ModelFit fit = fitted(effects);
      if (fit.adjustment.chi2 >= result_.fit.adjustment.chi2) continue;
      found_[k] = better;
      result_.fit = std::move(fit);
    }
  }

  /// Effects that the others have made superfluous, the weakest first.
  std::vector<std::string> eliminate_backward() {
    std::vector<std::string> dropped;
    while (true) {
      std::size_t weakest = found_.size();
      double least = 1.0;
      for (std::size_t k = given_; k < found_.size(); ++k) {
        const double strength =
            wald(k) / (kWorthKeeping * static_cast<double>(found_[k].effect.shape.size()));
        if (strength < least) {
          least = strength;
          weakest = k;
        }
      }
      // The one just added is there because it was significant.
      if (weakest + 1 >= found_.size()) return dropped;
      dropped.push_back(found_[weakest].effect.name);
      std::vector<Effect> effects = result_.fit.model.effects;
      effects.erase(effects.begin() + static_cast<std::ptrdiff_t>(weakest));
      found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(weakest));
      result_.fit = fitted(effects);
    }
  }

  /// a' C^-1 a of an effect's coefficients.
  [[nodiscard]] double wald(std::size_t effect) const {
    const std::vector<int> unknown = unknown_coefficients(result_.fit.columns.border);
    std::vector<Eigen::Index> places;
    for (std::size_t k = 0; k < unknown.size(); ++k) {
      const Coefficient& one = result_.fit.columns.coefficients[idx(unknown[k])];
      if (one.effect == effect) places.push_back(static_cast<Eigen::Index>(k));
    }
    if (places.empty()) return 0.0;
    const Eigen::MatrixXd C = result_.fit.adjustment.coefficient_covariance(places, places);
    const Eigen::VectorXd a = result_.fit.adjustment.coefficients(places);
    return a.dot(C.ldlt().solve(a));
  }

  void judge() {
    const RecordingAdjustment& adjustment = result_.fit.adjustment;
    result_.consistent = adjustment.p_value >= 0.01;
    if (!result_.consistent) result_.stopped += ", but the misfit is not explained";
  }

  const std::vector<Recording>& recordings_;
  const DiscoveryOptions& options_;
  ModelFitOptions how_;
  std::size_t given_ = 0;
  std::vector<Candidate> found_;  ///< one per effect of the model; empty for those given
  Discovery result_;
};

}  // namespace

Discovery discover(const std::vector<Recording>& recordings, const Model& model,
                   const DiscoveryOptions& options) {
  return Discoverer(recordings, model, options).run();
}

}  // namespace trussmap
