// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/candidates.hpp"
#include "criticism/comparison.hpp"
#include "criticism/effect_evidence.hpp"
#include "criticism/judged_rows.hpp"
#include "criticism/look_alikes.hpp"
#include "criticism/score_test.hpp"
#include "fit/fit_state.hpp"
#include "recording/variable_names.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/workbench.hpp"
#include "validation/held_out_legs.hpp"
#include "workbench/tried_legs.hpp"

#include <algorithm>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace trussmap {
namespace {

/// Metrics of the held-out legs with an effect as its score has it.
std::optional<HeldOutMetrics> predicted_by(const validation::HeldOutLegs& legs,
                                           const Effect& effect, const criticism::Score& score) {
  if (score.dof == 0 || !legs.has_slopes()) return std::nullopt;
  const Eigen::VectorXd moved =
      legs.slopes(effect, score.columns, score.landmarks) *
      Eigen::Map<const Eigen::VectorXd>(score.coefficients.data(),
                                        static_cast<Eigen::Index>(score.coefficients.size()));
  return legs.moved(moved);
}

ModelFit judged_fit(const Diagnosis& diagnosis, const ModelFit& fit) {
  return diagnosis.under ? diagnosis.under->fit : fit;
}

std::string unit_of_parameter(const criticism::Candidate& candidate, std::size_t k) {
  const std::string& name = candidate.parameters[k].name;
  if (candidate.form == criticism::Form::catalogue) {
    for (const OpenParameter& one : find_entry(candidate.effect.name)->parameters) {
      if (one.name == name) return std::string(one.unit);
    }
  }
  if (name == "x" || name == "y" || name == "r") return "m";
  return std::string(recording::unit_of_variable(candidate.variable));
}

void say(const std::function<void(TryingStage)>& progress, TryingStage stage) {
  if (progress) progress(stage);
}

}  // namespace

struct TriedModel::Tried {
  Tried(std::shared_ptr<const std::vector<DrivenRecording>> recordings_given, const Model& model,
        const DiagnoseOptions& how, const std::function<void(TryingStage)>& progress)
      : recordings(std::move(recordings_given)), options(how) {
    say(progress, TryingStage::fitting);
    const ModelFit first = fit_model(*recordings, model, options.fit);
    say(progress, TryingStage::searching);
    run = criticism::run_diagnosis(*recordings, first, model.noise, options);
    look_at(first, progress);
  }

  Tried(PreparedRecordings rows, const Model& model, const DiagnoseOptions& how,
        const std::function<void(TryingStage)>& progress)
      : options(how) {
    say(progress, TryingStage::fitting);
    ModelFit first = fit_model(rows.recordings, model, options.fit);
    say(progress, TryingStage::searching);
    criticism::JudgedRun judged =
        criticism::judged_run(std::move(rows), std::move(first), model.noise, options);
    run = std::move(judged.run);
    recordings =
        std::make_shared<const std::vector<DrivenRecording>>(std::move(judged.rows.recordings));
    look_at(judged.fit, progress);
  }

  void look_at(const ModelFit& first, const std::function<void(TryingStage)>& progress) {
    fit = judged_fit(run.result, first);
    say(progress, TryingStage::comparing);
    tests.emplace(*fit.state);
    legs.emplace(*recordings, fit, options.legs);
    comparison = criticism::compare(*recordings, fit, {options.fit, options.legs, options.level},
                                    *tests, {run.result.missing, legs->metrics()});
    comparison.sightings = run.result.sightings;
    sizes = criticism::sizes_of(run.result, tests->context());
    map = fitted_map(fit);
    budget = noise_budget(*recordings, fit.model);
    all_legs = workbench::tried_legs(*recordings, *fit.state, options.legs);
    spans = validation::leg_spans(*fit.state, options.legs);
  }

  [[nodiscard]] const criticism::Candidate& candidate(std::size_t finding) const {
    return run.candidates.at(finding);
  }

  std::shared_ptr<const std::vector<DrivenRecording>> recordings;
  DiagnoseOptions options;
  criticism::DiagnosisRun run;
  ModelFit fit;
  Comparison comparison;
  std::vector<FindingSize> sizes;
  FittedMap map;
  std::vector<NoiseBudget> budget;
  std::vector<TriedLeg> all_legs;
  std::vector<validation::LegSpan> spans;  ///< of those that the fit has
  // Score tests keep what they make.
  mutable std::mutex mutex;
  std::optional<criticism::ScoreTest> tests;
  std::optional<validation::HeldOutLegs> legs;
};

TriedModel::TriedModel(std::shared_ptr<const std::vector<DrivenRecording>> recordings,
                       const Model& model, const DiagnoseOptions& options,
                       const std::function<void(TryingStage)>& progress)
    : tried_(std::make_shared<const Tried>(std::move(recordings), model, options, progress)) {}

TriedModel::TriedModel(PreparedRecordings rows, const Model& model, const DiagnoseOptions& options,
                       const std::function<void(TryingStage)>& progress)
    : tried_(std::make_shared<const Tried>(std::move(rows), model, options, progress)) {}

