// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A piece of a drive, as the adjustment measures it: where it led, which way the compass says it
// began, and how unsure both are together.
//
//   z        displacement (x, y, turn) in the frame of the piece's start               m, m, rad
//   c        heading at the start: mean over the readings of reading - turn so far    rad
//   n, w     compass noise; error of the reckoned turn, which grows along the piece    rad
//   C        joint covariance of the errors of (z, c): true - reckoned of z, measured - true of c
//
// With row r's own noise covariance Q_r (odometry/arc.hpp, in the row's frame), F_r what it does to
// the piece's end, and a_r the share of the readings that come after row r began:
//
//   error of z = sum F_r n_r,   error of c = mean(n) + sum a_r w_r
//   C_zz = sum F_r Q_r F_r',  C_zc = sum a_r F_r Q_r e_3,  C_cc = sd^2/N + sum a_r^2 Q_r(3,3)
//
// Compass and wheels share the wheels' noise: taken as independent, the heading would look too
// sure. One pass over the rows; so is what a systematic perturbation of the rows does to (z, c).
#pragma once

#include "trussmap/odometry/dead_reckoning.hpp"
#include "trussmap/odometry/merge.hpp"

#include <vector>

#include <Eigen/Core>

namespace trussmap {

using Vector4 = Eigen::Vector4d;
using Matrix4 = Eigen::Matrix4d;

/// A drive's row as a part of a piece.
struct PieceRow {
  DriveRow row;
  double path = 0.0;              ///< m
  double turn = 0.0;              ///< rad
  double heading = 0.0;           ///< at its start, from the piece's, rad
  Vector2 end = Vector2::Zero();  ///< its end, in the frame of the piece's start, m
  double readings_after = 0.0;    ///< a_r
};

struct Piece {
  double from = 0.0;  ///< s
  double to = 0.0;    ///< s
  Pose displacement;  ///< z
  int readings = 0;
  double compass = 0.0;                  ///< c, meaningless without readings
  Matrix4 covariance = Matrix4::Zero();  ///< C; last row and column 0 without readings
  std::vector<PieceRow> rows;
};

/// The drive between two times.
[[nodiscard]] Piece reckon_piece(const Drive& drive, double from, double to, const Model& model);

/// Perturbation of each row of a drive; empty = none.
struct RowPerturbation {
  std::vector<double> along;    ///< m per row
  std::vector<double> lateral;  ///< m per row, to the left
  std::vector<double> turn;     ///< rad per row
  std::vector<double> compass;  ///< rad, of the reading at the row's end
};

/// What it does to (z, c) of a piece of that drive, to first order.
[[nodiscard]] Vector4 response(const Piece& piece, const Drive& drive,
                               const RowPerturbation& perturbation);

/// Times at which the robot goes over from turning on the spot to driving, or back.
[[nodiscard]] std::vector<double> changes_of_motion(const Drive& drive);

}  // namespace trussmap
