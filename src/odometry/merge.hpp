// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Rows of a drive merged into arcs of constant curvature, so that covariance costs one closed form
// per arc, not one per row.
//
//   q   (R - L)/(|R| + |L|) of the travels that two wheels at the wheelbase B show, in [-1, 1]: the
//       row's curvature, times B/2 while both turn the same way; +-1 where one stands, and for any
//       turn on the spot
//
// A row joins the arc before it while it is the same kind of motion (forward, backward, turning on
// the spot left or right, standing) and its q lies within 0.1 of the arc's, or within what wheel
// noise explains, and while the arc ends within 1 % of its length of where its rows end. The rows'
// own displacements are not merged: their exact composition is what odometry measured.
#pragma once

#include "trussmap/arc.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <vector>

namespace trussmap::odometry {

struct DriveArc {
  BodyMotion motion;      ///< sums over the rows, nothing to the side
  double duration = 0.0;  ///< s
  std::size_t rows = 0;   ///< how many
};

/// A row, or the part of it inside a span of time.
struct DriveRow {
  std::size_t row = 0;
  double part = 1.0;      ///< share of the row's travel
  double duration = 0.0;  ///< s
  bool ends = true;       ///< the span holds the row's end, where the compass was read
};

/// The rows between two times, first and last cut to fit. `from` <= `to`; times outside of the
/// drive are cut to it.
[[nodiscard]] std::vector<DriveRow> rows_between(const MotionRows& drive, double from, double to);

/// Of the row, or its part.
[[nodiscard]] BodyMotion motion_of(const MotionRows& drive, const DriveRow& row);

/// An arc as rows join it, one after the other.
class GrowingArc {
 public:
  /// Takes the next row in; true where it begins a new arc.
  bool take(const BodyMotion& row, double duration, const Robot& robot, const WheelNoise& noise);
  [[nodiscard]] const DriveArc& arc() const { return arc_; }

 private:
  [[nodiscard]] GrowingArc with(const BodyMotion& row, double duration, const Robot& robot) const;
  [[nodiscard]] bool keeps_shape() const;

  DriveArc arc_;
  Pose rows_;          ///< the rows' own displacement
  double path_ = 0.0;  ///< of the wheels, m
};

/// The arcs of these rows, in order.
[[nodiscard]] std::vector<DriveArc> merge_rows(const MotionRows& drive,
                                               const std::vector<DriveRow>& rows,
                                               const Robot& robot, const WheelNoise& noise);

}  // namespace trussmap::odometry
