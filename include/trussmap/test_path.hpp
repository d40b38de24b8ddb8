// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// A path that a robot is told to drive for a calibration: segments of constant curvature, in the
// order driven. Heading +x at the start, y to the left, angles counter-clockwise.
//
// As text, segments are separated by commas:
//
//   10        straight, 10 m ahead           -10       straight, 10 m backwards
//   a90       turn on the spot by 90 degrees, counter-clockwise (a-90: clockwise)
//   3@45      an arc of length 3 m that turns by 45 degrees in all (-3@45: driven backwards)
//   eight@1   a figure-eight: a circle of radius 1 m to the left, then one to the right
//
// "10,-10" is Chong & Kleeman's (1997) experiment: out and back.
//
// A drive over a map, as `trussmap plan` lays it, is a list of waypoints instead: landmarks one
// after the other, what to do at each, and how to come there.
//
//        bend         the robot comes at `speed`, turning by `bend` on its way (0: straight), and
//      .------.       stands on the landmark for `stop`; its loads are changed; it turns on the
//      spot
//     o        `o     by `turn`, whole turns included, at `turn_rate`, and leaves at `heading`
#pragma once

#include "trussmap/planar.hpp"

#include <string>
#include <vector>

namespace trussmap {

struct PathSegment {
  double distance = 0.0;  ///< m, signed: negative is backwards
  double turn = 0.0;      ///< rad, over the whole segment
};

using TestPath = std::vector<PathSegment>;

enum class Direction { cw, ccw };

/// A square of this side (m), driven once round: four straight legs, each with a quarter turn on
/// the spot after it, to the left (ccw) or to the right (cw).
[[nodiscard]] TestPath square_path(double side, Direction direction);

/// A figure-eight of two circles of this radius (m), above 0: once round to the left, then once
/// round to the right. To first order its end is off by -2 R a ahead, a what a circle lacks of its
/// turn (2 pi (1 - E_s/E_b)), and the heading by twice what a circle turns too far by E_d: the
/// position shows E_b alone, the heading E_d alone.
[[nodiscard]] TestPath figure_eight_path(double radius);

/// Driven length of the axle's centre, m.
[[nodiscard]] double path_length(const TestPath& path);

/// The driven length and half the wheelbase (m) times all that is turned: no run ends further off
/// than that, m.
[[nodiscard]] double largest_end_error(const TestPath& path, double wheelbase);

/// Throws std::invalid_argument: an empty segment, text, a number that is not finite, no motion at
/// all. The message names the segment and says what was expected.
[[nodiscard]] TestPath parse_path(const std::string& text);

struct Waypoint {
  std::string landmark;
  Vector2 place = Vector2::Zero();  ///< m, map frame
  double heading = 0.0;    ///< rad, map frame, in (-pi, pi]: as it leaves, at the last as it comes
  double speed = 0.0;      ///< m/s, on the way to it; 0 at the first
  double bend = 0.0;       ///< rad turned on the way to it, + to the left
  double stop = 0.0;       ///< s that it stands there
  double turn = 0.0;       ///< rad on the spot, + to the left; at the first whole turns alone
  double turn_rate = 0.0;  ///< rad/s; 0 where nothing is turned
  std::vector<double> loads;  ///< as DrivePlan::loads, as it leaves
};

struct DrivePlan {
  std::vector<std::string> loads;   ///< columns of the recording that the driver sets: "payload_kg"
  std::vector<Waypoint> waypoints;  ///< two or more, successive ones at different landmarks
};

/// Of the ways between waypoints, m: straight, but for their bends.
[[nodiscard]] double plan_length(const DrivePlan& plan);
/// Of driving, turning and standing, s.
[[nodiscard]] double plan_duration(const DrivePlan& plan);

}  // namespace trussmap
