// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/diagnosis.hpp"

#include "criticism/constants_first.hpp"
#include "criticism/data_lacks.hpp"
#include "criticism/defence.hpp"
#include "criticism/diagnosed_changes.hpp"
#include "criticism/diagnosed_places.hpp"
#include "criticism/effect_search.hpp"
#include "criticism/explanations.hpp"
#include "criticism/look_alikes.hpp"
#include "criticism/noise_beside.hpp"
#include "criticism/place_uncertainty.hpp"
#include "criticism/refits.hpp"
#include "criticism/remaining_errors.hpp"
#include "criticism/trends.hpp"
#include "criticism/unobservable.hpp"
#include "criticism/verdict.hpp"
#include "drive/slow_covariates.hpp"
#include "fit/fit_warnings.hpp"
#include "linalg/dense.hpp"
#include "text/number_text.hpp"
#include "trussmap/held_out.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

namespace trussmap {
using namespace criticism;

namespace {

constexpr double kPractical = 0.05;    // rise of the arrival error
constexpr double kNegligible = 0.002;  // the same
constexpr double kFitsAnyway = 0.05;   // p
constexpr double kExplains = 1e-6;     // p, below which an adjustment warns of chi^2

/// None where the others do not tell the map.
std::shared_ptr<const validation::HeldOutLegs> held_out(
    const std::vector<DrivenRecording>& recordings, const ModelFit& fit, LegOptions legs) {
  try {
    return std::make_shared<const validation::HeldOutLegs>(recordings, fit, legs);
  } catch (const SolveError&) {
    legs.share = 0.0;
    return std::make_shared<const validation::HeldOutLegs>(recordings, fit, legs);
  }
}

/// Reports what a search has found.
class Diagnostician {
 public:
  Diagnostician(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                const DiagnoseOptions& options, const KnownLegs& known)
      : recordings_(recordings),
        fit_(fit),
        state_(*fit.state),
        options_(options),
        legs_(known.legs && known.of == fit.state ? known.legs
                                                  : held_out(recordings, fit, options.legs)),
        tests_(state_),
        search_(state_, tests_, {options.level, options.most_missing}, legs_.get()) {}

  DiagnosisRun run() {
    result_.chi2 = fit_.chi2;
    result_.dof = fit_.dof;
    result_.coefficients = fit_.coefficients;
    result_.level = options_.level;
    result_.held_out = legs_->metrics();
    result_.lacks = lacks_of(recordings_, fit_.model.robot, fit_.options);
    search_.run();
    result_.tried = static_cast<std::size_t>(search_.tried());
    for (std::size_t k = 0; k < search_.missing().size(); ++k) weigh_look_alikes(k);
    if (search_.missing().empty()) {
      for (TestedEvent& one : test_events(state_, tests_)) result_.events.push_back(std::move(one));
      result_.noise = test_noise_laws(state_, tests_);
    }
    report_findings();
    find_verdict();
    SearchedEffects searched{search_.tested(), {}, search_.events()};
    for (const MissingEffect& one : search_.missing()) searched.missing.push_back(one.tested);
    return {std::move(result_), std::move(candidates_), {}, std::move(searched)};
  }

 private:
  /// Of one that is missing, and whether one of them explains more.
  void weigh_look_alikes(std::size_t rank) {
    constexpr int kMostExchanges = 2;
    look_alikes_.emplace_back();
    for (int exchange = 0;; ++exchange) {
      std::vector<std::size_t> missing;
      std::vector<Effect> others;
      for (const MissingEffect& one : search_.missing()) {
        missing.push_back(one.tested);
        if (missing.size() - 1 != rank) others.push_back(joint_effect(one));
      }
      const Effect effect = joint_effect(search_.missing()[rank]);
      std::vector<LookAlike> alike =
          look_alikes_of(missing[rank], search_.tested(), missing, tests_, state_.adjustment.dof);
      weigh_by_fits(alike, effect, tests_, [&](const Effect& one) {
        std::vector<Effect> all = others;
        all.push_back(one);
        return if_fitted_with(recordings_, fit_, all);
      });
      const LookAlike* better = better_fitting(alike, effect);
      const std::size_t at = better == nullptr ? search_.tested().size() : place_of(*better);
      look_alikes_[rank] = std::move(alike);
      const bool other = at < search_.tested().size() &&
                         std::find(missing.begin(), missing.end(), at) == missing.end() &&
                         !is_implausible(search_.tested()[at]);
      if (!other || exchange == kMostExchanges) return;
      search_.exchange(rank, at);
    }
  }

