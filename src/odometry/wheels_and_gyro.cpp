// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "odometry/wheels_and_gyro.hpp"

#include "drive/body_motion.hpp"
#include "trussmap/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trussmap::odometry {
namespace {

double gyro_variance(const Noise& noise, double duration) {
  return noise.gyro * noise.gyro * duration;
}

/// Each wheel's noise, and that of the steering, as it moves the body; with what the model knows
/// besides.
ArcNoise columns_noise(const MotionRows& drive, std::size_t row, double part, double duration,
                       const Noise& noise) {
  const double k2 = 0.5 * (noise.left * noise.left + noise.right * noise.right);
  Matrix3 Q = Matrix3::Zero();
  for (const WheelColumn& column : drive.wheels) {
    const Eigen::Vector3d by(column.by_reading[row].data());
    const double way = std::abs(drive.wheels.front().reading[row]);  // what is steered
    const double steer = noise.steer * (column.gain.empty() ? 1.0 : column.gain[row]);
    const double variance = !column.steers ? k2 * std::abs(column.reading[row])
                            : way > 0.0    ? steer * steer / way
                                           : 0.0;
    Q += part * variance * by * by.transpose();
  }
  const ArcNoise laws = laws_noise(part * drive.turn[row], duration, noise);
  return {Q(0, 0) + laws.along,
          Q(2, 2) + laws.heading,
          Q(0, 2),
          Q(1, 1) + (drive.sideways.empty() ? 0.0 : laws.along),
          Q(0, 1),
          Q(1, 2)};
}

/// Of two wheels by their factors.
ArcNoise factors_noise(const Eigen::Matrix2d& by, const WheelTravel& travel, double duration,
                       const Noise& noise) {
  const Vector2 variance(noise.left * noise.left * std::abs(travel.left),
                         noise.right * noise.right * std::abs(travel.right));
  const Matrix2 Q = by * variance.asDiagonal() * by.transpose();
  const double turn = by.row(1).dot(Vector2(travel.left, travel.right));
  const ArcNoise laws = laws_noise(turn, duration, noise);
  return {Q(0, 0) + laws.along, Q(1, 1) + laws.heading, Q(0, 1)};
}

}  // namespace

ArcNoise laws_noise(double turn, double duration, const Noise& noise) {
  return {noise.travel_per_s * noise.travel_per_s * duration,
          noise.heading_per_s * noise.heading_per_s * duration +
              noise.heading_per_rad * noise.heading_per_rad * std::abs(turn),
          0.0};
}

ArcNoise wheels_noise(const MotionRows& drive, std::size_t row, double part, double duration,
                      const Robot& robot, const Noise& noise) {
  if (!drive.wheels.empty()) return columns_noise(drive, row, part, duration, noise);
  const WheelTravel travel = part * drive::noisy_travel(drive, row, robot);
  return drive.factors ? factors_noise(drive.factors->by_travel, travel, duration, noise)
                       : arc_noise(travel, duration, robot, noise);
}

GyroShare gyro_share(const BodyMotion& wheels, double yaw_rate, double duration, const Noise& noise,
                     const ArcNoise& of_wheels) {
  GyroShare share{wheels};
  if (std::isnan(yaw_rate)) {
    share.variance = std::numeric_limits<double>::infinity();
    return share;
  }
  share.excess = yaw_rate * duration - wheels.turn;
  share.variance = gyro_variance(noise, duration);
  if (wheels.forward == 0.0 && wheels.turn == 0.0) return share;
  const double total = of_wheels.heading + share.variance;
  if (!(total > 0.0)) return share;
  share.along = of_wheels.shared / total;
  share.turn = of_wheels.heading / total;
  share.lateral = of_wheels.heading_lateral / total;
  return share;
}

GyroShare gyro_share(const MotionRows& drive, std::size_t row, double yaw_rate, double duration,
                     const Robot& robot, const Noise& noise) {
  return gyro_share(drive.motion(row), yaw_rate, duration, noise,
                    wheels_noise(drive, row, 1.0, duration, robot, noise));
}

BodyMotion together(const GyroShare& share) {
  return share.wheels + share.excess * BodyMotion{share.along, share.lateral, share.turn};
}

ArcNoise noise_together(const GyroShare& share, const ArcNoise& wheels, double duration,
                        const Noise& noise) {
  if (!std::isfinite(share.variance)) return wheels;
  const double along = share.along;
  const double r = gyro_variance(noise, duration);
  const double kept = 1.0 - share.turn;
  const double lateral = share.lateral;
  const double both = wheels.heading + r;
  return {wheels.along - 2.0 * along * wheels.shared + along * along * both,
          kept * kept * wheels.heading + share.turn * share.turn * r,
          kept * (wheels.shared - along * wheels.heading) + share.turn * along * r,
          wheels.lateral - 2.0 * lateral * wheels.heading_lateral + lateral * lateral * both,
          wheels.along_lateral - along * wheels.heading_lateral - lateral * wheels.shared +
              along * lateral * both,
          kept * (wheels.heading_lateral - lateral * wheels.heading) + share.turn * lateral * r};
}

MotionRows with_gyro(const MotionRows& drive, const Robot& robot, const Noise& noise) {
  MotionRows result = drive;
  if (!drive.has_gyro() || !drive.gyro.empty()) return result;
  result.gyro.reserve(drive.rows());
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    result.gyro.push_back(
        gyro_share(drive, row, drive.yaw_rate[row], drive.duration(row), robot, noise));
    const BodyMotion both = together(result.gyro.back());
    result.forward[row] = both.forward;
    result.turn[row] = both.turn;
    if (!drive.sideways.empty()) result.sideways[row] = both.sideways;
  }
  return result;
}

std::vector<DrivenRecording> with_gyro(const std::vector<DrivenRecording>& recordings,
                                       const Robot& robot, const Noise& noise) {
  std::vector<DrivenRecording> result = recordings;
  for (DrivenRecording& one : result) {
    if (one.drive.has_gyro()) one.drive = with_gyro(one.drive, robot, noise);
  }
  return result;
}

bool has_gyro(const std::vector<DrivenRecording>& recordings) {
  return std::any_of(recordings.begin(), recordings.end(),
                     [](const DrivenRecording& one) { return one.drive.has_gyro(); });
}

ArcNoise row_noise(const MotionRows& drive, std::size_t row, double part, double duration,
                   const Robot& robot, const Noise& noise) {
  const ArcNoise wheels = wheels_noise(drive, row, part, duration, robot, noise);
  return drive.gyro.empty() ? wheels : noise_together(drive.gyro[row], wheels, duration, noise);
}

double excess_variance(const MotionRows& drive, std::size_t row, double part, double duration,
                       const Robot& robot, const Noise& noise) {
  if (drive.gyro.empty() || !std::isfinite(drive.gyro[row].variance)) {
    return std::numeric_limits<double>::infinity();
  }
  const BodyMotion both = part * drive.motion(row);
  const bool rests = both.forward == 0.0 && both.turn == 0.0 && both.sideways == 0.0;
  const double of_wheels =
      rests ? 0.0 : wheels_noise(drive, row, part, duration, robot, noise).heading;
  return of_wheels + gyro_variance(noise, duration);
}

}  // namespace trussmap::odometry
