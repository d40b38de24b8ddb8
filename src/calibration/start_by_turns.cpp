// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/start_by_turns.hpp"

#include "odometry/merge.hpp"
#include "trussmap/planar.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/QR>

namespace trussmap::calibration {
namespace {

/// What one stretch turns: by the wheels, by their ratio, by a gyro's bias; and by the other
/// sensor.
struct Turned {
  Eigen::Vector3d by = Eigen::Vector3d::Zero();  ///< rad, m ahead, s
  double measured = 0.0;                         ///< rad
};

/// How many of so many rows or readings make one of a few hundred stretches.
std::size_t rows_of_stretch(std::size_t rows) {
  constexpr std::size_t kStretches = 300;
  return std::max<std::size_t>(1, rows / kStretches);
}

Turned turned_by_wheels(const MotionRows& drive, double from, double to) {
  Turned result;
  for (const odometry::DriveRow& row : odometry::rows_between(drive, from, to)) {
    const BodyMotion body = odometry::motion_of(drive, row);
    result.by += Eigen::Vector3d(body.turn, body.forward, 0.0);
  }
  return result;
}

void add_turns_of_gyro(const MotionRows& drive, std::vector<Turned>& turns) {
  const std::size_t stretch = rows_of_stretch(drive.rows());
  Turned sum;
  for (std::size_t row = 0, taken = 0; row < drive.yaw_rate.size(); ++row) {
    if (std::isnan(drive.yaw_rate[row])) continue;
    const BodyMotion body = drive.motion(row);
    sum.by += Eigen::Vector3d(body.turn, body.forward, drive.duration(row));
    sum.measured += drive.yaw_rate[row] * drive.duration(row);
    if (++taken % stretch == 0) turns.push_back(std::exchange(sum, {}));
  }
}

/// Headings that are so close to each other that less than half a turn lies between.
void add_turns_of_headings(const MotionRows& drive,
                           const std::vector<std::pair<double, double>>& headings,
                           std::vector<Turned>& turns) {
  const std::size_t stretch = rows_of_stretch(headings.size());
  double from = 0.0;
  double measured = 0.0;
  for (std::size_t k = 0; k < headings.size(); ++k) {
    if (k > 0) measured += wrap_angle(headings[k].second - headings[k - 1].second);
    if (k % stretch != 0) continue;
    if (k > 0) {
      turns.push_back(turned_by_wheels(drive, from, headings[k].first));
      turns.back().measured = measured;
    }
    from = headings[k].first;
    measured = 0.0;
  }
}

std::vector<Turned> turns_of(const std::vector<DrivenRecording>& recordings) {
  std::vector<Turned> turns;
  for (const DrivenRecording& one : recordings) {
    const MotionRows& drive = one.drive;
    if (drive.has_gyro()) add_turns_of_gyro(drive, turns);
    std::vector<std::pair<double, double>> headings;
    for (std::size_t row = 0; row < drive.heading.size(); ++row) {
      if (!std::isfinite(drive.heading[row])) continue;
      headings.emplace_back(drive.t[row], drive.heading[row]);
    }
    add_turns_of_headings(drive, std::exchange(headings, {}), turns);
    for (const TruthRow& row : one.truth) {
      if (row.t < drive.start() || row.t > drive.t.back()) continue;
      headings.emplace_back(row.t, row.heading);
    }
    add_turns_of_headings(drive, headings, turns);
  }
  return turns;
}

/// Least absolute residuals, by least squares weighted anew.
Eigen::VectorXd fitted_line(const std::vector<Turned>& turns, const std::vector<int>& columns) {
  constexpr int kRounds = 20;
  constexpr double kLeast = 1e-3;  // rad: nearer ones count alike
  const auto rows = static_cast<Eigen::Index>(turns.size());
  Eigen::MatrixXd X(rows, static_cast<Eigen::Index>(columns.size()));
  Eigen::VectorXd y(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Turned& one = turns[static_cast<std::size_t>(row)];
    for (std::size_t c = 0; c < columns.size(); ++c) {
      X(row, static_cast<Eigen::Index>(c)) = one.by[columns[c]];
    }
    y[row] = one.measured;
  }
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(rows);
  Eigen::VectorXd found;
  for (int round = 0; round < kRounds; ++round) {
    found = (weights.asDiagonal() * X).colPivHouseholderQr().solve(weights.cwiseProduct(y));
    weights = (y - X * found).cwiseAbs().cwiseMax(kLeast).cwiseSqrt().cwiseInverse();
  }
  return found;
}

}  // namespace

std::optional<GrossStart> start_by_turns(const std::vector<DrivenRecording>& recordings,
                                         const Robot& robot) {
  constexpr std::size_t kFewest = 10;
  constexpr double kTurning = 1.0;  // rad, in all
  const std::vector<Turned> turns = turns_of(recordings);
  double most = 0.0;
  for (const Turned& one : turns) most += std::abs(one.by[0]);
  if (turns.size() < kFewest || most < kTurning) return std::nullopt;
  const bool two = recordings.front().drive.of_two_wheels();
  std::vector<int> columns{0};
  if (two) columns.push_back(1);
  const bool gyro =
      std::any_of(turns.begin(), turns.end(), [](const Turned& one) { return one.by[2] > 0.0; });
  if (gyro) columns.push_back(2);
  const Eigen::VectorXd line = fitted_line(turns, columns);
  if (!(line[0] > 0.0)) return std::nullopt;
  GrossStart start{line[0] - 1.0};
  if (two) start.difference = line[1] / line[0] * robot.wheelbase;
  if (!(std::abs(start.difference) < 2.0)) return std::nullopt;  // a wheel would run backwards
  if (std::abs(line[0] - 1.0) < kNearTurn && std::abs(start.difference) < kNearRatio) {
    return std::nullopt;
  }
  return start;
}

}  // namespace trussmap::calibration