  [[nodiscard]] Effect joint_effect(const MissingEffect& one) const {
    Effect effect = search_.tested()[one.tested].candidate.effect;
    effect.coefficients = one.joint.coefficients;
    return effect;
  }

  /// Among all that was tested; their number where it is none of them.
  [[nodiscard]] std::size_t place_of(const LookAlike& rival) const {
    const std::vector<Tested>& tested = search_.tested();
    const auto found = std::find_if(tested.begin(), tested.end(), [&rival](const Tested& one) {
      return one.score.dof > 0 && find_among(one.candidate.effect, {rival}) != nullptr;
    });
    return static_cast<std::size_t>(found - tested.begin());
  }

  /// What the effect of such coefficients moves the held-out legs by; empty where not known.
  [[nodiscard]] static Eigen::VectorXd moves(const Tested& one,
                                             const std::vector<double>& coefficients) {
    if (one.slopes.size() == 0) return {};
    return one.slopes * Eigen::Map<const Eigen::VectorXd>(coefficients.data(), one.slopes.cols());
  }

  [[nodiscard]] HeldOutMetrics predicted(const Eigen::VectorXd& moved) const {
    return moved.size() == 0 ? validation::metrics_of(result_.held_out)
                             : validation::metrics_of(legs_->moved(moved));
  }

  [[nodiscard]] HeldOutMetrics predicted(const Tested& one) const {
    return predicted(moves(one, one.score.coefficients));
  }

  [[nodiscard]] HeldOutMetrics predicted_with_missing() const {
    Eigen::VectorXd moved;
    for (const MissingEffect& one : search_.missing()) {
      const Eigen::VectorXd own = moves(search_.tested()[one.tested], one.joint.coefficients);
      if (own.size() == 0) continue;
      moved = moved.size() == 0 ? own : Eigen::VectorXd(moved + own);
    }
    return predicted(moved);
  }

  /// Relative rise of the arrival error over `floor` that a shape's minimal detectable size makes;
  /// the most of any shape.
  [[nodiscard]] static double detectable_rise(const Tested& one, double floor) {
    double most = 0.0;
    for (Eigen::Index k = 0; k < one.slopes.cols(); ++k) {
      const double size = one.score.minimal_detectable[static_cast<std::size_t>(k)];
      if (!std::isfinite(size)) return size;
      double squares = 0.0;
      const Eigen::Index legs = one.slopes.rows() / 6;
      for (Eigen::Index leg = 0; leg < legs; ++leg) {
        squares += one.slopes.col(k).segment<2>(6 * leg).squaredNorm();
      }
      const double moved =
          size * std::sqrt(squares / static_cast<double>(std::max<Eigen::Index>(1, legs)));
      most = std::max(most, std::hypot(1.0, moved / floor) - 1.0);
    }
    return one.slopes.cols() > 0 ? most : std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] bool changes_nothing(const Tested& one, const HeldOutMetrics& with_it,
                                     double floor) const {
    return legs_->has_slopes() && !result_.held_out.legs.empty() && fit_.p_value > kFitsAnyway &&
           with_it.arrival_rms > (1.0 - kNegligible) * result_.held_out.arrival_rms &&
           detectable_rise(one, floor) < kNegligible;
  }

  [[nodiscard]] Status status_of(std::size_t k, const HeldOutMetrics& with_it, double floor) const {
    const Tested& one = search_.tested()[k];
    if (rank(k) < search_.missing().size()) {
      return changes_nothing(one, with_it, floor) ? Status::negligible : Status::missing;
    }
    if (one.score.dof == 0) return Status::cannot_tell;
    if (const auto status = status_beside(one.candidate.effect, look_alikes_)) return *status;
    return detectable_rise(one, floor) <= kPractical ? Status::absent : Status::cannot_tell;
  }

  /// Among the missing; their number where it is none of them.
  [[nodiscard]] std::size_t rank(std::size_t k) const {
    const std::vector<MissingEffect>& missing = search_.missing();
    const auto found = std::find_if(missing.begin(), missing.end(),
                                    [k](const MissingEffect& one) { return one.tested == k; });
    return static_cast<std::size_t>(found - missing.begin());
  }

