// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/most_likely_noise.hpp"

#include "estimation/recording_adjustment.hpp"
#include "estimation/restricted_likelihood.hpp"
#include "fit/fit_numbers.hpp"
#include "fit/noise_search.hpp"

#include <cmath>

#include <Eigen/LU>

namespace trussmap::calibration {
namespace {

/// -2 log of the restricted likelihood, but for constants.
double restricted_loss(const estimation::RecordingProblem& problem,
                       const estimation::EffectParameters& parameters,
                       const estimation::RecordingState& start) {
  estimation::RecordingAdjustmentOptions options;
  options.landmark_uncertainties = false;
  const estimation::RecordingAdjustment best =
      estimation::adjust_from(start, problem, parameters, options);
  estimation::RecordingSystem system(problem, parameters);
  system.linearise(best.state, best.coefficients);
  system.factorise();
  return best.chi2 + estimation::log_determinants(system, problem);
}

}  // namespace

std::optional<WheelNoiseFit> most_likely_noise(const std::vector<DrivenRecording>& corrected,
                                               const Model& model,
                                               const estimation::ProblemOptions& options,
                                               const estimation::EffectParameters& parameters,
                                               const estimation::RecordingState& start) {
  const fitting::NoiseLoss loss = [&](const Eigen::VectorXd& log_k) {
    Model tried = model;
    tried.noise.left = std::exp(log_k[0]);
    tried.noise.right = std::exp(log_k[1]);
    return restricted_loss(estimation::make_problem(corrected, tried, options), parameters, start);
  };
  const Vector2 stated(std::log(model.noise.left), std::log(model.noise.right));
  const auto in_reach = [&stated](Eigen::VectorXd log_k) -> Eigen::VectorXd {
    return log_k.array()
        .max(stated.array() - fitting::kReach)
        .min(stated.array() + fitting::kReach);
  };
  const Vector2 log_k =
      fitting::likeliest_noise({loss, in_reach, fitting::kMostSteps, fitting::kLeastGain}, stated)
          .x;
  const Matrix2 curvature = fitting::curvatures(loss, log_k);
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

}  // namespace trussmap::calibration
