// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/noise_likelihood.hpp"

#include "estimation/restricted_likelihood.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

namespace trussmap::criticism {

NoiseLikelihood::NoiseLikelihood(const fitting::FitState& fit, const Eigen::MatrixXd& nuisance)
    : fit_(fit),
      nuisance_stated_(nuisance),
      problem_(fit.problem),
      system_(problem_, fit.columns.border) {
  if (nuisance_stated_.cols() == 0) nuisance_stated_.resize(system_.rows(), 0);
  nuisance_ = nuisance_stated_;
  system_.set_weights(
      estimation::weights_without(fit.adjustment.left_out, problem_.measurements.size()));
  for (const estimation::Measurement& one : problem_.measurements) {
    estimation::Matrix4 colour = estimation::Matrix4::Zero();
    colour.topLeftCorner(one.rows, one.rows) =
        one.whitener.topLeftCorner(one.rows, one.rows).inverse();
    colour_.push_back(colour);
  }
  stated_ = minus_two_log();
}

double NoiseLikelihood::minus_two_log() {
  return estimation::restricted_likelihood(system_, problem_, fit_.adjustment.state,
                                           fit_.adjustment.coefficients, nuisance_)
      .integrated();
}

double NoiseLikelihood::deviance(const NoiseLaw& law, double variance) {
  for (std::size_t k = 0; k < problem_.measurements.size(); ++k) {
    estimation::Measurement& one = problem_.measurements[k];
    const estimation::Matrix4& stated = fit_.problem.measurements[k].whitener;
    const bool noisier = variance > 0.0 && !law.added[k].isZero(0.0);
    one.whitener =
        noisier ? estimation::whitener_of(
                      colour_[k] * colour_[k].transpose() + variance * law.added[k], one.rows)
                : stated;
    if (nuisance_.cols() == 0) continue;
    const int at = system_.first_row(k);
    nuisance_.middleRows(at, one.rows) =
        (one.whitener * colour_[k]).topLeftCorner(one.rows, one.rows) *
        nuisance_stated_.middleRows(at, one.rows);
  }
  return minus_two_log() - stated_;
}

NoiseLikelihood::Best NoiseLikelihood::best(const NoiseLaw& law, double guess) {
  // Downhill in steps of e in the variance, then the vertex of the parabola through the last three.
  constexpr int kMostSteps = 12;
  double at = std::log(guess);
  double step = 1.0;
  std::array<double, 3> value{};  // at - step, at, at + step
  value[1] = deviance(law, std::exp(at));
  value[2] = deviance(law, std::exp(at + step));
  if (value[2] > value[1]) {
    step = -step;
    value[0] = value[2];
    value[2] = deviance(law, std::exp(at + step));
  } else {
    value[0] = value[1] + 1.0;  // not needed: the first step goes on
  }
  for (int k = 0; k < kMostSteps && value[2] < value[1]; ++k) {
    at += step;
    value = {value[1], value[2], deviance(law, std::exp(at + step))};
  }
  // Twice, the second time with a third of the step: the curve is no parabola far from its bottom.
  for (int resolution = 0; resolution < 2; ++resolution) {
    const double curvature = value[0] - 2.0 * value[1] + value[2];
    if (curvature > 0.0) {
      const double vertex =
          at + std::clamp(0.5 * (value[0] - value[2]) / curvature, -1.0, 1.0) * step;
      const double there = deviance(law, std::exp(vertex));
      if (there < value[1]) {
        at = vertex;
        value[1] = there;
      }
    }
    if (resolution > 0) break;
    step /= 3.0;
    value[0] = deviance(law, std::exp(at - step));
    value[2] = deviance(law, std::exp(at + step));
  }
  return {std::exp(at), std::max(0.0, -value[1])};
}

}  // namespace trussmap::criticism
