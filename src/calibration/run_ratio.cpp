// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/run_ratio.hpp"

#include "statistics/distributions.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace trussmap::calibration {

RunRatio ratio_of(const std::vector<RunOfRatio>& runs, bool stated) {
  double products = 0.0;
  double squares = 0.0;
  for (const RunOfRatio& run : runs) {
    products += run.x * run.y / run.variance;
    squares += run.x * run.x / run.variance;
  }
  RunRatio result;
  result.ratio.value = products / squares;
  double chi2 = 0.0;
  for (const RunOfRatio& run : runs) {
    chi2 += std::pow(run.y - result.ratio.value * run.x, 2) / run.variance;
  }
  const double dof = static_cast<double>(runs.size()) - 1.0;
  if (dof > 0.0) result.scatter = std::sqrt(chi2 / dof);
  if (stated) {
    result.p_value = statistics::chi2_p_value(chi2, static_cast<int>(dof));
    const bool wider = result.p_value < kSureOfRuns;
    result.ratio.standard_error = (wider ? result.scatter : 1.0) / std::sqrt(squares);
    result.ratio.dof = wider ? dof : kStatedDof;
  } else if (chi2 > 0.0 && dof > 0.0) {
    result.ratio.standard_error = result.scatter / std::sqrt(squares);
    result.ratio.dof = dof;
  }
  return result;
}

std::optional<RatioBeside> ratio_beside(const std::vector<RunOfRatio>& runs, bool stated,
                                        const std::vector<double>& z) {
  constexpr std::size_t kFewest = 4;
  constexpr double kAlike = 1e-6;  // 1 - cos^2 of x and z
  if (runs.size() < kFewest) return std::nullopt;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const Eigen::Vector2d row(runs[k].x, z[k]);
    normal += row * row.transpose() / runs[k].variance;
    right += row * runs[k].y / runs[k].variance;
  }
  if (normal.determinant() <= kAlike * normal(0, 0) * normal(1, 1)) return std::nullopt;
  const Eigen::Matrix2d inverse = normal.inverse();
  const Eigen::Vector2d at = inverse * right;
  double chi2 = 0.0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    chi2 += std::pow(runs[k].y - at.x() * runs[k].x - at.y() * z[k], 2) / runs[k].variance;
  }
  const double dof = static_cast<double>(runs.size()) - 2.0;
  const double scatter = chi2 / dof;
  const double variance = stated ? std::max(scatter, 1.0) : scatter;
  RatioBeside result{at.x(), {at.y(), 0.0, 0.0}};
  if (variance > 0.0) {
    result.c = {at.y(), std::sqrt(variance * inverse(1, 1)),
                stated && scatter <= 1.0 ? kStatedDof : dof};
  }
  return result;
}

}  // namespace trussmap::calibration
