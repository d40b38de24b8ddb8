// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "odometry/merge.hpp"

#include "drive/body_motion.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::odometry {
namespace {

constexpr double kSameCurvature = 0.1;  // of q
constexpr double kNoiseLimit = 3.0;     // standard deviations of q
constexpr double kSameShape = 0.01;     // of the path: how far the rows' end may lie from the arc's
constexpr double kStanding = 1e-6;      // m per row

enum class Kind { standing, forward, backward, spin_left, spin_right };

/// m that each of two wheels goes for the turn alone, to the left.
double turned_way(const BodyMotion& motion, const Robot& robot) {
  return drive::wheel_travel({0.0, 0.0, motion.turn}, robot).right;
}

Kind kind_of(const BodyMotion& motion, const Robot& robot) {
  constexpr double kRounding = 1e-12;  // where one wheel stands it is no spin
  if (2.0 * drive::mean_travel(motion, robot) < kStanding) return Kind::standing;
  if (std::abs(turned_way(motion, robot)) > (1.0 + kRounding) * std::abs(motion.forward)) {
    return motion.turn > 0.0 ? Kind::spin_left : Kind::spin_right;
  }
  return motion.forward > 0.0 ? Kind::forward : Kind::backward;
}

double curvature_of(const BodyMotion& motion, const Robot& robot) {
  const double way = drive::mean_travel(motion, robot);
  return way > 0.0 ? turned_way(motion, robot) / way : 0.0;
}

/// Standard deviation of q that wheel noise gives.
double curvature_noise(const BodyMotion& motion, const Robot& robot, const WheelNoise& noise) {
  const WheelTravel travel = drive::wheel_travel(motion, robot);
  return std::sqrt(noise.left * noise.left * std::abs(travel.left) +
                   noise.right * noise.right * std::abs(travel.right)) /
         (2.0 * drive::mean_travel(motion, robot));
}

bool same_arc(const DriveArc& arc, const BodyMotion& row, const Robot& robot,
              const WheelNoise& noise) {
  const Kind kind = kind_of(row, robot);
  if (kind_of(arc.motion, robot) != kind) return false;
  if (kind == Kind::standing) return true;
  const double tolerance =
      std::max(kSameCurvature, kNoiseLimit * curvature_noise(row, robot, noise));
  return std::abs(curvature_of(arc.motion, robot) - curvature_of(row, robot)) <= tolerance;
}

}  // namespace

std::vector<DriveRow> rows_between(const MotionRows& drive, double from, double to) {
  std::vector<DriveRow> rows;
  const auto first = std::upper_bound(drive.t.begin(), drive.t.end(), from) - drive.t.begin();
  for (auto row = static_cast<std::size_t>(first); row < drive.rows(); ++row) {
    const double begin = row == 0 ? drive.start() : drive.t[row - 1];
    const double end = drive.t[row];
    if (begin >= to) break;
    const double duration = std::min(end, to) - std::max(begin, from);
    rows.push_back({row, duration / (end - begin), duration, end <= to});
  }
  return rows;
}

BodyMotion motion_of(const MotionRows& drive, const DriveRow& row) {
  return row.part * drive.motion(row.row);
}

GrowingArc GrowingArc::with(const BodyMotion& row, double duration, const Robot& robot) const {
  GrowingArc longer = *this;
  longer.arc_.motion = arc_.motion + BodyMotion{row.forward, 0.0, row.turn};
  longer.arc_.duration += duration;
  ++longer.arc_.rows;
  longer.rows_ = compose(rows_, arc_displacement(row.forward, row.turn));
  longer.path_ += drive::mean_travel(row, robot);
  return longer;
}

/// Many gentle bends add up: each row may be like the arc, and the whole not.
bool GrowingArc::keeps_shape() const {
  const Pose end = arc_displacement(arc_.motion.forward, arc_.motion.turn);
  return (end.position() - rows_.position()).norm() <= kSameShape * path_;
}

bool GrowingArc::take(const BodyMotion& row, double duration, const Robot& robot,
                      const WheelNoise& noise) {
  const GrowingArc longer = with(row, duration, robot);
  const bool joins = arc_.rows > 0 && same_arc(arc_, row, robot, noise) && longer.keeps_shape();
  *this = joins ? longer : GrowingArc{}.with(row, duration, robot);
  return !joins;
}

std::vector<DriveArc> merge_rows(const MotionRows& drive, const std::vector<DriveRow>& rows,
                                 const Robot& robot, const WheelNoise& noise) {
  std::vector<DriveArc> arcs;
  GrowingArc last;
  for (const DriveRow& row : rows) {
    if (last.take(motion_of(drive, row), row.duration, robot, noise)) arcs.emplace_back();
    arcs.back() = last.arc();
  }
  return arcs;
}

}  // namespace trussmap::odometry