const std::vector<DrivenRecording>& TriedModel::recordings() const {
  return *tried_->recordings;
}
const DiagnoseOptions& TriedModel::options() const {
  return tried_->options;
}
const ModelFit& TriedModel::fit() const {
  return tried_->fit;
}
const Diagnosis& TriedModel::diagnosis() const {
  return tried_->run.result;
}
const std::vector<FindingSize>& TriedModel::sizes() const {
  return tried_->sizes;
}
const Comparison& TriedModel::comparison() const {
  return tried_->comparison;
}
const FittedMap& TriedModel::map() const {
  return tried_->map;
}
const std::vector<NoiseBudget>& TriedModel::budget() const {
  return tried_->budget;
}
const std::vector<TriedLeg>& TriedModel::legs() const {
  return tried_->all_legs;
}

std::vector<EffectParameter> TriedModel::parameters(std::size_t finding) const {
  const criticism::Candidate& candidate = tried_->candidate(finding);
  std::vector<EffectParameter> result;
  for (std::size_t k = 0; k < candidate.parameters.size(); ++k) {
    const criticism::SearchRange& range = candidate.search[k];
    result.push_back({candidate.parameters[k], range.step, range.least, range.most,
                      unit_of_parameter(candidate, k)});
  }
  return result;
}

Effect TriedModel::moved(std::size_t finding, const std::vector<double>& values) const {
  const criticism::Candidate& candidate = tried_->candidate(finding);
  if (values.size() != candidate.parameters.size()) {
    throw std::invalid_argument("effect \"" + candidate.effect.name + "\" has " +
                                std::to_string(candidate.parameters.size()) +
                                " values that can be moved, not " + std::to_string(values.size()));
  }
  Effect effect = criticism::with_parameters(candidate, values).effect;
  effect.coefficients.clear();
  return effect;
}

std::vector<double> TriedModel::best_near(std::size_t finding, const std::vector<double>& values,
                                          std::optional<std::size_t> only) const {
  static_cast<void>(moved(finding, values));
  criticism::Candidate candidate = tried_->candidate(finding);
  for (std::size_t k = 0; only && k < candidate.search.size(); ++k) {
    if (k != *only) candidate.search[k].least = candidate.search[k].most = values[k];
  }
  const std::scoped_lock lock(tried_->mutex);
  const criticism::Candidate best =
      criticism::refined(*tried_->tests, criticism::with_parameters(candidate, values));
  std::vector<double> result;
  for (const ShapeParameter& one : best.parameters) result.push_back(one.value);
  return result;
}

EffectPreview TriedModel::preview(const Effect& effect, const std::vector<Effect>& rivals,
                                  const std::vector<std::size_t>& legs) const {
  const fitting::FitState& fit = *tried_->fit.state;
  const std::scoped_lock lock(tried_->mutex);
  std::vector<Effect> asked{effect};
  asked.insert(asked.end(), rivals.begin(), rivals.end());
  const std::vector<criticism::Score> scores = tried_->tests->test(asked);
  EffectPreview result;
  const criticism::Score& score = scores.front();
  result.score = score.score;
  result.dof = score.dof;
  result.p_value = score.p_value;
  for (std::size_t k = 0; k < asked.size(); ++k) asked[k].coefficients = scores[k].coefficients;
  result.predicted = predicted_by(*tried_->legs, asked.front(), score);
  for (std::size_t k = 1; k < scores.size(); ++k) {
    result.rivals_predicted.push_back(predicted_by(*tried_->legs, asked[k], scores[k]));
  }
  if (!rivals.empty()) {
    criticism::ScoreTest beside = *tried_->tests;  // what else is missing, as the diagnosis has it
    for (const Finding* one : found_by(tried_->run.result)) {
      const auto same = [one](const Effect& other) { return other.name == one->effect.name; };
      if (std::none_of(asked.begin(), asked.end(), same)) {
        beside.condition_on(beside.columns(one->effect));
      }
    }
    result.rivals_behind = criticism::chi2_behind(effect, rivals, beside, tried_->fit.dof);
  }
  const EffectEstimate estimate{asked.front(), score.sd, {}};
  result.evidence = criticism::seen_effect(
      estimate, {asked.begin() + 1, asked.end()}, fit, *tried_->tests,
      workbench::rows_of_legs(legs, tried_->spans, fit, tried_->tests->system()));
  return result;
}

double p_with_noise(const Diagnosis& diagnosis, std::size_t finding, double factor) {
  const Finding& one = diagnosis.findings.at(finding);
  if (one.dof == 0) return 1.0;
  const int dof = std::max(1, diagnosis.dof - one.dof);
  const double left = std::max(0.0, diagnosis.chi2 - one.score) / dof;
  const double noise = std::max({1.0, factor * factor, left});
  const double p = statistics::chi2_p_value(one.score / noise, one.dof);
  // Never surer than the diagnosis, which knows of more than this.
  return std::clamp(p * static_cast<double>(diagnosis.tried), one.p_adjusted, 1.0);
}

EffectEvidence TriedModel::shown(std::size_t effect, const std::vector<std::size_t>& legs) const {
  const fitting::FitState& fit = *tried_->fit.state;
  const EffectEstimate& estimate = tried_->fit.effects.at(effect);
  const std::scoped_lock lock(tried_->mutex);
  const criticism::ScoreTest tests = tried_->tests->lacking(effect, {estimate.effect});
  return criticism::seen_effect(estimate, {}, fit, tests,
                                workbench::rows_of_legs(legs, tried_->spans, fit, tests.system()));
}

}  // namespace trussmap
