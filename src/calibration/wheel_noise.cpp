// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/wheel_noise.hpp"

#include "calibration/end_moments.hpp"
#include "calibration/noise_distances.hpp"
#include "statistics/distributions.hpp"
#include "trussmap/arc.hpp"
#include "trussmap/error.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace trussmap {
using namespace calibration;

namespace {

using Eigen::Vector3d;

/// Mean and covariance of the end as k_L^2 and k_R^2 have it, with their derivatives.
struct Law {
  Vector3d mean = Vector3d::Zero();
  Matrix3 sigma = Matrix3::Zero();
  std::array<Vector3d, 2> mean_by{Vector3d::Zero(), Vector3d::Zero()};
  std::array<Matrix3, 2> sigma_by{Matrix3::Zero(), Matrix3::Zero()};
};

/// What the runs are fitted with.
struct Problem {
  NoiseExperiment experiment;
  NoiseShape shape;
  std::array<bool, 2> free = {true, true};
  Matrix3 sensor = Matrix3::Zero();
  Vector3d mean = Vector3d::Zero();   // of the runs
  Matrix3 scatter = Matrix3::Zero();  // about their mean
  double count = 0.0;                 // n, or n - 1

  [[nodiscard]] EndMoments moments(const Vector2& squared) const {
    return end_moments(experiment, shape, squared);
  }

  [[nodiscard]] Law law(const Vector2& squared) const {
    const EndMoments at = moments(squared);
    Law result;
    result.mean = at.mean;
    result.sigma = at.covariance + sensor;
    if (experiment.order == NoiseOrder::first) {
      result.sigma_by = {shape.left, shape.right};
      return result;
    }
    const double h = 1e-4 * squared.cwiseAbs().maxCoeff();  // the moments are smooth: error h^2
    for (std::size_t a = 0; a < 2; ++a) {
      const Vector2 step = h * Vector2::Unit(static_cast<Eigen::Index>(a));
      const EndMoments ahead = moments(squared + step);
      const EndMoments behind = moments(squared - step);
      result.mean_by[a] = (ahead.mean - behind.mean) / (2.0 * h);
      result.sigma_by[a] = (ahead.covariance - behind.covariance) / (2.0 * h);
    }
    return result;
  }

