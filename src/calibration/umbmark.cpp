// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/umbmark.hpp"

#include "calibration/square_ends.hpp"
#include "calibration/welch.hpp"
#include "geometry/units.hpp"
#include "trussmap/error.hpp"

#include <cmath>
#include <stdexcept>

#include <Eigen/Cholesky>

namespace trussmap {
using namespace calibration;

namespace {

using Eigen::Vector2d;

/// A number and its derivatives by the two centres.
struct Sensitivity {
  double value = 0.0;
  Vector2d by_cw = Vector2d::Zero();
  Vector2d by_ccw = Vector2d::Zero();

  [[nodiscard]] Sensitivity mapped(double new_value, double slope) const {
    return {new_value, slope * by_cw, slope * by_ccw};
  }
};

Sensitivity mean(const Sensitivity& a, const Sensitivity& b) {
  return {0.5 * (a.value + b.value), 0.5 * (a.by_cw + b.by_cw), 0.5 * (a.by_ccw + b.by_ccw)};
}

Sensitivity linear(const SquareClusters& at, const Vector2d& by_cw, const Vector2d& by_ccw) {
  return {by_cw.dot(at.cw.mean) + by_ccw.dot(at.ccw.mean), by_cw, by_ccw};
}

struct AngleResponses {
  AngleResponses(const SquareClusters& at, double side)
      : alpha_x(linear(at, -x / (4 * side), -x / (4 * side))),
        alpha_y(linear(at, -y / (4 * side), y / (4 * side))),
        beta_x(linear(at, -x / (4 * side), x / (4 * side))),
        beta_y(linear(at, -y / (4 * side), -y / (4 * side))) {}

  const Vector2d x = Vector2d::UnitX();
  const Vector2d y = Vector2d::UnitY();
  Sensitivity alpha_x, alpha_y, beta_x, beta_y;
};

Estimate estimate(const Sensitivity& response, const SquareClusters& at) {
  return welch_estimate(response.value, response.by_cw, at.cw, response.by_ccw, at.ccw);
}

/// What follows from E_d and E_b. What E_s does to alpha, beta and E_d is of second order.
SquareSolution solution(const Sensitivity& alpha, const Sensitivity& beta, const Sensitivity& e_d,
                        const Sensitivity& e_b, const SquareClusters& at,
                        const SquareSetup& setup) {
  const GeometryErrors errors{e_d.value, e_b.value, setup.scale.value};
  const double slope = 2.0 * errors.scale / std::pow(e_d.value + 1.0, 2);
  const auto scaled = [&](const Sensitivity& response) {
    return also_by(estimate(response, at), response.value / errors.scale, setup.scale);
  };
  SquareSolution result;
  result.alpha = estimate(alpha, at);
  result.beta = estimate(beta, at);
  result.diameter_ratio = estimate(e_d, at);
  result.wheelbase_ratio = scaled(e_b);
  result.left_factor = scaled(e_d.mapped(errors.left_factor(), -slope));
  result.right_factor = scaled(e_d.mapped(errors.right_factor(), slope));
  result.wheelbase = scaled(e_b.mapped(setup.wheelbase * e_b.value, setup.wheelbase));
  result.scale = errors.scale;
  return result;
}

Estimate largest_offset(const SampleMean& cw, const SampleMean& ccw) {
  const SampleMean& farther = cw.mean.norm() >= ccw.mean.norm() ? cw : ccw;
  const double distance = farther.mean.norm();
  const Vector2d outwards = distance > 0.0 ? Vector2d(farther.mean / distance) : Vector2d::UnitX();
  return welch_estimate(distance, outwards, farther, Vector2d::Zero(), farther);
}

struct ExactFit {
  GeometryErrors at;
  Eigen::Vector4d left = Eigen::Vector4d::Zero();  // cw x, y, ccw x, y: measured - modelled, m
  Eigen::Matrix<double, 4, 2> jacobian;            // of the modelled, by E_d and E_b
};

ExactFit exact_fit_at(const GeometryErrors& at, const SquareClusters& clusters,
                      const SquareSetup& setup) {
  const SquareEnds ends = square_ends(setup, at);
  return {at, ends.left_of(clusters), ends.jacobian()};
}

/// Gauss-Newton from a given geometry to the minimum nearby; a step that makes things worse is
/// halved.
ExactFit descend(const GeometryErrors& start, const SquareClusters& clusters,
                 const SquareSetup& setup) {
  constexpr int kMostIterations = 200;
  constexpr double kSmallestStep = 1e-15;
  constexpr double kSmallestRatio = 0.1;
  ExactFit fit = exact_fit_at(start, clusters, setup);
  double damping = 1.0;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const Vector2d step =
        damping *
        (fit.jacobian.transpose() * fit.jacobian).ldlt().solve(fit.jacobian.transpose() * fit.left);
    if (step.cwiseAbs().maxCoeff() <= kSmallestStep) break;
    const GeometryErrors next{fit.at.diameter_ratio + step.x(), fit.at.wheelbase_ratio + step.y(),
                              fit.at.scale};
    const bool sensible = std::min(next.diameter_ratio, next.wheelbase_ratio) > kSmallestRatio;
    ExactFit tried = sensible ? exact_fit_at(next, clusters, setup) : fit;
    const bool better = tried.left.squaredNorm() < fit.left.squaredNorm();
    damping = better ? 1.0 : 0.5 * damping;
    if (better) fit = std::move(tried);
  }
  return fit;
}

/// Errors as large as a tenth of a turn per leg have minima besides the true one: where the one
/// next to the nominal geometry fits badly, the search starts again from others.
ExactFit fit_exactly(const SquareClusters& clusters, const SquareSetup& setup) {
  constexpr double kGoodShare = 0.05;    // of the measured errors, left over
  constexpr double kLargestError = 0.7;  // rad, per leg or per turn
  constexpr int kStarts = 4;             // on either side of 0
  const double measured = std::hypot(clusters.cw.mean.norm(), clusters.ccw.mean.norm());
  const double scale = setup.scale.value;
  ExactFit best = descend({1.0, scale, scale}, clusters, setup);
  if (best.left.norm() > kGoodShare * measured) {
    ExactFit elsewhere = best;
    for (int i = -kStarts; i <= kStarts; ++i) {
      for (int j = -kStarts; j <= kStarts; ++j) {
        const double beta = kLargestError * i / kStarts;
        const double alpha = kLargestError * j / kStarts;
        ExactFit fit =
            descend({1.0 + beta * setup.wheelbase / setup.side,
                     scale * geometry::kQuarterTurn / (geometry::kQuarterTurn - alpha), scale},
                    clusters, setup);
        if (fit.left.norm() < elsewhere.left.norm()) elsewhere = std::move(fit);
      }
    }
    // Far from the nominal geometry only for a fit that leaves no doubt: scatter makes neither.
    if (elsewhere.left.norm() < kGoodShare * best.left.norm()) best = std::move(elsewhere);
  }
  if (best.left.norm() > 0.5 * measured && measured > 0.5 * setup.side) {
    throw SolveError(
        "no wheelbase and wheel ratio near the nominal ones bring the robot to where the runs "
        "ended; are the errors in metres (not centimetres, 100 times too long), and absolute - "
        "calculated?");
  }
  return best;
}

void check(const SquareSetup& setup) {
  const bool positive = setup.side > 0.0 && setup.wheelbase > 0.0;
  if (!positive || !std::isfinite(setup.side) || !std::isfinite(setup.wheelbase)) {
    throw std::invalid_argument("side and wheelbase must be above 0");
  }
  if (!(setup.scale.value > 0.0) || !std::isfinite(setup.scale.value)) {
    throw std::invalid_argument("the scale must be above 0");
  }
}

}  // namespace

