// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/evidence.hpp"

#include "criticism/comparison.hpp"
#include "criticism/effect_evidence.hpp"
#include "criticism/response.hpp"
#include "drive/slow_covariates.hpp"
#include "effects/place.hpp"
#include "effects/place_patterns.hpp"
#include "fit/fit_state.hpp"
#include "trussmap/error.hpp"
#include "validation/dead_reckoned_horizons.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace trussmap {
using namespace criticism;

namespace {

constexpr std::size_t kMostRivalsDrawn = 3;

CompareOptions compare_options(const DiagnoseOptions& options) {
  return {options.fit, options.legs, options.level};
}

/// Those of 10 s and more that the recordings have enough windows of.
std::vector<ReckonedError> reckoned_errors(const fitting::FitState& fit) {
  constexpr int kFewestWindows = 10;
  const std::vector<double> horizons{10.0, 30.0, 100.0, 300.0, 1000.0};
  const std::vector<validation::HorizonError> errors = validation::horizon_errors(fit, horizons);
  std::vector<ReckonedError> reckoned;
  for (std::size_t k = 0; k < horizons.size(); ++k) {
    if (errors[k].windows >= kFewestWindows) reckoned.push_back({horizons[k], errors[k].rms});
  }
  return reckoned;
}

ModelEvidence model_evidence(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                             const ScoreTest& tests, const CompareOptions& options,
                             const std::optional<std::string>& known_missing = {}) {
  return {compare(recordings, fit, options, tests, {known_missing, {}}), fitted_map(fit),
          reckoned_errors(*fit.state)};
}

struct Bell {
  Vector2 middle;
  double radius = 1.0;
  double height = 0.0;

