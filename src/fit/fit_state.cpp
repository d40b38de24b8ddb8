// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/fit_state.hpp"

#include "estimation/common_errors.hpp"
#include "estimation/segment_noise.hpp"
#include "estimation/student_tails.hpp"
#include "fit/fit_stages.hpp"
#include "fit/noise_under_effects.hpp"
#include "odometry/wheels_and_gyro.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace trussmap::fitting {
namespace {

constexpr double kMostDispersion = 4.0;  // chi^2/dof
constexpr int kMisfitRounds = 4;

/// With the common errors that are freed, and every coefficient.
Model resolved(const Model& model, const std::vector<DrivenRecording>& recordings, bool common) {
  Model result = model;
  if (common) {
    for (const Effect& effect : estimation::common_errors(recordings))
      result.effects.push_back(effect);
  }
  for (Effect& effect : result.effects) {
    effect.coefficients = coefficients_of(effect, recordings.size());
  }
  return result;
}

void lay_paths(FitState& fit) {
  fit.paths = fitted_paths(fit.recordings, fit.model.robot, fit.problem, fit.columns.border,
                           offsets_of(fit), fit.adjustment.state);
}

/// The largest change of a measurement's value by it, in standard deviations.
double relinearised(const FitTask& task, Fitting& now) {
  FitState& fit = now.fit;
  // The residuals of a misfit are no estimate of noise, and need not come to rest; but where they
  // are is where the rows have to be linear, or what is missing explains too little of them.
  const bool noise = task.options.relinearise &&
                     (now.round < kMisfitRounds ||
                      fit.adjustment.chi2 < kMostDispersion * std::max(1, fit.adjustment.dof));
  const estimation::EffectParameters& border = fit.columns.border;
  const estimation::RecordingState& state = fit.adjustment.state;
  const Eigen::VectorXd offsets = offsets_of(fit);
  const double tails = estimation::take_tails(fit.problem, border, offsets, state);
  if (!noise) return tails;
  return std::max(tails, estimation::relinearise(fit.problem, fit.recordings, fit.model, border,
                                                 offsets, state));
}

/// m and rad.
double most_moved(const std::vector<SessionPath>& before, const std::vector<SessionPath>& after) {
  double moved = 0.0;
  for (std::size_t s = 0; s < std::min(before.size(), after.size()); ++s) {
    for (std::size_t row = 0; row < before[s].ends.size(); ++row) {
      const Pose& a = before[s].ends[row];
      const Pose& b = after[s].ends[row];
      moved = std::max({moved, (a.position() - b.position()).norm(),
                        std::abs(wrap_angle(a.heading - b.heading))});
    }
  }
  return moved;
}

/// Path and rows as the adjustment has them. Without effects nothing depends on the path but what
/// asks for it afterwards.
FitChange follow(const FitTask& task, Fitting& now) {
  const std::vector<SessionPath> before = std::exchange(now.fit.paths, {});
  if (now.columns_see_paths()) {
    lay_paths(now.fit);
    step_noise_under_effects(before, now.fit);
  }
  FitChange change;
  change.offsets = relinearised(task, now);
  change.path = most_moved(before, now.fit.paths);
  return change;
}

/// Coefficients that no measurement tells from the unknowns, looked for at the best fit without
/// them: far from it large residuals make anything appear observable.
void hold_unobservable(const FitTask& task, Fitting& now) {
  FitState& fit = now.fit;
  const std::vector<int> unknown = estimation::unknown_coefficients(fit.columns.border);
  if (unknown.empty()) return;
  estimation::EffectParameters without = fit.columns.border;
  for (const int k : unknown) without[idx(k)].held = coefficient_at(fit, idx(k));
  estimation::RecordingAdjustmentOptions how;
  how.gate = task.options.gate;
  fit.adjustment = estimation::adjust_from(fit.adjustment.state, fit.problem, without, how);
  now.chi2_without = chi2_of_all(fit.adjustment, task.options);
  static_cast<void>(follow(task, now));
  take_columns(task, now);
  while (hold_one(task, now)) {
  }
}

/// Neither a coefficient nor the path has moved, from which the columns were made.
bool is_settled(const FitterOptions& options, const Fitting& now, const FitChange& change) {
  constexpr double kStill = 1e-6;  // m and rad
  // Instants that a delay moves cut rows anew, whose rounding comes back larger.
  constexpr double kCutAnew = 100.0;
  const std::vector<Effect>& effects = now.fit.model.effects;
  const auto has = [&effects](bool (*kind)(Channel)) {
    return std::any_of(effects.begin(), effects.end(),
                       [kind](const Effect& effect) { return kind(effect.channel); });
  };
  if (change.offsets > options.still_offset) return false;
  if (now.fit.columns.border.empty()) return true;
  if (now.only_common() && !has([](Channel one) { return one == Channel::compass; })) return true;
  if (estimation::unknown_coefficients(now.fit.columns.border).empty()) return change.path < kStill;
  return change.coefficients < (has(effects::is_delay) ? kCutAnew : 1.0);
}

/// Whether rounds go round in circles: by a delay a sighting may fall into one row and back. Each
/// figure is what a round still moved.
bool circles(const std::vector<double>& moved) {
  constexpr std::ptrdiff_t kPatience = 6;  // rounds
  constexpr double kNoLess = 0.5;
  if (std::ssize(moved) <= 2 * kPatience) return false;
  const auto lately = moved.end() - kPatience;
  return *std::min_element(lately, moved.end()) >
         kNoLess * *std::min_element(moved.begin(), lately);
}

/// Whether rounds wander about far from any fit: each figure is what one left, chi^2/dof. What
/// finds its way in the end comes nearer from one few rounds to the next.
bool wanders(const std::vector<double>& left) {
  constexpr int kPatience = 5;  // rounds
  constexpr double kFar = 100.0;
  constexpr double kNearer = 0.7;
  double least = std::numeric_limits<double>::infinity();
  int without = 0;
  for (const double one : left) {
    without = one < kNearer * least ? 0 : without + 1;
    least = std::min(least, one);
  }
  return without >= kPatience && least > kFar;
}

std::vector<EffectEstimate> estimates(const Fitting& now) {
  const FitState& fit = now.fit;
  std::vector<EffectEstimate> result;
  for (std::size_t e = 0; e < fit.model.effects.size(); ++e) {
    const Effect& effect = fit.model.effects[e];
    EffectEstimate estimate{effect, std::vector<double>(effect.coefficients.size(), 0.0), {}};
    for (std::size_t place = 0; place < effect.coefficients.size(); ++place) {
      if (!now.not_fitted[e][place]) continue;
      estimate.sd[place] = std::numeric_limits<double>::infinity();
      estimate.not_fitted.push_back(*now.not_fitted[e][place]);
    }
    result.push_back(std::move(estimate));
  }
  const std::vector<int> unknown = estimation::unknown_coefficients(fit.columns.border);
  for (std::size_t k = 0; k < unknown.size(); ++k) {
    const Coefficient& one = fit.columns.coefficients[idx(unknown[k])];
    result[one.effect].sd[one.place] = sd_of_unknown(fit, k);
  }
  return result;
}

/// What of a last round could be seen in any figure; empty where nothing could.
std::string still_moving(const FitterOptions& options, const FitChange& change) {
  constexpr double kSeen = 1e-3;         // sds
  constexpr double kPathSeen = 1e-5;     // m and rad
  constexpr double kCoefficient = 1e-2;  // sds
  const double coefficient = change.coefficients * options.still;
  std::string moving;
  const auto add = [&moving](const std::string& one) {
    moving += (moving.empty() ? "" : ", ") + one;
  };
  if (change.path > kPathSeen) add(text::joined("the path by up to ", change.path, " m or rad"));
  if (change.offsets > kSeen) {
    add(text::joined("a measurement by up to ", change.offsets, " standard deviations"));
  }
  if (coefficient > kCoefficient) {
    add(text::joined("a coefficient by up to ", coefficient, " standard errors"));
  }
  return moving;
}

void tell_whether_settled(const FitterOptions& options, const FitChange& change, FitState& fit) {
  if (fit.settled) return;
  fit.still_moving = still_moving(options, change);
  fit.settled = fit.still_moving.empty();
}

}  // namespace

