// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What sightings of a landmark have in common.
//
//   p, theta  robot pose; q = p + R(theta) (ahead, left) its sensor; l a landmark
//   delta     l - q
#pragma once

#include "estimation/measurement_kind.hpp"

namespace trussmap::estimation {

/// From the robot's sensor to a landmark, and how it changes with the pose and the sensor's place.
struct Sight {
  Vector2 offset;      ///< delta, map axes
  Vector2 by_heading;  ///< of the robot
  Matrix2 by_lever;    ///< of (ahead, left)
};
[[nodiscard]] Sight sight(const Pose& pose, const Vector2& landmark,
                          const effects::ViewPattern& view);

/// q.
[[nodiscard]] inline Vector2 sensor_at(const Pose& pose, const effects::ViewPattern& view) {
  return pose.position() + rotation(pose.heading) * Vector2(view.ahead, view.left);
}

/// The landmark's place in the sensor's axes: R(theta + heading)' delta - offset.
[[nodiscard]] MeasurementRows offset_rows(const Ends& at, const Vector4& value,
                                          const effects::ViewPattern& view);

/// Range and bearing: |delta| - range,  direction(delta) - theta - bearing.
[[nodiscard]] MeasurementRows polar_rows(const Ends& at, const Vector4& value,
                                         const effects::ViewPattern& view);

inline constexpr double kLeastDrawnRange = 1e-6;  ///< m

/// A range and, where the sighting has one, a bearing drawn anew.
void draw_polar(double range, double bearing, const Noise& noise, statistics::NormalDraws& draws,
                Sighting& sighting);

class Sighted : public MeasurementKind {
 public:
  /// Of the facts those in which they differ.
  constexpr explicit Sighted(KindFacts facts) : MeasurementKind(of_landmark(facts)) {}

  /// The landmark is where it is known to be, within so much.
  [[nodiscard]] Eigen::MatrixXd slack(const Measurement& one, const MeasurementRows& rows,
                                      double map_sd) const override;

 protected:
  ~Sighted() = default;

 private:
  static constexpr KindFacts of_landmark(KindFacts facts) {
    facts.several = "sightings";
    facts.stream = RecordingStream::sightings;
    facts.to = NodeType::landmark;
    facts.noise_is_sought = true;
    facts.may_be_wrong = true;
    return facts;
  }
};

}  // namespace trussmap::estimation
