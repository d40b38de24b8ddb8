// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/measured_rows.hpp"

#include "recording/floor_code.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap {
namespace {

constexpr double kExactSd = 1e-6;   // m or rad: what is called exact is this exact
constexpr double kNearRange = 3.0;  // sds

/// A row per value.
Measurement independent(MeasurementKind kind, std::initializer_list<double> values,
                        std::initializer_list<double> sds) {
  Measurement one;
  one.kind = kind;
  one.rows = static_cast<int>(values.size());
  std::copy(values.begin(), values.end(), one.value.data());
  Eigen::Index k = 0;
  for (const double sd : sds) {
    one.whitener(k, k) = 1.0 / std::max(sd, kExactSd);
    ++k;
  }
  return one;
}

double stated_or(double sd, double otherwise) {
  return std::isnan(sd) ? otherwise : sd;
}

}  // namespace

Measurement measured_by(const Sighting& sighting, const Noise& noise) {
  if (sighting.standing()) {
    const Vector2 offset = code_from_robot(sighting);
    return independent(MeasurementKind::standing, {offset.x(), offset.y()},
                       {noise.sighting, noise.sighting});
  }
  const double sd_range = std::hypot(noise.range, noise.range_relative * sighting.range);
  if (std::isnan(sighting.range)) {
    return independent(MeasurementKind::direction, {sighting.bearing}, {noise.bearing});
  }
  if (std::isnan(sighting.bearing)) {
    return independent(MeasurementKind::view, {sighting.range}, {sd_range});
  }
  if (sighting.range > kNearRange * sd_range) {
    return independent(MeasurementKind::view, {sighting.range, sighting.bearing},
                       {sd_range, noise.bearing});
  }
  const Vector2 offset = sighting.range * rotation(sighting.bearing).col(0);
  return independent(MeasurementKind::cartesian_view, {offset.x(), offset.y()},
                     {sd_range, sd_range});
}

std::optional<Measurement> yaw_measured(const Sighting& sighting, const Noise& noise) {
  if (std::isnan(sighting.yaw)) return std::nullopt;
  return independent(MeasurementKind::sighting_yaw, {sighting.yaw}, {noise.yaw});
}

Measurement measured_by(const TruthRow& row, const Noise& noise) {
  return independent(MeasurementKind::truth, {row.x, row.y, row.heading},
                     {noise.truth, noise.truth, noise.truth_heading});
}

Measurement measured_by(const Fix& fix, const Noise& noise) {
  const double sd = stated_or(fix.sd, noise.fix);
  return independent(MeasurementKind::fix, {fix.x, fix.y}, {sd, sd});
}

Measurement measured_by(const Loop& loop, const Noise& noise) {
  const double sd = stated_or(loop.sd, noise.loop);
  return independent(MeasurementKind::loop, {loop.dx, loop.dy, loop.dtheta},
                     {sd, sd, stated_or(loop.sd_heading, noise.loop_heading)});
}

Measurement measured_by(const SurveyPoint& point, const Noise& noise) {
  const double sd = stated_or(point.sd, noise.survey);
  return independent(MeasurementKind::survey, {point.x, point.y}, {sd, sd});
}

Measurement heading_measured(const SurveyPoint& point, const Noise& noise) {
  return independent(MeasurementKind::survey_heading, {point.heading}, {noise.yaw});
}

}  // namespace trussmap
