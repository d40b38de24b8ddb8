// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/second_order.hpp"

namespace trussmap::estimation {
namespace {

constexpr double kStep = 1e-5;  // m, rad or fraction

using Slopes = Eigen::Matrix<double, 15, 1>;

effects::ViewPattern pattern_of(const effects::ViewVector& v) {
  return {v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]};
}

/// One of a node's numbers.
double& number_of(const RecordingProblem& problem, RecordingState& state, int node, int place) {
  if (problem.is_landmark(node)) return state.landmarks[idx(node)][place];
  if (problem.is_orientation(node)) return state.orientations[idx(node - problem.pose_end())];
  Pose& pose = state.poses[idx(node - problem.landmark_count())];
  return place == 0 ? pose.x : place == 1 ? pose.y : pose.heading;
}

Vector2 place_of(const RecordingProblem& problem, const RecordingState& state, int node) {
  if (problem.is_landmark(node)) return state.landmarks[idx(node)];
  return state.poses[idx(node - problem.landmark_count())].position();
}

SecondOrder second_order_of_way(const RecordingProblem& problem, const Measurement& one,
                                const RecordingState& state, const effects::ViewPattern& view,
                                const Vector4& weighted) {
  const bool by_view = one.kind->facts().curvature == Curvature::of_a_way_by_view;
  const double turn = by_view ? view.heading : 0.0;
  const Pose& from = state.poses[idx(one.from - problem.landmark_count())];
  const Vector2 pull = rotation(from.heading + turn) * weighted.head<2>();
  const Vector2 turned = quarter_turn(pull);
  SecondOrder result = SecondOrder::Zero();
  // The point that the way goes from is the axle's; what lies ahead of it turns with the robot.
  result(2, 2) = -pull.dot(place_of(problem, state, one.to) - from.position());
  result.block<2, 1>(0, 2) = -turned;
  result.block<2, 1>(kSecondOrderTo, 2) = turned;
  result.row(2) = result.col(2).transpose();
  return result;
}

}  // namespace

SecondOrder second_order(const RecordingProblem& problem, const Measurement& one,
                         RecordingState& state, const effects::ViewPattern& view,
                         const Vector4& weighted, bool with_view) {
  SecondOrder result = SecondOrder::Zero();
  const Curvature curvature = one.kind->facts().curvature;
  if (curvature == Curvature::none) return result;
  const bool bent = curvature == Curvature::of_a_way_without_view && !view.vector().isZero(0.0);
  if (curvature != Curvature::general && !with_view && !bent) {
    return second_order_of_way(problem, one, state, view, weighted);
  }
  const auto slopes = [&](const effects::ViewPattern& at) -> Slopes {
    const MeasurementRows rows = measurement_rows(problem, one, state, one.value, at);
    Slopes all;
    all << rows.by_from.transpose() * weighted, rows.by_to.transpose() * weighted,
        rows.by_view.transpose() * weighted;
    return all;
  };
  const auto differentiate = [&](int node, int column) {
    if (node < 0) return;
    for (int place = 0; place < problem.size_of(node); ++place) {
      double& number = number_of(problem, state, node, place);
      const double value = number;
      number = value + kStep;
      const Slopes above = slopes(view);
      number = value - kStep;
      const Slopes below = slopes(view);
      number = value;
      result.col(column + place) = (above - below) / (2.0 * kStep);
    }
  };
  differentiate(one.from, 0);
  differentiate(one.to, kSecondOrderTo);
  if (with_view && !is_driven(one)) {
    for (Eigen::Index k = 0; k < effects::ViewVector::RowsAtCompileTime; ++k) {
      const effects::ViewVector step = kStep * effects::ViewVector::Unit(k);
      result.col(kSecondOrderView + k) =
          (slopes(pattern_of(view.vector() + step)) - slopes(pattern_of(view.vector() - step))) /
          (2.0 * kStep);
    }
  }
  return 0.5 * (result + result.transpose());
}

SegmentBends segment_bends(const RecordingProblem& problem, const Measurement& segment,
                           const EffectParameters& border, const Eigen::VectorXd& offsets) {
  const std::vector<int> unknown = unknown_coefficients(border);
  const auto count = static_cast<Eigen::Index>(unknown.size());
  SegmentBends result;
  result.fill(Eigen::MatrixXd::Zero(count, count));
  const std::vector<const std::vector<effects::DrivePattern>*> patterns =
      drive_patterns(border, idx(segment.session));
  for (Eigen::Index c = 0; c < count; ++c) {
    const int place = unknown[idx(static_cast<int>(c))];
    if (patterns[idx(place)] == nullptr) continue;
    Eigen::VectorXd at = offsets;
    at[place] += kStep;
    const auto above = segment_motion(problem.segments[segment.source], patterns, at).derivatives;
    at[place] -= 2.0 * kStep;
    const auto below = segment_motion(problem.segments[segment.source], patterns, at).derivatives;
    for (Eigen::Index other = 0; other < count; ++other) {
      const int row = unknown[idx(static_cast<int>(other))];
      for (std::size_t k = 0; k < result.size(); ++k) {
        const auto number = static_cast<Eigen::Index>(k);
        result[k](other, c) = (above(number, row) - below(number, row)) / (2.0 * kStep);
      }
    }
  }
  for (Eigen::MatrixXd& one : result) one = 0.5 * (one + one.transpose()).eval();
  return result;
}

}  // namespace trussmap::estimation
