// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/calibration/wheel_noise.hpp"

#include "trussmap/core/error.hpp"
#include "trussmap/odometry/arc.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <boost/math/distributions/fisher_f.hpp>

namespace trussmap {
namespace {

using Eigen::Vector3d;

/// Sigma = sum of weights x shapes + constant, fitted to S.
struct Components {
  std::array<Matrix3, 2> shapes;
  std::array<bool, 2> free = {true, true};
  Matrix3 constant = Matrix3::Zero();
  Matrix3 observed = Matrix3::Zero();  // S
  double count = 0.0;                  // n, or n - 1

  [[nodiscard]] Matrix3 sigma(const Vector2& weights) const {
    return weights[0] * shapes[0] + weights[1] * shapes[1] + constant;
  }
};

struct Fit {
  Vector2 weights = Vector2::Zero();
  Matrix2 information = Matrix2::Zero();  // of the weights; identity for one that is not free
};

/// -2/n log likelihood; none where Sigma is not positive definite.
std::optional<double> loss(const Components& of, const Vector2& weights) {
  const Matrix3 sigma = of.sigma(weights);
  const Vector3d scale = sigma.diagonal();
  if (!(scale.array() > 0.0).all()) return std::nullopt;
  const Vector3d by = scale.cwiseSqrt().cwiseInverse();
  const Matrix3 correlation = by.asDiagonal() * sigma * by.asDiagonal();
  const Eigen::LLT<Matrix3> factor(correlation);
  constexpr double kLeastPivot = 1e-7;
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Vector3d pivots = factor.matrixLLT().diagonal();
  if (!(pivots.minCoeff() > kLeastPivot)) return std::nullopt;
  const Matrix3 observed = by.asDiagonal() * of.observed * by.asDiagonal();
  return 2.0 * pivots.array().log().sum() + scale.array().log().sum() +
         factor.solve(observed).trace();
}

/// Fisher information of the weights, and what it must be multiplied with to give them.
void scoring_equations(const Components& of, const Vector2& weights, Matrix2& information,
                       Vector2& right_side) {
  const Matrix3 inverse = of.sigma(weights).inverse();
  information.setIdentity();
  right_side = weights;
  for (std::size_t a = 0; a < 2; ++a) {
    if (!of.free[a]) continue;
    const auto row = static_cast<Eigen::Index>(a);
    const Matrix3 left = inverse * of.shapes[a] * inverse;
    const double half = 0.5 * of.count;
    Matrix3 target = of.observed - of.constant;
    for (std::size_t b = 0; b < 2; ++b) {
      const auto column = static_cast<Eigen::Index>(b);
      if (of.free[b]) {
        information(row, column) = half * (left * of.shapes[b]).trace();
      } else {
        target -= weights[column] * of.shapes[b];
      }
    }
    right_side[row] = half * (left * target).trace();
  }
}

void require_two_wheels(const Matrix2& information) {
  constexpr double kAlike = 1e-8;
  const double product = information(0, 0) * information(1, 1);
  if (information.determinant() > kAlike * product) return;
  throw SolveError(
      "this path shows the noise of both wheels in the same way, so that they cannot be told "
      "apart; drive straight pieces as well, \"10,-10\" for instance");
}

Fit fit_components(const Components& of, Vector2 weights) {
  constexpr int kMostIterations = 500;
  constexpr double kConverged = 1e-13;
  std::optional<double> now = loss(of, weights);
  Fit fit;
  Vector2 right_side;
  for (int iteration = 0; now && iteration < kMostIterations; ++iteration) {
    scoring_equations(of, weights, fit.information, right_side);
    if (of.free[0] && of.free[1]) require_two_wheels(fit.information);
    Vector2 step = fit.information.ldlt().solve(right_side) - weights;
    const double size = weights.cwiseAbs().maxCoeff();
    std::optional<double> next;
    while (step.cwiseAbs().maxCoeff() > kConverged * size) {
      next = loss(of, weights + step);
      if (next && *next <= *now) break;
      next.reset();
      step *= 0.5;
    }
    if (!next) break;
    weights += step;
    now = next;
  }
  if (!now) throw SolveError("the noise of the wheels cannot be told from that of the sensor");
  scoring_equations(of, weights, fit.information, right_side);
  fit.weights = weights;
  return fit;
}

Vector2 start(const Components& of) {
  const Matrix3 shape = of.shapes[0] + of.shapes[1];
  double scale = 0.0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (shape(k, k) > 0.0) scale = std::max(scale, of.observed(k, k) / shape(k, k));
  }
  return Vector2::Constant(scale);
}

double mean_p_value(const Vector3d& mean, const Matrix3& scatter, int runs) {
  if (runs < 5) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::FullPivLU<Matrix3> factor(scatter);
  if (!factor.isInvertible()) return std::numeric_limits<double>::quiet_NaN();
  const double n = runs;
  const double t2 = n * mean.dot(factor.solve(mean));
  const double f = t2 * (n - 3.0) / (3.0 * (n - 1.0));
  return boost::math::cdf(
      boost::math::complement(boost::math::fisher_f_distribution<double>(3.0, n - 3.0), f));
}

WheelConstant constant(double squared, double squared_sd) {
  constexpr double kOneSided95 = 1.6448536269514722;
  WheelConstant result;
  result.k = std::sqrt(std::max(squared, 0.0));
  result.upper_limit = std::sqrt(std::max(squared, 0.0) + kOneSided95 * squared_sd);
  result.standard_error =
      result.k > 0.0 ? squared_sd / (2.0 * result.k) : std::numeric_limits<double>::quiet_NaN();
  return result;
}

/// Means and scatter, checked.
void observe(const EndErrors& errors, const NoiseExperiment& experiment, NoiseEstimate& result) {
  const auto n = static_cast<double>(errors.size());
  result.runs = static_cast<int>(errors.size());
  for (const Vector3d& e : errors) result.mean += e / n;
  Matrix3 scatter = Matrix3::Zero();
  for (const Vector3d& e : errors) {
    scatter += (e - result.mean) * (e - result.mean).transpose() / (n - 1.0);
  }
  result.mean_p_value = mean_p_value(result.mean, scatter, result.runs);
  result.observed = scatter;
  if (experiment.subtract_mean) {
    result.centre = result.mean;
  } else {
    result.observed = scatter * (n - 1.0) / n + result.mean * result.mean.transpose();
  }
  if (!(scatter.trace() > 0.0)) {
    throw SolveError("all runs ended with the same errors: there is no scatter to learn from");
  }
}

}  // namespace