  /// What is missing, then by evidence.
  [[nodiscard]] std::vector<std::size_t> order() const {
    const std::vector<Tested>& tested = search_.tested();
    std::vector<std::size_t> order(tested.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      if (rank(a) != rank(b)) return rank(a) < rank(b);
      return plausible_evidence(tested[a]) > plausible_evidence(tested[b]);
    });
    return order;
  }

  void report_findings() {
    const std::vector<Tested>& tested = search_.tested();
    result_.with_missing = predicted_with_missing();
    const double floor = search_.missing().empty()
                             ? result_.held_out.arrival_rms
                             : predicted(tested[search_.missing().front().tested]).arrival_rms;
    for (const std::size_t k : order()) {
      const Tested& one = tested[k];
      if (one.score.dof > 0) {
        result_.findings.push_back(finding(k, floor));
        candidates_.push_back(one.candidate);
        candidates_.back().effect = result_.findings.back().effect;
      } else if (one.candidate.form == Form::catalogue && !hidden_by_misfit(one) &&
                 !tests_.is_present(one.candidate.effect)) {
        result_.unobservable.push_back(why_unobservable(one, state_.problem));
      }
    }
  }

  [[nodiscard]] Finding finding(std::size_t k, double floor) const {
    const Tested& one = search_.tested()[k];
    Finding finding;
    finding.effect = one.candidate.effect;
    finding.effect.coefficients = one.score.coefficients;
    finding.catalogue = one.candidate.form == Form::catalogue;
    finding.score = one.score.score;
    finding.dof = one.score.dof;
    finding.p_value = one.p_value;
    finding.p_adjusted = one.p_adjusted;
    finding.evidence = one.evidence;
    finding.sd = one.score.sd;
    finding.minimal_detectable = one.score.minimal_detectable;
    finding.tried = one.tried;
    finding.held_out = predicted(one);
    finding.status = status_of(k, finding.held_out, floor);
    finding.implausible = one.score.dof > 0 && is_implausible(one);
    if (rank(k) < search_.missing().size()) {
      finding.look_alikes = look_alikes_[rank(k)];
      finding.joint = search_.missing()[rank(k)].joint.coefficients;
      finding.joint_sd = search_.missing()[rank(k)].joint.sd;
      Tested beside_the_others = one;
      beside_the_others.score.coefficients = finding.joint;
      finding.implausible = is_implausible(beside_the_others);
      finding.only_together = search_.only_together();
      finding.sd_inflation = widening_of(k);
      for (std::size_t c = 0; c < finding.sd_inflation.size(); ++c) {
        finding.sd[c] *= finding.sd_inflation[c];
        finding.joint_sd[c] *= finding.sd_inflation[c];
      }
    }
    return finding;
  }

  /// Of one that is missing, beside the others.
  [[nodiscard]] std::vector<double> widening_of(std::size_t k) const {
    const Tested& one = search_.tested()[k];
    if (one.candidate.parameters.empty()) return {};
    Eigen::MatrixXd others = tests_.present();
    for (const MissingEffect& other : search_.missing()) {
      if (other.tested == k) continue;
      linalg::append_columns(
          others,
          tests_.free_of_map(tests_.columns(search_.tested()[other.tested].candidate.effect)));
    }
    return widening(tests_, one.candidate, search_.missing()[rank(k)].joint.coefficients, others);
  }

  void find_verdict() {
    result_.p_value = fit_.p_value;
    if (!search_.missing().empty()) {
      const Finding& first = result_.findings.front();
      result_.verdict = Diagnosis::Verdict::missing;
      result_.missing = first.effect.name;
      result_.p_value = first.p_adjusted;
      if (const LookAlike* rival = closest_rival(first.look_alikes)) {
        result_.next_drive = {first.effect, rival->effect,
                              drive::slow_covariates(state_.recordings)};
      }
      return;
    }
    result_.objection = misfit_of(fit_.p_value, find_trends(state_, tests_), options_.level);
    if (result_.objection != Objection::none) {
      result_.verdict = Diagnosis::Verdict::unexplained_misfit;
    }
  }

  const std::vector<DrivenRecording>& recordings_;
  const ModelFit& fit_;
  const fitting::FitState& state_;
  const DiagnoseOptions& options_;
  /// Before the tests: the largest of what is needed only for a while.
  std::shared_ptr<const validation::HeldOutLegs> legs_;
  ScoreTest tests_;
  EffectSearch search_;
  std::vector<std::vector<LookAlike>> look_alikes_;  ///< of each that is missing
  Diagnosis result_;
  std::vector<Candidate> candidates_;
};

}  // namespace

