// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where a wheeled robot really went: laid down first, without a thought of its sensors.
//
//   L1 o .  (bow)  . o L2        At every landmark: rest perhaps, spin to the next leg's first
//        spin   drive            direction, drive. A leg is a gentle bow or S, or has a corner
//                                with a spin half-way. The true stop lies a little off the
//                                landmark.
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

#include "simulation/mesh_world.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace trussmap {

/// What else was the case during a row: the covariate columns.
struct Surroundings {
  double payload_kg = 0.0;
  double lights = 0.0;  ///< 1 switched on, 0 off
  double temperature_C = 20.0;
};

enum class Activity { rest, spin, drive };

/// One odometry interval of true motion.
struct TrueRow {
  double t = 0.0;          ///< s, end of the interval
  double duration = 0.0;   ///< s
  double speed = 0.0;      ///< m/s, constant within the row
  double turn_rate = 0.0;  ///< rad/s, constant within the row
  Activity activity = Activity::rest;
  Pose pose;  ///< at t; heading not wrapped
  Surroundings surroundings;
  double slip_speed = 0.0;  ///< m/s to its left, constant within the row
  double jump = 0.0;        ///< m ahead beside its speed, all through the row
};

/// The robot at a landmark.
struct TrueStop {
  double t = 0.0;        ///< s, the end of a row, or the start of the first
  int landmark = -1;     ///< of the mesh
  std::size_t rows = 0;  ///< rows driven until then
  Pose pose;             ///< true pose of the axle; its position is off the landmark's
};

struct TrueMotion {
  Pose start;  ///< before the first row, at time 0
  std::vector<TrueRow> rows;
  std::vector<TrueStop> stops;     ///< one per landmark of the walk
  std::vector<Covariate> further;  ///< what else was the case, one value per row
  std::vector<int> segments;       ///< rows of each rest, spin and drive, in order
};

/// What a path gives way to. Empty lists: to nothing.
struct PathBias {
  std::vector<double> slip;     ///< per row, sideways (to the left) for every forward metre
  std::vector<double> jump;     ///< per row: ahead, while it spins on the spot, m
  std::vector<Vector2> sensor;  ///< per stop: what meets the landmark, from the axle; robot axes, m
  std::vector<int> segments;    ///< rows of each segment, of an earlier path of the same seed
};

/// How the robot drives. Ranges are drawn from uniformly, anew for each leg or spin.
struct DrivingStyle {
  double row_duration = 0.1;       ///< s
  double slowest = 0.25;           ///< m/s
  double fastest = 0.9;            ///< m/s
  double slowest_turn = 0.3;       ///< rad/s, on the spot
  double fastest_turn = 1.1;       ///< rad/s
  double bend = 0.15;              ///< rad, standard deviation of each of a leg's three bends
  double corner_share = 0.1;       ///< fraction of legs with a corner half-way
  double corner_reach = 0.15;      ///< how far the corner lies off the straight leg, of its length
  double rest_share = 0.0;         ///< fraction of stops with a rest
  double shortest_rest = 2.0;      ///< s
  double longest_rest = 20.0;      ///< s
  int full_spins = 0;              ///< stops, spread evenly, with two full turns left, two right
  double standing = 0.005;         ///< m per coordinate, standard deviation of stop - landmark
  double load_change_share = 0.7;  ///< chance of another payload for the next leg
  double lights_change_share = 0.5;
  double first_rest = 0.0;  ///< s, before the first sighting
  double last_rest = 0.0;   ///< s, after the last
  double overrun = 0.0;     ///< m driven straight on after each landmark, before the spin
  double ramp = 0.0;        ///< s in which a drive reaches its speed, and leaves it
  std::vector<std::string> covariates;  ///< further columns: anew at one stop in two, from 0 to 1
};

/// Lays the path along a walk (landmarks of the mesh, successive ones different). The robot starts
/// on the first landmark with heading 0 at time 0. Throws std::invalid_argument on a walk of fewer
/// than two landmarks, on a style that makes no sense, and on landmarks so near each other (below
/// 20 `standing`, or 1 cm) that a leg would have no direction. The same seed gives the same path;
/// with a bias, the same style of driving on a path that gives way to it.
[[nodiscard]] TrueMotion lay_path(const Mesh& mesh, const std::vector<int>& walk,
                                  const DrivingStyle& style, std::uint64_t seed,
                                  const PathBias& bias = {});

}  // namespace trussmap
