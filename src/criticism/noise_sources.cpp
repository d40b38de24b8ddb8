// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/noise_sources.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <utility>

namespace trussmap::criticism {
namespace {

/// Of each row, by random signs: E[z' R z] over the rows of a source is the trace of R there.
Eigen::VectorXd redundancies(const estimation::RecordingSystem& system) {
  constexpr int kBatches = 3;
  constexpr Eigen::Index kProbes = 16;  // at once
  std::mt19937_64 random(1);
  const Eigen::Index unknowns = system.normal_equations().unknowns();
  const Eigen::MatrixXd& M = system.border();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(system.rows());
  for (int batch = 0; batch < kBatches; ++batch) {
    Eigen::MatrixXd probes(system.rows(), kProbes);
    for (double& sign : probes.reshaped()) sign = (random() & 1U) != 0U ? 1.0 : -1.0;
    Eigen::MatrixXd right(unknowns + M.cols(), kProbes);
    right.topRows(unknowns) = system.transposed_times(probes);
    right.bottomRows(M.cols()) = M.transpose() * probes;
    const Eigen::MatrixXd x = system.solve(right);
    Eigen::MatrixXd left = probes - M * x.bottomRows(M.cols());
    system.subtract_times(x.topRows(unknowns), left);
    sum += probes.cwiseProduct(left).rowwise().sum();
  }
  return sum / (kBatches * kProbes);
}

}  // namespace

std::vector<SourceCalibration> calibrate_sources(const fitting::FitState& fit,
                                                 const ScoreTest& tests) {
  constexpr double kLeastRedundancy = 5.0;
  const estimation::RecordingSystem& system = tests.system();
  const Eigen::VectorXd redundancy = redundancies(system);
  std::vector<std::string> order;
  std::map<std::string, std::pair<double, double>> sums;
  for (std::size_t k = 0; k < fit.problem.measurements.size(); ++k) {
    const estimation::Measurement& one = fit.problem.measurements[k];
    for (int row = 0; row < one.rows; ++row) {
      const std::string source(one.kind->noise(row));
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

std::vector<SourceResiduals> residuals_by_source(
    const estimation::RecordingProblem& problem,
    const std::vector<estimation::CheckedMeasurement>& checked) {
  std::vector<SourceResiduals> result;
  for (const estimation::CheckedMeasurement& one : checked) {
    const estimation::Measurement& measured = problem.measurements[idx(one.measurement)];
    for (Eigen::Index row = 0; row < measured.rows; ++row) {
      if (!std::isfinite(one.minimal_detectable[row])) continue;
      const std::string_view source = measured.kind->noise(row);
      auto at = std::find_if(result.begin(), result.end(), [source](const SourceResiduals& other) {
        return other.source == source;
      });
      if (at == result.end()) at = result.insert(result.end(), {std::string(source), {}});
      at->standardised.push_back(one.standardised[row]);
    }
  }
  for (SourceResiduals& one : result) {
    std::sort(one.standardised.begin(), one.standardised.end());
  }
  return result;
}

}  // namespace trussmap::criticism
