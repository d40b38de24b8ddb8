// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/noise_free.hpp"

#include "estimation/measurement_rows.hpp"

#include <utility>

namespace trussmap {
namespace {

RecordingState standing_exactly(const RecordingProblem& problem, const EffectParameters& border,
                                const Eigen::VectorXd& offsets, const RecordingState& state) {
  std::vector<Vector2> sums(state.poses.size(), Vector2::Zero());
  std::vector<int> counts(state.poses.size(), 0);
  for (const Measurement& one : problem.measurements) {
    if (!is_standing(one)) continue;
    const ViewPattern view = view_of(border, offsets, one);
    const std::size_t pose = idx(one.from - problem.landmark_count());
    sums[pose] +=
        state.landmarks[idx(one.to)] - rotation(state.poses[pose].heading) *
                                           (Vector2(view.ahead, view.left) + one.value.head<2>());
    ++counts[pose];
  }
  RecordingState result = state;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (counts[k] == 0) continue;
    result.poses[k].x = sums[k].x() / counts[k];
    result.poses[k].y = sums[k].y() / counts[k];
  }
  return result;
}

RecordingProblem without_noise(const RecordingProblem& problem,
                               const std::vector<SessionPath>& paths) {
  RecordingProblem result = problem;
  for (const Measurement& one : problem.measurements) {
    if (!is_segment(one)) continue;
    const SessionPath& path = paths[idx(one.session)];
    if (path.missing.empty()) continue;
    std::vector<SegmentRow> rows = result.segments[one.source];
    for (SegmentRow& row : rows) {
      row.path += row.part * path.missing[row.row][0];
      row.turn += row.part * path.missing[row.row][1];
    }
    result.segments[one.source] = std::move(rows);
  }
  return result;
}

}  // namespace

EffectParameters border_as_fitted(const Model& model, const ShapeContext& context,
                                  const EffectParameters& fitted) {
  EffectParameters border = effect_columns(model.effects, context).border;
  for (std::size_t k = 0; k < border.size(); ++k) {
    border[k].held = fitted[k].held;
    border[k].reference = fitted[k].reference;
  }
  return border;
}

NoiseFree::NoiseFree(const std::vector<DrivenRecording>& recordings, const Model& model,
                     const RecordingProblem& fitted, const EffectParameters& fitted_border,
                     const Eigen::VectorXd& offsets, const RecordingState& fitted_state)
    : state(standing_exactly(fitted, fitted_border, offsets, fitted_state)),
      paths(fitted_paths(recordings, model.robot, fitted, fitted_border, offsets, state)),
      problem(without_noise(fitted, paths)),
      context(recordings, model.robot, paths),
      border(border_as_fitted(model, context, fitted_border)) {}

}  // namespace trussmap
