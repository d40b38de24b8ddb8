// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The robot's pose, measured independently: q - t,  theta + heading - h.
#include "estimation/kinds/independent_rows.hpp"
#include "estimation/kinds/kinds.hpp"
#include "estimation/kinds/sighted.hpp"

namespace trussmap::estimation {
namespace {

class TruthKind final : public MeasurementKind {
 public:
  using MeasurementKind::MeasurementKind;

  [[nodiscard]] MeasurementRows rows(const Measurement&, const Ends& at, const Vector4& value,
                                     const effects::ViewPattern& view) const override {
    MeasurementRows rows;
    const Pose& pose = at.from;
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

  [[nodiscard]] std::optional<Vector2> seen_from(const Measurement&, const Pose& pose,
                                                 const effects::ViewPattern& view) const override {
    return sensor_at(pose, view);
  }
};

constinit const TruthKind kTruth{{.words = "truth",
                                  .several = "truth rows",
                                  .stream = RecordingStream::truth,
                                  .from = NodeType::pose,
                                  .in_map = InMap::pose,
                                  .noise = "truth",
                                  .other_from = 2,
                                  .other_noise = "truth_heading",
                                  .noise_is_sought = true}};

}  // namespace

const MeasurementKind& kinds::truth = kTruth;

Measurement kinds::measured_by(const TruthRow& row, const Noise& noise) {
  return independent_rows(truth, {row.x, row.y, row.heading},
                          {noise.truth, noise.truth, noise.truth_heading});
}

void kinds::draw(TruthRow& row, const Pose& pose, const effects::ViewPattern& view,
                 const Noise& noise, statistics::NormalDraws& draws) {
  const Vector2 place = sensor_at(pose, view);
  row.x = place.x() + draws(noise.truth);
  row.y = place.y() + draws(noise.truth);
  row.heading = wrap_angle(pose.heading + view.heading + draws(noise.truth_heading));
}

}  // namespace trussmap::estimation
