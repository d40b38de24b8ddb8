// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/measurement_rows.hpp"

namespace trussmap::estimation {
namespace {

/// Per session a pattern per row; nullptr of a stream that is no view.
const std::vector<std::vector<effects::ViewPattern>>* views_of(const EffectPattern& effect,
                                                               RecordingStream stream) {
  switch (stream) {
    case RecordingStream::sightings:
      return &effect.sightings;
    case RecordingStream::truth:
      return &effect.truths;
    case RecordingStream::fixes:
      return &effect.fixes;
    case RecordingStream::loops:
      return &effect.loops;
    case RecordingStream::drive:
    case RecordingStream::survey:
      break;
  }
  return nullptr;
}

const effects::ViewPattern* unit_view_of(const EffectPattern& effect, RecordingStream stream,
                                         std::size_t session, std::size_t row) {
  const auto* views = views_of(effect, stream);
  if (views == nullptr || views->empty() || (*views)[session].empty()) return nullptr;
  return &(*views)[session][row];
}

}  // namespace

const effects::ViewPattern* unit_view_of(const EffectPattern& effect, const Measurement& one) {
  if (one.session < 0) return nullptr;
  return unit_view_of(effect, one.kind->facts().stream, idx(one.session), one.source);
}

effects::ViewPattern view_of(const EffectParameters& border, const Eigen::VectorXd& offsets,
                             RecordingStream stream, std::size_t session, std::size_t row,
                             const effects::ViewPattern& mounted) {
  effects::ViewPattern sum = mounted;
  for (std::size_t k = 0; k < border.size(); ++k) {
    const effects::ViewPattern* pattern = unit_view_of(border[k], stream, session, row);
    if (pattern != nullptr) sum.add(offsets[static_cast<Eigen::Index>(k)], *pattern);
  }
  return sum;
}

effects::ViewPattern view_of(const EffectParameters& border, const Eigen::VectorXd& offsets,
                             const Measurement& one) {
  if (one.session < 0) return {};
  return view_of(border, offsets, one.kind->facts().stream, idx(one.session), one.source,
                 one.mounted);
}

Ends ends_of(const RecordingProblem& problem, const Measurement& measurement,
             const RecordingState& state) {
  Ends ends;
  const KindFacts& facts = measurement.kind->facts();
  const auto take = [&](NodeType type, int node, Pose& pose) {
    switch (type) {
      case NodeType::pose:
        pose = state.poses[idx(node - problem.landmark_count())];
        break;
      case NodeType::landmark:
        ends.landmark = state.landmarks[idx(node)];
        break;
      case NodeType::orientation:
        ends.orientation = state.orientations[idx(node - problem.pose_end())];
        break;
      case NodeType::none:
        break;
    }
  };
  take(facts.from, measurement.from, ends.from);
  take(facts.to, measurement.to, ends.to);
  return ends;
}

MeasurementRows measurement_rows(const RecordingProblem& problem, const Measurement& measurement,
                                 const RecordingState& state, const Vector4& value,
                                 const effects::ViewPattern& view) {
  return measurement.kind->rows(measurement, ends_of(problem, measurement, state), value, view);
}

}  // namespace trussmap::estimation
