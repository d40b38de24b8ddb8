// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// Where a robot stands, by three distances to two walls at right angles: the absolute measurement
// of Borenstein & Feng (1996, 3.1 and 5: "measuring the distance between three specific points on
// the robot and the walls", by tape or by three ultrasonic sensors, two of which face one wall) and
// of Chong & Kleeman (1997, 5.1).
//
//        wall B  |                 m_i     where sensor i is, robot axes (x ahead)   m
//                |   1     2       u_i     direction in which it faces its wall      -
//            3 --|---o-----o->     d_i     its distance from the wall, perpendicular m
//                |   |d1   |d2     p       the axle's centre, from the corner        m
//        --------+------------     theta   heading, counter-clockwise                rad
//                     wall A
//
//   d_i = -u_i . (p + R(theta) m_i)
//
// Axes are parallel to the walls, their origin is the corner, x points ahead of a robot whose
// sensors face their walls squarely (theta = 0). The two that face the same wall differ by the
// heading alone, which follows in closed form, and p from it:
//   u . R(theta) (m_1 - m_2) = d_2 - d_1
//
// Distances are perpendicular ones: what a tape finds by swinging it, and what an ultrasonic sensor
// measures while the wall is within its beam. (A laser that points askew measures d / cos(theta).)
// Sensors 0.4 m apart, good to 2 mm, give the heading to 7 mrad, 0.4 degrees, as the paper states.
// Where the start is measured as the end is, errors that are always alike cancel.
#pragma once

#include "trussmap/planar.hpp"

#include <array>
#include <optional>

namespace trussmap {

enum class Faces { ahead, left, behind, right };

struct WallSensor {
  Faces faces = Faces::left;
  Vector2 at = Vector2::Zero();  ///< m, robot axes: x ahead of the axle's centre, y to its left
  double sd = 0.0;               ///< m, standard deviation of a distance; 0: not stated
};

using WallSensors = std::array<WallSensor, 3>;
using WallDistances = std::array<double, 3>;  ///< m, perpendicular, in the order of the sensors

/// Throws std::invalid_argument unless two of them face the same wall, apart from each other along
/// it by more than their distances from it differ, and the third one a wall at right angles to it.
void check_wall_sensors(const WallSensors& sensors);

struct WallPose {
  Pose pose;                             ///< from the corner, m, m, rad
  Matrix3 covariance = Matrix3::Zero();  ///< by the sensors' standard deviations
};

/// Throws std::invalid_argument where the distances fit no heading, or one of more than 45 degrees.
[[nodiscard]] WallPose pose_by_walls(const WallSensors& sensors, const WallDistances& distances);

/// A run that starts and ends in the corner.
struct WallRun {
  WallDistances start = {};
  WallDistances end = {};
  Pose odometry;  ///< at the end, from the start: x ahead there
};

/// Absolute - calculated, in the frame of the start.
struct WallError {
  Eigen::Vector3d error = Eigen::Vector3d::Zero();  ///< m, m, rad
  Matrix3 covariance = Matrix3::Zero();             ///< of both measurements
};

/// Throws as pose_by_walls does.
[[nodiscard]] WallError end_error(const WallSensors& sensors, const WallRun& run);

}  // namespace trussmap
