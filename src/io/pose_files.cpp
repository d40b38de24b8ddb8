// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/csv.hpp"
#include "trussmap/recording_files.hpp"

#include <cmath>

#include <fmt/format.h>

namespace trussmap {
using namespace io;

std::string format_poses(const std::vector<TimedPose>& poses) {
  std::string text = "t,x,y,heading,c_xx,c_xy,c_xh,c_yy,c_yh,c_hh\n";
  for (const TimedPose& one : poses) {
    const Pose& pose = one.estimate.pose;
    text += csv_number(one.t) + ',' + csv_number(pose.x) + ',' + csv_number(pose.y) + ',' +
            csv_number(pose.heading);
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) text += ',' + csv_number(one.estimate.covariance(i, j));
    }
    text += '\n';
  }
  return text;
}

std::string format_tum(const std::vector<TimedPose>& poses) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (const TimedPose& one : poses) {
    const Pose& pose = one.estimate.pose;
    const double half = 0.5 * wrap_angle(pose.heading);
    text += fmt::format("{} {} {} 0 0 0 {} {}\n", csv_number(one.t), csv_number(pose.x),
                        csv_number(pose.y), csv_number(std::sin(half)), csv_number(std::cos(half)));
  }
  return text;
}

std::string format_kitti(const std::vector<TimedPose>& poses) {
  std::string text;
  for (const TimedPose& one : poses) {
    const Pose& pose = one.estimate.pose;
    const std::string cosine = csv_number(std::cos(pose.heading));
    const double sine = std::sin(pose.heading);
    text += fmt::format("{} {} 0 {} {} {} 0 {} 0 0 1 0\n", cosine, csv_number(0.0 - sine),
                        csv_number(pose.x), csv_number(sine), cosine, csv_number(pose.y));
  }
  return text;
}

}  // namespace trussmap
