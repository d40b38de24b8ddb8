// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/noise_screening.hpp"

#include "fit/fit_projection.hpp"
#include "fit/process_columns.hpp"
#include "linalg/dense.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <utility>

namespace trussmap::fitting {
namespace {

constexpr Eigen::Index kDraws = 96;
constexpr std::size_t kFewestStates = 6;

class Screening {
 public:
  Screening(const FitState& fit, const NoiseReml& reml) : fit_(fit), reml_(reml) {
    const estimation::RecordingSystem& system = reml.system();
    const FitProjection P(fit, reml.problem(), system, system.free_of_nodes(reml.nuisance()));
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    draws_.resize(system.rows(), kDraws + 1);
    for (double& value : draws_.reshaped()) value = normal(random);
    draws_.col(kDraws) = system.residuals();
    draws_ = P.times(std::move(draws_));
  }

  /// q of each draw and, last, of the residuals; less the draws' mean. Nothing where there is
  /// nothing to ask.
  [[nodiscard]] std::optional<Eigen::VectorXd> quadratics(const NoiseComponent& one) const {
    Eigen::VectorXd q;
    if (one.lasts()) {
      const estimation::LaidProcess laid =
          reml_.layer().lay(one.process.channel, one.process.process,
                            std::max(one.process.length, kLeastProcessLength));
      if (laid.states.size() < kFewestStates) return std::nullopt;
      q = quadratic(laid, draws_);
    } else {
      q = quadratic(reml_.unit_covariances(one), draws_);
    }
    q.array() -= q.head(kDraws).mean();
    return q;
  }

 private:
  /// y'V y of each column, V of a white component.
  [[nodiscard]] Eigen::VectorXd quadratic(const std::vector<estimation::Matrix4>& added,
                                          const Eigen::MatrixXd& draws) const {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(draws.cols());
    const estimation::RecordingProblem& problem = reml_.problem();
    for (std::size_t k = 0; k < added.size(); ++k) {
      if (added[k].isZero(0.0) || reml_.left_out(k)) continue;
      const estimation::Measurement& one = problem.measurements[k];
      const Eigen::MatrixXd V =
          (one.whitener * added[k] * one.whitener.transpose()).topLeftCorner(one.rows, one.rows);
      const auto y = draws.middleRows(reml_.system().first_row(k), one.rows);
      q += (y.cwiseProduct(V * y)).colwise().sum().transpose();
    }
    return q;
  }

  /// The same of a process: what its states' columns see of y, coloured by their prior.
  [[nodiscard]] Eigen::VectorXd quadratic(const estimation::LaidProcess& laid,
                                          const Eigen::MatrixXd& draws) const {
    const estimation::RecordingProblem& problem = reml_.problem();
    const auto states = static_cast<Eigen::Index>(laid.states.size());
    Eigen::MatrixXd u = Eigen::MatrixXd::Zero(states, draws.cols());
    for (std::size_t k = 0; k < laid.terms.size(); ++k) {
      if (laid.terms[k].empty() || reml_.left_out(k)) continue;
      const estimation::Measurement& one = problem.measurements[k];
      const auto y = draws.middleRows(reml_.system().first_row(k), one.rows);
      for (const estimation::NoiseTerm& term : laid.terms[k]) {
        const estimation::Vector4 column =
            one.whitener * estimation::error_by(one, by_view_of(fit_, problem, k), term);
        u.row(term.state) += column.head(one.rows).transpose() * y;
      }
    }
    // u'K u with K = L L', L the chain: z = L eta.
    for (Eigen::Index k = states; k-- > 0;) {
      const estimation::NoiseState& state = laid.states[static_cast<std::size_t>(k)];
      if (state.previous >= 0) u.row(state.previous) += state.keep * u.row(k);
    }
    Eigen::VectorXd q = Eigen::VectorXd::Zero(draws.cols());
    for (Eigen::Index k = 0; k < states; ++k) {
      const double sd = laid.states[static_cast<std::size_t>(k)].sd;
      q += sd * sd * u.row(k).cwiseAbs2().transpose();
    }
    return q + quadratic(laid.within, draws);
  }

  const FitState& fit_;
  const NoiseReml& reml_;
  Eigen::MatrixXd draws_;  ///< projected; the residuals last
};

}  // namespace

std::vector<ScreenedNoise> screened_noise(const FitState& fit, const NoiseReml& reml,
                                          const std::vector<NoiseComponent>& candidates,
                                          const std::vector<NoiseComponent>& estimated) {
  const Screening screening(fit, reml);
  Eigen::MatrixXd known(kDraws + 1, 0);
  for (const NoiseComponent& one : estimated) {
    const std::optional<Eigen::VectorXd> q = screening.quadratics(one);
    if (!q) continue;
    known.conservativeResize(Eigen::NoChange, known.cols() + 1);
    known.rightCols<1>() = *q;
  }
  std::vector<ScreenedNoise> result;
  for (const NoiseComponent& one : candidates) {
    std::optional<Eigen::VectorXd> q = screening.quadratics(one);
    if (!q) continue;
    if (known.cols() > 0)
      *q -= known * linalg::least_squares(known.topRows(kDraws), q->head(kDraws));
    const double variance =
        q->head(kDraws).squaredNorm() / static_cast<double>(kDraws - 1 - known.cols());
    if (!(variance > 0.0)) continue;
    const double found = (*q)[kDraws];
    // Var q = 2 tr(PVPV), and q - E q rises by tr(PVPV) per unit of variance.
    result.push_back(
        {one, found / std::sqrt(variance), std::sqrt(std::max(0.0, found / (0.5 * variance)))});
  }
  return result;
}

}  // namespace trussmap::fitting
