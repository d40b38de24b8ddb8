// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/fitted_rows.hpp"

namespace trussmap::estimation {

FittedRows::FittedRows(const RecordingSystem& fit)
    : fit_(fit),
      inverse_(fit.normal_equations().inverse()),
      coefficient_covariance_(fit.coefficient_covariance()) {}

Eigen::MatrixXd FittedRows::by_nodes(const RecordingSystem& rows, std::size_t measurement) const {
  const linalg::BlockSystem& normal = fit_.normal_equations();
  const std::vector<RecordingSystem::NodeRows> links = rows.node_rows(measurement);
  const Eigen::Index count = rows.first_row(measurement + 1) - rows.first_row(measurement);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(count, count);
  for (const RecordingSystem::NodeRows& a : links) {
    for (const RecordingSystem::NodeRows& b : links) {
      result += a.rows *
                inverse_.block(normal.offset(a.node), normal.size(a.node), normal.offset(b.node),
                               normal.size(b.node)) *
                b.rows.transpose();
    }
  }
  return 0.5 * (result + result.transpose());
}

Eigen::MatrixXd FittedRows::covariance(const RecordingSystem& rows, std::size_t measurement) const {
  Eigen::MatrixXd result = by_nodes(rows, measurement);
  if (coefficient_covariance_.cols() == 0) return result;
  Eigen::MatrixXd F = rows.border().middleRows(rows.first_row(measurement), result.rows());
  for (const RecordingSystem::NodeRows& link : rows.node_rows(measurement)) {
    F -= link.rows * fit_.nodes_by_coefficients().middleRows(
                         fit_.normal_equations().offset(link.node), link.rows.cols());
  }
  result += F * coefficient_covariance_ * F.transpose();
  return result;
}

}  // namespace trussmap::estimation
