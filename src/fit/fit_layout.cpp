// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/steering.hpp"
#include "effects/wheel_factors.hpp"
#include "estimation/recording_start.hpp"
#include "fit/along_paths.hpp"
#include "fit/fit_stages.hpp"
#include "odometry/wheels_and_gyro.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace trussmap::fitting {
namespace {

/// Then what was laid out by another path is not what its columns say.
bool steering_sees_path(const std::vector<Effect>& effects) {
  const auto sees_path = [](const Shape& shape) {
    const std::vector<std::string>& names = shape.variables();
    return std::any_of(names.begin(), names.end(), [](const std::string& name) {
      return name == "heading" || name == "x" || name == "y";
    });
  };
  return std::any_of(effects.begin(), effects.end(), [&](const Effect& effect) {
    return effects::is_steering(effect.channel) &&
           std::any_of(effect.shape.begin(), effect.shape.end(), sees_path);
  });
}

/// As it was read, which leaves every row a way.
std::vector<Effect> without_steering(std::vector<Effect> effects) {
  for (Effect& effect : effects) {
    if (effects::is_steering(effect.channel)) std::ranges::fill(effect.coefficients, 0.0);
  }
  return effects;
}

/// Those of each recording by the model's own effects, where any is far from the robot's; once they
/// are taken in, until all are near it.
std::vector<WheelFactors> far_factors(const FitState& fit, std::size_t sessions, bool taken_in) {
  const std::vector<Effect> own(
      fit.model.effects.begin(),
      fit.model.effects.end() - static_cast<std::ptrdiff_t>(fit.common_errors));
  // Gross constants are compared on one side of it.
  const double far = taken_in ? 0.02 : effects::kFarFactors;
  std::vector<WheelFactors> result;
  bool any = false;
  for (std::size_t s = 0; s < sessions; ++s) {
    const std::optional<WheelFactors> of_session =
        effects::wheel_factors(own, fit.model.robot, static_cast<int>(s));
    if (!of_session) return {};
    result.push_back(*of_session);
    any = any || effects::difference(*of_session, fit.model.robot) > far;
  }
  if (!any) result.clear();
  return result;
}

bool has_factors(const std::vector<DrivenRecording>& recordings) {
  return !recordings.empty() && recordings.front().drive.factors.has_value();
}

/// What was recorded, driven as steering effects and far factors of wheels say.
std::vector<DrivenRecording> as_driven(const FitTask& task, const FitState& fit) {
  const Model& model = fit.model;
  const std::vector<WheelFactors> factors =
      far_factors(fit, task.raw.size(), has_factors(fit.recordings));
  if (factors.empty() && !effects::steers(model.effects)) return task.recorded;
  std::vector<DrivenRecording> result = steered(task.raw, model.effects, model.robot, fit.paths);
  for (std::size_t s = 0; s < factors.size(); ++s) {
    result[s].drive = effects::with_factors(std::move(result[s].drive), factors[s], model.robot);
  }
  return odometry::with_gyro(result, model.robot, model.noise);
}

/// Since they were taken in, by more than may tell fits apart that have the same motion by other
/// factors.
bool factors_moved(const FitState& fit) {
  constexpr double kMoved = 2e-4;
  const bool taken_in = has_factors(fit.recordings);
  const std::vector<WheelFactors> now = far_factors(fit, fit.recordings.size(), taken_in);
  if (now.empty() || !taken_in) return now.empty() == taken_in;
  for (std::size_t s = 0; s < now.size(); ++s) {
    const WheelFactors& before = *fit.recordings[s].drive.factors;
    if (effects::difference(now[s], before, fit.model.robot) > kMoved) return true;
  }
  return false;
}

/// Spans are left out where delays move them.
estimation::ProblemOptions moved_options(const FitTask& task, const Model& model) {
  estimation::ProblemOptions result = task.options.problem;
  const std::size_t sessions = task.recorded.size();
  if (result.left_out.size() > sessions) {
    throw std::invalid_argument(text::joined("spans are left out of ", result.left_out.size(),
                                             " recordings, of which there are ", sessions));
  }
  result.left_out.resize(result.left_out.empty() ? 0 : sessions);
  for (std::size_t s = 0; s < result.left_out.size(); ++s) {
    std::vector<double> ends;
    for (const TimeSpan& span : result.left_out[s]) {
      ends.push_back(span.from);
      ends.push_back(span.to);
    }
    ends = retimed(ends, task.recorded[s], s, sessions, model.effects, model.robot,
                   delay_of_legs(task.recorded[s]));
    for (std::size_t k = 0; k < result.left_out[s].size(); ++k) {
      result.left_out[s][k] = {ends[2 * k], ends[2 * k + 1]};
    }
  }
  return result;
}

/// Mean of where these poses have seen the landmark; of ranges or bearings alone, where they were.
Vector2 place_seen_from(const estimation::RecordingProblem& problem, int landmark,
                        const std::vector<Pose>& poses) {
  Vector2 sum = Vector2::Zero();
  double count = 0.0;
  for (const estimation::Measurement& one : problem.measurements) {
    const int pose = one.from - problem.landmark_count();
    if (one.to != landmark || pose < 0 || pose >= static_cast<int>(poses.size())) continue;
    const std::optional<Vector2> seen =
        estimation::locates(one) ? one.kind->seen_from(one, poses[idx(pose)], one.mounted)
                                 : std::nullopt;
    sum += seen.value_or(poses[idx(pose)].position());
    count += 1.0;
  }
  return sum / std::max(count, 1.0);
}

}  // namespace

