// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A landmark's own axis, seen from the robot: phi - theta - heading + yaw - y.
#include "estimation/kinds/independent_rows.hpp"
#include "estimation/kinds/kinds.hpp"
#include "recording/floor_code.hpp"

#include <cmath>

namespace trussmap::estimation {
namespace {

class SightingYawKind final : public MeasurementKind {
 public:
  using MeasurementKind::MeasurementKind;

  [[nodiscard]] MeasurementRows rows(const Measurement&, const Ends& at, const Vector4& value,
                                     const effects::ViewPattern& view) const override {
    MeasurementRows rows;
    rows.error[0] =
        wrap_angle(at.orientation - at.from.heading - view.heading + view.yaw - value[0]);
    rows.by_from(0, 2) = -1.0;
    rows.by_to(0, 0) = 1.0;
    rows.by_view(0, 2) = -1.0;
    rows.by_view(0, 8) = 1.0;
    return rows;
  }

  [[nodiscard]] bool shows(Channel channel, const Measurement&) const override {
    return channel == Channel::sighting_yaw || channel == Channel::delay;
  }

  /// An orientation is as certain as the heading that it was read from.
  [[nodiscard]] Eigen::MatrixXd slack(const Measurement&, const MeasurementRows&,
                                      double) const override {
    constexpr double kOrientationSd = 0.05;  // rad
    return Eigen::MatrixXd::Constant(1, 1, kOrientationSd * kOrientationSd);
  }

  [[nodiscard]] std::vector<NamedResidual> residuals(int) const override {
    return {{"sighting yaw", Channel::sighting_yaw}};
  }

  /// Where the robot stands beside a floor code stays as it was in its own axes.
  void draw(const Vector4& exact, const Noise& noise, statistics::NormalDraws& draws,
            Sighting& sighting) const override {
    const Vector2 code = recording::code_from_robot(sighting);
    sighting.yaw = wrap_angle(exact[0] + draws(noise.yaw));
    if (!std::isnan(sighting.dx)) recording::place_by_code(code, sighting);
  }
};

constinit const SightingYawKind kSightingYaw{{.words = "yaw of",
                                              .several = "yaws",
                                              .stream = RecordingStream::sightings,
                                              .from = NodeType::pose,
                                              .to = NodeType::orientation,
                                              .noise = "yaw",
                                              .noise_is_sought = true,
                                              .may_be_wrong = true,
                                              .curvature = Curvature::none}};

}  // namespace

const MeasurementKind& kinds::sighting_yaw = kSightingYaw;

std::optional<Measurement> kinds::yaw_measured(const Sighting& sighting, const Noise& noise) {
  if (std::isnan(sighting.yaw)) return std::nullopt;
  return independent_rows(sighting_yaw, {sighting.yaw}, {noise.yaw});
}

}  // namespace trussmap::estimation
