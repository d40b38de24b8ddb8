// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One pose as the robot measured it from another: R(theta_i)'(p_j - p_i) - d,
// theta_j - theta_i - a. A loop does not count turns.
#include "estimation/kinds/independent_rows.hpp"
#include "estimation/kinds/kinds.hpp"
#include "estimation/kinds/way_rows.hpp"

#include <cmath>

namespace trussmap {
namespace {

class LoopKind final : public MeasurementKind {
 public:
  using MeasurementKind::MeasurementKind;

  [[nodiscard]] MeasurementRows rows(const Measurement&, const Ends& at, const Vector4& value,
                                     const ViewPattern&) const override {
    MeasurementRows rows = way_rows(at.from, at.to, value);
    rows.error[2] = wrap_angle(rows.error[2]);
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
                                .curvature = Curvature::of_a_way}};

}  // namespace

const MeasurementKind& kinds::loop = kLoop;

Measurement kinds::measured_by(const Loop& loop, const Noise& noise) {
  const double sd = stated_or(loop.sd, noise.loop);
  Measurement one = independent_rows(kLoop, {loop.dx, loop.dy, loop.dtheta},
                                     {sd, sd, stated_or(loop.sd_heading, noise.loop_heading)});
  one.own_sd = !std::isnan(loop.sd) && !std::isnan(loop.sd_heading);
  return one;
}

void kinds::draw(Loop& loop, const Pose& step, const Noise& noise, NormalDraws& draws) {
  const double sd = stated_or(loop.sd, noise.loop);
  loop.dx = step.x + draws(sd);
  loop.dy = step.y + draws(sd);
  loop.dtheta = wrap_angle(step.heading + draws(stated_or(loop.sd_heading, noise.loop_heading)));
}

}  // namespace trussmap
