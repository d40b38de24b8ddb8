// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The robot stands on the landmark, or on a code on the floor: R(theta)' delta - offset. In robot
// axes too: the map turned as a whole then changes no error, not even to first order where the
// errors are large, and a free direction stays recognisable.
#include "estimation/kinds/kinds.hpp"
#include "estimation/kinds/sighted.hpp"

namespace trussmap::estimation {
namespace {

class StandingKind final : public Sighted {
 public:
  using Sighted::Sighted;

  [[nodiscard]] MeasurementRows rows(const Measurement&, const Ends& at, const Vector4& value,
                                     const effects::ViewPattern& view) const override {
    effects::ViewPattern place = view;
    place.heading = 0.0;
    MeasurementRows rows = offset_rows(at, value, place);
    rows.by_view.col(2).setZero();
    return rows;
  }

  [[nodiscard]] std::optional<Vector2> seen_from(const Measurement& one, const Pose& pose,
                                                 const effects::ViewPattern& view) const override {
    return sensor_at(pose, view) + rotation(pose.heading) * one.value.head<2>();
  }

  [[nodiscard]] Eigen::Matrix<double, 2, 4> seen_by_rows(
      const Measurement&, const Pose& pose, const effects::ViewPattern&) const override {
    Eigen::Matrix<double, 2, 4> T = Eigen::Matrix<double, 2, 4>::Zero();
    T.leftCols<2>() = -rotation(pose.heading);
    return T;
  }
};

constinit const StandingKind kStanding{
    {.words = "standing on", .noise = "sighting", .curvature = Curvature::of_a_way}};

}  // namespace

const MeasurementKind& kinds::standing = kStanding;

}  // namespace trussmap::estimation
