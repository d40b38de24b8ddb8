// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "odometry/wheels_and_gyro.hpp"
#include "text/number_text.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trussmap {
namespace {

constexpr double kLeastSd = 1e-5;  // m, rad: nothing that stands still is surer

Loop motion_between(const MotionRows& drive, double from, double to, const Model& model) {
  const PoseEstimate end = dead_reckon({}, drive, from, to, model.robot, model.noise);
  const Matrix3& P = end.covariance;
  Loop loop{from, to, end.pose.x, end.pose.y, end.pose.heading};
  loop.sd = std::max(std::sqrt(0.5 * (P(0, 0) + P(1, 1))), kLeastSd);
  loop.sd_heading = std::max(std::sqrt(P(2, 2)), kLeastSd);
  return loop;
}

}  // namespace

std::vector<Loop> second_odometer_loops(const Recording& second, const Model& model,
                                        const DriveColumns& drive, double every) {
  if (!(every > 0.0)) throw std::invalid_argument("motions last longer than 0 s");
  MotionRows own = with_wheels(second, model.robot).drive;
  own.heading.clear();  // a compass would tie motions together that count as independent
  own = odometry::with_gyro(own, model.robot, model.noise);  // once, not for every motion
  if (own.rows() < 2 || drive.rows() < 2) {
    throw std::invalid_argument("a drive has two rows at least");
  }
  const double first = std::max(own.start(), drive.start());
  const double last = std::min(own.t.back(), drive.t.back());
  constexpr double kRounding = 1e-9;  // of `every`
  std::vector<Loop> loops;
  double from = first;
  for (const double t : own.t) {
    if (t > last) break;
    if (t - from < (1.0 - kRounding) * every) continue;
    loops.push_back(motion_between(own, from, t, model));
    from = t;
  }
  if (loops.empty()) {
    throw std::invalid_argument(text::joined(
        "the drives have ", text::short_text(std::max(last - first, 0.0)),
        " s in common, expected ", text::short_text(every), " s at least: from ",
        text::short_text(own.start()), " to ", text::short_text(own.t.back()), " s the one, from ",
        text::short_text(drive.start()), " to ", text::short_text(drive.t.back()), " s the other"));
  }
  return loops;
}

}  // namespace trussmap
