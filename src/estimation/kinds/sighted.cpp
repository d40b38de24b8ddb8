// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/kinds/sighted.hpp"

#include "estimation/kinds/independent_rows.hpp"
#include "estimation/kinds/kinds.hpp"
#include "recording/floor_code.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::estimation {

Sight sight(const Pose& pose, const Vector2& landmark, const effects::ViewPattern& view) {
  const Matrix2 R = rotation(pose.heading);
  const Vector2 lever = R * Vector2(view.ahead, view.left);
  return {landmark - pose.position() - lever, -quarter_turn(lever), -R};
}

MeasurementRows offset_rows(const Ends& at, const Vector4& value,
                            const effects::ViewPattern& view) {
  MeasurementRows rows;
  const Sight seen = sight(at.from, at.landmark, view);
  const Matrix2 R = rotation(-at.from.heading - view.heading);
  const Vector2 offset = R * seen.offset;
  rows.error.head<2>() = offset - value.head<2>();
  rows.by_from.topLeftCorner<2, 2>() = -R;
  rows.by_from.block<2, 1>(0, 2) = R * seen.by_heading - quarter_turn(offset);
  rows.by_to.topLeftCorner<2, 2>() = R;
  rows.by_view.topLeftCorner<2, 2>() = R * seen.by_lever;
  rows.by_view.block<2, 1>(0, 2) = -quarter_turn(offset);
  return rows;
}

MeasurementRows polar_rows(const Ends& at, const Vector4& value, const effects::ViewPattern& view) {
  // A trajectory that folds up may bring the robot onto what it saw from afar; the direction's
  // slope there, which grows without bound, would hold it: it is that of no less than this share of
  // what was measured.
  constexpr double kNearShare = 0.02;
  MeasurementRows rows;
  const Sight seen = sight(at.from, at.landmark, view);
  const double range = std::max(seen.offset.norm(), 1e-9);
  const double far = std::max(range, kNearShare * value[0]);
  Matrix2 polar;  // d(range, direction)/d(offset)
  polar.row(0) = seen.offset.transpose() / range;
  polar.row(1) = quarter_turn(seen.offset).transpose() / (range * far);
  rows.error[0] = range * (1.0 + view.range_scale) + view.range - value[0];
  rows.error[1] =
      wrap_angle(direction(seen.offset) - at.from.heading - view.heading + view.bearing - value[1]);
  polar.row(0) *= 1.0 + view.range_scale;
  rows.by_from.topLeftCorner<2, 2>() = -polar;
  rows.by_from.block<2, 1>(0, 2) = polar * seen.by_heading - Vector2(0.0, 1.0);
  rows.by_to.topLeftCorner<2, 2>() = polar;
  rows.by_view.topLeftCorner<2, 2>() = polar * seen.by_lever;
  rows.by_view(1, 2) = -1.0;
  rows.by_view(0, 3) = 1.0;
  rows.by_view(0, 4) = range;
  rows.by_view(1, 5) = 1.0;
  return rows;
}

void draw_polar(double range, double bearing, const Noise& noise, statistics::NormalDraws& draws,
                Sighting& sighting) {
  const double sd = std::hypot(noise.range, noise.range_relative * range);
  sighting.range = std::max(range + draws(sd), kLeastDrawnRange);
  if (!std::isnan(sighting.bearing)) {
    sighting.bearing = wrap_angle(bearing + draws(noise.bearing));
  }
}

Eigen::MatrixXd Sighted::slack(const Measurement& one, const MeasurementRows& rows,
                               double map_sd) const {
  const Eigen::MatrixXd by_landmark = rows.by_to.topLeftCorner(one.rows, 2);
  return map_sd * map_sd * by_landmark * by_landmark.transpose();
}

namespace kinds {

Measurement measured_by(const Sighting& sighting, const Noise& noise) {
  constexpr double kNearRange = 3.0;  // sds: a range within says nothing of a direction
  if (sighting.standing()) {
    const Vector2 offset = recording::code_from_robot(sighting);
    return independent_rows(standing, {offset.x(), offset.y()}, {noise.sighting, noise.sighting});
  }
  const double sd_range = std::hypot(noise.range, noise.range_relative * sighting.range);
  if (std::isnan(sighting.range)) {
    return independent_rows(direction, {sighting.bearing}, {noise.bearing});
  }
  if (std::isnan(sighting.bearing)) {
    return independent_rows(view, {sighting.range}, {sd_range});
  }
  if (sighting.range > kNearRange * sd_range) {
    return independent_rows(view, {sighting.range, sighting.bearing}, {sd_range, noise.bearing});
  }
  const Vector2 offset = sighting.range * rotation(sighting.bearing).col(0);
  return independent_rows(cartesian_view, {offset.x(), offset.y()}, {sd_range, sd_range});
}

}  // namespace kinds

}  // namespace trussmap::estimation
