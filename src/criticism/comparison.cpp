// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/comparison.hpp"

#include "estimation/source_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace trussmap {
namespace {

int squared_values(const RecordingSystem& system, const Measurement& one, std::size_t k,
                   double& sum) {
  sum += system.residuals().segment(system.first_row(k), one.rows).squaredNorm();
  return one.rows;
}

/// Legs and routes with what is locked in them.
void find_misfits(const ModelFit& fit, const ScoreTest& tests, const LegOptions& options,
                  Comparison& result) {
  const RecordingProblem& problem = fit.problem;
  const std::vector<LegSpan> legs = leg_spans(fit.recordings, problem, options);
  std::map<int, std::size_t> segment_from;  // node -> measurement
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    if (problem.measurements[k].kind == MeasurementKind::segment) {
      segment_from[problem.measurements[k].from] = k;
    }
  }
  const auto pose = [&](int node) -> const Pose& {
    return fit.adjustment.state.poses[idx(node - problem.landmark_count())];
  };
  std::map<std::pair<std::string, std::string>, RouteMisfit> routes;
  for (const LegSpan& leg : legs) {
    const Measurement& from = problem.measurements[leg.from];
    const Measurement& to = problem.measurements[leg.to];
    LegMisfit one;
    one.from = from.to < 0 ? std::string() : problem.landmarks[idx(from.to)];
    one.to = to.to < 0 ? std::string() : problem.landmarks[idx(to.to)];
    one.t = leg.time.to;
    Pose reckoned = pose(from.from);
    Vector2 pull = Vector2::Zero();  // of the last segment on the leg's end
    for (int node = from.from; node != to.from;) {
      const auto found = segment_from.find(node);
      if (found == segment_from.end()) break;
      const Measurement& segment = problem.measurements[found->second];
      one.dof += squared_values(tests.system(), segment, found->second, one.chi2);
      const Pose& a = pose(segment.from);
      const Pose& b = pose(segment.to);
      const auto error =
          tests.system().residuals().segment(tests.system().first_row(found->second), segment.rows);
      const Eigen::MatrixXd W = segment.whitener.topLeftCorner(segment.rows, segment.rows);
      const Eigen::VectorXd raw = W.triangularView<Eigen::Lower>().solve(error);
      const Pose measured = relative(a, b);
      reckoned =
          compose(reckoned, {measured.x - raw[0], measured.y - raw[1], measured.heading - raw[2]});
      const Eigen::VectorXd force = W.transpose() * error;
      pull = rotation(a.heading) * force.head<2>();
      node = segment.to;
    }
    const Vector2 begin = pose(from.from).position();
    const Vector2 chord = pose(to.from).position() - begin;
    const Vector2 driven = reckoned.position() - begin;
    if (chord.norm() >= 0.1) {
      one.stretch_error = (driven.norm() - chord.norm()) / chord.norm();
      one.orientation_error = wrap_angle(direction(driven) - direction(chord));
    }
    if (!one.from.empty()) {
      const bool forward = one.from < one.to;
      RouteMisfit& route =
          routes[forward ? std::pair(one.from, one.to) : std::pair(one.to, one.from)];
      route.from = forward ? one.from : one.to;
      route.to = forward ? one.to : one.from;
      ++route.traversals;
      route.chi2 += one.chi2;
      route.stretch_error += one.stretch_error;
      route.orientation_error += one.orientation_error;
      if (chord.norm() > 0.0) route.force += pull.dot(chord) / chord.norm();
    }
    result.worst.push_back(std::move(one));
  }
  result.legs = legs.size();
  const auto worse = [](const auto& a, const auto& b) { return a.chi2 > b.chi2; };
  std::stable_sort(result.worst.begin(), result.worst.end(), worse);
  for (auto& [name, route] : routes) {
    route.stretch_error /= route.traversals;
    route.orientation_error /= route.traversals;
    result.routes.push_back(route);
  }
  std::stable_sort(result.routes.begin(), result.routes.end(), worse);
  std::map<int, LandmarkMisfit> landmarks;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    const bool survey = one.kind == MeasurementKind::survey;
    if (!survey && (one.to < 0 || !problem.is_landmark(one.to))) continue;
    const int node = survey ? one.from : one.to;
    LandmarkMisfit& landmark = landmarks[node];
    landmark.landmark = problem.landmarks[idx(node)];
    landmark.sightings += survey ? 0 : 1;
    squared_values(tests.system(), one, k, landmark.chi2);
  }
  for (auto& [node, landmark] : landmarks) result.worst_landmarks.push_back(landmark);
  std::stable_sort(result.worst_landmarks.begin(), result.worst_landmarks.end(), worse);
}

