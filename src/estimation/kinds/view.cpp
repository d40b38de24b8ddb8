// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A landmark seen at a range and a bearing, or at a range alone:
//
//   |delta| (1 + range_scale) + range - r,  direction(delta) - theta - heading + bearing - b
#include "estimation/kinds/kinds.hpp"
#include "estimation/kinds/sighted.hpp"

#include <cmath>

namespace trussmap::estimation {
namespace {

/// m, freed from what the view adds.
double range_of(const Measurement& one, const effects::ViewPattern& view) {
  return (one.value[0] - view.range) / (1.0 + view.range_scale);
}

class ViewKind final : public Sighted {
 public:
  using Sighted::Sighted;

  [[nodiscard]] MeasurementRows rows(const Measurement& one, const Ends& at, const Vector4& value,
                                     const effects::ViewPattern& view) const override {
    MeasurementRows rows = polar_rows(at, value, view);
    if (one.rows > 1) return rows;
    rows.error[1] = 0.0;
    rows.by_from.row(1).setZero();
    rows.by_to.row(1).setZero();
    rows.by_view.row(1).setZero();
    return rows;
  }

  [[nodiscard]] Matrix4 fixed_covariance(const Measurement& one,
                                         const Noise& stated) const override {
    Matrix4 fixed = Matrix4::Zero();
    fixed(0, 0) = std::pow(stated.range_relative * one.value[0], 2);
    return fixed;
  }

  [[nodiscard]] Matrix4 reading_variance(Channel channel, const Measurement& one) const override {
    Matrix4 variance = MeasurementKind::reading_variance(channel, one);
    if (channel == Channel::range_scale) variance(0, 0) = one.value[0] * one.value[0];
    return variance;
  }

  [[nodiscard]] std::optional<Vector2> seen_from(const Measurement& one, const Pose& pose,
                                                 const effects::ViewPattern& view) const override {
    if (one.rows == 1) return std::nullopt;
    const Vector2 offset = range_of(one, view) * rotation(one.value[1] - view.bearing).col(0);
    return sensor_at(pose, view) + rotation(pose.heading + view.heading) * offset;
  }

  [[nodiscard]] Eigen::Matrix<double, 2, 4> seen_by_rows(
      const Measurement& one, const Pose& pose, const effects::ViewPattern& view) const override {
    Eigen::Matrix<double, 2, 4> T = Eigen::Matrix<double, 2, 4>::Zero();
    const Matrix2 along =
        rotation(pose.heading + view.heading) * rotation(one.value[1] - view.bearing);
    T.col(0) = -along.col(0) / (1.0 + view.range_scale);
    T.col(1) = -range_of(one, view) * along.col(1);
    return T;
  }

  [[nodiscard]] double missed(const Measurement& one, const Pose& pose, const Vector2& landmark,
                              const effects::ViewPattern& view) const override {
    if (one.rows > 1) return MeasurementKind::missed(one, pose, landmark, view);
    return std::abs((landmark - sensor_at(pose, view)).norm() - range_of(one, view));
  }

  [[nodiscard]] std::vector<NamedResidual> residuals(int rows) const override {
    std::vector<NamedResidual> all{{"sighting range", Channel::range}};
    if (rows > 1) all.push_back({"sighting bearing", Channel::bearing});
    return all;
  }

  void draw(const Vector4& exact, const Noise& noise, statistics::NormalDraws& draws,
            Sighting& sighting) const override {
    draw_polar(exact[0], exact[1], noise, draws, sighting);
  }
};

constinit const ViewKind kView{
    {.words = "sight of", .noise = "range", .other_from = 1, .other_noise = "bearing"}};

}  // namespace

const MeasurementKind& kinds::view = kView;

}  // namespace trussmap::estimation
