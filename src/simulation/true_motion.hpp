// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where a wheeled robot really went: the path is laid first, independently of its sensors.
//
//   L1 o .  (bow)  . o L2        At every landmark: rest perhaps, spin to the next leg's first
//        spin   drive            direction, drive. A leg is a gentle bow or S, or has a corner
//                                with a spin half-way. The true stop lies a little off the
//                                landmark. Other wheels drive otherwise (driving_manner.hpp).
//
// In each row speed and turn rate are constant, so a row is an arc; rests, spins and drives begin
// and end with a row. A leg's shape is a profile of headings over its length, which is scaled and
// turned so that it ends at its stop; positions come from quadrature of the headings.
//
// Whatever disturbs odometry acts between a TrueRow and the sensors (see wheeled_robot.hpp): the
// row has all that an effect may depend on. Two kinds of effect change the path itself: wheels that
// creep sideways, and a sensor beside the axle with which the robot stops on its landmarks
// (PathBias).
#pragma once

#include "simulation/driving_manner.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/simulation.hpp"

#include <cstdint>
#include <vector>

namespace trussmap::simulation {

/// What a path gives way to. Empty lists: to nothing.
struct PathBias {
  std::vector<double> slip;     ///< per row, sideways (to the left) for every forward metre
  std::vector<double> jump;     ///< per row: ahead, while it spins on the spot, m
  std::vector<Vector2> sensor;  ///< per stop: what meets the landmark, from the axle; robot axes, m
  std::vector<int> segments;    ///< rows of each segment, of an earlier path of the same seed
  std::vector<double> turns;    ///< likewise TrueMotion::turns

  [[nodiscard]] double slip_of(std::size_t row) const {
    return row < slip.size() ? slip[row] : 0.0;
  }
  [[nodiscard]] double jump_of(std::size_t row) const {
    return row < jump.size() ? jump[row] : 0.0;
  }
  [[nodiscard]] Vector2 sensor_at(std::size_t stop) const {
    return stop < sensor.size() ? sensor[stop] : Vector2::Zero();
  }
  [[nodiscard]] int rows_of(std::size_t segment, int otherwise) const {
    return segment < segments.size() ? segments[segment] : otherwise;
  }

  /// Where so much way on a course (robot axes, of length 1) takes the robot whose axis ahead is
  /// this on average, and the slip of the row with it.
  [[nodiscard]] Vector2 step_of(double way, const Vector2& ahead, const Vector2& course,
                                std::size_t row) const;
};

/// Lays the path along a walk (landmarks of the mesh, successive ones different). The robot starts
/// on the first landmark with heading 0 at time 0. Throws std::invalid_argument on a walk of fewer
/// than two landmarks, on a style that makes no sense, and on landmarks so near each other (below
/// 20 `standing`, or 1 cm) that a leg would have no direction. The same seed gives the same path;
/// with a bias, the same style of driving on a path that gives way to it. A robot that cannot turn
/// on the spot needs legs twice as long as the radius of its tightest bend.
[[nodiscard]] TrueMotion lay_path(const Mesh& mesh, const std::vector<int>& walk,
                                  const DrivingStyle& style, std::uint64_t seed,
                                  const PathBias& bias = {}, const DrivingManner& manner = {});

}  // namespace trussmap::simulation
