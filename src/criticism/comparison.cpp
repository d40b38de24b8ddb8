// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/comparison.hpp"

#include "criticism/changing_coefficients.hpp"
#include "criticism/data_lacks.hpp"
#include "criticism/effect_search.hpp"
#include "criticism/misfits.hpp"
#include "criticism/noise_sources.hpp"
#include "criticism/trends.hpp"
#include "criticism/verdict.hpp"

#include <utility>

namespace trussmap {
using namespace criticism;

namespace {

/// Against the dispersion there is: where everything is off, nothing stands out.
std::vector<Outlier> find_outliers(const fitting::FitState& fit,
                                   const std::vector<estimation::CheckedMeasurement>& checked,
                                   double dispersion, double level) {
  std::vector<Outlier> result;
  for (const estimation::OutlierTest& one : estimation::outliers(checked, level, dispersion)) {
    result.push_back(
        {estimation::describe(fit.problem, fit.problem.measurements[idx(one.measurement)]),
         one.statistic, one.checked, one.p_adjusted});
  }
  return result;
}

/// Name of the effect that a diagnosis would name first; empty where it would name none.
std::string missing_effect(const fitting::FitState& fit, const ScoreTest& tests, double level) {
  EffectSearch search(fit, tests, {level, 1}, nullptr);
  search.run();
  if (search.missing().empty()) return {};
  return search.tested()[search.missing().front().tested].candidate.effect.name;
}

}  // namespace

}  // namespace trussmap

namespace trussmap::criticism {

Comparison compare(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                   const CompareOptions& options, const ScoreTest& tests, KnownOfFit known) {
  const fitting::FitState& state = *fit.state;
  Comparison result;
  result.chi2 = fit.chi2;
  result.dof = fit.dof;
  result.coefficients = fit.coefficients;
  result.p_value = fit.p_value;
  result.level = options.level;
  result.landmarks = fit.landmarks.size();
  result.warnings = fit.warnings;
  Misfits misfits = find_misfits(state, tests, options.legs);
  result.legs = misfits.legs.size();
  result.worst = std::move(misfits.legs);
  result.routes = std::move(misfits.routes);
  result.worst_landmarks = std::move(misfits.landmarks);
  result.trends = find_trends(state, tests);
  result.sources = calibrate_sources(state, tests);
  const std::vector<estimation::CheckedMeasurement> checked = estimation::snoop(
      tests.system(), *tests.fitted_rows(), state.problem, state.columns.border, state.adjustment);
  result.residuals = residuals_by_source(state.problem, checked);
  result.outliers = find_outliers(state, checked, tests.dispersion(), options.level);
  result.lacks = lacks_of(recordings, fit.model.robot, fit.options);
  result.held_out =
      known.held_out ? std::move(*known.held_out) : predict_held_out(recordings, fit, options.legs);
  result.objection = misfit_of(result.p_value, result.trends, options.level);
  if (result.objection != Objection::none) return result;
  result.missing = known.missing ? *known.missing : missing_effect(state, tests, options.level);
  if (!result.missing.empty()) {
    result.objection = Objection::effect;
    return result;
  }
  const std::vector<ChangingCoefficient> changing =
      changing_coefficients(state, tests, std::min(kChangeLevel, options.level));
  if (!changing.empty()) {
    result.objection = Objection::change;
    result.changing = changing.front().effect.name;
  }
  return result;
}

}  // namespace trussmap::criticism

namespace trussmap {

Comparison compare(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                   const CompareOptions& options) {
  // Before the tests, so that what either needs for a while is not there at once.
  KnownOfFit known;
  known.held_out = predict_held_out(recordings, fit, options.legs);
  return compare(recordings, fit, options, ScoreTest(*fit.state), std::move(known));
}

Comparison compare(const std::vector<DrivenRecording>& recordings, const Model& model,
                   const CompareOptions& options) {
  FitOptions how = options.fit;
  how.fit_effects = false;
  return compare(recordings, fit_model(recordings, model, how), options);
}

EffectGain gain_of_effects(const std::vector<DrivenRecording>& recordings, const ModelFit& without,
                           const ModelFit& with, const LegOptions& legs) {
  EffectGain gain{without, with, predict_held_out(recordings, without, legs),
                  predict_held_out(recordings, with, legs)};
  std::vector<Effect> effects;
  for (const EffectEstimate& one : with.effects) {
    if (!one.effect.per_session) effects.push_back(one.effect);
  }
  if (!effects.empty()) {
    gain.predicted_decrease = ScoreTest(*without.state).joint_score(effects);
  }
  return gain;
}

}  // namespace trussmap
