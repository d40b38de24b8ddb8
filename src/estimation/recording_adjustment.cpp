// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_adjustment.hpp"

#include "estimation/kinds/sighted.hpp"
#include "estimation/multilateration.hpp"
#include "estimation/recording_descent.hpp"
#include "estimation/recording_robust.hpp"
#include "estimation/recording_start.hpp"
#include "statistics/distributions.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace trussmap::estimation {
namespace {

std::string name_of(const RecordingProblem& problem, int node) {
  if (problem.is_landmark(node)) return "landmark " + problem.landmarks[idx(node)];
  if (problem.is_orientation(node)) {
    return "the orientation of landmark " + problem.landmark_of(node);
  }
  const PoseNode& pose = problem.poses[idx(node - problem.landmark_count())];
  const std::string session =
      problem.sessions.size() > 1 ? " of " + problem.sessions[idx(pose.session)] : std::string();
  return "the robot at t = " + text::fixed_text(pose.t, 3) + " s" + session;
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
  if (nodes.size() > kNodesNamed)
    names += text::joined(" and ", nodes.size() - kNodesNamed, " more");
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
  } catch (const linalg::NotPositiveDefinite& error) {
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

/// Square roots of the traces of (1 - G G') C (1 - G G'), G an orthonormal basis of the points'
/// shifts and rotation about their middle (Baarda's S-transformation, inner constraints).
std::vector<double> shape_sds(const std::vector<Vector2>& points, const RecordingSystem& system,
                              const std::vector<Matrix2>& covariances) {
  const auto count = static_cast<Eigen::Index>(points.size());
  Vector2 middle = Vector2::Zero();
  for (const Vector2& point : points) middle += point / static_cast<double>(count);
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(2 * count, 3);
  for (Eigen::Index k = 0; k < count; ++k) {
    G.block<2, 2>(2 * k, 0).setIdentity();
    G.block<2, 1>(2 * k, 2) = quarter_turn(Vector2(points[idx(static_cast<int>(k))] - middle));
  }
  for (Eigen::Index c = 0; c < 3; ++c) {
    const double length = G.col(c).norm();
    if (length > 0.0) G.col(c) /= length;
  }
  const Eigen::MatrixXd CG = system.landmark_covariance_times(G);
  const Eigen::Matrix3d GCG = G.transpose() * CG;
  std::vector<double> sds;
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Matrix<double, 2, 3> own = G.middleRows<2>(2 * k);
    const Matrix2 inner = covariances[idx(static_cast<int>(k))] + own * GCG * own.transpose() -
                          own * CG.middleRows<2>(2 * k).transpose() -
                          CG.middleRows<2>(2 * k) * own.transpose();
    sds.push_back(std::sqrt(std::max(0.0, inner.trace())));
  }
  return sds;
}

std::vector<double> orientation_sds(const RecordingSystem& system, const RecordingProblem& problem,
                                    const std::vector<int>& left_out) {
  std::vector<double> sds(problem.oriented.size(), kAbsent);
  if (sds.empty()) return sds;
  const std::vector<double> variances = system.orientation_variances();
  const std::vector<double> weights = weights_without(left_out, problem.measurements.size());
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    if (!is_of_orientation(one) || weights[k] == 0.0) continue;
    const int node = is_yaw(one) ? one.to : one.from;
    const std::size_t orientation = idx(node - problem.pose_end());
    sds[orientation] = std::sqrt(std::max(0.0, variances[orientation]));
  }
  return sds;
}

/// The system is factorised at the adjustment.
void take_uncertainties(const RecordingSystem& system, const RecordingProblem& problem,
                        RecordingAdjustment& result) {
  result.landmark_covariances = system.landmark_covariances();
  result.landmark_sds = shape_sds(result.state.landmarks, system, result.landmark_covariances);
  result.orientation_sds = orientation_sds(system, problem, result.left_out);
}

RobustFit robust_fit(RecordingSystem& system, const RecordingProblem& problem,
                     const RecordingDescent& start, const RecordingAdjustmentOptions& options) {
  if (options.near == nullptr) {
    return descend_robustly(system, problem, start.state, start.coefficients,
                            {*options.gate, options.most_left_out});
  }
  RobustFit before{start.state, start.coefficients, {}, 0.0};
  before.weights = weights_without(options.near->left_out, problem.measurements.size());
  before.gate = *options.gate * options.near->gate_widened * options.near->gate_widened;
  return look_again(system, problem, std::move(before));
}

}  // namespace

RecordingAdjustment adjust(const RecordingProblem& problem, const EffectParameters& border,
                           const RecordingAdjustmentOptions& options) {
  StartOptions start;
  if (options.gate) start.gate = *options.gate;
  static_cast<void>(choose_gauge(problem));  // refuses what has no start
  const EffectParameters no_effects;
  return adjust_from(start_of(problem, no_effects, start).state, problem, border, options);
}

