// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/map_fit.hpp"

#include "estimation/measurement_rows.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/gate.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace trussmap::map_building {
namespace {

constexpr double kFreed = 0.05;  // p-value below which common errors stay

fitting::FitterOptions options_for(const std::optional<double>& gate) {
  fitting::FitterOptions how;
  how.fit_effects = false;
  how.relinearise = false;
  how.problem.survey = false;
  how.problem.truth = false;
  how.max_rounds = 4;
  how.still = 0.1;
  how.landmark_uncertainties = false;
  how.paths = false;
  const double sds = gate.value_or(kAdjustmentGate);
  if (std::isfinite(sds)) how.gate = sds * sds;
  if (!gate) how.most_left_out = kMostLeftOut;
  return how;
}

/// Wald's test of all common errors at once, by the scatter that there is.
double p_value_of_common_errors(const fitting::FitState& fit) {
  const Eigen::VectorXd& values = fit.adjustment.coefficients;
  if (values.size() == 0) return 1.0;
  const double dispersion = std::max(1.0, fit.adjustment.chi2 / std::max(1, fit.adjustment.dof));
  const double statistic =
      values.dot(fit.adjustment.coefficient_covariance.inverse() * values) / dispersion;
  return statistics::chi2_p_value(statistic, static_cast<int>(values.size()));
}

/// Standard errors by the scatter that there is, as those of the landmarks.
std::vector<FreedError> freed_of(const fitting::FitState& fit) {
  const double dispersion = std::max(1.0, fit.adjustment.chi2 / std::max(1, fit.adjustment.dof));
  std::vector<FreedError> result;
  for (std::size_t k = fit.effects.size() - fit.common_errors; k < fit.effects.size(); ++k) {
    result.push_back({fit.effects[k].effect, fit.effects[k].sd});
    for (double& sd : result.back().sd) sd *= std::sqrt(dispersion);
  }
  return result;
}

/// How far from its landmark a sighting points, m.
double misfit_of(const fitting::FitState& fit, const estimation::Measurement& one) {
  const estimation::RecordingState& state = fit.adjustment.state;
  const Pose& pose = state.poses[idx(one.from - fit.problem.landmark_count())];
  return one.kind->missed(one, pose, state.landmarks[idx(one.to)],
                          estimation::view_of(fit.columns.border, fitting::offsets_of(fit), one));
}

}  // namespace

bool are_paths_alone(const std::vector<DrivenRecording>& recordings) {
  return std::all_of(recordings.begin(), recordings.end(), [](const DrivenRecording& one) {
    return one.sightings.empty() && !(one.fixes.empty() && one.loops.empty());
  });
}

MapFitState fit_map(const std::vector<DrivenRecording>& recordings, const Model& given,
                    const std::optional<double>& gate) {
  fitting::FitterOptions how = options_for(gate);
  Model model = given;
  const std::optional<AntennaFound> antenna = antenna_by_sightings(recordings, model, how);
  if (antenna) model.robot.mounted.antenna = antenna->place;
  how.free_common_errors = true;
  how.paths = are_paths_alone(recordings);
  MapFitState result;
  result.antenna = antenna;
  result.fit = fitting::fit_recordings(recordings, model, how);
  result.p_freed = p_value_of_common_errors(result.fit);
  if (result.p_freed < kFreed) {
    result.freed = freed_of(result.fit);
  } else {
    how.free_common_errors = false;
    how.near = &result.fit;
    fitting::FitState plain = fitting::fit_recordings(recordings, model, how);
    result.fit = std::move(plain);
  }
  estimation::add_landmark_uncertainties(result.fit.problem, result.fit.columns.border,
                                         result.fit.adjustment);
  return result;
}

std::vector<RejectedSighting> left_out_of(const fitting::FitState& fit) {
  std::vector<RejectedSighting> result;
  const estimation::RecordingProblem& problem = fit.problem;
  for (const int k : fit.adjustment.left_out) {
    const estimation::Measurement& one = problem.measurements[idx(k)];
    if (!estimation::is_sighting(one)) continue;
    result.push_back({problem.sessions[idx(one.session)], problem.time_of(one.from),
                      problem.landmarks[idx(one.to)], misfit_of(fit, one)});
  }
  return result;
}

std::vector<SessionGuide> guides_of(const fitting::FitState& fit) {
  std::vector<SessionGuide> guides(fit.recordings.size());
  for (std::size_t s = 0; s < guides.size(); ++s) {
    guides[s].headings.resize(fit.recordings[s].sightings.size());
    guides[s].left_out.resize(fit.recordings[s].sightings.size());
    guides[s].yaw_left_out.resize(fit.recordings[s].sightings.size());
  }
  for (const estimation::Measurement& one : fit.problem.measurements) {
    if (!estimation::is_sighting(one)) continue;
    const std::size_t pose = idx(one.from - fit.problem.landmark_count());
    guides[idx(one.session)].headings[one.source] = fit.adjustment.state.poses[pose].heading;
  }
  for (const int k : fit.adjustment.left_out) {
    const estimation::Measurement& one = fit.problem.measurements[idx(k)];
    if (one.session < 0) continue;
    SessionGuide& guide = guides[idx(one.session)];
    if (estimation::is_sighting(one)) guide.left_out[one.source] = true;
    if (estimation::is_yaw(one)) guide.yaw_left_out[one.source] = true;
  }
  return guides;
}

LandmarkGraph adjusted_landmarks(const fitting::FitState& fit) {
  LandmarkGraph result;
  for (std::size_t k = 0; k < fit.problem.landmarks.size(); ++k) {
    const int landmark =
        result.add_landmark(fit.problem.landmarks[k], fit.adjustment.state.landmarks[k]);
    result.set_covariance(landmark, fit.adjustment.landmark_covariances[k]);
  }
  for (std::size_t k = 0; k < fit.problem.oriented.size(); ++k) {
    const double sd = fit.adjustment.orientation_sds[k];
    if (std::isnan(sd)) continue;
    result.set_heading(fit.problem.oriented[k], wrap_angle(fit.adjustment.state.orientations[k]),
                       sd);
  }
  return result;
}

void orient_as(const LandmarkGraph& adjusted, double turn, LandmarkGraph& map) {
  for (int k = 0; k < map.landmarks(); ++k) {
    const std::optional<int> best = adjusted.find(map.landmark(k).name);
    if (!best || !adjusted.landmark(*best).heading) continue;
    const Landmark& one = adjusted.landmark(*best);
    map.set_heading(k, wrap_angle(*one.heading + turn), one.sd_heading);
  }
}

void place_as(const LandmarkGraph& adjusted, LandmarkGraph& map) {
  for (int k = 0; k < map.landmarks(); ++k) {
    const Landmark& best = adjusted.landmark(*adjusted.find(map.landmark(k).name));
    map.set_position(k, best.position);
    map.set_covariance(k, *best.covariance);
  }
  for (int k = 0; k < adjusted.landmarks(); ++k) {
    const Landmark& best = adjusted.landmark(k);
    if (map.find(best.name)) continue;
    map.set_covariance(map.add_landmark(best.name, best.position), *best.covariance);
  }
}

}  // namespace trussmap::map_building
