// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/square_ends.hpp"
#include "calibration/welch.hpp"
#include "geometry/units.hpp"
#include "trussmap/error.hpp"
#include "trussmap/umbmark.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <fmt/format.h>

namespace trussmap {
using namespace calibration;

namespace {

/// alpha and beta of the exact solution by the centres: cw x, y, ccw x, y; rad/m.
struct PositionGains {
  Eigen::Vector4d alpha = Eigen::Vector4d::Zero();
  Eigen::Vector4d beta = Eigen::Vector4d::Zero();
};

PositionGains position_gains(const SquareSetup& setup, const SquareSolution& exact) {
  const SquareEnds ends = square_ends(setup, exact.errors());
  const Eigen::Matrix<double, 4, 2> by_ratios = ends.jacobian();
  const Eigen::Matrix<double, 2, 4> gain =
      (by_ratios.transpose() * by_ratios).ldlt().solve(by_ratios.transpose());
  // Headings go with alpha and beta alone: cw 4 (beta + alpha), ccw 4 (beta - alpha).
  const Eigen::RowVector2d alpha = (ends.cw.jacobian.row(2) - ends.ccw.jacobian.row(2)) / 8.0;
  const Eigen::RowVector2d beta = (ends.cw.jacobian.row(2) + ends.ccw.jacobian.row(2)) / 8.0;
  return {(alpha * gain).transpose(), (beta * gain).transpose()};
}

/// One number per run: its heading by `by_heading`, its position by `by_position`.
Estimate contrast(const std::vector<Eigen::Vector2d>& ends, const std::vector<double>& headings,
                  double by_heading, const Eigen::Vector2d& by_position) {
  std::vector<double> values;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    values.push_back(by_heading * headings[k] + by_position.dot(ends[k]));
  }
  return mean_of(values);
}

/// Headings less positions; the scatter by the slope of the exact solution, the value as it is.
Estimate excess(const SquareRuns& runs, double by_cw, double by_ccw, const Eigen::Vector4d& gain,
                double value) {
  Estimate result = sum_of(contrast(runs.cw, runs.cw_headings, by_cw, -gain.head<2>()),
                           contrast(runs.ccw, runs.ccw_headings, by_ccw, -gain.tail<2>()));
  result.value = value;
  return result;
}

Estimate times(double factor, const Estimate& one) {
  return {factor * one.value, std::abs(factor) * one.standard_error, one.dof};
}

Estimate mapped(const Estimate& from, double value, double slope) {
  return {value, std::abs(slope) * from.standard_error, from.dof};
}

/// E_b by alpha and E_d by beta.
void add_ratios(SquareHeadings& result, const SquareSetup& setup) {
  const double scale = setup.scale.value;
  const double lacking = geometry::kQuarterTurn - result.alpha.value;
  if (!(lacking > 0.0)) {
    throw SolveError(
        "the orientation errors are as large as the square's turns: no wheelbase explains them; "
        "are the headings in radians?");
  }
  const double e_b = scale * geometry::kQuarterTurn / lacking;
  result.wheelbase_ratio =
      also_by(mapped(result.alpha, e_b, e_b / lacking), e_b / scale, setup.scale);
  const double per_beta = setup.wheelbase * e_b / (2.0 * setup.side * scale);
  const double q = per_beta * result.beta.value;
  if (!(std::abs(q) < 1.0)) {
    throw SolveError(
        "the orientation errors are so large that no wheels explain them; are the headings in "
        "radians?");
  }
  result.diameter_ratio =
      mapped(result.beta, (1.0 + q) / (1.0 - q), 2.0 * per_beta / ((1.0 - q) * (1.0 - q)));
}

}  // namespace

std::optional<SquareHeadings> square_headings(const SquareRuns& runs, const SquareSetup& setup,
                                              const SquareSolution& exact) {
  if (runs.cw_headings.empty() && runs.ccw_headings.empty()) return std::nullopt;
  if (runs.cw_headings.size() != runs.cw.size() || runs.ccw_headings.size() != runs.ccw.size()) {
    throw std::invalid_argument("headings must be of all runs, or of none");
  }
  SquareHeadings result;
  result.cw = mean_of(runs.cw_headings);
  result.ccw = mean_of(runs.ccw_headings);
  result.largest = std::max(std::abs(result.cw.value), std::abs(result.ccw.value));
  result.alpha = sum_of(times(0.125, result.cw), times(-0.125, result.ccw));
  result.beta = sum_of(times(0.125, result.cw), times(0.125, result.ccw));
  add_ratios(result, setup);
  const PositionGains gains = position_gains(setup, exact);
  result.alpha_excess =
      excess(runs, 0.125, -0.125, gains.alpha, result.alpha.value - exact.alpha.value);
  result.beta_excess = excess(runs, 0.125, 0.125, gains.beta, result.beta.value - exact.beta.value);
  const double p_alpha = two_sided_p(result.alpha_excess);
  const double p_beta = two_sided_p(result.beta_excess);
  // The smaller of two.
  result.p_value = std::isnan(p_alpha) || std::isnan(p_beta)
                       ? std::numeric_limits<double>::quiet_NaN()
                       : std::min(1.0, 2.0 * std::min(p_alpha, p_beta));
  return result;
}

std::vector<std::string> heading_doubts(const SquareHeadings& headings) {
  constexpr double kSure = 0.01;
  constexpr double kShare = 0.1;  // of the angles, where there is no scatter to judge by
  const double largest =
      std::max(std::abs(headings.alpha_excess.value), std::abs(headings.beta_excess.value));
  const double angles =
      std::max({std::abs(headings.alpha.value), std::abs(headings.beta.value), 1e-6});
  const bool contradict =
      std::isnan(headings.p_value) ? largest > kShare * angles : headings.p_value < kSure;
  if (!contradict) return {};
  return {fmt::format(
      "headings and positions contradict each other: by the headings a turn lacks {:.2g} rad more "
      "and a leg turns by {:.2g} rad more than by the positions{}; expected the robot turned a "
      "fourth time, headings in radians and counter-clockwise, and the start heading as exact as "
      "the end's",
      headings.alpha_excess.value, headings.beta_excess.value,
      std::isnan(headings.p_value) ? "" : fmt::format(" (p = {:.1g})", headings.p_value))};
}

}  // namespace trussmap
