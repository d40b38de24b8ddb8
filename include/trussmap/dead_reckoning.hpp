// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// Dead reckoning between two times of a recording, and routes from landmark to landmark.
//
//   A o . . . . rho_A . . . robot ~~~~~ drive ~~~~> robot . . rho_B . . o B
//     position 0                                                        displacement A -> B
//
// Without a compass: rows composed exactly, covariance in closed form per merged arc. With one:
// the heading is filtered row by row (extended Kalman filter over x, y and heading: wheels
// predict, each reading corrects, and what is learnt of the heading corrects the displacement
// driven since the start, too). Wheel noise as Chong & Kleeman; the model's further noise laws
// (heading per second or per radian, travel per second) are added to it.
#pragma once

#include "trussmap/arc.hpp"
#include "trussmap/model.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"

#include <limits>
#include <vector>

namespace trussmap {

/// Where the noise of one merged arc comes from: all that the model knows of wheels.
[[nodiscard]] ArcNoise arc_noise(const WheelTravel& travel, double duration, const Robot& robot,
                                 const Noise& noise);
/// Its covariance, in the arc's start frame.
[[nodiscard]] Matrix3 arc_covariance(const WheelTravel& travel, double duration, const Robot& robot,
                                     const Noise& noise);

/// Standing on it: no offset, sd `sighting` per coordinate. By range and bearing: the offset, with
/// `range` and `range_relative` along, `bearing` across.
[[nodiscard]] LandmarkOffset landmark_offset(const Sighting& sighting, const Noise& noise);

/// A first heading, and the time of the compass reading that it rests on (without: -infinity).
struct InitialHeading {
  HeadingEstimate heading;
  double reading_time = -std::numeric_limits<double>::infinity();  ///< s
};

/// Heading at time `t` in map axes: the first compass reading from there on, less the turn up to
/// it. Without a compass: 0, exactly, which makes this heading the map's +x direction.
[[nodiscard]] InitialHeading initial_heading(const MotionRows& drive, double t, const Robot& robot,
                                             const Noise& noise);

/// The robot sees a landmark that is the origin: where the robot then is.
[[nodiscard]] PoseEstimate pose_from_landmark(const HeadingEstimate& heading,
                                              const LandmarkOffset& landmark);

/// The robot drives from time `from` to time `to`, by its wheels and by its gyro where it has one.
/// Compass readings up to `readings_used_until` are passed over: `start` knows them already.
/// `slip`: how far it slips to its left in each row of the drive beside what its wheels show, m;
/// empty: not at all.
[[nodiscard]] PoseEstimate dead_reckon(
    const PoseEstimate& start, const MotionRows& drive, double from, double to, const Robot& robot,
    const Noise& noise, double readings_used_until = -std::numeric_limits<double>::infinity(),
    const std::vector<double>& slip = {});

/// Pose at the end of each row, from the first compass heading (else 0) at the origin. The first
/// heading is as uncertain as that reading leaves it; without a compass it is exact.
[[nodiscard]] std::vector<PoseEstimate> dead_reckoned_estimates(
    const MotionRows& drive, const Robot& robot, const Noise& noise,
    const std::vector<double>& slip = {});

/// Their poses alone.
[[nodiscard]] std::vector<Pose> dead_reckoned_path(const MotionRows& drive, const Robot& robot,
                                                   const Noise& noise,
                                                   const std::vector<double>& slip = {});

/// Position of a landmark that the robot at `pose` sees, with its covariance, both map axes.
struct PositionEstimate {
  Vector2 position = Vector2::Zero();
  Matrix2 covariance = Matrix2::Zero();
};
[[nodiscard]] PositionEstimate landmark_from_pose(const PoseEstimate& pose,
                                                  const LandmarkOffset& landmark);

}  // namespace trussmap
