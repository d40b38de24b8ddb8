// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "odometry/wheels_and_gyro.hpp"

#include "trussmap/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trussmap {
namespace {

double gyro_variance(const Noise& noise, double duration) {
  return noise.gyro * noise.gyro * duration;
}

/// As both say: of the wheels alone, rows that err towards a larger turn would count less than
/// those that err the other way, and all turns seem larger than the wheels say.
WheelTravel wheels_of(const Drive& drive, std::size_t row, double part) {
  return {part * drive.left[row], part * drive.right[row]};
}

}  // namespace

GyroShare gyro_share(const WheelTravel& wheels, double yaw_rate, double duration,
                     const Robot& robot, const Noise& noise) {
  GyroShare share{wheels.left, wheels.right};
  if (std::isnan(yaw_rate)) {
    share.variance = std::numeric_limits<double>::infinity();
    return share;
  }
  share.excess = yaw_rate * duration - (share.right - share.left) / robot.wheelbase;
  share.variance = gyro_variance(noise, duration);
  if (share.left == 0.0 && share.right == 0.0) return share;
  const ArcNoise of_wheels = arc_noise(wheels, duration, robot, noise);
  const double total = of_wheels.heading + share.variance;
  if (!(total > 0.0)) return share;
  share.along = of_wheels.shared / total;
  share.turn = of_wheels.heading / total;
  return share;
}

WheelTravel together(const GyroShare& share, const Robot& robot) {
  const double apart = 0.5 * robot.wheelbase * share.turn * share.excess;
  const double along = share.along * share.excess;
  return {share.left + along - apart, share.right + along + apart};
}

ArcNoise noise_together(const GyroShare& share, const ArcNoise& wheels, double duration,
                        const Noise& noise) {
  if (!std::isfinite(share.variance)) return wheels;
  const double along = share.along;
  const double r = gyro_variance(noise, duration);
  const double kept = 1.0 - share.turn;
  return {wheels.along - 2.0 * along * wheels.shared + along * along * (wheels.heading + r),
          kept * kept * wheels.heading + share.turn * share.turn * r,
          kept * (wheels.shared - along * wheels.heading) + share.turn * along * r};
}

Drive with_gyro(const Drive& drive, const Robot& robot, const Noise& noise) {
  Drive result = drive;
  if (!drive.has_gyro() || !drive.gyro.empty()) return result;
  result.gyro.reserve(drive.rows());
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const GyroShare share = gyro_share({drive.left[row], drive.right[row]}, drive.yaw_rate[row],
                                       drive.duration(row), robot, noise);
    const WheelTravel both = together(share, robot);
    result.left[row] = both.left;
    result.right[row] = both.right;
    result.gyro.push_back(share);
  }
  return result;
}

std::vector<Recording> with_gyro(const std::vector<Recording>& recordings, const Robot& robot,
                                 const Noise& noise) {
  std::vector<Recording> result = recordings;
  for (Recording& one : result) one.drive = with_gyro(one.drive, robot, noise);
  return result;
}

bool has_gyro(const std::vector<Recording>& recordings) {
  return std::any_of(recordings.begin(), recordings.end(),
                     [](const Recording& one) { return one.drive.has_gyro(); });
}

ArcNoise row_noise(const Drive& drive, std::size_t row, double part, double duration,
                   const Robot& robot, const Noise& noise) {
  const ArcNoise wheels = arc_noise(wheels_of(drive, row, part), duration, robot, noise);
  return drive.gyro.empty() ? wheels : noise_together(drive.gyro[row], wheels, duration, noise);
}

Matrix3 row_covariance(const Drive& drive, std::size_t row, double part, double duration,
                       const Robot& robot, const Noise& noise) {
  const WheelTravel travel{part * drive.left[row], part * drive.right[row]};
  if (drive.gyro.empty()) return arc_covariance(travel, duration, robot, noise);
  return arc_covariance(0.5 * (travel.left + travel.right),
                        (travel.right - travel.left) / robot.wheelbase,
                        row_noise(drive, row, part, duration, robot, noise));
}

double excess_variance(const Drive& drive, std::size_t row, double part, double duration,
                       const Robot& robot, const Noise& noise) {
  if (drive.gyro.empty() || !std::isfinite(drive.gyro[row].variance)) {
    return std::numeric_limits<double>::infinity();
  }
  const WheelTravel wheels = wheels_of(drive, row, part);
  const bool rests = wheels.left == 0.0 && wheels.right == 0.0;
  const double of_wheels = rests ? 0.0 : arc_noise(wheels, duration, robot, noise).heading;
  return of_wheels + gyro_variance(noise, duration);
}

}  // namespace trussmap
