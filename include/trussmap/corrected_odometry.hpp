// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// A model on the robot: its odometry corrected row by row, as the wheels turn.
//
//   wheels, compass, covariates --CorrectedOdometry, by a model--> motion of the row, pose so far
//
// The robot may have any drive (DriveKind): of two wheels a row says what left and right one
// travelled, of others what the model's columns read.
//
// The same as dead_reckoned_poses (fit_model.hpp) reckons afterwards from a recording of the same
// rows, but for what is not known yet:
//
//   rates        speed, turn_rate, acceleration, curvature, arc_angle and spin_angle are means over
//                the second up to the row's end, within one kind of motion; afterwards, over the
//                second about the row. They lag by half a second while the motion changes: of what
//                an effect of speed does over 10 s, some 1 % is missed on real robots, of one that
//                goes with turning about 10 %, of an arc loss 15 %.
//   heading, x, y  see the path corrected to the row itself; afterwards, two passes over the drive.
//                With a compass the first reading says what the heading of the map is; before it
//                heading counts from 0, and the covariance knows nothing of that reading yet.
//
// `compass` effects are taken off each reading, which then corrects heading and pose. Without a
// compass they do nothing. `lever`, `range`, `range_scale`, `bearing` and `delay` change no pose:
// corrected() applies them to a sighting. Truth does not occur here. Of noise that lasts
// (Noise::processes) a compass's counts, as white noise whose mean is as uncertain; that of the
// motion does not: covariances are those of the wheels' white noise.
//
// Cost: a microsecond or so per row and shape; memory for the rows of two seconds.
#pragma once

#include "trussmap/arc.hpp"
#include "trussmap/dead_reckoning.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace trussmap {

/// What the robot has besides its wheels.
struct OdometryInputs {
  std::vector<std::string> covariates = {};  ///< names, in the order in which rows give the values
  bool compass = false;                      ///< whether there will ever be a reading
  bool gyro = false;                         ///< likewise
};

struct WheelRow {
  double duration = 0.0;      ///< s
  double left = 0.0;          ///< m, signed travel of the left wheel, of the drive `differential`
  double right = 0.0;         ///< m
  double compass = kAbsent;   ///< rad, reading at the row's end; NaN: none
  double yaw_rate = kAbsent;  ///< rad/s, gyro, mean over the row; NaN: none
  /// Of other drives, in place of left and right: what the columns that the model names (Robot)
  /// read in the row, in their order. m; rad where one steers.
  std::vector<double> readings = {};
};

struct CorrectedRow {
  /// By the wheels, and the gyro where there is one, in the frame of the row's start, effects taken
  /// off; covariance of (x, y, heading).
  Motion motion;
  /// At the row's end, in the axes of the robot as it started. With a compass, by its readings too;
  /// the covariance then holds what they leave of the first heading.
  PoseEstimate pose;
};

struct CorrectedSighting {
  Sighting sighting;                       ///< t moved back by the delay; range and bearing
  Vector2 sensor_robot = Vector2::Zero();  ///< m, robot frame: from where it was seen, or what
                                           ///< met the landmark: the levers
};

/// Movable. Equal rows give equal results, to the bit. One thread at a time; several of one model
/// may drive in as many threads.
class CorrectedOdometry {
 public:
  /// Effects without coefficients count as 0; one that is `per_session` must have those of one
  /// session. Throws std::invalid_argument, naming the effect, where it has no shape, a number of
  /// coefficients that does not match, a shape with a variable that the robot does not supply, or
  /// is of another drive than the robot's; and where a covariate's name is a variable's already,
  /// the wheelbase is not positive, or the robot has not the columns or lengths of its drive.
  explicit CorrectedOdometry(const Model& model, const OdometryInputs& inputs = {});
  ~CorrectedOdometry();
  CorrectedOdometry(CorrectedOdometry&&) noexcept;
  CorrectedOdometry& operator=(CorrectedOdometry&&) noexcept;

  /// The next row. `covariates` are its values, in the order of the names. Throws
  /// std::invalid_argument, and leaves all as it was, on a duration that is not positive, a number
  /// that is not finite, too few or too many covariates or readings of wheels, a steering angle
  /// that leaves the measured wheel no way ahead, a reading where there is no compass or gyro, and,
  /// naming the effect, where a shape has no finite value.
  CorrectedRow drive(const WheelRow& row, std::span<const double> covariates = {});

  /// The pose as the last row left it.
  [[nodiscard]] const PoseEstimate& pose() const;

  /// Counts the pose anew from here. Time, distance, rates and where the robot is in the map go on;
  /// so does the heading's variance with a compass.
  void reset();

  /// Where the robot is in the map, for shapes that speak of it; from the start on (0, 0, 0). The
  /// pose is not touched. With a compass the heading stays that of the readings.
  void set_map_pose(const Pose& pose_map);

  /// A sighting that is made now, at the end of the last row; its `t` is on any clock, s. Shapes
  /// are taken now, those of a delay without heading, x and y (0). A range that its offset exceeds
  /// becomes 0. Throws std::invalid_argument, naming the effect, where a shape has no finite value:
  /// before the first row one of a covariate has none.
  [[nodiscard]] CorrectedSighting corrected(const Sighting& sighting) const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace trussmap
