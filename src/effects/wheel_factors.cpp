// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/wheel_factors.hpp"

#include "drive/body_motion.hpp"
#include "drive/row_motion.hpp"
#include "effects/channel_physics.hpp"

#include <cmath>
#include <cstddef>
#include <stdexcept>

#include <Eigen/LU>

namespace trussmap::effects {
namespace {

double coefficient_of(const Effect& effect, int session) {
  const std::size_t place = effect.per_session ? static_cast<std::size_t>(session) : 0;
  return place < effect.coefficients.size() ? effect.coefficients[place] : 0.0;
}

double largest(const Eigen::Matrix2d& motion, const Robot& robot) {
  return (drive::by_travel(robot).inverse() * motion).cwiseAbs().maxCoeff();
}

}  // namespace

bool is_wheel_factor(Channel channel) {
  using enum Channel;
  return channel == travel || channel == turn || channel == difference || channel == wheels ||
         channel == left || channel == right;
}

bool is_wheel_factor(const Effect& effect) {
  return is_wheel_factor(effect.channel) && effect.is_constant();
}

std::optional<WheelFactors> wheel_factors(const std::vector<Effect>& effects, const Robot& robot,
                                          int session, FactorsAct act) {
  constexpr double kSame = 1e-6;
  if (robot.drive != DriveKind::differential && robot.drive != DriveKind::unicycle) {
    return std::nullopt;
  }
  const Eigen::Matrix2d stated = drive::by_travel(robot);
  Eigen::Matrix2d by = stated;
  for (const Effect& one : effects) {
    if (!is_wheel_factor(one) || !is_of_drive(one.channel, robot)) continue;
    const Eigen::Matrix2d on = act == FactorsAct::in_turn ? by : stated;
    for (const Eigen::Index wheel : {0, 1}) {
      const DrivePattern more =
          drive_pattern(one.channel, coefficient_of(one, session),
                        drive::row_motion(BodyMotion{on(0, wheel), 0.0, on(1, wheel)}, 1.0, robot));
      by.col(wheel) += Eigen::Vector2d(more.advance, more.turn);
    }
  }
  if (std::abs(by.determinant()) < kSame * std::abs(stated.determinant())) return std::nullopt;
  return WheelFactors{by, stated * by.inverse()};
}

double difference(const WheelFactors& a, const WheelFactors& b, const Robot& robot) {
  return largest(a.by_travel - b.by_travel, robot);
}

double difference(const WheelFactors& a, const Robot& robot) {
  return largest(a.by_travel - drive::by_travel(robot), robot);
}

MotionRows with_factors(MotionRows drive, const WheelFactors& factors, const Robot& robot) {
  if (!drive.gyro.empty() || drive.factors) {
    throw std::logic_error("wheels' factors are taken in once, and before the gyro");
  }
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const WheelTravel own = drive::own_travel(drive, row, robot);
    const Eigen::Vector2d is = factors.by_travel * Eigen::Vector2d(own.left, own.right);
    drive.forward[row] = is[0];
    drive.turn[row] = is[1];
    if (drive.pair.empty()) continue;
    const WheelTravel by = drive::wheel_travel({is[0], 0.0, is[1]}, robot);
    drive.pair.left[row] = by.left;
    drive.pair.right[row] = by.right;
  }
  drive.factors = factors;
  return drive;
}

}  // namespace trussmap::effects
