// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/steered_motion.hpp"

#include <cmath>

namespace trussmap {

SteeredMotion steered_motion(const Robot& robot, double travel, double angle) {
  SteeredMotion body;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  if (robot.drive == DriveKind::tricycle) {
    body.by_reading = {Eigen::Vector3d(c, 0.0, s / robot.length),
                       Eigen::Vector3d(-travel * s, 0.0, travel * c / robot.length)};
    body.motion = travel * body.by_reading[0];
    return body;
  }
  const double k = s / (c * robot.length);
  const double k_by_angle = 1.0 / (c * c * robot.length);
  const double share = 1.0 / (1.0 - robot.wheel_left * k);  // of the centre's way in the wheel's
  const double share_by_angle = share * share * robot.wheel_left * k_by_angle;
  body.by_reading = {Eigen::Vector3d(share, 0.0, share * k),
                     Eigen::Vector3d(travel * share_by_angle, 0.0,
                                     travel * (share_by_angle * k + share * k_by_angle))};
  body.motion = travel * body.by_reading[0];
  body.possible = c > 0.0 && share > 0.0;
  return body;
}

}  // namespace trussmap
