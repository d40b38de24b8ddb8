// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/units.hpp"
#include "trussmap/texts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace trussmap {
namespace {

/// Processes of the wheels' motion.
bool motion_noise_lasts(const Noise& noise) {
  return std::any_of(noise.processes.begin(), noise.processes.end(), [](const NoiseProcess& one) {
    static constexpr std::array kOthers{
        Channel::lever,   Channel::lever_left,   Channel::range,     Channel::range_scale,
        Channel::bearing, Channel::delay,        Channel::compass,   Channel::truth_heading,
        Channel::antenna, Channel::antenna_left, Channel::fix_delay, Channel::fix_x,
        Channel::fix_y,   Channel::gyro,         Channel::gyro_scale};
    return std::find(kOthers.begin(), kOthers.end(), one.channel) == kOthers.end();
  });
}

}  // namespace

std::string poses_text(const std::vector<TimedPose>& poses, bool adjusted) {
  const PoseEstimate& end = poses.back().estimate;
  return fmt::format(
      "{} poses, {}; the last is known to {:.3f} m and {:.2f} deg (standard deviations)\n",
      poses.size(),
      adjusted ? "adjusted with everything that was measured, in the map's frame"
               : "dead reckoned from (0, 0, 0)",
      std::sqrt(end.covariance(0, 0) + end.covariance(1, 1)),
      std::sqrt(end.covariance(2, 2)) * geometry::kDegrees);
}

std::string lasting_noise_text(const Noise& noise, TextStyle style) {
  if (!motion_noise_lasts(noise)) return {};
  return warning_text(
      "of the wheels' noise the covariances know what is white: with motion noise that lasts, as "
      "the model has, they are too small",
      style);
}

}  // namespace trussmap