namespace {

/// Without coefficients.
std::vector<Candidate> candidates_found(const DiagnosisRun& run) {
  std::vector<Candidate> found;
  for (std::size_t k = 0; k < run.candidates.size(); ++k) {
    if (run.result.findings[k].joint.empty()) continue;  // not missing
    found.push_back(run.candidates[k]);
    found.back().effect.coefficients.clear();
  }
  return found;
}

/// About a fit that may be believed.
DiagnosisRun diagnosis_about(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                             const Noise& stated, const DiagnoseOptions& options,
                             const KnownLegs& known) {
  auto under = std::make_shared<const FitWithNoise>(
      options.estimate_noise ? with_noise_beside(recordings, fit, stated) : FitWithNoise{fit, {}});
  DiagnosisRun run;
  std::vector<Candidate> found;
  std::vector<Effect> missing;
  std::optional<ModelFit> with;  // what is missing, where it can be fitted
  const auto judge = [&] {
    run = Diagnostician(recordings, under->fit, options, known).run();
    found = candidates_found(run);
    missing.clear();
    for (const Candidate& one : found) missing.push_back(one.effect);
    with.reset();
    if (!missing.empty()) with = if_fitted_with(recordings, under->fit, missing);
  };
  const auto judge_by = [&](FitWithNoise other) {
    under = std::make_shared<const FitWithNoise>(std::move(other));
    judge();
  };
  judge();
  if (options.estimate_noise && !missing.empty()) {
    if (auto beside = with_noise_beside_found(recordings, *under, with, found, stated)) {
      judge_by(std::move(*beside));
    }
  }
  if (options.estimate_noise && !missing.empty()) {
    const bool as_stated = under->fit.model.noise == stated && under->fit.p_value > kFitsAnyway;
    Defended defended = defended_against_noise(
        recordings, *under, with, missing,
        {stated, static_cast<double>(run.result.tried), options.level, as_stated});
    if (defended.otherwise) judge_by(std::move(*defended.otherwise));
  }
  const ScoreTest about(with ? *with->state : *under->fit.state);
  explain(run.result, run.searched, under->fit, with, about);
  if (missing.empty() || with) {
    tell_changes(fit, under->fit, with, about, run.result);
    tell_places(recordings, fit, under->fit, with, about, run.result);
  }
  const Noise& asked_of = options.estimate_noise ? stated : fit.model.noise;
  fitting::FitAnswers answers;
  bool answered = under->noise.changed();  // the noise is not the model's any more
  if (!missing.empty()) {
    RemainingErrors rest = remaining_errors(recordings, under->fit, with, about, asked_of, missing);
    run.result.events = std::move(rest.events);
    run.result.noise = std::move(rest.noise);
    if (rest.fitted) answers.left_out_with_missing = rest.left_out;
    answered = answered || (rest.fitted && rest.p_value > kExplains);
  } else if (under->noise.changed()) {
    run.result.noise = noise_beyond(recordings, under->fit, stated);
  }
  // What is missing says why the errors are too large.
  answers.misfit = answered && run.result.verdict == Diagnosis::Verdict::missing;
  run.result.warnings = fitting::fit_warnings(*under->fit.state, answers);
  if (options.estimate_noise) {
    object_to_noise(under->noise, run.result);
    run.result.under = std::move(under);
  }
  return run;
}

}  // namespace

}  // namespace trussmap

namespace trussmap::criticism {

DiagnosisRun run_diagnosis(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                           const Noise& stated, const DiagnoseOptions& options,
                           const KnownLegs& known) {
  if (std::optional<GrossConstants> gross = gross_constants(recordings, fit, options.legs)) {
    DiagnosisRun run = diagnosis_about(recordings, gross->fit, stated, options, {});
    put_constants_first(recordings, fit, *std::move(gross), options, run);
    return run;
  }
  return diagnosis_about(recordings, fit, stated, options, known);
}

}  // namespace trussmap::criticism

namespace trussmap {

Diagnosis diagnose(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                   const DiagnoseOptions& options) {
  return run_diagnosis(recordings, fit, fit.model.noise, options).result;
}

Diagnosis diagnose(const std::vector<DrivenRecording>& recordings, const Model& model,
                   const DiagnoseOptions& options) {
  return diagnose(recordings, fit_model(recordings, model, options.fit), options);
}

}  // namespace trussmap
