// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_adjustment.hpp"

#include "estimation/recording_descent.hpp"
#include "estimation/recording_robust.hpp"
#include "estimation/recording_start.hpp"
#include "statistics/distributions.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace trussmap {
namespace {

std::string name_of(const RecordingProblem& problem, int node) {
  if (problem.is_landmark(node)) return "landmark " + problem.landmarks[idx(node)];
  const PoseNode& pose = problem.poses[idx(node - problem.landmark_count())];
  const std::string session =
      problem.sessions.size() > 1 ? " of " + problem.sessions[idx(pose.session)] : std::string();
  return "the robot at t = " + fixed_text(pose.t, 3) + " s" + session;
}

/// Landmarks first: they are what the user knows by name.
[[noreturn]] void refuse_loose(const RecordingProblem& problem, std::vector<int> nodes) {
  std::stable_sort(nodes.begin(), nodes.end(),
                   [&](int a, int b) { return problem.is_landmark(a) && !problem.is_landmark(b); });
  constexpr std::size_t kNodesNamed = 3;
  std::string names;
  for (std::size_t k = 0; k < std::min(nodes.size(), kNodesNamed); ++k) {
    names += (k == 0 ? "" : k + 1 == nodes.size() ? " and " : ", ") + name_of(problem, nodes[k]);
  }
  if (nodes.size() > kNodesNamed) names += joined(" and ", nodes.size() - kNodesNamed, " more");
  throw SolveError(names +
                   " can still move without changing any measurement; sight more landmarks from "
                   "there, or survey one");
}

void refuse_undetermined(const EffectParameters& border, const std::vector<int>& coefficients) {
  if (coefficients.empty()) return;
  const std::vector<int> unknown = unknown_coefficients(border);
  std::string names;
  for (const int k : coefficients) {
    names += (names.empty() ? "" : ", ") + border[idx(unknown[idx(k)])].name;
  }
  throw UndeterminedError(
      (coefficients.size() == 1 ? "the coefficient of " : "the coefficients of ") + names +
          " cannot be determined from this motion: no measurement tells them from the "
          "unknowns; add a survey, or drive routes of other lengths and turns",
      coefficients);
}

void check_determined(RecordingSystem& system, const RecordingProblem& problem,
                      const EffectParameters& border) {
  const std::vector<int> loose = find_loose_nodes(system);
  if (!loose.empty()) refuse_loose(problem, loose);
  try {
    system.factorise();
  } catch (const NotPositiveDefinite& error) {
    if (error.column() >= 0) throw SolveError("the map is too loosely tied together to be solved");
    const std::vector<int> known = find_undetermined(system);
    std::vector<int> all(unknown_coefficients(border).size());
    std::iota(all.begin(), all.end(), 0);
    refuse_undetermined(border, known.empty() ? all : known);
  }
  refuse_undetermined(border, find_undetermined(system));
}

Eigen::VectorXd initial(const RecordingAdjustmentOptions& options, Eigen::Index count) {
  return options.coefficients.size() == count ? options.coefficients : Eigen::VectorXd::Zero(count);
}

void add_warnings(RecordingAdjustment& result) {
  constexpr double kImplausible = 1e-6;
  if (!result.converged) {
    result.warnings.push_back(joined("no minimum was reached in ", result.iterations,
                                     " iterations: the map is not the best one"));
  }
  if (result.p_value < kImplausible) {
    result.warnings.push_back(joined("chi^2 = ", fixed_text(result.chi2, 1), " is too large for ",
                                     result.dof,
                                     " degrees of freedom: the model's noise is too small, "
                                     "an effect is missing, or sightings are wrong"));
  }
  if (!result.left_out.empty()) {
    result.warnings.push_back(joined(result.left_out.size(), " sightings were left out"));
  }
}

}  // namespace

RecordingAdjustment adjust(const RecordingProblem& problem, const EffectParameters& border,
                           const RecordingAdjustmentOptions& options) {
  StartOptions start;
  if (options.gate) start.gate = *options.gate;
  static_cast<void>(choose_gauge(problem));  // refuses what has no start
  return adjust_from(start_of(problem, start), problem, border, options);
}

RecordingAdjustment adjust_from(const RecordingState& start, const RecordingProblem& problem,
                                const EffectParameters& border,
                                const RecordingAdjustmentOptions& options) {
  RecordingSystem system(problem, border);
  const auto coefficients = static_cast<Eigen::Index>(unknown_coefficients(border).size());
  RecordingAdjustment result;
  RecordingDescent fit{start, initial(options, coefficients), 0.0, 0, false};
  const DescentOptions descent{options.max_iterations, options.tolerance, kNegligibleDecrease};
  int rows = system.rows();
  try {
    if (options.gate) {
      system.linearise(fit.state, fit.coefficients);
      system.set_weights(soft_weights(problem, system.squared_errors(), *options.gate));
      fit = descend(system, fit.state, fit.coefficients, {30, 1e-4, kNegligibleDecrease});
      RobustFit robust =
          reduce_nonconvexity(system, problem, fit.state, fit.coefficients, *options.gate);
      for (std::size_t k = 0; k < robust.weights.size(); ++k) {
        if (robust.weights[k] > 0.0) continue;
        result.left_out.push_back(static_cast<int>(k));
        rows -= problem.measurements[k].rows;
      }
      fit.state = std::move(robust.state);
      fit.coefficients = std::move(robust.coefficients);
    }
    fit = descend(system, std::move(fit.state), std::move(fit.coefficients), descent);
  } catch (const NotPositiveDefinite&) {
    throw SolveError("the adjustment broke down: the model's noise spans too many magnitudes");
  }
  check_determined(system, problem, border);
  result.state = std::move(fit.state);
  result.coefficients = std::move(fit.coefficients);
  result.chi2 = fit.chi2;
  result.dof = rows - system.unknowns();
  for (const EffectPattern& effect : border) {
    result.dof += !effect.held && std::isfinite(effect.prior_sd) ? 1 : 0;
  }
  result.p_value = chi2_p_value(result.chi2, result.dof);
  result.iterations = fit.iterations;
  result.converged = fit.converged;
  result.gradient_norm = system.gradient_norm();
  std::vector<int> landmarks(problem.landmarks.size());
  for (std::size_t k = 0; k < landmarks.size(); ++k) landmarks[k] = static_cast<int>(k);
  const Eigen::MatrixXd joint = system.joint_covariance(landmarks);
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(landmarks.size()); ++k) {
    result.landmark_covariances.emplace_back(joint.block<2, 2>(2 * k, 2 * k));
  }
  result.coefficient_covariance = joint.bottomRightCorner(coefficients, coefficients);
  add_warnings(result);
  return result;
}

Eigen::MatrixXd joint_covariance(const RecordingProblem& problem, const EffectParameters& border,
                                 const RecordingAdjustment& adjustment,
                                 const std::vector<int>& nodes) {
  RecordingSystem system(problem, border);
  std::vector<double> weights(problem.measurements.size(), 1.0);
  for (const int k : adjustment.left_out) weights[idx(k)] = 0.0;
  system.set_weights(weights);
  system.linearise(adjustment.state, adjustment.coefficients);
  check_determined(system, problem, border);
  return system.joint_covariance(nodes);
}

}  // namespace trussmap