  [[nodiscard]] double at(const Vector2& place) const {
    return height * std::exp(-0.5 * (place - middle).squaredNorm() / (radius * radius));
  }
};

/// Of a trend over bells all over the map; empty of any other.
std::vector<Bell> bells_of(const Effect& trend) {
  std::vector<Bell> bells;
  for (std::size_t k = 0; k < trend.shape.size(); ++k) {
    const Shape& shape = trend.shape[k];
    const auto x = shape.parameter("x"), y = shape.parameter("y"), r = shape.parameter("r");
    if (!x || !y || !r) return {};
    bells.push_back({{*x, *y}, *r, trend.coefficients.at(k)});
  }
  return bells;
}

/// A trend over bells is looked at from where their sum is largest; any other as it is.
Effect where_largest(const Effect& trend) {
  constexpr int kAcross = 32;
  const std::vector<Bell> bells = bells_of(trend);
  if (bells.empty()) return trend;
  Vector2 low = bells.front().middle;
  Vector2 high = low;
  for (const Bell& one : bells) {
    low = low.cwiseMin(one.middle);
    high = high.cwiseMax(one.middle);
  }
  Vector2 place = low;
  double most = -1.0;
  for (int i = 0; i <= kAcross; ++i) {
    for (int j = 0; j <= kAcross; ++j) {
      const Vector2 at = low + (high - low).cwiseProduct(Vector2(i, j) / kAcross);
      double g = 0.0;
      for (const Bell& one : bells) g += one.at(at);
      if (std::abs(g) <= most) continue;
      most = std::abs(g);
      place = at;
    }
  }
  const Shape bell(effects::kBellPattern,
                   {{"x", place.x()}, {"y", place.y()}, {"r", bells[0].radius}});
  return {trend.name, trend.channel, {bell}, {}};
}

std::vector<TrendEvidence> trend_evidence(const Comparison& comparison,
                                          const fitting::FitState& fit, const ScoreTest& tests) {
  std::vector<TrendEvidence> evidence;
  std::set<std::string> seen;
  for (const Trend& trend : comparison.trends) {  // strongest first
    const Effect effect = where_largest(trend.effect);
    const std::string variable = effects::place_of(effect) ? kPlace : natural_variable(effect);
    if (variable.empty() || seen.contains(variable)) continue;
    Response response = response_along(variable, effect, fit, tests);
    if (response.bins.empty()) continue;
    seen.insert(variable);
    evidence.push_back({trend, std::move(response)});
  }
  return evidence;
}

/// The first few, with the coefficients that each would have.
std::vector<Effect> drawn_rivals(const std::vector<LookAlike>& rivals, const ScoreTest& tests) {
  std::vector<Effect> drawn;
  for (const LookAlike& one : rivals) {
    if (drawn.size() == kMostRivalsDrawn) break;
    drawn.push_back(one.effect);
  }
  const std::vector<Score> scores = tests.test(drawn);
  for (std::size_t k = 0; k < drawn.size(); ++k) drawn[k].coefficients = scores[k].coefficients;
  return drawn;
}

/// An effect that is looked at, with what looks like it.
struct Seen {
  EffectEstimate estimate;
  std::vector<LookAlike> rivals;
};

/// Place among a model's effects, as fitted.
std::optional<std::size_t> place_among(const std::vector<EffectEstimate>& effects,
                                       const Effect& effect) {
  const auto same = [&effect](const EffectEstimate& one) {
    return one.effect.name == effect.name && one.effect.shape == effect.shape &&
           one.effect.coefficients == effect.coefficients;
  };
  const auto found = std::find_if(effects.begin(), effects.end(), same);
  if (found == effects.end()) return std::nullopt;
  return static_cast<std::size_t>(found - effects.begin());
}

/// Of effects that a fit lacks: by the fit that has them where there is one, else by the one that
/// lacks them; each with the others there.
std::vector<EffectEvidence> effect_evidence(const fitting::FitState& without, const ModelFit* with,
                                            const std::vector<Seen>& effects) {
  std::vector<EffectEvidence> result;
  std::optional<ScoreTest> there;
  if (with != nullptr) there.emplace(*with->state);
  for (const Seen& seen : effects) {
    const auto place =
        with != nullptr ? place_among(with->effects, seen.estimate.effect) : std::nullopt;
    if (place) {
      const ScoreTest tests = there->lacking(*place, {seen.estimate.effect});
      result.push_back(
          seen_effect(seen.estimate, drawn_rivals(seen.rivals, tests), *with->state, tests));
      continue;
    }
    ScoreTest tests(without);
    for (const Seen& other : effects) {
      if (&other != &seen) tests.condition_on(tests.columns(other.estimate.effect));
    }
    result.push_back(seen_effect(seen.estimate, drawn_rivals(seen.rivals, tests), without, tests));
  }
  return result;
}

/// The model with what is missing added and fitted; with the first alone where not all can be.
std::optional<ModelFit> fit_with(const std::vector<const Finding*>& missing,
                                 const std::vector<DrivenRecording>& recordings,
                                 const ModelFit& fit) {
  for (std::size_t count = missing.size(); count > 0; count = count > 1 ? 1 : 0) {
    Model model = fit.model;
    for (std::size_t k = 0; k < count; ++k) model.effects.push_back(missing[k]->effect);
    try {
      return fitting::refit(recordings, model, fit);
    } catch (const SolveError&) {
      continue;
    }
  }
  return std::nullopt;
}

/// What is missing, as it was fitted where it could be.
std::vector<Seen> seen_in(const std::vector<const Finding*>& missing, std::size_t had,
                          const std::optional<ModelFit>& with) {
  std::vector<Seen> seen;
  for (std::size_t k = 0; k < missing.size(); ++k) {
    const std::size_t place = had + k;
    const bool fitted = with && place < with->effects.size();
    EffectEstimate estimate =
        fitted ? with->effects[place] : EffectEstimate{missing[k]->effect, missing[k]->sd, {}};
    for (std::size_t c = 0; fitted && c < missing[k]->sd_inflation.size(); ++c) {
      estimate.sd.at(c) *= missing[k]->sd_inflation[c];
    }
    seen.push_back({std::move(estimate), missing[k]->look_alikes});
  }
  return seen;
}

/// Effects of the model found that the model given does not have.
std::vector<Seen> added_by(const Discovery& discovery) {
  std::vector<Seen> added;
  for (const EffectEstimate& one : discovery.found.effects) {
    // A place or threshold may have been sought anew since the step: then the name has it.
    const auto start = [](const std::string& name) { return name.substr(0, name.find(" (x=")); };
    for (const DiscoveryStep& step : discovery.steps) {
      const auto is_it = [&](const Effect& other) {
        return start(other.name) == start(one.effect.name);
      };
      const bool here = (step.added && is_it(*step.added)) ||
                        std::any_of(step.together.begin(), step.together.end(), is_it);
      if (!here) continue;
      added.push_back({one, step.look_alikes});
      break;
    }
  }
  return added;
}

/// The models between the one given and the one found, fitted anew. Each lacks an effect: that of
/// the next step.
std::vector<ModelEvidence> models_between(const std::vector<DrivenRecording>& recordings,
                                          const Discovery& discovery,
                                          const CompareOptions& options) {
  std::vector<ModelEvidence> models;
  Model model = discovery.given.model;
  for (std::size_t k = 1; k + 1 < discovery.steps.size(); ++k) {
    const DiscoveryStep& step = discovery.steps[k];
    model.effects.insert(model.effects.end(), step.together.begin(), step.together.end());
    model.effects.push_back(*step.added);
    std::erase_if(model.effects, [&step](const Effect& one) {
      return std::find(step.dropped.begin(), step.dropped.end(), one.name) != step.dropped.end();
    });
    const ModelFit fit = fitting::refit(recordings, model, discovery.given);
    models.push_back(model_evidence(recordings, fit, ScoreTest(*fit.state), options,
                                    discovery.steps[k + 1].added->name));
  }
  return models;
}

Eigen::MatrixXd correlation_of(const ModelFit& fit) {
  Eigen::Index count = 0;
  for (const EffectEstimate& one : fit.effects) {
    count += static_cast<Eigen::Index>(one.effect.coefficients.size());
  }
  const Eigen::MatrixXd& covariance = fit.state->adjustment.coefficient_covariance;
  if (count < 2 || covariance.rows() != count) return {};
  const Eigen::ArrayXd sd = covariance.diagonal().array().max(0.0).sqrt();
  const Eigen::ArrayXd scale = (sd > 0.0).select(1.0 / sd, 0.0);
  return scale.matrix().asDiagonal() * covariance * scale.matrix().asDiagonal();
}

}  // namespace

