// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/odometry/piece.hpp"

#include <cmath>

namespace trussmap {
namespace {

/// What a row's noise, in its own frame, does to the piece's end.
Matrix3 effect_on_end(const PieceRow& row, const Vector2& end) {
  Matrix3 F = pose_rotation(row.heading);
  F.topRightCorner<2, 1>() = quarter_turn(end - row.end);
  return F;
}

double value_at(const std::vector<double>& values, std::size_t row) {
  return values.empty() ? 0.0 : values[row];
}

bool has_reading(const Drive& drive, const DriveRow& row) {
  return drive.has_compass() && row.ends && !std::isnan(drive.heading[row.row]);
}

}  // namespace

Piece reckon_piece(const Drive& drive, double from, double to, const Model& model) {
  Piece piece;
  piece.from = from;
  piece.to = to;
  double sum = 0.0;
  double first = 0.0;
  for (const DriveRow& row : rows_between(drive, from, to)) {
    PieceRow one;
    one.row = row;
    one.heading = piece.displacement.heading;
    const WheelTravel travel = travel_of(drive, row);
    one.path = 0.5 * (travel.left + travel.right);
    one.turn = (travel.right - travel.left) / model.robot.wheelbase;
    piece.displacement =
        compose(piece.displacement, arc_displacement(travel, model.robot.wheelbase));
    one.end = piece.displacement.position();
    if (has_reading(drive, row)) {
      const double start = drive.heading[row.row] - piece.displacement.heading;
      if (piece.readings == 0) first = start;
      sum += unwrap_near(start, first);
      ++piece.readings;
    }
    piece.rows.push_back(one);
  }
  const int readings = piece.readings;
  int left = readings;
  for (PieceRow& one : piece.rows) {
    one.readings_after = readings > 0 ? static_cast<double>(left) / readings : 0.0;
    if (has_reading(drive, one.row)) --left;
    const Matrix3 Q =
        arc_covariance(travel_of(drive, one.row), one.row.duration, model.robot, model.noise);
    const Matrix3 F = effect_on_end(one, piece.displacement.position());
    const Matrix3 FQ = F * Q;
    piece.covariance.topLeftCorner<3, 3>() += FQ * F.transpose();
    piece.covariance.topRightCorner<3, 1>() += one.readings_after * FQ.col(2);
    piece.covariance(3, 3) += one.readings_after * one.readings_after * Q(2, 2);
  }
  if (readings > 0) {
    piece.compass = sum / readings;
    piece.covariance(3, 3) += model.noise.compass * model.noise.compass / readings;
  }
  piece.covariance.bottomLeftCorner<1, 3>() = piece.covariance.topRightCorner<3, 1>().transpose();
  return piece;
}

Vector4 response(const Piece& piece, const Drive& drive, const RowPerturbation& perturbation) {
  Vector4 result = Vector4::Zero();
  for (const PieceRow& one : piece.rows) {
    const std::size_t row = one.row.row;
    const double turn = one.row.part * value_at(perturbation.turn, row);
    const double along = one.row.part * value_at(perturbation.along, row);
    const double lateral = one.row.part * value_at(perturbation.lateral, row);
    // The row is an arc: chord = path sinc(turn/2), in the direction of its middle.
    const double half = 0.5 * one.turn;
    const bool straight = std::abs(half) < 1e-4;
    const double sinc = straight ? 1.0 - half * half / 6.0 : std::sin(half) / half;
    const double slope = straight ? -half / 3.0 : (std::cos(half) - sinc) / half;
    const Vector2 ahead = rotation(one.heading + half).col(0);
    const Vector2 by_turn = 0.5 * one.path * (slope * ahead + sinc * quarter_turn(ahead));
    result.head<2>() += sinc * (along * ahead + lateral * quarter_turn(ahead)) +
                        turn * (by_turn + quarter_turn(piece.displacement.position() - one.end));
    result[2] += turn;
    result[3] -= one.readings_after * turn;
    if (piece.readings > 0 && has_reading(drive, one.row)) {
      result[3] -= value_at(perturbation.compass, row) / piece.readings;
    }
  }
  return result;
}

std::vector<double> changes_of_motion(const Drive& drive) {
  constexpr double kStanding = 1e-6;  // m per row
  std::vector<double> times;
  int before = 0;  // 1: turning on the spot, 2: driving
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    if (std::abs(drive.left[row]) + std::abs(drive.right[row]) < kStanding) continue;
    const int now = drive.left[row] * drive.right[row] < 0.0 ? 1 : 2;
    if (before != 0 && now != before) times.push_back(row == 0 ? drive.start() : drive.t[row - 1]);
    before = now;
  }
  return times;
}

}  // namespace trussmap