void shorten_steering(const FitTask& task, const std::vector<Effect>& from, FitState& fit) {
  constexpr int kHalvings = 20;
  std::vector<Effect>& effects = fit.model.effects;
  const std::vector<Effect> wanted = effects;
  double share = 1.0;
  for (int halving = 0; halving <= kHalvings; ++halving) {
    if (leave_a_way(effects, task.raw, fit.model.robot, fit.paths)) return;
    share = halving < kHalvings ? 0.5 * share : 0.0;
    for (std::size_t e = 0; e < effects.size(); ++e) {
      if (!effects::is_steering(effects[e].channel)) continue;
      for (std::size_t k = 0; k < effects[e].coefficients.size(); ++k) {
        const double before = from[e].coefficients[k];
        effects[e].coefficients[k] = before + share * (wanted[e].coefficients[k] - before);
      }
    }
  }
}

void lay_out_recordings(const FitTask& task, Fitting& now) {
  FitState& fit = now.fit;
  if (task.options.fit_effects) shorten_steering(task, without_steering(fit.model.effects), fit);
  now.laid_out = fit.model.effects;
  fit.recordings = retimed(as_driven(task, fit), fit.model.effects, fit.model.robot);
  fit.used = moved_options(task, fit.model);
  fit.problem = estimation::make_problem(fit.recordings, fit.model, fit.used);
}

bool layout_moved(const Fitting& now) {
  constexpr double kMovedLayout = 0.02;  // standard deviations
  const FitState& fit = now.fit;
  if (steering_sees_path(fit.model.effects)) return true;
  if (factors_moved(fit)) return true;
  const std::vector<int> unknown = estimation::unknown_coefficients(fit.columns.border);
  for (std::size_t k = 0; k < unknown.size(); ++k) {
    const Coefficient& one = fit.columns.coefficients[idx(unknown[k])];
    if (!is_laid_out(fit.model.effects[one.effect].channel)) continue;
    const double before = now.laid_out[one.effect].coefficients[one.place];
    const double moved = coefficient_at(fit, idx(unknown[k])) - before;
    if (std::abs(moved) > kMovedLayout * sd_of_unknown(fit, k)) return true;
  }
  return false;
}

void lay_out_again(const FitTask& task, Fitting& now) {
  const std::map<std::string, Vector2> landmarks = landmark_places(now.fit);
  lay_out_recordings(task, now);
  now.fit.adjustment.state = placed(now.fit, landmarks);
}

estimation::RecordingState along_paths(const estimation::RecordingProblem& problem,
                                       const std::vector<DrivenRecording>& recordings,
                                       const std::vector<SessionPath>& paths,
                                       const std::map<std::string, Vector2>& landmarks) {
  estimation::RecordingState state;
  for (const estimation::PoseNode& node : problem.poses) {
    const std::size_t session = idx(node.session);
    state.poses.push_back(pose_at(recordings[session].drive, paths[session], node.t));
  }
  for (int k = 0; k < problem.landmark_count(); ++k) {
    const auto known = landmarks.find(problem.landmarks[idx(k)]);
    state.landmarks.push_back(known != landmarks.end() ? known->second
                                                       : place_seen_from(problem, k, state.poses));
  }
  state.orientations = estimation::orientations_seen_from(problem, state.poses);
  return state;
}

estimation::RecordingState placed(const FitState& fit,
                                  const std::map<std::string, Vector2>& landmarks) {
  return along_paths(fit.problem, fit.recordings, fit.paths, landmarks);
}

}  // namespace trussmap::fitting