FitChange adjust_once(const FitTask& task, const estimation::RecordingAdjustment* near,
                      Fitting& now) {
  FitState& fit = now.fit;
  estimation::RecordingAdjustmentOptions how;
  how.gate = task.options.gate;
  how.most_left_out = task.options.most_left_out;
  how.landmark_uncertainties = task.options.landmark_uncertainties;
  how.near = near;
  // What misfit without the effects hid may show only now, at the best fit with them.
  for (bool adjusted = false; !adjusted;) {
    how.coefficients = unknown_values(fit);
    try {
      fit.adjustment =
          estimation::adjust_from(fit.adjustment.state, fit.problem, fit.columns.border, how);
      adjusted = true;
    } catch (const estimation::UndeterminedError& error) {
      const std::vector<int> unknown = estimation::unknown_coefficients(fit.columns.border);
      hold_coefficient(task, unknown[idx(error.coefficients().back())], NotFitted::undetermined,
                       0.0, now);
    }
  }
  double changed = 0.0;
  const std::vector<int> unknown = estimation::unknown_coefficients(fit.columns.border);
  for (std::size_t k = 0; k < unknown.size(); ++k) {
    const Coefficient& one = fit.columns.coefficients[idx(unknown[k])];
    double& value = fit.model.effects[one.effect].coefficients[one.place];
    const double next = fit.adjustment.coefficients[static_cast<Eigen::Index>(k)];
    const double negligible = 1e-9 * std::abs(next) + task.options.still * sd_of_unknown(fit, k);
    changed = std::max(changed, std::abs(next - value) / negligible);
    value = next;
  }
  shorten_steering(task, now.laid_out, fit);
  FitChange change = follow(task, now);
  change.coefficients = changed;
  return change;
}

