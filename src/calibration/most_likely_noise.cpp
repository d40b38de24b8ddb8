// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/most_likely_noise.hpp"

#include "estimation/recording_adjustment.hpp"
#include "estimation/restricted_likelihood.hpp"

#include <cmath>

#include <Eigen/LU>
#include <boost/math/tools/minima.hpp>

namespace trussmap {
namespace {

/// -2 log of the restricted likelihood, but for constants.
double restricted_loss(const RecordingProblem& problem, const EffectParameters& parameters,
                       const RecordingState& start) {
  RecordingAdjustmentOptions options;
  options.landmark_uncertainties = false;
  const RecordingAdjustment best = adjust_from(start, problem, parameters, options);
  RecordingSystem system(problem, parameters);
  system.linearise(best.state, best.coefficients);
  system.factorise();
  return best.chi2 + log_determinants(system, problem);
}

/// Minimum near `start`, in turns along the sum and the difference of the two coordinates.
template <class Loss>
Vector2 minimum(const Loss& loss, Vector2 at) {
  constexpr double kReach = 2.5;  // in log k: a factor of 12 either way
  constexpr int kBits = 9;
  double reach = kReach;
  for (int round = 0; round < 3; ++round) {
    for (const Vector2& way : {Vector2(1.0, 1.0), Vector2(1.0, -1.0)}) {
      const double step = boost::math::tools::brent_find_minima(
                              [&](double by) { return loss(at + by * way); }, -reach, reach, kBits)
                              .first;
      at += step * way;
    }
    reach *= 0.3;
  }
  return at;
}

/// Second differences about the minimum.
template <class Loss>
Matrix2 curvature_at(const Loss& loss, const Vector2& at) {
  constexpr double h = 0.15;
  const double middle = loss(at);
  Matrix2 curvature = Matrix2::Zero();
  for (int k = 0; k < 2; ++k) {
    curvature(k, k) =
        (loss(at + h * Vector2::Unit(k)) + loss(at - h * Vector2::Unit(k)) - 2.0 * middle) /
        (h * h);
  }
  const Vector2 both(h, h);
  const double diagonal = (loss(at + both) + loss(at - both) - 2.0 * middle) / (h * h);
  curvature(0, 1) = curvature(1, 0) = 0.5 * (diagonal - curvature(0, 0) - curvature(1, 1));
  return curvature;
}

}  // namespace

std::optional<WheelNoiseFit> most_likely_noise(const std::vector<Recording>& corrected,
                                               const Model& model, const ProblemOptions& options,
                                               const EffectParameters& parameters,
                                               const RecordingState& start) {
  const auto loss = [&](const Vector2& log_k) {
    Model tried = model;
    tried.noise.left = std::exp(log_k[0]);
    tried.noise.right = std::exp(log_k[1]);
    return restricted_loss(make_problem(corrected, tried, options), parameters, start);
  };
  const Vector2 log_k =
      minimum(loss, Vector2(std::log(model.noise.left), std::log(model.noise.right)));
  const Matrix2 curvature = curvature_at(loss, log_k);
  if (curvature(0, 0) <= 0.0 || curvature.determinant() <= 0.0) return std::nullopt;
  // The loss is -2 log L: its curvature is twice the information.
  const Matrix2 covariance = (0.5 * curvature).inverse();
  WheelNoiseFit result;
  result.k = log_k.array().exp();
  for (Eigen::Index k = 0; k < 2; ++k) {
    result.sd[k] = result.k[k] * std::sqrt(covariance(k, k));
  }
  return result;
}

}  // namespace trussmap
