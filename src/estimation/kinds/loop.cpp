// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One pose of the robot's scanner as it was measured from another, in the scanner's axes; it sits
// at s = (ahead, left) and looks `heading` further left than the robot:
//
//   R(heading)' (R(theta_i)'(p_j - p_i) + R(theta_j - theta_i) s - s) - d,  theta_j - theta_i - a
//
// A loop does not count turns.
#include "estimation/kinds/independent_rows.hpp"
#include "estimation/kinds/kinds.hpp"
#include "estimation/kinds/way_rows.hpp"

#include <cmath>

namespace trussmap::estimation {
namespace {

class LoopKind final : public MeasurementKind {
 public:
  using MeasurementKind::MeasurementKind;

  [[nodiscard]] MeasurementRows rows(const Measurement&, const Ends& at, const Vector4& value,
                                     const effects::ViewPattern& view) const override {
    MeasurementRows rows = way_rows(at.from, at.to, value);
    rows.error[2] = wrap_angle(rows.error[2]);
    const Vector2 s(view.ahead, view.left);
    const Matrix2 turned = rotation(at.to.heading - at.from.heading);
    const Matrix2 into = rotation(-view.heading);
    const Vector2 swung = turned * s;
    const Vector2 way = into * (rows.error.head<2>() + value.head<2>() + swung - s);
    rows.error.head<2>() = way - value.head<2>();
    rows.by_from.topLeftCorner<2, 3>() = into * rows.by_from.topLeftCorner<2, 3>();
    rows.by_to.topLeftCorner<2, 3>() = into * rows.by_to.topLeftCorner<2, 3>();
    const Vector2 by_turn = into * quarter_turn(swung);
    rows.by_from.block<2, 1>(0, 2) -= by_turn;
    rows.by_to.block<2, 1>(0, 2) += by_turn;
    rows.by_view.topLeftCorner<2, 2>() = into * (turned - Matrix2::Identity());
    rows.by_view.block<2, 1>(0, 2) = -quarter_turn(way);
    return rows;
  }
};

constinit const LoopKind kLoop{{.words = "loop",
                                .several = "loops",
                                .stream = RecordingStream::loops,
                                .from = NodeType::pose,
                                .to = NodeType::pose,
                                .noise = "loop",
                                .other_from = 2,
                                .other_noise = "loop_heading",
                                .may_be_wrong = true,
                                .curvature = Curvature::of_a_way_without_view}};

}  // namespace

const MeasurementKind& kinds::loop = kLoop;

Measurement kinds::measured_by(const Loop& loop, const Noise& noise) {
  const double sd = stated_or(loop.sd, noise.loop);
  Measurement one = independent_rows(kLoop, {loop.dx, loop.dy, loop.dtheta},
                                     {sd, sd, stated_or(loop.sd_heading, noise.loop_heading)});
  one.own_sd = !std::isnan(loop.sd) && !std::isnan(loop.sd_heading);
  return one;
}

void kinds::draw(Loop& loop, const Pose& robot_step, const effects::ViewPattern& view,
                 const Noise& noise, statistics::NormalDraws& draws) {
  const Pose scanner{view.ahead, view.left, view.heading};
  const Pose step = compose(inverse(scanner), compose(robot_step, scanner));
  const double sd = stated_or(loop.sd, noise.loop);
  loop.dx = step.x + draws(sd);
  loop.dy = step.y + draws(sd);
  loop.dtheta = wrap_angle(step.heading + draws(stated_or(loop.sd_heading, noise.loop_heading)));
}

}  // namespace trussmap::estimation
