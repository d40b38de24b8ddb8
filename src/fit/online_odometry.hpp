// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// CorrectedOdometry's work (trussmap/corrected_odometry.hpp), with what others of the library ask
// of the last row besides: how the channels of effects see it, and its compass reading.
#pragma once

#include "fit/online_effects.hpp"
#include "fit/row_at_hand.hpp"
#include "odometry/row_reckoner.hpp"
#include "trussmap/corrected_odometry.hpp"

#include <span>
#include <utility>
#include <vector>

namespace trussmap::fitting {

/// Where the robot is, and by what.
struct Reckoning {
  odometry::RowReckoner reckoner;
  Pose start_map = {};           ///< where the pose is counted from
  bool heading_known = false;    ///< by a reading
  double turned_variance = 0.0;  ///< rad^2, since the start, until a reading comes

  [[nodiscard]] Pose map_pose(const Pose& pose) const { return compose(start_map, pose); }
  [[nodiscard]] Pose map_pose() const { return map_pose(reckoner.at().pose); }
};

class OnlineOdometry {
 public:
  /// Calls and errors are those of CorrectedOdometry.
  OnlineOdometry(const Model& model, OdometryInputs inputs);

  CorrectedRow drive(const WheelRow& row, std::span<const double> covariates);
  [[nodiscard]] const PoseEstimate& pose() const { return now_.reckoner.at(); }
  void reset();
  void set_map_pose(const Pose& pose_map);
  [[nodiscard]] CorrectedSighting corrected(const Sighting& sighting) const;

  /// The model has these effects from the next row on. Throws as the constructor does.
  void set_effects(const std::vector<Effect>& effects);

  /// The last row as channels see it; what it points to lives until the next row.
  [[nodiscard]] const drive::RowMotion& shown() const { return shown_; }
  /// Its compass reading less what effects add to it, rad; NaN: none.
  [[nodiscard]] double reading() const { return reading_; }
  /// By how much the gyro's turn exceeds the wheels', less what effects add to it, rad.
  [[nodiscard]] double excess() const { return excess_; }

 private:
  [[nodiscard]] Pose middle_of(const Reckoning& after) const;
  odometry::ReckonedRow cleared(const odometry::ReckonedRow& row, const GyroShare& gyro,
                                const OnlineFacts& facts, const Reckoning& after);

  RowAtHand at_hand_;
  OdometryInputs inputs_;
  OnlineEffects effects_;
  drive::CausalVariables variables_;
  drive::CausalRow last_;
  std::vector<double> covariates_;  ///< of the last row
  Reckoning now_;
  drive::RowMotion shown_;
  double reading_ = kAbsent;
  double added_excess_ = 0.0;  ///< by the effects, to the row at hand
  double excess_ = 0.0;
};

}  // namespace trussmap::fitting
