// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The place of the robot's antenna, by a receiver:
//
//   p + R(theta + heading) (ahead, left) + (x, y) - f
//
// The way to the antenna turns with the heading of the view: a late fix is one of another heading.
#include "estimation/kinds/independent_rows.hpp"
#include "estimation/kinds/kinds.hpp"

#include <cmath>

namespace trussmap::estimation {
namespace {

/// In map axes, from the robot.
Vector2 antenna_of(const Pose& pose, const effects::ViewPattern& view) {
  return rotation(pose.heading + view.heading) * Vector2(view.ahead, view.left);
}

class FixKind final : public MeasurementKind {
 public:
  using MeasurementKind::MeasurementKind;

  [[nodiscard]] MeasurementRows rows(const Measurement&, const Ends& at, const Vector4& value,
                                     const effects::ViewPattern& view) const override {
    MeasurementRows rows;
    const Matrix2 R = rotation(at.from.heading + view.heading);
    const Vector2 antenna = R * Vector2(view.ahead, view.left);
    rows.error.head<2>() = at.from.position() + antenna + Vector2(view.x, view.y) - value.head<2>();
    rows.by_from.topLeftCorner<2, 2>().setIdentity();
    rows.by_from.block<2, 1>(0, 2) = quarter_turn(antenna);
    rows.by_view.topLeftCorner<2, 2>() = R;
    rows.by_view.block<2, 1>(0, 2) = quarter_turn(antenna);
    rows.by_view.block<2, 2>(0, 6).setIdentity();
    return rows;
  }

  [[nodiscard]] Matrix4 reading_variance(Channel channel, const Measurement&) const override {
    Matrix4 variance = Matrix4::Zero();
    if (channel == Channel::fix_x) variance(0, 0) = 1.0;
    if (channel == Channel::fix_y) variance(1, 1) = 1.0;
    return variance;
  }

  [[nodiscard]] std::optional<Vector2> seen_from(const Measurement&, const Pose& pose,
                                                 const effects::ViewPattern& view) const override {
    return pose.position() + antenna_of(pose, view) + Vector2(view.x, view.y);
  }

  /// The antenna is taken to be at the robot, as nearly as a landmark is known.
  [[nodiscard]] Eigen::MatrixXd slack(const Measurement&, const MeasurementRows&,
                                      double map_sd) const override {
    return map_sd * map_sd * Matrix2::Identity();
  }
};

constinit const FixKind kFix{{.words = "fix",
                              .several = "fixes",
                              .stream = RecordingStream::fixes,
                              .from = NodeType::pose,
                              .in_map = InMap::place,
                              .noise = "fix",
                              .noise_is_sought = true,
                              .may_be_wrong = true}};

}  // namespace

const MeasurementKind& kinds::fix = kFix;

Measurement kinds::measured_by(const Fix& fix, const Noise& noise) {
  const double sd = stated_or(fix.sd, noise.fix);
  Measurement one = independent_rows(kFix, {fix.x, fix.y}, {sd, sd});
  one.own_sd = !std::isnan(fix.sd);
  return one;
}

void kinds::draw(Fix& fix, const Pose& pose, const effects::ViewPattern& view, const Noise& noise,
                 statistics::NormalDraws& draws) {
  const Vector2 antenna = antenna_of(pose, view);
  const double sd = stated_or(fix.sd, noise.fix);
  fix.x = pose.x + antenna.x() + view.x + draws(sd);
  fix.y = pose.y + antenna.y() + view.y + draws(sd);
}

}  // namespace trussmap::estimation
