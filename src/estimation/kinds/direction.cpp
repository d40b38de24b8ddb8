// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A landmark's bearing alone: direction(delta) - theta - heading + bearing - b.
#include "estimation/kinds/kinds.hpp"
#include "estimation/kinds/sighted.hpp"

#include <cmath>

namespace trussmap::estimation {
namespace {

class DirectionKind final : public Sighted {
 public:
  using Sighted::Sighted;

  /// Of a view the second row.
  [[nodiscard]] MeasurementRows rows(const Measurement&, const Ends& at, const Vector4& value,
                                     const effects::ViewPattern& view) const override {
    MeasurementRows rows = polar_rows(at, Vector4(0.0, value[0], 0.0, 0.0), view);
    rows.error.head<2>() << rows.error[1], 0.0;
    for (auto* part : {&rows.by_from, &rows.by_to}) {
      part->row(0) = part->row(1);
      part->row(1).setZero();
    }
    rows.by_view.row(0) = rows.by_view.row(1);
    rows.by_view.row(1).setZero();
    return rows;
  }

  [[nodiscard]] double missed(const Measurement& one, const Pose& pose, const Vector2& landmark,
                              const effects::ViewPattern& view) const override {
    const Vector2 to = landmark - sensor_at(pose, view);
    const double looked = pose.heading + view.heading - view.bearing + one.value[0];
    return to.norm() * std::abs(wrap_angle(trussmap::direction(to) - looked));
  }

  [[nodiscard]] std::vector<NamedResidual> residuals(int) const override {
    return {{"bearing", Channel::bearing}};
  }

  void draw(const Vector4& exact, const Noise& noise, statistics::NormalDraws& draws,
            Sighting& sighting) const override {
    sighting.bearing = wrap_angle(exact[0] + draws(noise.bearing));
  }
};

constinit const DirectionKind kDirection{{.words = "sight of", .noise = "bearing"}};

}  // namespace

const MeasurementKind& kinds::direction = kDirection;

}  // namespace trussmap::estimation