RecordingAdjustment adjust_from(const RecordingState& start, const RecordingProblem& problem,
                                const EffectParameters& border,
                                const RecordingAdjustmentOptions& options) {
  RecordingSystem system(problem, border);
  const auto coefficients = static_cast<Eigen::Index>(unknown_coefficients(border).size());
  RecordingAdjustment result;
  RecordingDescent fit{start, initial(options, coefficients), 0.0, 0, false};
  const linalg::DescentOptions descent{options.max_iterations, options.tolerance,
                                       kNegligibleDecrease};
  int rows = system.rows();
  try {
    if (options.gate) {
      RobustFit robust = robust_fit(system, problem, fit, options);
      for (std::size_t k = 0; k < robust.weights.size(); ++k) {
        if (robust.weights[k] > 0.0) continue;
        result.left_out.push_back(static_cast<int>(k));
        rows -= problem.measurements[k].rows;
      }
      result.gate_widened = std::sqrt(robust.gate / *options.gate);
      fit.state = std::move(robust.state);
      fit.coefficients = std::move(robust.coefficients);
    }
    fit = descend(system, std::move(fit.state), std::move(fit.coefficients), descent);
  } catch (const linalg::NotPositiveDefinite&) {
    throw SolveError("the adjustment broke down: the model's noise spans too many magnitudes");
  }
  if (!std::isfinite(fit.chi2)) {
    throw SolveError(
        "the errors are beyond all numbers: an effect's coefficient or a reading is far "
        "too large");
  }
  check_determined(system, problem, border);
  result.state = std::move(fit.state);
  result.coefficients = std::move(fit.coefficients);
  result.chi2 = fit.chi2;
  result.dof = rows - system.unknowns();
  for (const EffectPattern& effect : border) {
    result.dof += !effect.held && std::isfinite(effect.prior_sd) ? 1 : 0;
  }
  result.p_value = statistics::chi2_p_value(result.chi2, result.dof);
  result.iterations = fit.iterations;
  result.converged = fit.converged;
  result.gradient_norm = system.gradient_norm();
  if (options.landmark_uncertainties) take_uncertainties(system, problem, result);
  if (coefficients > 0) result.coefficient_covariance = system.coefficient_covariance();
  return result;
}

namespace {

/// The adjustment's system, factorised there.
void prepare(RecordingSystem& system, const RecordingProblem& problem,
             const EffectParameters& border, const RecordingAdjustment& adjustment) {
  system.set_weights(weights_without(adjustment.left_out, problem.measurements.size()));
  system.linearise(adjustment.state, adjustment.coefficients);
  check_determined(system, problem, border);
}

}  // namespace

std::vector<double> weights_without(const std::vector<int>& left_out, std::size_t measurements) {
  std::vector<double> weights(measurements, 1.0);
  for (const int k : left_out) weights[idx(k)] = 0.0;
  return weights;
}

std::vector<std::string> mirror_warnings(const RecordingProblem& problem,
                                         const RecordingAdjustment& adjustment) {
  std::vector<std::vector<RangeReading>> readings(problem.landmarks.size());
  std::vector<bool> told(problem.landmarks.size(), false);
  const std::vector<double> weights =
      weights_without(adjustment.left_out, problem.measurements.size());
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    if (is_surveyed_place(one)) told[idx(one.from)] = true;
    if (!is_sighting(one) || weights[k] == 0.0) continue;
    const bool range_alone = one.rows == 1 && begins_with(one, "range");
    if (!range_alone) {
      told[idx(one.to)] = true;
      continue;
    }
    const Pose& pose = adjustment.state.poses[idx(one.from - problem.landmark_count())];
    readings[idx(one.to)].push_back(
        {sensor_at(pose, one.mounted), one.value[0], 1.0 / one.whitener(0, 0)});
  }
  std::vector<std::string> warnings;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    if (told[k]) continue;
    const std::optional<Multilateration> found = multilaterate(readings[k]);
    if (!found || !found->mirror) continue;
    const bool first = (found->place - adjustment.state.landmarks[k]).norm() <
                       (*found->mirror - adjustment.state.landmarks[k]).norm();
    const Vector2 other = first ? *found->mirror : found->place;
    warnings.push_back(
        text::joined("landmark ", problem.landmarks[k],
                     " has ranges from about one line alone: it may as well lie at (",
                     text::fixed_text(other.x(), 2), ", ", text::fixed_text(other.y(), 2),
                     ") m; drive to another side of it"));
  }
  return warnings;
}

void add_landmark_uncertainties(const RecordingProblem& problem, const EffectParameters& border,
                                RecordingAdjustment& adjustment) {
  RecordingSystem system(problem, border);
  prepare(system, problem, border, adjustment);
  take_uncertainties(system, problem, adjustment);
}

std::vector<Matrix3> pose_covariances(const RecordingProblem& problem,
                                      const EffectParameters& border,
                                      const RecordingAdjustment& adjustment) {
  RecordingSystem system(problem, border);
  prepare(system, problem, border, adjustment);
  return system.pose_covariances();
}

Eigen::MatrixXd joint_covariance(const RecordingProblem& problem, const EffectParameters& border,
                                 const RecordingAdjustment& adjustment,
                                 const std::vector<int>& nodes) {
  RecordingSystem system(problem, border);
  prepare(system, problem, border, adjustment);
  return system.joint_covariance(nodes);
}

}  // namespace trussmap::estimation
