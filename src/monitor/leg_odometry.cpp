// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "monitor/leg_odometry.hpp"

#include "drive/unit_arc.hpp"

#include <cmath>
#include <utility>

namespace trussmap::monitor {
namespace {

/// What more of way and turn adds to the displacement of an arc, in the frame of its start.
struct ArcDerivatives {
  Matrix2 by_way;   ///< ahead and to the left, m
  Vector2 by_turn;  ///< m/rad
};

ArcDerivatives arc_derivatives(const BodyMotion& body) {
  const drive::UnitArc arc = drive::unit_arc(body.turn);
  ArcDerivatives result;
  result.by_way << arc.end, quarter_turn(arc.end);
  result.by_turn = body.forward * arc.slope + body.sideways * quarter_turn(arc.slope);
  return result;
}

}  // namespace

LegOdometry::LegOdometry(std::vector<Channel> channels) : channels_(std::move(channels)) {
  begin();
}

void LegOdometry::begin() {
  leg_ = {};
  leg_.by_channel = LegColumns::Zero(5, static_cast<Eigen::Index>(channels_.size()));
  sum_of_readings_ = 0.0;
}

/// Readings are averaged about the first, so that they may be wrapped.
void LegOdometry::read_compass(double reading) {
  const double at_start = reading - leg_.displacement.heading;
  if (leg_.readings++ == 0) first_reading_ = at_start;
  sum_of_readings_ += wrap_angle(at_start - first_reading_);
}

void LegOdometry::take(const Motion& motion, const drive::RowMotion& shown, double reading,
                       double excess, double excess_variance) {
  const double before = leg_.displacement.heading;
  const Matrix2 R = rotation(before);
  const Vector2 step = R * motion.displacement.position();
  // An error of the heading moves all that comes after it.
  const auto carry = [&](auto&& errors) {
    errors.row(0) -= step.y() * errors.row(2);
    errors.row(1) += step.x() * errors.row(2);
  };
  carry(leg_.covariance);
  carry(leg_.covariance.transpose());
  carry(leg_.by_channel);
  Eigen::Matrix<double, 5, 3> G = Eigen::Matrix<double, 5, 3>::Zero();
  G.topLeftCorner<2, 2>() = R;
  G(2, 2) = 1.0;
  leg_.covariance.topLeftCorner<3, 3>() +=
      G.topRows<3>() * motion.covariance * G.topRows<3>().transpose();

  const ArcDerivatives arc = arc_derivatives(shown.body);
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    const effects::DrivePattern more = effects::drive_pattern(channels_[k], 1.0, shown);
    auto column = leg_.by_channel.col(static_cast<Eigen::Index>(k));
    column.head<2>() +=
        R * (arc.by_way * Vector2(more.advance, more.slip) + arc.by_turn * more.turn);
    column[2] += more.turn;
    column[kLegExcess] += more.excess;
  }
  leg_.displacement = compose(leg_.displacement, motion.displacement);
  leg_.duration += shown.duration;
  const double way = std::hypot(shown.body.forward, shown.body.sideways);
  leg_.way += way;
  if (way > 0.0 || shown.body.turn != 0.0) ++leg_.rows;
  if (shown.gyro_reads) {
    ++leg_.gyro_readings;
    leg_.excess += excess;
    leg_.covariance(kLegExcess, kLegExcess) += excess_variance;
  }
  if (std::isnan(reading)) return;
  read_compass(reading);
  // The mean over the readings is a sum until the leg ends.
  leg_.covariance.row(kLegMeanHeading) += leg_.covariance.row(2);
  leg_.covariance.col(kLegMeanHeading) += leg_.covariance.col(2);
  leg_.by_channel.row(kLegMeanHeading) += leg_.by_channel.row(2);
}

LegReckoning LegOdometry::finish() {
  LegReckoning leg = std::move(leg_);
  const double sum = sum_of_readings_;
  begin();
  if (leg.readings == 0) return leg;
  const double share = 1.0 / leg.readings;
  leg.heading = first_reading_ + share * sum;
  leg.covariance.row(kLegMeanHeading) *= share;
  leg.covariance.col(kLegMeanHeading) *= share;
  leg.by_channel.row(kLegMeanHeading) *= share;
  return leg;
}

}  // namespace trussmap::monitor