SquareClusters square_clusters(const SquareRuns& runs) {
  SquareClusters result;
  result.cw = sample_mean(runs.cw);
  result.ccw = sample_mean(runs.ccw);
  result.largest_offset = largest_offset(result.cw, result.ccw);
  const double trace = result.cw.covariance.trace() + result.ccw.covariance.trace();
  result.sem = std::sqrt(trace / 4.0);
  result.second_round_worthwhile = result.largest_offset.value > 3.0 * result.sem;
  return result;
}

SquareAngles square_angles(const SquareClusters& clusters, double side) {
  const AngleResponses angles(clusters, side);
  return {estimate(angles.alpha_x, clusters), estimate(angles.alpha_y, clusters),
          estimate(angles.beta_x, clusters), estimate(angles.beta_y, clusters)};
}

SquareSolution umbmark(const SquareClusters& clusters, const SquareSetup& setup) {
  check(setup);
  const double scale = setup.scale.value;
  const double side = scale * setup.side;  // as driven
  const AngleResponses angles(clusters, side);
  const Sensitivity alpha = mean(angles.alpha_x, angles.alpha_y);
  const Sensitivity beta = mean(angles.beta_x, angles.beta_y);
  const double s = setup.wheelbase * std::sin(0.5 * beta.value);
  if (alpha.value >= geometry::kQuarterTurn || std::abs(s) >= side) {
    throw SolveError(
        "the end errors are as large as the square itself: no wheelbase and wheels "
        "explain them by the small-angle formulas");
  }
  const double lacking = geometry::kQuarterTurn - alpha.value;
  const double slope_d =
      side * setup.wheelbase * std::cos(0.5 * beta.value) / ((side - s) * (side - s));
  const Sensitivity e_d = beta.mapped((side + s) / (side - s), slope_d);
  const Sensitivity e_b = alpha.mapped(scale * geometry::kQuarterTurn / lacking,
                                       scale * geometry::kQuarterTurn / (lacking * lacking));
  return solution(alpha, beta, e_d, e_b, clusters, setup);
}

SquareSolution solve_square(const SquareClusters& clusters, const SquareSetup& setup) {
  check(setup);
  const ExactFit fit = fit_exactly(clusters, setup);
  const Eigen::Matrix<double, 2, 4> gain =
      (fit.jacobian.transpose() * fit.jacobian).ldlt().solve(fit.jacobian.transpose());
  const Sensitivity e_d{fit.at.diameter_ratio, gain.block<1, 2>(0, 0).transpose(),
                        gain.block<1, 2>(0, 2).transpose()};
  const Sensitivity e_b{fit.at.wheelbase_ratio, gain.block<1, 2>(1, 0).transpose(),
                        gain.block<1, 2>(1, 2).transpose()};
  const double scale = setup.scale.value;
  const Sensitivity alpha = e_b.mapped(geometry::kQuarterTurn * (1.0 - scale / e_b.value),
                                       scale * geometry::kQuarterTurn / (e_b.value * e_b.value));
  const double per_ratio = setup.side / (setup.wheelbase * e_b.value);
  const double beta = (fit.at.right_factor() - fit.at.left_factor()) * per_ratio;
  const double by_d = 4.0 * scale / std::pow(e_d.value + 1.0, 2) * per_ratio;
  const double by_b = -beta / e_b.value;
  const Sensitivity beta_response{beta, by_d * e_d.by_cw + by_b * e_b.by_cw,
                                  by_d * e_d.by_ccw + by_b * e_b.by_ccw};
  return solution(alpha, beta_response, e_d, e_b, clusters, setup);
}

}  // namespace trussmap