/// Redundancies by random signs: E[z' R z] over the rows of a source is the trace of R there.
std::vector<SourceCalibration> calibrate_sources(const ModelFit& fit, const ScoreTest& tests) {
  constexpr Eigen::Index kProbes = 48;
  constexpr double kLeastRedundancy = 5.0;
  const RecordingSystem& system = tests.system();
  const Eigen::Index rows = system.rows();
  std::mt19937_64 random(1);
  Eigen::MatrixXd probes(rows, kProbes);
  for (double& sign : probes.reshaped()) sign = (random() & 1U) != 0U ? 1.0 : -1.0;
  const Eigen::Index unknowns = system.normal_equations().unknowns();
  const Eigen::MatrixXd& M = system.border();
  Eigen::MatrixXd right(unknowns + M.cols(), kProbes);
  right.topRows(unknowns) = system.transposed_times(probes);
  right.bottomRows(M.cols()) = M.transpose() * probes;
  const Eigen::MatrixXd x = system.solve(right);
  const Eigen::MatrixXd left =
      probes - system.times(x.topRows(unknowns)) - M * x.bottomRows(M.cols());
  const Eigen::VectorXd redundancy = probes.cwiseProduct(left).rowwise().mean();
  std::vector<std::string> order;
  std::map<std::string, std::pair<double, double>> sums;
  for (std::size_t k = 0; k < fit.problem.measurements.size(); ++k) {
    const Measurement& one = fit.problem.measurements[k];
    for (int row = 0; row < one.rows; ++row) {
      const std::string source = noise_source(one.kind, row);
      if (!sums.contains(source)) order.push_back(source);
      auto& [squares, checked] = sums[source];
      const double r = system.residuals()[system.first_row(k) + row];
      squares += r * r;
      checked += redundancy[system.first_row(k) + row];
    }
  }
  std::vector<SourceCalibration> result;
  for (const std::string& source : order) {
    const auto& [squares, checked] = sums[source];
    if (checked < kLeastRedundancy) continue;
    const double factor = std::sqrt(squares / checked);
    result.push_back({source, factor, factor / std::sqrt(2.0 * checked), checked});
  }
  return result;
}

/// Against the dispersion there is: where everything is off, nothing stands out.
std::vector<Outlier> find_outliers(const ModelFit& fit, double dispersion) {
  const std::vector<CheckedMeasurement> checked =
      snoop(fit.problem, fit.columns.border, fit.adjustment);
  const auto count = static_cast<double>(checked.size());
  std::vector<Outlier> result;
  for (const CheckedMeasurement& one : checked) {
    const double statistic = one.statistic / dispersion;
    const double p = std::min(1.0, count * chi2_p_value(statistic, one.checked));
    if (p >= 0.05) continue;
    result.push_back({describe(fit.problem, fit.problem.measurements[idx(one.measurement)]),
                      statistic, one.checked, p});
  }
  std::stable_sort(result.begin(), result.end(), [](const Outlier& a, const Outlier& b) {
    return a.p_adjusted < b.p_adjusted ||
           (a.p_adjusted == b.p_adjusted && a.statistic > b.statistic);
  });
  return result;
}

ModelFitOptions fit_options(const ComparisonOptions& options) {
  ModelFitOptions how;
  how.fit_effects = false;
  how.problem = options.problem;
  how.gate = options.gate;
  return how;
}

}  // namespace

Comparison compare(const std::vector<Recording>& recordings, const Model& model,
                   const ComparisonOptions& options) {
  const ModelFit fit = fit_to_compare(recordings, model, options);
  return compare(recordings, model, options, fit, ScoreTest(fit));
}

ModelFit fit_to_compare(const std::vector<Recording>& recordings, const Model& model,
                        const ComparisonOptions& options) {
  return fit_model(recordings, model, fit_options(options));
}

Comparison compare(const std::vector<Recording>& recordings, const Model& model,
                   const ComparisonOptions& options, const ModelFit& fit, const ScoreTest& tests) {
  Comparison result;
  result.chi2 = fit.adjustment.chi2;
  result.dof = fit.adjustment.dof;
  result.p_value = fit.adjustment.p_value;
  result.consistent = result.p_value >= options.level;
  result.landmarks = fit.problem.landmarks.size();
  result.warnings = fit.adjustment.warnings;
  find_misfits(fit, tests, options.legs, result);
  result.trends = find_trends(fit, tests);
  result.sources = calibrate_sources(fit, tests);
  result.outliers = find_outliers(fit, tests.dispersion());
  result.advice = advice_on(recordings, model, options.problem);
  result.held_out = predict_held_out(recordings, fit, fit_options(options), options.legs);
  return result;
}

}  // namespace trussmap
