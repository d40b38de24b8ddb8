// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/student_tails.hpp"

#include "effects/channel_physics.hpp"
#include "estimation/measurement_rows.hpp"
#include "estimation/noise_states.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::estimation {

bool has_used_tails(const NoiseProcess& process) {
  return process.tails > 0.0 && process.process == ProcessKind::white &&
         effects::acts_on_sightings(process.channel);
}

double tail_information(double tails, int rows) {
  if (!(tails > 0.0)) return 1.0;
  return tails * (tails + rows) / ((tails - 2.0) * (tails + rows + 2.0));
}

double tail_deviance(double tails, int rows, double squared_error) {
  if (!(tails > 0.0)) return squared_error;
  return (tails + rows) * std::log1p(squared_error / (tails - 2.0));
}

double take_tails(RecordingProblem& problem, const EffectParameters& border,
                  const Eigen::VectorXd& offsets, const RecordingState& state) {
  double most = 0.0;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    Measurement& one = problem.measurements[k];
    if (!(one.tails > 0.0)) continue;
    effects::ViewPattern view = view_of(border, offsets, one);
    if (state.noise.size() > 0) view = lasting_in_view(problem, k, view, state.noise);
    const MeasurementRows rows = measurement_rows(problem, one, state, one.value, view);
    const double squared_error = (one.whitener * rows.error).squaredNorm();
    const double kept = (one.tails + one.rows) / (one.tails - 2.0 + squared_error) /
                        tail_information(one.tails, one.rows);
    const Vector4 offset = (1.0 - kept) * rows.error;
    const Vector4 change = one.whitener * (offset - one.value_offset);
    most = std::max(most, change.cwiseAbs().maxCoeff());
    one.value_offset = offset;
  }
  return most;
}

}  // namespace trussmap::estimation