  /// How far the runs' mean is from the law's; a subtracted mean is free.
  [[nodiscard]] Vector3d off(const Law& at) const {
    return experiment.subtract_mean ? Vector3d::Zero() : Vector3d(mean - at.mean);
  }
  /// S, about the law's mean.
  [[nodiscard]] Matrix3 observed(const Law& at) const {
    return scatter + off(at) * off(at).transpose();
  }
};

struct Fit {
  Vector2 weights = Vector2::Zero();
  Matrix2 information = Matrix2::Zero();  // of the weights; identity for one that is not free
};

/// -2/n log likelihood; none where Sigma is not positive definite.
std::optional<double> loss(const Problem& problem, const Law& at) {
  const Vector3d scale = at.sigma.diagonal();
  if (!(scale.array() > 0.0).all()) return std::nullopt;
  const Vector3d by = scale.cwiseSqrt().cwiseInverse();
  const Matrix3 correlation = by.asDiagonal() * at.sigma * by.asDiagonal();
  const Eigen::LLT<Matrix3> factor(correlation);
  constexpr double kLeastPivot = 1e-7;
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Vector3d pivots = factor.matrixLLT().diagonal();
  if (!(pivots.minCoeff() > kLeastPivot)) return std::nullopt;
  const Matrix3 observed = by.asDiagonal() * problem.observed(at) * by.asDiagonal();
  return 2.0 * pivots.array().log().sum() + scale.array().log().sum() +
         factor.solve(observed).trace();
}

/// Fisher information of the weights, and the slope of the log likelihood by them.
void scoring_equations(const Problem& problem, const Law& at, Matrix2& information,
                       Vector2& slope) {
  const Matrix3 inverse = at.sigma.inverse();
  const Vector3d off = problem.off(at);
  const Matrix3 excess = problem.observed(at) - at.sigma;
  const bool fits_mean = !problem.experiment.subtract_mean;
  information.setIdentity();
  slope.setZero();
  for (std::size_t a = 0; a < 2; ++a) {
    if (!problem.free[a]) continue;
    const auto row = static_cast<Eigen::Index>(a);
    const Matrix3 left = inverse * at.sigma_by[a] * inverse;
    slope[row] = 0.5 * problem.count * (left * excess).trace();
    if (fits_mean) slope[row] += problem.count * at.mean_by[a].dot(inverse * off);
    for (std::size_t b = 0; b < 2; ++b) {
      if (!problem.free[b]) continue;
      const auto column = static_cast<Eigen::Index>(b);
      information(row, column) = 0.5 * problem.count * (left * at.sigma_by[b]).trace();
      if (fits_mean) {
        information(row, column) += problem.count * at.mean_by[a].dot(inverse * at.mean_by[b]);
      }
    }
  }
}

/// Sum over the runs of the outer product of each one's slope: what the information would be on
/// average if the errors were Gaussian, and what counts where they are not (Huber's sandwich).
Matrix2 slope_scatter(const EndErrors& errors, const Problem& problem, const Law& at) {
  const Matrix3 inverse = at.sigma.inverse();
  const Vector3d centre = problem.experiment.subtract_mean ? problem.mean : at.mean;
  Matrix2 sum = Matrix2::Zero();
  for (const Vector3d& e : errors) {
    const Vector3d off = inverse * (e - centre);
    Vector2 slope = Vector2::Zero();
    for (std::size_t a = 0; a < 2; ++a) {
      if (!problem.free[a]) continue;
      const auto row = static_cast<Eigen::Index>(a);
      slope[row] = 0.5 * (off.dot(at.sigma_by[a] * off) - (inverse * at.sigma_by[a]).trace());
      if (!problem.experiment.subtract_mean) slope[row] += at.mean_by[a].dot(off);
    }
    sum += slope * slope.transpose();
  }
  return sum;
}

/// Covariance of the weights.
Matrix2 covariance_of(const Fit& fit, const EndErrors& errors, const Problem& problem) {
  Matrix2 inverse = fit.information.inverse();
  if (problem.experiment.order == NoiseOrder::first) return inverse;
  return inverse * slope_scatter(errors, problem, problem.law(fit.weights)) * inverse;
}

void require_two_wheels(const Matrix2& information) {
  constexpr double kAlike = 1e-8;
  const double product = information(0, 0) * information(1, 1);
  if (information.determinant() > kAlike * product) return;
  throw SolveError(
      "this path shows the noise of both wheels in the same way, so that they cannot be told "
      "apart; drive straight segments as well, \"10,-10\" for instance");
}

Fit fit_weights(const Problem& problem, Vector2 weights) {
  constexpr int kMostIterations = 500;
  constexpr double kConverged = 1e-13;
  Law at = problem.law(weights);
  std::optional<double> now = loss(problem, at);
  if (!now) throw SolveError("the noise of the wheels cannot be told from that of the sensor");
  Fit fit;
  Vector2 slope;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    scoring_equations(problem, at, fit.information, slope);
    if (problem.free[0] && problem.free[1]) require_two_wheels(fit.information);
    Vector2 step = fit.information.ldlt().solve(slope);
    const double size = weights.cwiseAbs().maxCoeff();
    std::optional<double> next;
    Law tried;
    while (step.cwiseAbs().maxCoeff() > kConverged * size) {
      tried = problem.law(weights + step);
      next = loss(problem, tried);
      if (next && *next <= *now) break;
      next.reset();
      step *= 0.5;
    }
    if (!next) break;
    weights += step;
    at = tried;
    now = next;
  }
  scoring_equations(problem, at, fit.information, slope);
  fit.weights = weights;
  return fit;
}

Vector2 start(const Problem& problem) {
  const Matrix3 shape = problem.shape.left + problem.shape.right;
  const Matrix3 observed = problem.observed(Law{});
  double scale = 0.0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (shape(k, k) > 0.0) scale = std::max(scale, observed(k, k) / shape(k, k));
  }
  return Vector2::Constant(scale);
}

