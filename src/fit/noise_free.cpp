// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/noise_free.hpp"

#include "estimation/measurement_rows.hpp"

#include <utility>

namespace trussmap::fitting {
namespace {

estimation::RecordingState standing_exactly(const estimation::RecordingProblem& problem,
                                            const estimation::EffectParameters& border,
                                            const Eigen::VectorXd& offsets,
                                            const estimation::RecordingState& state) {
  std::vector<Vector2> sums(state.poses.size(), Vector2::Zero());
  std::vector<int> counts(state.poses.size(), 0);
  for (const estimation::Measurement& one : problem.measurements) {
    if (!estimation::is_standing(one)) continue;
    const effects::ViewPattern view = estimation::view_of(border, offsets, one);
    const std::size_t pose = idx(one.from - problem.landmark_count());
    sums[pose] +=
        state.landmarks[idx(one.to)] - rotation(state.poses[pose].heading) *
                                           (Vector2(view.ahead, view.left) + one.value.head<2>());
    ++counts[pose];
  }
  estimation::RecordingState result = state;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (counts[k] == 0) continue;
    result.poses[k].x = sums[k].x() / counts[k];
    result.poses[k].y = sums[k].y() / counts[k];
  }
  return result;
}

estimation::RecordingProblem without_noise(const estimation::RecordingProblem& problem,
                                           const std::vector<SessionPath>& paths) {
  estimation::RecordingProblem result = problem;
  for (const estimation::Measurement& one : problem.measurements) {
    if (!estimation::is_segment(one)) continue;
    const SessionPath& path = paths[idx(one.session)];
    if (path.missing.empty()) continue;
    std::vector<estimation::SegmentRow> rows = result.segments[one.source];
    for (estimation::SegmentRow& row : rows) {
      row.path += row.part * path.missing[row.row][0];
      row.turn += row.part * path.missing[row.row][1];
    }
    result.segments[one.source] = std::move(rows);
  }
  return result;
}

}  // namespace

estimation::EffectParameters border_as_fitted(const Model& model, const ShapeContext& context,
                                              const estimation::EffectParameters& fitted) {
  estimation::EffectParameters border = effect_columns(model.effects, context).border;
  for (std::size_t k = 0; k < border.size(); ++k) {
    border[k].held = fitted[k].held;
    border[k].reference = fitted[k].reference;
  }
  return border;
}

NoiseFree::NoiseFree(const std::vector<DrivenRecording>& recordings, const Model& model,
                     const estimation::RecordingProblem& fitted,
                     const estimation::EffectParameters& fitted_border,
                     const Eigen::VectorXd& offsets, const estimation::RecordingState& fitted_state)
    : state(standing_exactly(fitted, fitted_border, offsets, fitted_state)),
      paths(fitted_paths(recordings, model.robot, fitted, fitted_border, offsets, state)),
      problem(without_noise(fitted, paths)),
      context(recordings, model.robot, paths),
      border(border_as_fitted(model, context, fitted_border)) {}

}  // namespace trussmap::fitting
