// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A landmark seen so near that its range says nothing of a direction, in robot axes:
// R(theta + heading)' delta - offset.
#include "estimation/kinds/kinds.hpp"
#include "estimation/kinds/sighted.hpp"

namespace trussmap::estimation {
namespace {

class CartesianViewKind final : public Sighted {
 public:
  using Sighted::Sighted;

  [[nodiscard]] MeasurementRows rows(const Measurement&, const Ends& at, const Vector4& value,
                                     const effects::ViewPattern& view) const override {
    return offset_rows(at, value, view);
  }

  [[nodiscard]] Matrix4 fixed_covariance(const Measurement& one,
                                         const Noise& stated) const override {
    Matrix4 fixed = Matrix4::Zero();
    fixed(0, 0) = fixed(1, 1) =
        stated.range_relative * stated.range_relative * one.value.squaredNorm();
    return fixed;
  }

  [[nodiscard]] Matrix4 reading_variance(Channel channel, const Measurement& one) const override {
    const double size = channel == Channel::range_scale ? one.value.head<2>().norm() : 1.0;
    return size * size * MeasurementKind::reading_variance(channel, one);
  }

  /// The offset is measured: a range's error lies along the sight.
  [[nodiscard]] effects::ViewVector unit_view(Channel channel, const Measurement& one, double speed,
                                              double turn_rate) const override {
    effects::ViewVector unit = MeasurementKind::unit_view(channel, one, speed, turn_rate);
    const Vector2 away = -one.value.head<2>().normalized();
    const double size = channel == Channel::range         ? 1.0
                        : channel == Channel::range_scale ? one.value.head<2>().norm()
                                                          : 0.0;
    if (size > 0.0) {
      unit.setZero();
      unit.head<2>() = size * away;
    }
    return unit;
  }

  [[nodiscard]] std::optional<Vector2> seen_from(const Measurement& one, const Pose& pose,
                                                 const effects::ViewPattern& view) const override {
    return sensor_at(pose, view) + rotation(pose.heading + view.heading) * one.value.head<2>();
  }

  [[nodiscard]] Eigen::Matrix<double, 2, 4> seen_by_rows(
      const Measurement&, const Pose& pose, const effects::ViewPattern& view) const override {
    Eigen::Matrix<double, 2, 4> T = Eigen::Matrix<double, 2, 4>::Zero();
    T.leftCols<2>() = -rotation(pose.heading + view.heading);
    return T;
  }

  void draw(const Vector4& exact, const Noise& noise, statistics::NormalDraws& draws,
            Sighting& sighting) const override {
    draw_polar(exact.head<2>().norm(), direction(exact.head<2>()), noise, draws, sighting);
  }
};

constinit const CartesianViewKind kCartesianView{
    {.words = "sight of", .noise = "range", .curvature = Curvature::of_a_way_by_view}};

}  // namespace

const MeasurementKind& kinds::cartesian_view = kCartesianView;

}  // namespace trussmap::estimation
