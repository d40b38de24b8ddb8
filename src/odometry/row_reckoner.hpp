// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Dead reckoning row by row: what dead_reckoning.hpp does with a drive, as its rows come.
//
//   without a compass   covariance by the arc that the row belongs to: from the arc's start, one
//                       closed form over all of its rows so far
//   with one            row by row, and each reading corrects (extended Kalman filter)
//   with a gyro, or with other wheels than two   row by row
#pragma once

#include "odometry/merge.hpp"
#include "trussmap/arc.hpp"
#include "trussmap/dead_reckoning.hpp"

#include <optional>

namespace trussmap::odometry {

/// In the frame of its start.
[[nodiscard]] Pose displacement_of(const BodyMotion& motion);
/// What its end is unsure by, as arc_covariance, of a row or the part of it that lasts `duration`
/// s.
[[nodiscard]] Matrix3 row_covariance(const MotionRows& drive, std::size_t row, double part,
                                     double duration, const Robot& robot, const Noise& noise);

/// Variance of a single compass reading, rad^2: white noise and what lasts.
[[nodiscard]] double reading_variance(const Noise& noise);
/// The white noise that a row's reading has to be given, lest a filter that knows no other average
/// away what lasts: of a process with correlation phi from row to row sd^2 (1 + phi)/(1 - phi), the
/// variance of its mean over many times their number.
[[nodiscard]] double white_equivalent(const Noise& noise, double duration, double way);

struct ReckonedRow {
  BodyMotion motion;
  double duration = 0.0;     ///< s
  double slip = 0.0;         ///< m to the left, beside what the wheels show
  double reading = kAbsent;  ///< rad, compass at the row's end; NaN: none
  /// Where a gyro was taken in, or of other wheels than two: the row's noise. Absent: the wheels'.
  std::optional<ArcNoise> noise = std::nullopt;

  /// With the slip.
  [[nodiscard]] BodyMotion whole() const { return motion + BodyMotion{0.0, slip, 0.0}; }
};

/// Of the row's motion, in the frame of its start.
[[nodiscard]] Matrix3 covariance_of(const ReckonedRow& row, const Robot& robot, const Noise& noise);

class RowReckoner {
 public:
  RowReckoner(const PoseEstimate& start, bool compass)
      : at_(start), anchor_(start), compass_(compass) {}

  void take(const ReckonedRow& row, const Robot& robot, const Noise& noise);
  /// The heading at the origin, that all was reckoned from, turns out to have this variance (rad^2)
  /// besides; with a compass alone.
  void add_first_variance(double variance);

  [[nodiscard]] const PoseEstimate& at() const { return at_; }

 private:
  PoseEstimate at_;
  PoseEstimate anchor_;  ///< where the arc began
  GrowingArc arc_;
  bool compass_;
};

}  // namespace trussmap::odometry
