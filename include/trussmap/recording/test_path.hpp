// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A path that a robot is told to drive for a calibration, as pieces of constant curvature. Heading
// +x at the start, y to the left, angles counter-clockwise.
#pragma once

#include <vector>

namespace trussmap {

struct PathPiece {
  double distance = 0.0;  ///< m, signed: negative is backwards
  double turn = 0.0;      ///< rad, over the whole piece
};

using TestPath = std::vector<PathPiece>;

enum class Direction { cw, ccw };

/// A square of this side (m), driven once round: four straight legs, each with a quarter turn on
/// the spot after it, to the left (ccw) or to the right (cw).
[[nodiscard]] TestPath square_path(double side, Direction direction);

/// Driven length of the axle's centre, m.
[[nodiscard]] double path_length(const TestPath& path);

}  // namespace trussmap