NoiseShape noise_shape(const TestPath& path, double wheelbase) {
  if (!(wheelbase > 0.0)) throw std::invalid_argument("the wheelbase must be above 0");
  Motion left;
  Motion right;
  for (const PathPiece& piece : path) {
    const double half = 0.5 * wheelbase * piece.turn;
    const WheelTravel travel{piece.distance - half, piece.distance + half};
    left = then(left, arc_motion(travel, wheelbase, {1.0, 0.0}));
    right = then(right, arc_motion(travel, wheelbase, {0.0, 1.0}));
  }
  return {left.covariance, right.covariance};
}

NoiseEstimate estimate_wheel_noise(const EndErrors& errors, const NoiseExperiment& experiment) {
  if (errors.size() < 2) throw std::invalid_argument("a scatter takes two runs or more");
  if (!(experiment.sensor_sd.array() >= 0.0).all()) {
    throw std::invalid_argument("the sensor's standard deviations must be 0 or more");
  }
  const NoiseShape shape = noise_shape(experiment.path, experiment.wheelbase);
  NoiseEstimate result;
  observe(errors, experiment, result);

  Components components;
  components.shapes = {shape.left, shape.right};
  components.constant = experiment.sensor_sd.cwiseAbs2().asDiagonal();
  components.observed = result.observed;
  components.count = result.runs - (experiment.subtract_mean ? 1 : 0);
  const Fit free = fit_components(components, start(components));
  result.squared = free.weights;
  result.squared_covariance = free.information.inverse();

  Vector2 weights = free.weights;
  Matrix2 covariance = result.squared_covariance;
  if (weights.minCoeff() <= 0.0) {
    const std::size_t hidden = weights[0] < weights[1] ? 0 : 1;
    const auto at = static_cast<Eigen::Index>(hidden);
    Vector2 from = weights.cwiseMax(start(components) * 1e-3);
    from[at] = 0.0;
    components.free[hidden] = false;
    const Fit bound = fit_components(components, from);
    weights = bound.weights.cwiseMax(0.0);
    covariance(1 - at, 1 - at) = 1.0 / bound.information(1 - at, 1 - at);
  }
  result.left = constant(weights[0], std::sqrt(covariance(0, 0)));
  result.right = constant(weights[1], std::sqrt(covariance(1, 1)));
  result.modelled = components.sigma(weights);
  return result;
}

}  // namespace trussmap
