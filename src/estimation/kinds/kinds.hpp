// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The kinds of measurement there are, and what makes measurements of a recording's rows. A new one
// is a file here, a line in `all`, and, of rows that no stream has, a line here.
#pragma once

#include "estimation/gyro_excess.hpp"
#include "estimation/measurement_kind.hpp"

#include <optional>
#include <span>

namespace trussmap::estimation::kinds {

extern const MeasurementKind& segment;
extern const MeasurementKind& gyro;
extern const MeasurementKind& standing;
extern const MeasurementKind& view;            ///< range and bearing, or range alone
extern const MeasurementKind& cartesian_view;  ///< the same in robot axes, of a near landmark
extern const MeasurementKind& direction;       ///< bearing alone
extern const MeasurementKind& sighting_yaw;
extern const MeasurementKind& survey;
extern const MeasurementKind& survey_heading;
extern const MeasurementKind& truth;
extern const MeasurementKind& fix;
extern const MeasurementKind& loop;

/// In the order in which they are told.
[[nodiscard]] std::span<const MeasurementKind* const> all();

/// What was driven, and what the gyro adds to that.
[[nodiscard]] Measurement segment_measured(const SegmentMotion& motion, const Matrix4& covariance);
[[nodiscard]] Measurement gyro_measured(const GyroExcess& excess);

/// What rows of a recording measure; their nodes and their place in the recording are still open.
[[nodiscard]] Measurement measured_by(const Sighting& sighting, const Noise& noise);
/// By the sighting's yaw, if it has one.
[[nodiscard]] std::optional<Measurement> yaw_measured(const Sighting& sighting, const Noise& noise);
[[nodiscard]] Measurement measured_by(const TruthRow& row, const Noise& noise);
[[nodiscard]] Measurement measured_by(const Fix& fix, const Noise& noise);
[[nodiscard]] Measurement measured_by(const Loop& loop, const Noise& noise);
[[nodiscard]] Measurement measured_by(const SurveyPoint& point, const Noise& noise);
[[nodiscard]] Measurement heading_measured(const SurveyPoint& point, const Noise& noise);

/// The same rows drawn anew, of a robot at this pose, or moved by this step between both.
void draw(TruthRow& row, const Pose& pose, const effects::ViewPattern& view, const Noise& noise,
          statistics::NormalDraws& draws);
void draw(Fix& fix, const Pose& pose, const effects::ViewPattern& view, const Noise& noise,
          statistics::NormalDraws& draws);
void draw(Loop& loop, const Pose& robot_step, const effects::ViewPattern& view, const Noise& noise,
          statistics::NormalDraws& draws);
/// A surveyed place, and heading, drawn anew.
[[nodiscard]] Vector2 drawn_place(const SurveyPoint& point, const Vector2& place,
                                  const Noise& noise, statistics::NormalDraws& draws);
[[nodiscard]] double drawn_heading(double orientation, const Noise& noise,
                                   statistics::NormalDraws& draws);

}  // namespace trussmap::estimation::kinds
