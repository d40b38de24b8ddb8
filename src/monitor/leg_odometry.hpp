// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A leg's odometry for the monitor: where it led, how unsure that is, and what each effect and each
// lasting error would add to it.
//
// Errors of a leg are five numbers, in the frame of its start:
//
//   e = (x, y [m], heading, mean heading over the compass readings, the gyro's excess [rad])
//
//   e_k = F_k e_{k-1} + G_k (error of row k)      rows one after the other
//
// Noise, effects and lasting errors go the same way. An effect is a constant g of a channel: what
// it adds to a row is the channel's physics (effects/channel_physics.hpp). The excess is that of
// the gyro's turn beyond the wheels', which does not correlate with the motion of both together
// (odometry/wheels_and_gyro.hpp).
#pragma once

#include "drive/row_motion.hpp"
#include "effects/channel_physics.hpp"
#include "trussmap/arc.hpp"
#include "trussmap/channel.hpp"
#include "trussmap/model.hpp"
#include "trussmap/planar.hpp"

#include <vector>

#include <Eigen/Core>

namespace trussmap::monitor {

using LegVector = Eigen::Matrix<double, 5, 1>;
using LegMatrix = Eigen::Matrix<double, 5, 5>;
using LegColumns = Eigen::Matrix<double, 5, Eigen::Dynamic>;

/// Some numbers of a LegVector.
inline constexpr Eigen::Index kLegMeanHeading = 3;
inline constexpr Eigen::Index kLegExcess = 4;

struct LegReckoning {
  Pose displacement = {};                    ///< end in the frame of the start
  LegMatrix covariance = LegMatrix::Zero();  ///< of the rows' white noise
  LegColumns by_channel = {};                ///< what one unit of g adds, a column per channel
  double duration = 0.0;                     ///< s
  double way = 0.0;                          ///< m driven
  int rows = 0;                              ///< that were driven
  int readings = 0;                          ///< of the compass
  double heading = 0.0;   ///< rad, of the leg's start: mean of readings less the turn up to each
  int gyro_readings = 0;  ///< rows of the gyro
  double excess = 0.0;    ///< rad
};

class LegOdometry {
 public:
  /// `channels`: those whose patterns are to be followed.
  explicit LegOdometry(std::vector<Channel> channels);

  /// A row's motion with its covariance, as channels see it, and the compass reading at its end
  /// (rad, NaN: none), the gyro's excess (rad) and its variance.
  void take(const Motion& motion, const drive::RowMotion& shown, double reading, double excess,
            double excess_variance);

  /// The leg so far; a new one begins.
  [[nodiscard]] LegReckoning finish();
  [[nodiscard]] double duration() const { return leg_.duration; }
  [[nodiscard]] double way() const { return leg_.way; }

 private:
  void read_compass(double reading);
  void begin();

  std::vector<Channel> channels_;
  LegReckoning leg_;
  double first_reading_ = 0.0;  ///< rad, less the turn up to it
  double sum_of_readings_ = 0.0;
};

}  // namespace trussmap::monitor
