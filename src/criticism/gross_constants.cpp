// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/gross_constants.hpp"

#include "calibration/measured_distance.hpp"
#include "criticism/calibrated_start.hpp"
#include "criticism/candidates.hpp"
#include "criticism/effect_strength.hpp"
#include "criticism/fewest_constants.hpp"
#include "criticism/gross_cause.hpp"
#include "criticism/look_alikes.hpp"
#include "criticism/refits.hpp"
#include "criticism/small_causes.hpp"
#include "criticism/tested_candidate.hpp"
#include "drive/steered_motion.hpp"
#include "fit/fit_state.hpp"
#include "odometry/wheels_and_gyro.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/error.hpp"
#include "trussmap/held_out.hpp"
#include "validation/held_out_legs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trussmap::criticism {
namespace {

constexpr double kMisfit = 1e-6;   // p of chi^2, below which they are asked for
constexpr double kMostLeft = 0.5;  // of chi^2/dof, beside them

/// Without a measured distance a smaller map has smaller errors.
bool is_scale(Channel channel) {
  return channel == Channel::travel || channel == Channel::sideways;
}

/// Those that the recordings can have, and the model lacks; without coefficients.
std::vector<Effect> constants_for(const std::vector<DrivenRecording>& recordings,
                                  const ModelFit& given) {
  const fitting::FitState& fit = *given.state;
  const estimation::ProblemOptions used = fitting::fitter_options(given.options).problem;
  const Noise& noise = given.model.noise;
  const bool scale = calibration::measures_distance(recordings, used, noise);
  // Beside a scale of the travel one of ranges would leave the map without any.
  const bool ranges_alone =
      scale && !calibration::measures_distance_without_ranges(recordings, used, noise);
  const bool gyro = odometry::has_gyro(fit.recordings);
  std::vector<Effect> result;
  const fitting::ShapeContext context(fit.recordings, fit.model.robot, fit.paths);
  for (const Candidate& one : candidates_for(fit, context)) {
    const effects::CatalogueRecord* record = record_of(one);
    const Channel channel = one.effect.channel;
    if (record == nullptr || !record->robot_constant) continue;
    if (!scale && is_scale(channel)) continue;
    if (ranges_alone && channel == Channel::range_scale) continue;
    if (effects::is_delay(channel)) continue;         // these need a fit that is near already
    if (gyro && channel == Channel::drift) continue;  // its bias is what drifts
    const bool there = std::any_of(
        fit.model.effects.begin(), fit.model.effects.end(), [&one](const Effect& other) {
          return other.channel == one.effect.channel && other.shape == one.effect.shape;
        });
    if (!there) result.push_back(one.effect);
  }
  return result;
}

std::optional<ModelFit> better_of(std::optional<ModelFit> one, std::optional<ModelFit> other) {
  if (!one || (other && chi2_of_all(*other) < chi2_of_all(*one))) return other;
  return one;
}

bool is_far_off(const ModelFit& fit) {
  return fit.chi2 > kGrossMisfit * std::max(1, fit.dof);
}

bool is_far_off(const std::optional<ModelFit>& fit) {
  return !fit || is_far_off(*fit);
}

/// From a start of its own.
std::optional<ModelFit> fitted_afresh(const std::vector<DrivenRecording>& recordings,
                                      const ModelFit& given, const std::vector<Effect>& constants) {
  Model model = given.model;
  model.effects.insert(model.effects.end(), constants.begin(), constants.end());
  return if_possible<ModelFit>([&] { return fit_model(recordings, model, given.options); });
}

/// All of them at once. `start` is made where it is wanted, once.
std::optional<ModelFit> with_all(const std::vector<DrivenRecording>& recordings,
                                 const ModelFit& given, const std::vector<Effect>& constants,
                                 std::optional<CalibratedStart>& start) {
  std::optional<ModelFit> best;
  if (is_far_off(given)) {
    if (!start) start = start_of_constants(recordings, given, constants);
    // About a fit that has a sensor metres off no other fit can begin.
    if (start->far_places) best = fitted_afresh(recordings, given, start->constants);
    if (!is_far_off(best)) return best;
  }
  best = better_of(std::move(best),
                   if_possible<ModelFit>([&] { return refit_with(recordings, given, constants); }));
  if (!is_far_off(best)) return best;
  if (!start) start = start_of_constants(recordings, given, constants);
  if (start->found && !start->gross) return best;
  best = better_of(std::move(best), fitted_afresh(recordings, given, start->constants));
  for (const std::vector<Effect>& likely : start->likely) {
    if (!is_far_off(best)) break;
    best = better_of(std::move(best), fitted_afresh(recordings, given, likely));
  }
  return best;
}

bool is_fitted(const ModelFit& fit, std::size_t effect) {
  return fit.effects[effect].not_fitted.empty();
}

std::optional<ModelFit> without(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                                std::size_t place) {
  std::vector<Effect> effects = fit.model.effects;
  effects.erase(effects.begin() + static_cast<std::ptrdiff_t>(place));
  return refit_by(recordings, fit, std::move(effects));
}

/// How surely it is there by its standard error: 0 where it was not fitted.
double strength_of(const ModelFit& fit, std::size_t place) {
  return is_fitted(fit, place) ? wald(fit, place) / scatter_left(fit) : 0.0;
}

/// Without those that are weak by their standard errors, the weakest first.
std::optional<ModelFit> strong_ones(const std::vector<DrivenRecording>& recordings, ModelFit fit,
                                    std::size_t first) {
  while (fit.model.effects.size() > first) {
    std::size_t weakest = first;
    for (std::size_t k = first; k < fit.model.effects.size(); ++k) {
      if (strength_of(fit, k) < strength_of(fit, weakest)) weakest = k;
    }
    if (strength_of(fit, weakest) >= kWorthKeeping) break;
    std::optional<ModelFit> next = without(recordings, fit, weakest);
    if (!next) return std::nullopt;
    fit = *std::move(next);
  }
  return fit;
}

/// Without those that a fit without them does hardly worse than: a standard error is of the plane
/// about the fit. Without what is gross a fit would be lost.
ModelFit sure_ones(const std::vector<DrivenRecording>& recordings, ModelFit fit,
                   std::size_t first) {
  for (std::size_t k = fit.model.effects.size(); k-- > first;) {
    if (is_gross(fit.model.effects[k])) continue;
    std::optional<ModelFit> next = without(recordings, fit, k);
    if (!next || !does_as_well(*next, fit)) continue;
    fit = *std::move(next);
  }
  return fit;
}

ModelFit surest_first(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                      std::size_t first) {
  std::vector<std::pair<double, Effect>> rated;
  for (std::size_t k = first; k < fit.model.effects.size(); ++k) {
    rated.emplace_back(strength_of(fit, k), fit.model.effects[k]);
  }
  std::stable_sort(rated.begin(), rated.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Effect> effects(fit.model.effects.begin(),
                              fit.model.effects.begin() + static_cast<std::ptrdiff_t>(first));
  for (auto& [strength, effect] : rated) effects.push_back(std::move(effect));
  return refit_by(recordings, fit, std::move(effects)).value_or(fit);
}

/// Gross, or all that so few measurements can tell of.
bool matters(const ModelFit& fit, std::size_t first) {
  constexpr int kFew = 10;        // dof
  constexpr double kFits = 0.05;  // p
  if (fit.model.effects.size() == first) return false;
  if (fit.dof < kFew && fit.p_value > kFits) return true;
  return std::any_of(fit.model.effects.begin() + static_cast<std::ptrdiff_t>(first),
                     fit.model.effects.end(), [](const Effect& one) { return is_gross(one); });
}

double per_dof(const ModelFit& fit) {
  return chi2_of_all(fit) / std::max(1, fit.dof);
}

bool explains_much(const ModelFit& with, const ModelFit& given) {
  return per_dof(with) <= kMostLeft * per_dof(given);
}

/// Those of a fit with all of them that the recordings surely show, where they matter.
std::optional<ModelFit> those_that_matter(const std::vector<DrivenRecording>& recordings,
                                          const ModelFit& given, const ModelFit& all) {
  const std::size_t first = given.model.effects.size();
  // With fewer it explains no more.
  if (!matters(all, first) || !explains_much(all, given)) return std::nullopt;
  const std::optional<ModelFit> strong = strong_ones(recordings, all, first);
  if (!strong) return std::nullopt;
  ModelFit sure = sure_ones(recordings, *strong, first);
  if (!matters(sure, first)) return std::nullopt;
  return sure;
}

/// Where nothing tells ahead from back, a robot that backs fits as well as one that goes ahead: it
/// goes ahead. Fitted from a start of its own, for all of the map is turned.
std::optional<ModelFit> going_ahead(const std::vector<DrivenRecording>& recordings,
                                    const ModelFit& given, const ModelFit& found) {
  const std::size_t first = given.model.effects.size();
  std::vector<Effect> constants(found.model.effects.begin() + static_cast<std::ptrdiff_t>(first),
                                found.model.effects.end());
  const auto backs = std::find_if(constants.begin(), constants.end(), [](const Effect& one) {
    return one.channel == Channel::travel && 1.0 + one.coefficients.front() < 0.0;
  });
  if (backs == constants.end()) return std::nullopt;
  double& g = backs->coefficients.front();
  g = -(1.0 + g) - 1.0;
  const std::optional<ModelFit> ahead = fitted_afresh(recordings, given, constants);
  if (!ahead || !does_as_well(*ahead, found)) return std::nullopt;
  return those_that_matter(recordings, given, *ahead);
}

/// Far from the right constants the gate takes right measurements for wrong ones: here it only
/// looks at what comes of them all.
std::optional<ModelFit> those_without_gate(const std::vector<DrivenRecording>& recordings,
                                           const ModelFit& given,
                                           const std::vector<Effect>& constants,
                                           std::optional<CalibratedStart>& start) {
  ModelFit open = given;
  open.options.gate.reset();
  const std::optional<ModelFit> all = with_all(recordings, open, constants, start);
  if (!all) return std::nullopt;
  std::optional<ModelFit> found = those_that_matter(recordings, open, *all);
  if (!found) return std::nullopt;
  found->options = given.options;
  return if_possible<ModelFit>([&] { return fitting::refit(recordings, found->model, *found); });
}

/// Of legs that no fit has seen.
bool predicts_worse(const std::vector<DrivenRecording>& recordings, const ModelFit& given,
                    const ModelFit& found, const LegOptions& legs) {
  constexpr double kNoWorse = 1.05;
  const auto arrival = [&](const ModelFit& fit) {
    return if_possible<double>([&] { return predict_held_out(recordings, fit, legs).arrival_rms; });
  };
  const std::optional<double> before = arrival(given);
  const std::optional<double> after = arrival(found);
  return before && *before > 0.0 && (!after || *after > kNoWorse * *before);
}

/// Beside each wheel by itself the ratio and the scale of both are the same in other words.
bool says_the_same(const Effect& one, const std::vector<Effect>& fitted) {
  using enum Channel;
  const auto has = [&fitted](Channel channel) {
    return std::any_of(fitted.begin(), fitted.end(), [channel](const Effect& other) {
      return other.channel == channel && other.is_constant();
    });
  };
  const Channel of = one.channel;
  const bool of_wheels = of == wheels || of == difference || of == left || of == right;
  return of_wheels && one.is_constant() && has(left) && has(right);
}

/// What else could leave its trace, at a fit that has it.
std::vector<LookAlike> look_alikes_at(const std::vector<DrivenRecording>& recordings,
                                      const ModelFit& fit, const ScoreTest& at_fit,
                                      std::size_t place) {
  const fitting::FitState& state = *fit.state;
  const Effect& effect = fit.model.effects[place];
  const ScoreTest tests = at_fit.lacking(place, {effect});
  std::vector<Tested> asked(1);
  asked.front().candidate.effect = effect;
  for (const Candidate& one : candidates_for(state, tests.context())) {
    const bool other = one.effect.name != effect.name && one.family.empty();
    if (!other || tests.is_present(one.effect)) continue;
    if (says_the_same(one.effect, fit.model.effects)) continue;
    asked.emplace_back();
    asked.back().candidate = one;
  }
  std::vector<LookAlike> alike = look_alikes_of(0, asked, {}, tests, state.adjustment.dof);
  weigh_by_fits(alike, effect, tests, [&](const Effect& one) {
    std::vector<Effect> effects = fit.model.effects;
    effects[place] = one;
    return refit_by(recordings, fit, std::move(effects));
  });
  return alike;
}

/// Nothing where there are none, or they do not explain much.
std::optional<GrossConstants> sure_constants(const std::vector<DrivenRecording>& recordings,
                                             const ModelFit& given, const LegOptions& legs) {
  std::vector<Effect> constants = constants_for(recordings, given);
  if (constants.empty()) return std::nullopt;
  const std::size_t first = given.model.effects.size();
  std::optional<CalibratedStart> start;
  if (drive::has_steering(given.model.robot)) {
    start = start_of_constants(recordings, given, constants);
    constants = start->constants;
    for (Effect& one : constants) one.coefficients.clear();
  }
  const std::optional<ModelFit> all = with_all(recordings, given, constants, start);
  std::optional<ModelFit> sure;
  if (all) sure = those_that_matter(recordings, given, *all);
  const bool explained = all && per_dof(*all) < kLittleLeft;  // what the gate left out counted
  if (given.options.gate && !explained && is_far_off(sure)) {
    sure = better_of(std::move(sure), those_without_gate(recordings, given, constants, start));
  }
  if (!sure || !explains_much(*sure, given)) return std::nullopt;
  if (std::optional<ModelFit> ahead = going_ahead(recordings, given, *sure))
    sure = std::move(ahead);
  if (is_far_off(sure) && predicts_worse(recordings, given, *sure, legs)) return std::nullopt;
  return GrossConstants{surest_first(recordings, with_fewest(recordings, *sure, first), first),
                        first};
}

}  // namespace

std::optional<GrossConstants> gross_constants(const std::vector<DrivenRecording>& recordings,
                                              const ModelFit& given, const LegOptions& legs) {
  if (given.p_value > kMisfit) return std::nullopt;
  const ExplainedBy small =
      is_far_off(given) ? explained_by(recordings, given) : ExplainedBy::nothing_small;
  if (small == ExplainedBy::small_ones) return std::nullopt;
  std::optional<GrossConstants> constants = sure_constants(recordings, given, legs);
  if (small == ExplainedBy::few || (constants && per_dof(constants->fit) < kLittleLeft)) {
    return constants;
  }
  const bool scale = calibration::measures_distance(
      recordings, fitting::fitter_options(given.options).problem, given.model.noise);
  if (std::optional<ModelFit> cause = gross_cause(recordings, given, scale)) {
    return GrossConstants{*std::move(cause), given.model.effects.size()};
  }
  return constants;
}

namespace {

/// `most`: the chi^2 that all constants together take away.
Finding finding_at(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                   const ScoreTest& at_fit, std::size_t place, double most) {
  const Effect& effect = fit.model.effects[place];
  Finding result;
  result.effect = effect;
  result.dof = static_cast<int>(effect.shape.size());
  std::optional<ModelFit> lacking;
  if (!is_gross(effect)) lacking = without(recordings, fit, place);
  const double scatter = scatter_left(fit);
  const double score = lacking ? chi2_of_all(*lacking) - chi2_of_all(fit) : wald(fit, place);
  result.score = std::clamp(score, 0.0, most);
  result.p_value = result.p_adjusted = statistics::chi2_p_value(result.score / scatter, result.dof);
  result.evidence = result.score / scatter;
  result.status = Status::missing;
  result.joint = effect.coefficients;
  for (const double sd : fit.effects[place].sd) {
    result.sd.push_back(sd * std::sqrt(scatter));
    result.minimal_detectable.push_back(std::sqrt(kDetectableScore) * result.sd.back());
  }
  result.joint_sd = result.sd;
  result.look_alikes = look_alikes_at(recordings, fit, at_fit, place);
  return result;
}

/// A size that was fitted, beside what is known of its channel. A gross constant is none the less
/// plausible.
bool is_implausible(const ModelFit& given, const Effect& effect) {
  if (effect.is_constant()) return false;
  const ScoreTest tests(*given.state);
  Tested fitted;
  fitted.candidate.effect = effect;
  fitted.score = tests.test({effect}).front();
  fitted.score.coefficients = effect.coefficients;
  return fitted.score.largest.size() == effect.coefficients.size() && is_implausible(fitted);
}

}  // namespace

std::vector<Finding> findings_of(const std::vector<DrivenRecording>& recordings,
                                 const ModelFit& given, const GrossConstants& constants,
                                 const LegOptions& legs) {
  const ModelFit& fit = constants.fit;
  HeldOutMetrics predicted;
  try {
    predicted = validation::metrics_of(predict_held_out(recordings, fit, legs));
  } catch (const SolveError&) {  // what is left without those legs does not tell them
  }
  const double most = std::max(0.0, given.chi2 - fit.chi2);
  const ScoreTest at_fit(*fit.state);
  std::vector<Finding> result;
  for (std::size_t k = constants.first; k < fit.model.effects.size(); ++k) {
    result.push_back(finding_at(recordings, fit, at_fit, k, most));
    result.back().held_out = predicted;
    result.back().implausible = is_implausible(given, result.back().effect);
  }
  return result;
}

}  // namespace trussmap::criticism