ComparisonEvidence evidence_of(const ModelFit& fit, const Comparison& comparison) {
  return {{comparison, fitted_map(fit), reckoned_errors(*fit.state)},
          trend_evidence(comparison, *fit.state, ScoreTest(*fit.state))};
}

FitEvidence evidence_of(const std::vector<DrivenRecording>& recordings, const EffectGain& gain,
                        const CompareOptions& options) {
  FitEvidence evidence;
  evidence.without =
      model_evidence(recordings, gain.without, ScoreTest(*gain.without.state), options);
  evidence.with = model_evidence(recordings, gain.with, ScoreTest(*gain.with.state), options);
  std::vector<Seen> effects;
  for (const EffectEstimate& one : gain.with.effects) effects.push_back({one, {}});
  evidence.effects = effect_evidence(*gain.without.state, &gain.with, effects);
  evidence.correlation = correlation_of(gain.with);
  return evidence;
}

DiagnosisEvidence evidence_of(const std::vector<DrivenRecording>& recordings, const ModelFit& given,
                              const Diagnosis& diagnosis, const DiagnoseOptions& options) {
  const CompareOptions compared = compare_options(options);
  const ModelFit& fit = diagnosis.under ? diagnosis.under->fit : given;
  const ScoreTest tests(*fit.state);
  DiagnosisEvidence evidence;
  evidence.given = model_evidence(recordings, fit, tests, compared, diagnosis.missing);
  evidence.trends = trend_evidence(evidence.given.comparison, *fit.state, tests);
  evidence.sizes = sizes_of(diagnosis, tests.context());
  if (diagnosis.under && diagnosis.under->noise.changed()) {
    evidence.as_stated = predict_held_out(recordings, given, options.legs);
  }
  const std::vector<const Finding*> missing = found_by(diagnosis);
  const std::optional<ModelFit> with = fit_with(missing, recordings, fit);
  evidence.effects = effect_evidence(*fit.state, with ? &*with : nullptr,
                                     seen_in(missing, fit.effects.size(), with));
  if (with) {
    evidence.with = model_evidence(recordings, *with, ScoreTest(*with->state), compared);
  }
  return evidence;
}

DiscoveryEvidence evidence_of(const std::vector<DrivenRecording>& recordings,
                              const Discovery& discovery, const DiagnoseOptions& options) {
  const CompareOptions compared = compare_options(options);
  const ScoreTest given(*discovery.given.state);
  const ScoreTest found(*discovery.found.state);
  DiscoveryEvidence evidence;
  evidence.given =
      model_evidence(recordings, discovery.given, given, compared, discovery.first.missing);
  evidence.between = models_between(recordings, discovery, compared);
  evidence.found =
      model_evidence(recordings, discovery.found, found, compared, discovery.last.missing);
  const std::vector<Seen> added = added_by(discovery);
  evidence.effects = effect_evidence(*discovery.given.state, &discovery.found, added);
  const std::vector<std::string> slow = drive::slow_covariates(recordings);
  for (const Seen& one : added) {
    evidence.look_alikes.push_back(one.rivals);
    evidence.next_drives.emplace_back();
    if (const LookAlike* rival = closest_rival(one.rivals)) {
      evidence.next_drives.back() = {one.estimate.effect, rival->effect, slow};
    }
  }
  evidence.trends = trend_evidence(evidence.found.comparison, *discovery.found.state, found);
  evidence.sizes = sizes_of(discovery.last, found.context());
  return evidence;
}

}  // namespace trussmap
