// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/stretch_adjustment.hpp"

#include "estimation/problem_part.hpp"
#include "estimation/recording_descent.hpp"
#include "estimation/recording_robust.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::estimation {
namespace {

/// Roughly: what is beyond the gate is held out, or weighs less.
RecordingDescent descend_roughly(RecordingSystem& system, const RecordingProblem& problem,
                                 const StartOptions& options, RecordingDescent fit) {
  constexpr linalg::DescentOptions kRough{30, 1e-4, kNegligibleDecrease};
  if (std::isfinite(options.gate) && has_loops(problem)) {
    system.linearise(fit.state, fit.coefficients);
    RobustFit robust{fit.state, fit.coefficients, {}, options.gate};
    robust.weights.reserve(problem.measurements.size());
    for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
      const bool out =
          may_be_wrong(problem.measurements[k]) && system.squared_errors()[k] > options.gate;
      robust.weights.push_back(out ? 0.0 : 1.0);
    }
    robust = look_again(system, problem, std::move(robust));
    return descend(system, robust.state, robust.coefficients, kRough);
  }
  if (std::isfinite(options.gate)) {
    follow_majority(problem, fit.state);
    constexpr linalg::DescentOptions kRound{5, 1e-4, kNegligibleDecrease};
    return descend_softly(system, problem, std::move(fit), options.gate, 4, kRound);
  }
  return descend(system, fit.state, fit.coefficients, kRough);
}

/// What is laid of the landmarks, poses and orientations of a stretch.
RecordingState state_laid(const ProblemPart& stretch, const LaidSession& laid) {
  RecordingState state;
  for (const int landmark : stretch.landmarks) {
    state.landmarks.push_back(*laid.landmarks[idx(landmark)]);
  }
  state.poses.assign(laid.poses.begin(), laid.poses.begin() + std::ssize(stretch.problem.poses));
  state.orientations = orientations_seen_from(stretch.problem, state.poses);
  for (std::size_t k = 0; k < stretch.orientations.size(); ++k) {
    const std::optional<double>& known = laid.orientations[idx(stretch.orientations[k])];
    if (known) state.orientations[k] = *known;
  }
  return state;
}

LaidSession with_state(const ProblemPart& stretch, const RecordingState& state, LaidSession laid) {
  for (std::size_t k = 0; k < stretch.landmarks.size(); ++k) {
    laid.landmarks[idx(stretch.landmarks[k])] = state.landmarks[k];
  }
  for (std::size_t k = 0; k < stretch.orientations.size(); ++k) {
    laid.orientations[idx(stretch.orientations[k])] = state.orientations[k];
  }
  std::copy(state.poses.begin(), state.poses.end(), laid.poses.begin());
  return laid;
}

/// How well a fit knows its coefficients. A misfit makes them less certain, but never less than
/// they were at first.
Eigen::MatrixXd coefficient_covariance_of(RecordingSystem& system, double chi2,
                                          const Eigen::MatrixXd& prior) {
  try {
    system.factorise();
  } catch (
      const linalg::NotPositiveDefinite&) {  // rounding has eaten what the stretch says of them
    return prior;
  }
  const double dispersion = std::max(1.0, chi2 / std::max(1, system.rows() - system.unknowns()));
  Eigen::MatrixXd covariance = dispersion * system.coefficient_covariance();
  for (Eigen::Index k = 0; k < covariance.cols(); ++k) {
    const double ratio = std::sqrt(std::min(1.0, prior(k, k) / covariance(k, k)));
    covariance.col(k) *= ratio;
    covariance.row(k) *= ratio;
  }
  return covariance;
}

}  // namespace

AdjustedStretch adjust_stretch(const SessionToLay& session, LaidSession laid, int count) {
  const ProblemPart stretch = part_of(session.problem, {0, count}, &laid.landmarks);
  if (stretch.landmarks.empty() && !has_loops(stretch.problem)) return {std::move(laid), 0.0};
  RecordingSystem system(stretch.problem, session.border);
  system.set_slack(RecordingSystem::kRoughSlack);
  const auto lost = [&] {
    return share_beyond(stretch.problem, system.squared_errors(), session.options.gate);
  };
  RecordingDescent fit{state_laid(stretch, laid), laid.coefficients.values};
  try {
    fit = descend_roughly(system, stretch.problem, session.options, std::move(fit));
  } catch (
      const linalg::NotPositiveDefinite&) {  // rounding leaves no step to take: it stays as laid
    return {std::move(laid), lost()};
  }
  laid = with_state(stretch, fit.state, std::move(laid));
  if (fit.coefficients.size() > 0) {
    laid.coefficients = {
        fit.coefficients,
        coefficient_covariance_of(system, fit.chi2, prior_of(session.border).covariance)};
  }
  return {std::move(laid), lost()};
}

}  // namespace trussmap::estimation
