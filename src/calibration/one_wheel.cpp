// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/one_wheel.hpp"

#include "statistics/distributions.hpp"

#include <cmath>

#include <Eigen/Cholesky>

namespace trussmap::calibration {
namespace {

/// Logarithms of the left and the right wheel and of the wheelbase, over the nominal ones.
struct LogSizes {
  Eigen::Vector3d u = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Sums of them that are to be nothing.
using ZeroSums = Eigen::Matrix<double, Eigen::Dynamic, 3>;

double wald_p(const LogSizes& sizes, const ZeroSums& zero) {
  const Eigen::VectorXd r = zero * sizes.u;
  const Eigen::MatrixXd S = zero * sizes.covariance * zero.transpose();
  return statistics::chi2_p_value(r.dot(S.ldlt().solve(r)), static_cast<int>(zero.rows()));
}

/// This one, and the wheelbase where it was sought.
ZeroSums zero_sums(const Eigen::RowVector3d& one, bool base_sought) {
  ZeroSums sums(base_sought ? 2 : 1, 3);
  sums.row(0) = one;
  if (base_sought) sums.row(1) = Eigen::RowVector3d::UnitZ();
  return sums;
}

/// Whether those that were sought are known each for itself: else some sum is taken for certain.
bool has_full_rank(const LogSizes& sizes, bool base_sought) {
  const Eigen::Index size = base_sought ? 3 : 2;
  const Eigen::MatrixXd part = sizes.covariance.topLeftCorner(size, size);
  const Eigen::VectorXd D = part.ldlt().vectorD();
  return D.minCoeff() > 1e-6 * D.maxCoeff();
}

}  // namespace

std::optional<OneWheel> one_wheel(const Robot& robot, const std::vector<ConstantValue>& values,
                                  const Eigen::MatrixXd& covariance) {
  constexpr double kKept = 0.05;
  constexpr double kRefused = 1e-3;
  if (robot.drive != DriveKind::differential) return std::nullopt;
  const std::vector<ConstantValue> nominal = constant_values(robot, {});
  LogSizes sizes;
  Eigen::Vector3d slope;                  // of the logarithm
  for (Eigen::Index k = 0; k < 3; ++k) {  // left wheel, right wheel, wheelbase: the first three
    const auto at = static_cast<std::size_t>(k);
    sizes.u[k] = std::log(values[at].value / nominal[at].value);
    slope[k] = 1.0 / values[at].value;
  }
  sizes.covariance = slope.asDiagonal() * covariance.topLeftCorner<3, 3>() * slope.asDiagonal();
  const bool base_sought = sizes.covariance(2, 2) > 0.0;
  if (!base_sought && sizes.u[2] != 0.0) return std::nullopt;
  if (!has_full_rank(sizes, base_sought)) return std::nullopt;

  using Row = Eigen::RowVector3d;
  const Row left = Row::UnitX();
  const Row right = Row::UnitY();
  const double left_alone = wald_p(sizes, zero_sums(right, base_sought));
  const double right_alone = wald_p(sizes, zero_sums(left, base_sought));
  const double ratio_alone = wald_p(sizes, zero_sums(left + right, base_sought));
  const bool is_left = left_alone > right_alone;
  const double kept = is_left ? left_alone : right_alone;
  const double refused = is_left ? right_alone : left_alone;
  if (!(kept >= kKept && refused < kRefused && ratio_alone < kRefused)) return std::nullopt;

  // Its size, the others held where they are.
  const Row own = is_left ? left : right;
  const ZeroSums held = zero_sums(is_left ? right : left, base_sought);
  const Eigen::MatrixXd S = held * sizes.covariance * held.transpose();
  const Eigen::VectorXd beside = held * sizes.covariance * own.transpose();
  const Eigen::VectorXd gain = S.ldlt().solve(beside);
  const double size = own.dot(sizes.u.transpose()) - gain.dot(held * sizes.u);
  const double variance = own * sizes.covariance * own.transpose() - gain.dot(beside);
  return OneWheel{is_left, std::expm1(size), std::exp(size) * std::sqrt(variance), kept};
}

}  // namespace trussmap::calibration
