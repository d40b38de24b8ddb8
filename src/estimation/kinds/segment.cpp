// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What was driven from one pose to the next, and the mean innovation of the compass on the way:
//
//   R(theta_i)'(p_j - p_i) - d,  theta_j - theta_i - a,  theta_i - m
//
// Its four numbers share the wheels' noise (segment_motion.hpp).
#include "estimation/kinds/kinds.hpp"
#include "estimation/kinds/way_rows.hpp"

#include <cmath>

namespace trussmap::estimation {
namespace {

class SegmentKind final : public MeasurementKind {
 public:
  using MeasurementKind::MeasurementKind;

  [[nodiscard]] MeasurementRows rows(const Measurement& one, const Ends& at, const Vector4& value,
                                     const effects::ViewPattern&) const override {
    MeasurementRows rows = way_rows(at.from, at.to, value);
    if (one.rows < 4) return rows;
    rows.error[3] = wrap_angle(at.from.heading - value[3]);
    rows.by_from(3, 2) = 1.0;
    return rows;
  }

  /// Standing still is not exact.
  [[nodiscard]] Matrix4 fixed_covariance(const Measurement& one, const Noise&) const override {
    constexpr double kLeastSd = 1e-5;  // m and rad
    Matrix4 fixed = Matrix4::Zero();
    fixed.diagonal().head(one.rows).setConstant(kLeastSd * kLeastSd);
    return fixed;
  }

  [[nodiscard]] std::vector<NamedResidual> residuals(int rows) const override {
    if (rows < 4) return {};
    return {{"compass", Channel::compass}};
  }
};

constinit const SegmentKind kSegment{{.words = "drive",
                                      .several = "drives",
                                      .stream = RecordingStream::drive,
                                      .from = NodeType::pose,
                                      .to = NodeType::pose,
                                      .noise = "wheels",
                                      .other_from = 3,
                                      .other_noise = "compass",
                                      .curvature = Curvature::of_a_way}};

}  // namespace

const MeasurementKind& kinds::segment = kSegment;

Measurement kinds::segment_measured(const SegmentMotion& motion, const Matrix4& covariance) {
  Measurement one;
  one.kind = &kSegment;
  one.rows = std::isnan(motion.mean_heading) ? 3 : 4;
  one.value << motion.displacement.x, motion.displacement.y, motion.displacement.heading,
      one.rows == 4 ? motion.mean_heading : 0.0;
  one.whitener = whitener_of(covariance, one.rows);
  return one;
}

}  // namespace trussmap::estimation
