// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/measurement_rows.hpp"

#include <algorithm>

namespace trussmap {
namespace {

MeasurementRows segment_rows(const Measurement& one, const Pose& from, const Pose& to,
                             const Vector4& value) {
  MeasurementRows rows;
  const Matrix2 R = rotation(-from.heading);
  const Vector2 seen = R * (to.position() - from.position());
  rows.error.head<2>() = seen - value.head<2>();
  rows.error[2] = to.heading - from.heading - value[2];
  rows.by_from.topLeftCorner<2, 2>() = -R;
  rows.by_from.block<2, 1>(0, 2) = -quarter_turn(seen);
  rows.by_from(2, 2) = -1.0;
  rows.by_to.topLeftCorner<2, 2>() = R;
  rows.by_to(2, 2) = 1.0;
  if (one.rows == 4) {
    rows.error[3] = wrap_angle(from.heading - value[3]);
    rows.by_from(3, 2) = 1.0;
  }
  return rows;
}

/// From the robot's sensor to a landmark, and how it changes with the pose and the sensor's place.
struct Sight {
  Vector2 offset;                        ///< map axes
  Vector2 by_heading;                    ///< of the robot
  Eigen::Matrix<double, 2, 2> by_lever;  ///< of (ahead, left)
};

Sight sight(const Pose& pose, const Vector2& landmark, const ViewPattern& view) {
  const Matrix2 R = rotation(pose.heading);
  const Vector2 lever = R * Vector2(view.ahead, view.left);
  return {landmark - pose.position() - lever, -quarter_turn(lever), -R};
}

MeasurementRows view_rows(const Measurement& one, const Pose& pose, const Vector2& landmark,
                          const Vector4& value, const ViewPattern& view) {
  MeasurementRows rows;
  const Sight seen = sight(pose, landmark, view);
  const double range = std::max(seen.offset.norm(), 1e-9);
  Matrix2 polar;  // d(range, direction)/d(offset)
  polar.row(0) = seen.offset.transpose() / range;
  polar.row(1) = quarter_turn(seen.offset).transpose() / (range * range);
  rows.error[0] = range * (1.0 + view.range_scale) + view.range - value[0];
  rows.error[1] =
      wrap_angle(direction(seen.offset) - pose.heading - view.heading + view.bearing - value[1]);
  polar.row(0) *= 1.0 + view.range_scale;
  rows.by_from.topLeftCorner<2, 2>() = -polar;
  rows.by_from.block<2, 1>(0, 2) = polar * seen.by_heading - Vector2(0.0, 1.0);
  rows.by_to.topLeftCorner<2, 2>() = polar;
  rows.by_view.topLeftCorner<2, 2>() = polar * seen.by_lever;
  rows.by_view(1, 2) = -1.0;
  rows.by_view(0, 3) = 1.0;
  rows.by_view(0, 4) = range;
  rows.by_view(1, 5) = 1.0;
  if (one.rows == 1) {
    rows.error[1] = 0.0;
    rows.by_from.row(1).setZero();
    rows.by_to.row(1).setZero();
    rows.by_view.row(1).setZero();
  }
  return rows;
}

/// Of a view its bearing alone.
MeasurementRows direction_rows(const Measurement& one, const Pose& pose, const Vector2& landmark,
                               const Vector4& value, const ViewPattern& view) {
  Measurement both = one;
  both.rows = 2;
  MeasurementRows rows = view_rows(both, pose, landmark, Vector4(0.0, value[0], 0.0, 0.0), view);
  rows.error.head<2>() << rows.error[1], 0.0;
  for (auto* part : {&rows.by_from, &rows.by_to}) {
    part->row(0) = part->row(1);
    part->row(1).setZero();
  }
  rows.by_view.row(0) = rows.by_view.row(1);
  rows.by_view.row(1).setZero();
  return rows;
}

MeasurementRows cartesian_view_rows(const Pose& pose, const Vector2& landmark, const Vector4& value,
                                    const ViewPattern& view) {
  MeasurementRows rows;
  const Sight seen = sight(pose, landmark, view);
  const Matrix2 R = rotation(-pose.heading - view.heading);
  const Vector2 offset = R * seen.offset;
  rows.error.head<2>() = offset - value.head<2>();
  rows.by_from.topLeftCorner<2, 2>() = -R;
  rows.by_from.block<2, 1>(0, 2) = R * seen.by_heading - quarter_turn(offset);
  rows.by_to.topLeftCorner<2, 2>() = R;
  rows.by_view.topLeftCorner<2, 2>() = R * seen.by_lever;
  rows.by_view.block<2, 1>(0, 2) = -quarter_turn(offset);
  return rows;
}

/// In robot axes too: the map turned as a whole then changes no error, not even to first order
/// where the errors are large, and a free direction stays recognisable.
MeasurementRows standing_rows(const Pose& pose, const Vector2& landmark, const Vector4& value,
                              const ViewPattern& view) {
  ViewPattern place = view;
  place.heading = 0.0;
  MeasurementRows rows = cartesian_view_rows(pose, landmark, value, place);
  rows.by_view.col(2).setZero();
  return rows;
}

MeasurementRows yaw_rows(const Pose& pose, double orientation, const Vector4& value,
                         const ViewPattern& view) {
  MeasurementRows rows;
  rows.error[0] = wrap_angle(orientation - pose.heading - view.heading + view.yaw - value[0]);
  rows.by_from(0, 2) = -1.0;
  rows.by_to(0, 0) = 1.0;
  rows.by_view(0, 2) = -1.0;
  rows.by_view(0, 8) = 1.0;
  return rows;
}

MeasurementRows truth_rows(const Pose& pose, const Vector4& value, const ViewPattern& view) {
  MeasurementRows rows;
  const Matrix2 R = rotation(pose.heading);
  const Vector2 lever = R * Vector2(view.ahead, view.left);
  rows.error.head<2>() = pose.position() + lever - value.head<2>();
  rows.error[2] = wrap_angle(pose.heading + view.heading - value[2]);
  rows.by_from.topLeftCorner<3, 3>().setIdentity();
  rows.by_from.block<2, 1>(0, 2) = quarter_turn(lever);
  rows.by_view.topLeftCorner<2, 2>() = R;
  rows.by_view(2, 2) = 1.0;
  return rows;
}

/// The way to the antenna turns with the heading of the view: a late fix is one of another heading.
MeasurementRows fix_rows(const Pose& pose, const Vector4& value, const ViewPattern& view) {
  MeasurementRows rows;
  const Matrix2 R = rotation(pose.heading + view.heading);
  const Vector2 antenna = R * Vector2(view.ahead, view.left);
  rows.error.head<2>() = pose.position() + antenna + Vector2(view.x, view.y) - value.head<2>();
  rows.by_from.topLeftCorner<2, 2>().setIdentity();
  rows.by_from.block<2, 1>(0, 2) = quarter_turn(antenna);
  rows.by_view.topLeftCorner<2, 2>() = R;
  rows.by_view.block<2, 1>(0, 2) = quarter_turn(antenna);
  rows.by_view.block<2, 2>(0, 6).setIdentity();
  return rows;
}

MeasurementRows loop_rows(const Measurement& one, const Pose& from, const Pose& to,
                          const Vector4& value) {
  MeasurementRows rows = segment_rows(one, from, to, value);
  rows.error[2] = wrap_angle(rows.error[2]);  // a loop does not count turns
  return rows;
}

}  // namespace

const ViewPattern* unit_view_of(const EffectPattern& effect, const Measurement& one) {
  if (one.session < 0 || is_driven(one.kind) || one.kind == MeasurementKind::loop) {
    return nullptr;
  }
  const auto& views = one.kind == MeasurementKind::truth ? effect.truths
                      : one.kind == MeasurementKind::fix ? effect.fixes
                                                         : effect.sightings;
  if (views.empty() || views[idx(one.session)].empty()) return nullptr;
  return &views[idx(one.session)][one.source];
}

ViewPattern view_of(const EffectParameters& border, const Eigen::VectorXd& offsets,
                    const Measurement& one) {
  ViewPattern sum;
  for (std::size_t k = 0; k < border.size(); ++k) {
    const ViewPattern* pattern = unit_view_of(border[k], one);
    if (pattern != nullptr) sum.add(offsets[static_cast<Eigen::Index>(k)], *pattern);
  }
  return sum;
}

MeasurementRows measurement_rows(const RecordingProblem& problem, const Measurement& measurement,
                                 const RecordingState& state, const Vector4& value,
                                 const ViewPattern& view) {
  const auto pose = [&](int node) -> const Pose& {
    return state.poses[idx(node - problem.landmark_count())];
  };
  const auto landmark = [&](int node) -> const Vector2& { return state.landmarks[idx(node)]; };
  const auto orientation = [&](int node) {
    return state.orientations[idx(node - problem.pose_end())];
  };
  switch (measurement.kind) {
    case MeasurementKind::segment:
      return segment_rows(measurement, pose(measurement.from), pose(measurement.to), value);
    case MeasurementKind::gyro: {
      MeasurementRows rows;
      rows.error = -value;
      return rows;
    }
    case MeasurementKind::standing:
      return standing_rows(pose(measurement.from), landmark(measurement.to), value, view);
    case MeasurementKind::view:
      return view_rows(measurement, pose(measurement.from), landmark(measurement.to), value, view);
    case MeasurementKind::direction:
      return direction_rows(measurement, pose(measurement.from), landmark(measurement.to), value,
                            view);
    case MeasurementKind::cartesian_view:
      return cartesian_view_rows(pose(measurement.from), landmark(measurement.to), value, view);
    case MeasurementKind::sighting_yaw:
      return yaw_rows(pose(measurement.from), orientation(measurement.to), value, view);
    case MeasurementKind::survey_heading: {
      MeasurementRows rows;
      rows.error[0] = wrap_angle(orientation(measurement.from) - value[0]);
      rows.by_from(0, 0) = 1.0;
      return rows;
    }
    case MeasurementKind::truth:
      return truth_rows(pose(measurement.from), value, view);
    case MeasurementKind::fix:
      return fix_rows(pose(measurement.from), value, view);
    case MeasurementKind::loop:
      return loop_rows(measurement, pose(measurement.from), pose(measurement.to), value);
    case MeasurementKind::survey:
      break;
  }
  MeasurementRows rows;
  rows.error.head<2>() = landmark(measurement.from) - value.head<2>();
  rows.by_from.topLeftCorner<2, 2>().setIdentity();
  return rows;
}

}  // namespace trussmap