double sd_of_unknown(const FitState& fit, std::size_t k) {
  const auto at = static_cast<Eigen::Index>(k);
  return std::sqrt(fit.adjustment.coefficient_covariance(at, at));
}

std::map<std::string, Vector2> places_in(const estimation::RecordingProblem& problem,
                                         const estimation::RecordingState& state) {
  std::map<std::string, Vector2> places;
  for (std::size_t k = 0; k < problem.landmarks.size(); ++k) {
    places[problem.landmarks[k]] = state.landmarks[k];
  }
  return places;
}

double chi2_of_all(const estimation::RecordingAdjustment& adjustment,
                   const FitterOptions& options) {
  return adjustment.chi2 +
         options.gate.value_or(0.0) * static_cast<double>(adjustment.left_out.size());
}

bool is_gross_misfit(const FitState& fit) {
  constexpr double kFarTooLarge = 10.0;  // chi^2/dof
  return fit.adjustment.chi2 > kFarTooLarge * std::max(1, fit.adjustment.dof);
}

Fitting fit_from(const std::vector<DrivenRecording>& recordings, const Model& model,
                 const FitterOptions& options) {
  const FitTask task{recordings, odometry::with_gyro(recordings, model.robot, model.noise),
                     resolved(model, recordings, options.free_common_errors), options};
  Fitting now;
  FitState& fit = now.fit;
  fit.model = task.model;
  fit.common_errors = task.model.effects.size() - model.effects.size();
  for (const Effect& effect : fit.model.effects) {
    now.not_fitted.emplace_back(effect.coefficients.size());
  }
  lay_out_recordings(task, now);
  start_fit(task, now);
  FitChange change;
  std::vector<double> moved;
  std::vector<double> left;
  for (; now.round < options.max_rounds; ++now.round) {
    const bool first = now.round == 0;
    const std::size_t measured = fit.problem.measurements.size();
    const bool again = !first && layout_moved(now);
    if (again) lay_out_again(task, now);
    take_columns(task, now);
    // What is laid out anew is linearised along its record, and not at the noise believed so far.
    if (again) static_cast<void>(relinearised(task, now));
    if (first && options.fit_effects) hold_unobservable(task, now);
    // A delay may move sightings out of the drive, or back into it: then all is looked at anew.
    const bool same = fit.problem.measurements.size() == measured;
    change = first ? adjust_from_starts(task, now)
                   : adjust_once(task, same ? &fit.adjustment : nullptr, now);
    fit.settled = is_settled(options, now, change);
    moved.push_back(std::max(change.coefficients, change.offsets / options.still_offset));
    left.push_back(fit.adjustment.chi2 / std::max(1, fit.adjustment.dof));
    const bool last =
        fit.settled || now.round + 1 == options.max_rounds || circles(moved) || wanders(left);
    if ((first || last) && options.fit_effects && hold_one(task, now)) {
      fit.settled = false;
      moved.clear();
      left.clear();
      continue;
    }
    if (last) break;
  }
  if (options.paths && !now.columns_see_paths()) lay_paths(fit);
  fit.effects = estimates(now);
  fit.rounds = std::min(now.round + 1, options.max_rounds);
  tell_whether_settled(options, change, fit);
  return now;
}

estimation::RecordingProblem whole_problem(const FitState& fit) {
  estimation::ProblemOptions all = fit.used;
  all.left_out.clear();
  return estimation::make_problem(fit.recordings, fit.model, all);
}

std::map<std::string, Vector2> landmark_places(const FitState& fit) {
  return places_in(fit.problem, fit.adjustment.state);
}

Eigen::VectorXd offsets_of(const FitState& fit) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(fit.columns.border.size()));
  for (std::size_t k = 0; k < fit.columns.border.size(); ++k) {
    result[static_cast<Eigen::Index>(k)] = coefficient_at(fit, k) - fit.columns.border[k].reference;
  }
  return result;
}

}  // namespace trussmap::fitting
