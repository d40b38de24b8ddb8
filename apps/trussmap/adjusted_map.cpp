// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "adjusted_map.hpp"

#include "estimation/recording_adjustment.hpp"
#include "estimation/recording_robust.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

/// How far from its landmark a sighting points, m.
double misfit_of(const RecordingState& state, const RecordingProblem& problem,
                 const Measurement& one) {
  const Pose& pose = state.poses[idx(one.from - problem.landmark_count())];
  const Vector2 to = state.landmarks[idx(one.to)] - pose.position();
  if (one.kind == MeasurementKind::standing) return to.norm();
  if (one.rows == 1) return std::abs(to.norm() - one.value[0]);
  const Vector2 offset = one.kind == MeasurementKind::view
                             ? Vector2(one.value[0] * rotation(one.value[1]).col(0))
                             : Vector2(one.value.head<2>());
  return (to - rotation(pose.heading) * offset).norm();
}

std::vector<RejectedSighting> left_out_of(const RecordingAdjustment& fit,
                                          const RecordingProblem& problem) {
  std::vector<RejectedSighting> result;
  for (const int k : fit.left_out) {
    const Measurement& one = problem.measurements[idx(k)];
    result.push_back({problem.sessions[idx(one.session)],
                      problem.poses[idx(one.from - problem.landmark_count())].t,
                      problem.landmarks[idx(one.to)], misfit_of(fit.state, problem, one)});
  }
  return result;
}

/// Few sightings are wrong; many that are called so speak against the model.
std::vector<std::string> doubts(const RecordingAdjustment& fit, const RecordingProblem& problem) {
  constexpr double kMany = 0.05;
  constexpr double kImplausible = 1e-6;
  std::vector<std::string> result;
  if (!fit.converged) {
    result.push_back(fmt::format(
        "no minimum was reached in {} iterations: the map is not the best one", fit.iterations));
  }
  const auto sightings =
      std::count_if(problem.measurements.begin(), problem.measurements.end(),
                    [](const Measurement& one) { return is_sighting(one.kind); });
  const double share =
      static_cast<double>(fit.left_out.size()) / static_cast<double>(std::max(sightings, 1L));
  if (share > kMany) {
    result.push_back(fmt::format(
        "{:.0f} % of the sightings contradict the rest and were kept out: that many are seldom "
        "wrong; is the model's noise too small, or its robot another one?",
        100.0 * share));
  } else if (fit.p_value < kImplausible) {
    result.push_back(fmt::format(
        "chi^2 = {:.1f} is too large for {} degrees of freedom: the model's noise is too small or "
        "an effect is missing; the map's covariances are too small as well",
        fit.chi2, fit.dof));
  }
  return result;
}

}  // namespace

AdjustedMap map_by_adjustment(const std::vector<Recording>& recordings, const Model& model,
                              double gate, RecordingMapOptions options) {
  ProblemOptions measured;
  measured.survey = false;
  measured.truth = false;
  const RecordingProblem problem = make_problem(recordings, model, measured);
  RecordingAdjustmentOptions robust;
  robust.gate = gate * gate;
  const RecordingAdjustment fit = adjust(problem, {}, robust);

  for (std::size_t k = 0; k < problem.landmarks.size(); ++k) {
    options.guide[problem.landmarks[k]] = fit.state.landmarks[k];
  }
  AdjustedMap result;
  result.map = map_recordings(recordings, model, options);
  LandmarkGraph& map = result.map.map;
  for (std::size_t k = 0; k < problem.landmarks.size(); ++k) {
    const std::optional<int> landmark = map.find(problem.landmarks[k]);
    if (!landmark) continue;
    map.set_position(*landmark, fit.state.landmarks[k]);
    map.set_covariance(*landmark, fit.landmark_covariances[k]);
  }
  result.map.method = "adjustment";
  result.map.rejected = left_out_of(fit, problem);
  result.chi2 = fit.chi2;
  result.dof = fit.dof;
  result.p_value = fit.p_value;
  result.iterations = fit.iterations;
  result.converged = fit.converged;
  result.warnings = doubts(fit, problem);
  return result;
}

}  // namespace trussmap::app
