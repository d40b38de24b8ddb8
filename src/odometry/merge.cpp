// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "odometry/merge.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap {
namespace {

constexpr double kSameCurvature = 0.1;  // of q
constexpr double kNoiseLimit = 3.0;     // standard deviations of q
constexpr double kSameShape = 0.01;     // of the path: how far the rows' end may lie from the arc's
constexpr double kStanding = 1e-6;      // m per row

enum class Kind { standing, forward, backward, spin_left, spin_right };

Kind kind_of(const WheelTravel& travel) {
  if (std::abs(travel.left) + std::abs(travel.right) < kStanding) return Kind::standing;
  if (travel.left * travel.right < 0.0) {
    return travel.right > 0.0 ? Kind::spin_left : Kind::spin_right;
  }
  return travel.left + travel.right > 0.0 ? Kind::forward : Kind::backward;
}

double curvature_of(const WheelTravel& travel) {
  const double sum = std::abs(travel.left) + std::abs(travel.right);
  return sum > 0.0 ? (travel.right - travel.left) / sum : 0.0;
}

/// Standard deviation of q that wheel noise gives.
double curvature_noise(const WheelTravel& travel, const WheelNoise& noise) {
  const double sum = std::abs(travel.left) + std::abs(travel.right);
  return std::sqrt(noise.left * noise.left * std::abs(travel.left) +
                   noise.right * noise.right * std::abs(travel.right)) /
         sum;
}

bool same_arc(const DriveArc& arc, const WheelTravel& row, const WheelNoise& noise) {
  const Kind kind = kind_of(row);
  if (kind_of(arc.travel) != kind) return false;
  if (kind == Kind::standing) return true;
  const double tolerance = std::max(kSameCurvature, kNoiseLimit * curvature_noise(row, noise));
  return std::abs(curvature_of(arc.travel) - curvature_of(row)) <= tolerance;
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

WheelTravel travel_of(const MotionRows& drive, const DriveRow& row) {
  return {row.part * drive.left[row.row], row.part * drive.right[row.row]};
}

GrowingArc GrowingArc::with(const WheelTravel& travel, double duration, double wheelbase) const {
  GrowingArc longer = *this;
  longer.arc_.travel.left += travel.left;
  longer.arc_.travel.right += travel.right;
  longer.arc_.duration += duration;
  ++longer.arc_.rows;
  longer.rows_ = compose(rows_, arc_displacement(travel, wheelbase));
  longer.path_ += 0.5 * (std::abs(travel.left) + std::abs(travel.right));
  return longer;
}

/// Many gentle bends add up: each row may be like the arc, and the whole not.
bool GrowingArc::keeps_shape(double wheelbase) const {
  const Pose end = arc_displacement(arc_.travel, wheelbase);
  return (end.position() - rows_.position()).norm() <= kSameShape * path_;
}

bool GrowingArc::take(const WheelTravel& travel, double duration, double wheelbase,
                      const WheelNoise& noise) {
  const GrowingArc longer = with(travel, duration, wheelbase);
  const bool joins =
      arc_.rows > 0 && same_arc(arc_, travel, noise) && longer.keeps_shape(wheelbase);
  *this = joins ? longer : GrowingArc{}.with(travel, duration, wheelbase);
  return !joins;
}

std::vector<DriveArc> merge_rows(const MotionRows& drive, const std::vector<DriveRow>& rows,
                                 double wheelbase, const WheelNoise& noise) {
  std::vector<DriveArc> arcs;
  GrowingArc last;
  for (const DriveRow& row : rows) {
    if (last.take(travel_of(drive, row), row.duration, wheelbase, noise)) arcs.emplace_back();
    arcs.back() = last.arc();
  }
  return arcs;
}

}  // namespace trussmap
