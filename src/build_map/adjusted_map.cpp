// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/adjusted_map.hpp"

#include "estimation/measurement_rows.hpp"
#include "estimation/recording_robust.hpp"
#include "fit/fit_state.hpp"
#include "text/number_text.hpp"
#include "trussmap/gate.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap {
namespace {

/// Effects held, survey and truth left to judge the map.
FitState fit_map(const std::vector<Recording>& recordings, const Model& model, double gate) {
  FitterOptions how;
  how.fit_effects = false;
  how.relinearise = false;
  how.problem.survey = false;
  how.problem.truth = false;
  if (std::isfinite(gate)) how.gate = gate * gate;
  return fit_recordings(recordings, model, how);
}

/// How far from its landmark a sighting points, m.
double misfit_of(const FitState& fit, const Measurement& one) {
  const RecordingState& state = fit.adjustment.state;
  const Pose& pose = state.poses[idx(one.from - fit.problem.landmark_count())];
  const ViewPattern view = view_of(fit.columns.border, offsets_of(fit), one);
  const Matrix2 R = rotation(pose.heading);
  const Vector2 to =
      state.landmarks[idx(one.to)] - pose.position() - R * Vector2(view.ahead, view.left);
  if (one.kind == MeasurementKind::standing) return to.norm();
  if (one.kind == MeasurementKind::cartesian_view) {
    return (to - R * rotation(view.heading) * one.value.head<2>()).norm();
  }
  const double range = (one.value[0] - view.range) / (1.0 + view.range_scale);
  if (one.rows == 1) return std::abs(to.norm() - range);
  const double bearing = one.value[1] - view.bearing + view.heading;
  return (to - R * (range * rotation(bearing).col(0))).norm();
}

std::vector<RejectedSighting> left_out_of(const FitState& fit) {
  std::vector<RejectedSighting> result;
  const RecordingProblem& problem = fit.problem;
  for (const int k : fit.adjustment.left_out) {
    const Measurement& one = problem.measurements[idx(k)];
    result.push_back({problem.sessions[idx(one.session)],
                      problem.poses[idx(one.from - problem.landmark_count())].t,
                      problem.landmarks[idx(one.to)], misfit_of(fit, one)});
  }
  return result;
}

/// Few sightings are wrong; many that are called so speak against the model.
std::vector<std::string> doubts(const RecordingAdjustment& fit, const RecordingProblem& problem) {
  constexpr double kMany = 0.05;
  constexpr double kImplausible = 1e-6;
  std::vector<std::string> result;
  if (!fit.converged) {
    result.push_back(joined("no minimum was reached in ", fit.iterations,
                            " iterations: the map is not the best one"));
  }
  const auto sightings =
      std::count_if(problem.measurements.begin(), problem.measurements.end(),
                    [](const Measurement& one) { return is_sighting(one.kind); });
  const double share =
      static_cast<double>(fit.left_out.size()) / static_cast<double>(std::max(sightings, 1L));
  if (share > kMany) {
    result.push_back(
        fixed_text(100.0 * share, 0) +
        " % of the sightings contradict the rest and were kept out: that many are seldom wrong; is "
        "the model's noise too small, or its robot another one?");
  } else if (fit.p_value < kImplausible) {
    result.push_back(joined("chi^2 = ", fixed_text(fit.chi2, 1), " is too large for ", fit.dof,
                            " degrees of freedom: the model's noise is too small or an effect is "
                            "missing; the map's covariances are too small as well"));
  }
  return result;
}

}  // namespace

BuiltMap map_by_adjustment(const std::vector<Recording>& recordings, const Model& model,
                           const std::vector<SightedDrive>& sessions,
                           const BuildMapOptions& options) {
  const FitState fit = fit_map(recordings, model, options.gate.value_or(kAdjustmentGate));
  const RecordingAdjustment& adjustment = fit.adjustment;
  LegByLegOptions routes{options, kMapGate, landmark_places(fit)};
  routes.build.method = Method::gauss_markov;
  BuiltMap result = map_leg_by_leg(sessions, routes);
  for (std::size_t k = 0; k < fit.problem.landmarks.size(); ++k) {
    const std::optional<int> landmark = result.map.find(fit.problem.landmarks[k]);
    if (!landmark) continue;
    result.map.set_position(*landmark, adjustment.state.landmarks[k]);
    result.map.set_covariance(*landmark, adjustment.landmark_covariances[k]);
  }
  result.method = Method::adjustment;
  result.rejected = left_out_of(fit);
  result.fit = {adjustment.chi2, adjustment.dof, adjustment.p_value, adjustment.iterations,
                adjustment.converged};
  result.warnings = doubts(adjustment, fit.problem);
  return result;
}

}  // namespace trussmap
