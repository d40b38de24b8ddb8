// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/gyro_excess.hpp"

#include "odometry/wheels_and_gyro.hpp"

#include <cmath>

namespace trussmap::estimation {
namespace {

constexpr double kLeastSd = 1e-7;   // rad: who states no noise at all
constexpr double kLeastNew = 1e-3;  // of a basis vector that lies in the others

}  // namespace

GyroExcess gyro_excess(const MotionRows& drive, const std::vector<SegmentRow>& rows,
                       const Robot& robot, const Noise& noise) {
  GyroExcess result;
  if (drive.gyro.empty() || rows.empty()) return result;
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(count, 4);
  Eigen::VectorXd excess = Eigen::VectorXd::Zero(count);
  Eigen::VectorXd over_sd = Eigen::VectorXd::Zero(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const SegmentRow& row = rows[static_cast<std::size_t>(k)];
    const double variance =
        odometry::excess_variance(drive, row.row, row.part, row.duration, robot, noise);
    if (!std::isfinite(variance)) continue;
    over_sd[k] = 1.0 / std::sqrt(variance + kLeastSd * kLeastSd);
    excess[k] = row.part * drive.gyro[row.row].excess;
    if (drive.rests(row.row)) {
      basis(k, 0) = row.duration;
    } else {
      basis.row(k) << 0.0, row.duration, row.path, row.turn;
    }
  }
  basis = over_sd.asDiagonal() * basis;
  Eigen::MatrixXd orthonormal(count, 4);
  for (Eigen::Index column = 0; column < 4; ++column) {
    Eigen::VectorXd left = basis.col(column);
    const double whole = left.norm();
    for (int twice = 0; twice < 2; ++twice) {
      const auto before = orthonormal.leftCols(result.rows);
      left -= before * (before.transpose() * left);
    }
    const double own = left.norm();
    if (!(own > kLeastNew * whole) || result.rows == count) continue;
    orthonormal.col(result.rows++) = left / own;
  }
  if (result.rows == 0) return result;
  result.weights.assign(rows.size(), Vector4::Zero());
  for (Eigen::Index k = 0; k < count; ++k) {
    Vector4& weight = result.weights[static_cast<std::size_t>(k)];
    weight.head(result.rows) = over_sd[k] * orthonormal.row(k).head(result.rows).transpose();
    result.value += excess[k] * weight;
  }
  return result;
}

Eigen::Matrix<double, 4, Eigen::Dynamic> excess_slopes(
    const std::vector<SegmentRow>& rows, const std::vector<Vector4>& weights,
    const std::vector<const std::vector<effects::DrivePattern>*>& patterns) {
  Eigen::Matrix<double, 4, Eigen::Dynamic> slopes(4, static_cast<Eigen::Index>(patterns.size()));
  slopes.setZero();
  for (std::size_t p = 0; p < patterns.size(); ++p) {
    if (patterns[p] == nullptr || patterns[p]->empty()) continue;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      slopes.col(static_cast<Eigen::Index>(p)) +=
          rows[k].part * (*patterns[p])[rows[k].row].excess * weights[k];
    }
  }
  return slopes;
}

}  // namespace trussmap::estimation
