// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/common_errors.hpp"
#include "estimation/recording_start.hpp"
#include "estimation/recording_system.hpp"
#include "fit/cleared_recording.hpp"
#include "fit/fit_stages.hpp"

#include <algorithm>

namespace trussmap::fitting {
namespace {

constexpr int kShortStretch = 20;  // poses

/// How a start may be laid down, in the order in which they are tried.
enum class StartKind { common_errors, none_wrong, short_stretches, careful };

bool have_same_nodes(const estimation::RecordingProblem& one,
                     const estimation::RecordingProblem& other) {
  const auto same = [](const estimation::PoseNode& a, const estimation::PoseNode& b) {
    return a.session == b.session && a.t == b.t;
  };
  return one.landmarks == other.landmarks &&
         std::equal(one.poses.begin(), one.poses.end(), other.poses.begin(), other.poses.end(),
                    same);
}

std::vector<DrivenRecording> without_own_effects(const FitTask& task, const FitState& fit) {
  Model own = fit.model;
  own.effects.resize(fit.model.effects.size() - fit.common_errors);
  std::vector<DrivenRecording> result;
  for (ClearedRecording& one : cleared(task.raw, own)) result.push_back(std::move(one.recording));
  return result;
}

void take_common_errors(const Eigen::VectorXd& coefficients, Fitting& now) {
  Eigen::Index next = 0;
  for (std::size_t e = 0; e < now.fit.model.effects.size(); ++e) {
    if (!now.is_common(e)) continue;
    for (double& one : now.fit.model.effects[e].coefficients) one = coefficients[next++];
  }
}

estimation::StartOptions start_options(const FitterOptions& options, StartKind kind) {
  estimation::StartOptions how;
  how.careful = kind == StartKind::careful;
  if (kind == StartKind::short_stretches) how.first_stretch = kShortStretch;
  if (options.gate) how.gate = *options.gate;
  return how;
}

/// Whether the model's own effects were of some size at first.
bool own_are_known(const FitTask& task, const FitState& fit) {
  const std::vector<Effect>& effects = task.model.effects;
  const auto own = static_cast<std::ptrdiff_t>(effects.size() - fit.common_errors);
  return std::any_of(effects.begin(), effects.begin() + own, [](const Effect& effect) {
    return std::any_of(effect.coefficients.begin(), effect.coefficients.end(),
                       [](double one) { return one != 0.0; });
  });
}

/// Along unbroken drives, freed from the model's own effects as far as they are known: the common
/// errors are what is left.
void lay_start(const FitTask& task, StartKind kind, Fitting& now) {
  FitState& fit = now.fit;
  const Robot& robot = fit.model.robot;
  static_cast<void>(estimation::choose_gauge(fit.problem));  // refuses what has no start
  const bool freed = own_are_known(task, fit) || (fit.common_errors > 0 && !now.only_common());
  const bool as_fitted = task.options.problem.left_out.empty() && !freed;
  const std::vector<DrivenRecording> without =
      freed ? without_own_effects(task, fit) : std::vector<DrivenRecording>();
  const std::vector<DrivenRecording>& recordings = freed ? without : fit.recordings;
  estimation::ProblemOptions all = task.options.problem;
  all.left_out.clear();
  const estimation::RecordingProblem problem =
      as_fitted ? fit.problem : estimation::make_problem(recordings, fit.model, all);
  const estimation::EffectParameters common =
      kind == StartKind::none_wrong ? estimation::EffectParameters()
                                    : estimation::common_error_columns(recordings, robot);
  estimation::RecordingStart first =
      estimation::start_of(problem, common, start_options(task.options, kind));
  if (!common.empty()) take_common_errors(first.coefficients, now);
  if (!as_fitted || now.columns_see_paths()) {
    fit.paths = fitted_paths(recordings, robot, problem, {}, {}, first.state);
  }
  fit.adjustment.state =
      as_fitted ? std::move(first.state) : placed(fit, places_in(problem, first.state));
}

/// More sightings contradict the rest than are ever wrong or, where none may go and no compass
/// led the start, the errors are far too large: perhaps the start was lost.
bool start_lost(const FitTask& task, const FitState& fit) {
  if (task.options.near != nullptr) return false;
  if (fit.common_errors > 0 && task.options.most_left_out < 1.0) {
    return fit.adjustment.gate_widened > 1.0;
  }
  const bool led = std::any_of(task.recorded.begin(), task.recorded.end(),
                               [](const DrivenRecording& one) { return one.drive.has_compass(); });
  return !led && is_gross_misfit(fit);
}

/// From one other start. Nothing where it leads nowhere.
std::optional<FitChange> adjusted_from(const FitTask& task, StartKind kind, Fitting& now) {
  const bool known = own_are_known(task, now.fit);
  for (std::size_t e = 0; e < now.fit.model.effects.size(); ++e) {
    std::vector<double>& values = now.fit.model.effects[e].coefficients;
    if (now.is_common(e)) {
      std::fill(values.begin(), values.end(), 0.0);
    } else if (known) {
      values = task.model.effects[e].coefficients;
    }
  }
  if (known && task.options.fit_effects) shorten_steering(task, now.laid_out, now.fit);
  lay_start(task, kind, now);
  take_columns(task, now);
  try {
    return adjust_once(task, nullptr, now);
  } catch (const SolveError&) {
    return std::nullopt;
  }
}

/// From other starts, unless they lead to nothing better than what was adjusted, and so `changed`.
/// Nothing where there is no adjustment then.
std::optional<FitChange> start_again(const FitTask& task, std::optional<FitChange> changed,
                                     Fitting& now) {
  FitState best = now.fit;
  for (const StartKind kind :
       {StartKind::none_wrong, StartKind::short_stretches, StartKind::careful}) {
    const std::optional<FitChange> next = adjusted_from(task, kind, now);
    if (!next) continue;
    const estimation::RecordingAdjustment& one = now.fit.adjustment;
    if (!changed || one.gate_widened < best.adjustment.gate_widened ||
        (one.gate_widened == best.adjustment.gate_widened && one.chi2 < best.adjustment.chi2)) {
      best = now.fit;
    }
    changed = next;
    if (!start_lost(task, now.fit)) break;
    // Without a gate a careful start is like any other.
    if (!task.options.gate && kind == StartKind::short_stretches) break;
  }
  now.fit = std::move(best);
  return changed;
}

}  // namespace

void start_fit(const FitTask& task, Fitting& now) {
  const FitState* near = task.options.near;
  if (near == nullptr) {
    lay_start(task, StartKind::common_errors, now);
    return;
  }
  now.fit.paths = near->paths;
  now.fit.adjustment.state = have_same_nodes(now.fit.problem, near->problem)
                                 ? near->adjustment.state
                                 : placed(now.fit, landmark_places(*near));
}

/// A start may be so far off that the adjustment runs away from it and finds all of it loose:
/// others are tried before that is believed.
FitChange adjust_from_starts(const FitTask& task, Fitting& now) {
  const FitState* near = task.options.near;
  const bool alike =
      near != nullptr && near->problem.measurements.size() == now.fit.problem.measurements.size();
  std::optional<FitChange> changed;
  try {
    changed = adjust_once(task, alike ? &near->adjustment : nullptr, now);
  } catch (const SolveError&) {
    if (near == nullptr) changed = start_again(task, {}, now);
    if (!changed) throw;
    return *changed;
  }
  return start_lost(task, now.fit) ? *start_again(task, changed, now) : *changed;
}

}  // namespace trussmap::fitting