/// Hotelling's T^2 of a mean that is `off` from what it should be.
double mean_p_value(const Vector3d& off, const Matrix3& scatter, int runs) {
  if (runs < 5) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::FullPivLU<Matrix3> factor(scatter);
  if (!factor.isInvertible()) return std::numeric_limits<double>::quiet_NaN();
  const double n = runs;
  const double t2 = n * off.dot(factor.solve(off));
  const double f = t2 * (n - 3.0) / (3.0 * (n - 1.0));
  return statistics::fisher_p_value(f, 3.0, n - 3.0);
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

/// Sample covariance about the mean.
Matrix3 unbiased_scatter(const EndErrors& errors, const Vector3d& mean) {
  Matrix3 scatter = Matrix3::Zero();
  for (const Vector3d& e : errors) scatter += (e - mean) * (e - mean).transpose();
  return scatter / (static_cast<double>(errors.size()) - 1.0);
}

}  // namespace

NoiseShape noise_shape(const TestPath& path, double wheelbase) {
  if (!(wheelbase > 0.0)) throw std::invalid_argument("the wheelbase must be above 0");
  Motion left;
  Motion right;
  for (const PathSegment& segment : path) {
    const double half = 0.5 * wheelbase * segment.turn;
    const WheelTravel travel{segment.distance - half, segment.distance + half};
    left = then(left, arc_motion(travel, wheelbase, {1.0, 0.0}));
    right = then(right, arc_motion(travel, wheelbase, {0.0, 1.0}));
  }
  return {left.covariance, right.covariance};
}

}  // namespace trussmap

namespace trussmap::calibration {

Matrix3 sensor_noise(const NoiseExperiment& experiment) {
  Matrix3 noise = experiment.sensor_covariance;
  noise.diagonal() += experiment.sensor_sd.cwiseAbs2();
  return noise;
}

EndMoments end_moments(const NoiseExperiment& experiment, const NoiseShape& shape,
                       const Vector2& squared) {
  if (experiment.order == NoiseOrder::exact) {
    return end_moments(experiment.path, experiment.wheelbase, squared);
  }
  return {Vector3d::Zero(), squared[0] * shape.left + squared[1] * shape.right};
}

}  // namespace trussmap::calibration

namespace trussmap {

NoiseEstimate estimate_wheel_noise(const EndErrors& errors, const NoiseExperiment& experiment) {
  if (errors.size() < 2) throw std::invalid_argument("a scatter takes two runs or more");
  if (!(experiment.sensor_sd.array() >= 0.0).all()) {
    throw std::invalid_argument("the sensor's standard deviations must be 0 or more");
  }
  Problem problem;
  problem.experiment = experiment;
  problem.shape = noise_shape(experiment.path, experiment.wheelbase);
  problem.sensor = sensor_noise(experiment);
  const auto n = static_cast<double>(errors.size());
  for (const Vector3d& e : errors) problem.mean += e / n;
  const Matrix3 scatter = unbiased_scatter(errors, problem.mean);
  if (!(scatter.trace() > 0.0)) {
    throw SolveError("all runs ended with the same errors: there is no scatter to learn from");
  }
  problem.count = experiment.subtract_mean ? n - 1.0 : n;
  problem.scatter = scatter * (n - 1.0) / problem.count;

  NoiseEstimate result;
  result.runs = static_cast<int>(errors.size());
  result.mean = problem.mean;
  const Fit free = fit_weights(problem, start(problem));
  result.squared = free.weights;
  result.squared_covariance = covariance_of(free, errors, problem);

  Vector2 weights = free.weights;
  Matrix2 covariance = result.squared_covariance;
  if (weights.minCoeff() <= 0.0) {
    const std::size_t hidden = weights[0] < weights[1] ? 0 : 1;
    const auto at = static_cast<Eigen::Index>(hidden);
    Vector2 from = weights.cwiseMax(start(problem) * 1e-3);
    from[at] = 0.0;
    problem.free[hidden] = false;
    const Fit bound = fit_weights(problem, from);
    weights = bound.weights.cwiseMax(0.0);
    covariance(1 - at, 1 - at) = covariance_of(bound, errors, problem)(1 - at, 1 - at);
  }
  result.left = constant(weights[0], std::sqrt(covariance(0, 0)));
  result.right = constant(weights[1], std::sqrt(covariance(1, 1)));
  const Law found = problem.law(weights);
  result.linearization_offset = found.mean;
  result.centre = experiment.subtract_mean ? problem.mean : found.mean;
  result.observed = problem.observed(found);
  result.modelled = found.sigma;
  result.mean_p_value = mean_p_value(problem.mean - found.mean, scatter, result.runs);
  return result;
}

}  // namespace trussmap
