// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/wheel_factors.hpp"
#include "estimation/common_errors.hpp"
#include "estimation/recording_descent.hpp"
#include "fit/fit_stages.hpp"
#include "fit/noise_free.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace trussmap::fitting {
namespace {

EffectColumns columns_of_common(const FitState& fit) {
  EffectColumns columns;
  std::vector<double> values;
  for (std::size_t e = 0; e < fit.model.effects.size(); ++e) {
    const Effect& effect = fit.model.effects[e];
    for (std::size_t k = 0; k < effect.coefficients.size(); ++k) {
      columns.coefficients.push_back({e, k, k, 1.0});
      values.push_back(effect.coefficients[k]);
    }
  }
  columns.border = estimation::common_error_columns(
      fit.recordings, fit.model.robot, Eigen::VectorXd::Map(values.data(), std::ssize(values)));
  return columns;
}

/// The standard deviation of what was known of a coefficient: of a factor that is large, of its
/// own size.
double known_before(const Effect& effect, std::size_t place) {
  const double sd = facts_of(effect.channel).prior_sd;
  const bool factor = effects::is_wheel_factor(effect) && place < effect.coefficients.size();
  return factor ? sd * std::max(1.0, std::abs(1.0 + effect.coefficients[place])) : sd;
}

/// The last of those that the data tell too little of gives way: the others may do without it.
bool hold_the_uncertain(const FitTask& task, const estimation::RecordingSystem& system,
                        Fitting& now) {
  const Eigen::MatrixXd covariance = system.coefficient_covariance();
  const std::vector<int> unknown = estimation::unknown_coefficients(now.fit.columns.border);
  for (std::size_t k = unknown.size(); k-- > 0;) {
    const Coefficient& one = now.fit.columns.coefficients[idx(unknown[k])];
    const Effect& effect = now.fit.model.effects[one.effect];
    const auto at = static_cast<Eigen::Index>(k);
    const double share =
        1.0 / (covariance(at, at) * std::max(system.border().col(at).squaredNorm(), 1e-300));
    const double uncertainty =
        std::sqrt(covariance(at, at)) * one.largest / known_before(effect, one.place);
    if (share >= kLeastShare && uncertainty <= kLargestUncertainty) continue;
    const bool uncertain = uncertainty > kLargestUncertainty;
    hold_coefficient(task, unknown[k], uncertain ? NotFitted::uncertain : NotFitted::faint,
                     uncertainty, now);
    return true;
  }
  return false;
}

}  // namespace

void take_columns(const FitTask& task, Fitting& now) {
  FitState& fit = now.fit;
  const std::vector<Effect>& effects = fit.model.effects;
  if (effects.empty()) return;
  if (now.only_common()) {
    fit.columns = columns_of_common(fit);
    return;
  }
  fit.columns = effect_columns(effects, ShapeContext(fit.recordings, fit.model.robot, fit.paths));
  for (std::size_t k = 0; k < fit.columns.border.size(); ++k) {
    const Coefficient& one = fit.columns.coefficients[k];
    estimation::EffectPattern& column = fit.columns.border[k];
    const bool factor = fit.recordings.front().drive.factors.has_value() &&
                        effects::is_wheel_factor(effects[one.effect]) && !now.is_common(one.effect);
    if (factor || is_laid_out(effects[one.effect].channel)) {
      column.reference = now.laid_out[one.effect].coefficients[one.place];
    }
    if (now.is_common(one.effect)) {
      column.prior_sd = estimation::common_error_sd(effects[one.effect]);
    } else if (!task.options.fit_effects || now.not_fitted[one.effect][one.place]) {
      column.held = coefficient_at(fit, k);
    }
  }
}

Eigen::VectorXd unknown_values(const FitState& fit) {
  std::vector<double> values;
  for (const int k : estimation::unknown_coefficients(fit.columns.border)) {
    values.push_back(coefficient_at(fit, idx(k)));
  }
  return Eigen::VectorXd::Map(values.data(), std::ssize(values));
}

void hold_coefficient(const FitTask& task, int column, NotFitted why, double uncertainty,
                      Fitting& now) {
  const Coefficient& one = now.fit.columns.coefficients[idx(column)];
  now.not_fitted[one.effect][one.place] = UnfittedCoefficient{one.place, why, uncertainty};
  const double value = task.model.effects[one.effect].coefficients[one.place];
  now.fit.model.effects[one.effect].coefficients[one.place] = value;
  now.fit.columns.border[idx(column)].held = value;
}

/// Judged at a state without noise of its own: noise that a smaller map shrinks is no evidence of a
/// scale. The one added last gives way.
bool hold_one(const FitTask& task, Fitting& now) {
  const FitState& fit = now.fit;
  const std::vector<int> free = estimation::unknown_coefficients(fit.columns.border);
  if (free.empty()) return false;
  const NoiseFree clean(fit.recordings, fit.model, fit.problem, fit.columns.border, offsets_of(fit),
                        fit.adjustment.state);
  estimation::RecordingSystem system(clean.problem, clean.border);
  system.linearise(clean.state, unknown_values(fit));
  try {
    system.factorise();
  } catch (const linalg::NotPositiveDefinite& error) {
    if (error.column() >= 0) throw SolveError("the map is too loosely tied together to be solved");
  }
  const std::vector<int> lost = estimation::find_undetermined(system);
  if (lost.empty()) return hold_the_uncertain(task, system, now);
  hold_coefficient(task, free[idx(lost.back())], NotFitted::undetermined, 0.0, now);
  return true;
}

}  // namespace trussmap::fitting
