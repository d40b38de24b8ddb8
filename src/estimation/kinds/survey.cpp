// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A landmark's place in the map, and its own axis, measured by somebody else: l - s,  phi - h.
#include "estimation/kinds/independent_rows.hpp"
#include "estimation/kinds/kinds.hpp"

#include <cmath>

namespace trussmap::estimation {
namespace {

class SurveyKind final : public MeasurementKind {
 public:
  using MeasurementKind::MeasurementKind;

  [[nodiscard]] MeasurementRows rows(const Measurement&, const Ends& at, const Vector4& value,
                                     const effects::ViewPattern&) const override {
    MeasurementRows rows;
    rows.error.head<2>() = at.landmark - value.head<2>();
    rows.by_from.topLeftCorner<2, 2>().setIdentity();
    return rows;
  }
};

constinit const SurveyKind kSurvey{{.words = "survey of",
                                    .several = "survey points",
                                    .stream = RecordingStream::survey,
                                    .from = NodeType::landmark,
                                    .in_map = InMap::place,
                                    .noise = "survey",
                                    .curvature = Curvature::none}};

class SurveyHeadingKind final : public MeasurementKind {
 public:
  using MeasurementKind::MeasurementKind;

  [[nodiscard]] MeasurementRows rows(const Measurement&, const Ends& at, const Vector4& value,
                                     const effects::ViewPattern&) const override {
    MeasurementRows rows;
    rows.error[0] = wrap_angle(at.orientation - value[0]);
    rows.by_from(0, 0) = 1.0;
    return rows;
  }
};

constinit const SurveyHeadingKind kSurveyHeading{{.words = "surveyed heading of",
                                                  .several = "surveyed headings",
                                                  .stream = RecordingStream::survey,
                                                  .from = NodeType::orientation,
                                                  .in_map = InMap::heading,
                                                  .noise = "survey",
                                                  .curvature = Curvature::none}};

}  // namespace

const MeasurementKind& kinds::survey = kSurvey;
const MeasurementKind& kinds::survey_heading = kSurveyHeading;

Measurement kinds::measured_by(const SurveyPoint& point, const Noise& noise) {
  const double sd = stated_or(point.sd, noise.survey);
  Measurement one = independent_rows(survey, {point.x, point.y}, {sd, sd});
  one.own_sd = !std::isnan(point.sd);
  return one;
}

Vector2 kinds::drawn_place(const SurveyPoint& point, const Vector2& place, const Noise& noise,
                           statistics::NormalDraws& draws) {
  const double sd = stated_or(point.sd, noise.survey);
  return place + Vector2(draws(sd), draws(sd));
}

Measurement kinds::heading_measured(const SurveyPoint& point, const Noise& noise) {
  return independent_rows(survey_heading, {point.heading}, {noise.yaw});
}

double kinds::drawn_heading(double orientation, const Noise& noise,
                            statistics::NormalDraws& draws) {
  return orientation + draws(noise.yaw);
}

}  // namespace trussmap::estimation
