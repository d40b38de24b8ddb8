// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a gyro and the wheels say of each other over a segment (gyro_excess.hpp): of no pose, but of
// effects. Nothing is predicted of an excess; its noise is white already.
#include "estimation/kinds/kinds.hpp"

namespace trussmap::estimation {
namespace {

class GyroKind final : public MeasurementKind {
 public:
  using MeasurementKind::MeasurementKind;

  [[nodiscard]] MeasurementRows rows(const Measurement&, const Ends&, const Vector4& value,
                                     const effects::ViewPattern&) const override {
    MeasurementRows rows;
    rows.error = -value;
    return rows;
  }

  [[nodiscard]] std::vector<NamedResidual> residuals(int) const override {
    return {{"gyro", Channel::gyro}};
  }
};

constinit const GyroKind kGyro{{.words = "gyro",
                                .several = "gyro readings",
                                .stream = RecordingStream::drive,
                                .from = NodeType::pose,
                                .noise = "gyro",
                                .noise_is_sought = true,
                                .curvature = Curvature::none}};

}  // namespace

const MeasurementKind& kinds::gyro = kGyro;

Measurement kinds::gyro_measured(const GyroExcess& excess) {
  Measurement one;
  one.kind = &kGyro;
  one.rows = excess.rows;
  one.value = excess.value;
  one.whitener.topLeftCorner(one.rows, one.rows).setIdentity();
  return one;
}

}  // namespace trussmap::estimation
