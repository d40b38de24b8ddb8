// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What wheels and compass say of one segment of a drive, as four numbers with their joint
// covariance.
//
//   start o~~~~~~~~~~~~~~~~> end      d, a    end pose in the frame of the start     m, rad
//          ^  ^  ^  ^  ^  ^           m       mean over the segment's compass readings of
//          readings                           (reading - turned since the start):
//                                             an observation of the start heading   rad
//
// The readings are white; the turn between them is not: an error in a row's turn is in (d, a) and
// in all later readings' reckoned headings. With S the sum of heading errors at the n readings,
//
//   m = heading + (sum of reading errors - S)/n
//
// so the covariance of (x, y, a, S) is carried from row to row like that of (x, y, a): a reading
// adds the present heading error to S. Rows are arcs (trussmap/arc.hpp), in closed form.
//
// Physical effects change rows in a pattern per coefficient: what one unit of it adds to the row's
// forward travel, sideways slip and turn, and to the compass reading at the row's end. Their exact
// derivatives come with the motion.
#pragma once

#include "effects/channel_physics.hpp"
#include "odometry/merge.hpp"
#include "trussmap/model.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"

#include <memory>
#include <utility>
#include <vector>

namespace trussmap::estimation {

using Vector4 = Eigen::Vector4d;
using Matrix4 = Eigen::Matrix4d;

/// One row of a segment, or the part of it inside.
struct SegmentRow {
  std::size_t row = 0;       ///< of the drive
  double part = 1.0;         ///< share of the row
  double path = 0.0;         ///< m, signed, of the axle's centre
  double turn = 0.0;         ///< rad
  double duration = 0.0;     ///< s
  double reading = kAbsent;  ///< rad, compass at the end of this row; NaN: none
  double slip = 0.0;         ///< m to the left, that the wheels show
};

/// A segment's rows, which copies share: of a week's drive they are a million.
class SegmentRows {
 public:
  SegmentRows() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): to be used as the vector that it holds
  SegmentRows(std::vector<SegmentRow> rows)
      : rows_(std::make_shared<const std::vector<SegmentRow>>(std::move(rows))) {}

  // NOLINTNEXTLINE(google-explicit-constructor)
  operator const std::vector<SegmentRow>&() const { return *rows_; }
  [[nodiscard]] std::size_t size() const { return rows_->size(); }
  [[nodiscard]] auto begin() const { return rows_->begin(); }
  [[nodiscard]] auto end() const { return rows_->end(); }

 private:
  std::shared_ptr<const std::vector<SegmentRow>> rows_ =
      std::make_shared<const std::vector<SegmentRow>>();
};

/// The four numbers. Without readings the mean is NaN.
struct SegmentMotion {
  Pose displacement;  ///< end pose in the frame of the start; heading not wrapped
  double mean_heading = kAbsent;
};

/// Rows between two times.
[[nodiscard]] std::vector<SegmentRow> segment_rows(const MotionRows& drive, double from, double to);

/// Compass readings among the rows.
[[nodiscard]] int readings_of(const std::vector<SegmentRow>& rows);

/// A row as effects move it that do this together to the drive's rows (empty: nothing).
[[nodiscard]] SegmentRow with_effects(SegmentRow row,
                                      const std::vector<effects::DrivePattern>& sum);
[[nodiscard]] std::vector<SegmentRow> with_effects(std::vector<SegmentRow> rows,
                                                   const std::vector<effects::DrivePattern>& sum);

/// The motion as the rows have it.
[[nodiscard]] SegmentMotion segment_motion(const std::vector<SegmentRow>& rows);

/// The motion with effects: `patterns` per coefficient, per row of the drive (empty: no influence),
/// and its derivatives by the coefficients, 4 x coefficients (the fourth row zero without
/// readings).
struct SegmentWithEffects {
  SegmentMotion motion;
  Eigen::Matrix<double, 4, Eigen::Dynamic> derivatives;
};
[[nodiscard]] SegmentWithEffects segment_motion(
    const std::vector<SegmentRow>& rows,
    const std::vector<const std::vector<effects::DrivePattern>*>& patterns,
    const Eigen::VectorXd& coefficients);

/// What one unit of more motion in each row does to the segment's displacement (3) and mean
/// innovation (1): per row a 4x4 whose columns are those of DrivePattern.
[[nodiscard]] std::vector<Matrix4> row_influences(const std::vector<SegmentRow>& rows);

/// Joint covariance of (d, a, m), in the frame of the start; fourth row and column zero without
/// readings. Never below (10 micrometres)^2 and (10 microradians)^2, lest standing still be exact.
[[nodiscard]] Matrix4 segment_covariance(const MotionRows& drive,
                                         const std::vector<SegmentRow>& rows, const Robot& robot,
                                         const Noise& noise);

}  // namespace trussmap::estimation
