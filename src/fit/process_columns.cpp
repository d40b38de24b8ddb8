// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/process_columns.hpp"

#include "estimation/measurement_rows.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::fitting {
namespace {

/// W A, but for what was left out of the fit.
Eigen::MatrixXd by_states(const FitState& fit, const estimation::LaidProcess& laid,
                          Eigen::Index rows) {
  const estimation::RecordingProblem& problem = fit.problem;
  std::vector<bool> left_out(problem.measurements.size(), false);
  for (const int k : fit.adjustment.left_out) left_out[idx(k)] = true;
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(laid.states.size()));
  Eigen::Index at = 0;
  for (std::size_t k = 0; k < laid.terms.size(); ++k) {
    const estimation::Measurement& one = problem.measurements[k];
    if (!laid.terms[k].empty() && !left_out[k]) {
      const effects::ByView by_view = by_view_of(fit, problem, k);
      for (const estimation::NoiseTerm& term : laid.terms[k]) {
        const estimation::Vector4 column = one.whitener * estimation::error_by(one, by_view, term);
        columns.col(term.state).segment(at, one.rows) += column.head(one.rows);
      }
    }
    at += one.rows;
  }
  return columns;
}

/// Successive steps of a walk as one, `most` in all: as far as all of them went, in the same way.
Eigen::MatrixXd together(const Eigen::MatrixXd& steps, const estimation::LaidProcess& laid,
                         Eigen::Index most) {
  const Eigen::Index count = steps.cols();
  const Eigen::Index groups = std::min(count, most);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(steps.rows(), groups);
  Eigen::VectorXd variances = Eigen::VectorXd::Zero(groups);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double sd = laid.states[static_cast<std::size_t>(k)].sd;
    const Eigen::Index group = k * groups / count;
    result.col(group) += sd * steps.col(k);
    variances[group] += sd * sd;
  }
  for (Eigen::Index k = 0; k < groups; ++k) {
    if (variances[k] > 0.0) result.col(k) /= std::sqrt(variances[k]);
  }
  return result;
}

}  // namespace

effects::ByView by_view_of(const FitState& fit, const estimation::RecordingProblem& problem,
                           std::size_t measurement) {
  const estimation::Measurement& one = problem.measurements[measurement];
  if (estimation::is_driven(one)) return effects::ByView::Zero();
  return estimation::measurement_rows(problem, one, fit.adjustment.state, one.value,
                                      estimation::view_of(fit.columns.border, offsets_of(fit), one))
      .by_view;
}

std::optional<Eigen::MatrixXd> process_columns(const FitState& fit, const NoiseProcess& process,
                                               Eigen::Index rows, Eigen::Index most) {
  const estimation::ProcessLayer layer(fit.problem, fit.recordings, fit.model.robot);
  const estimation::LaidProcess laid =
      layer.lay(process.channel, process.process, std::max(process.length, kLeastProcessLength));
  const auto states = static_cast<Eigen::Index>(laid.states.size());
  if (states == 0 || (states > most && !estimation::is_walk(process.process))) return std::nullopt;
  Eigen::MatrixXd columns = by_states(fit, laid, rows);
  for (Eigen::Index k = states; k-- > 0;) {
    const estimation::NoiseState& state = laid.states[static_cast<std::size_t>(k)];
    if (state.previous >= 0) columns.col(state.previous) += state.keep * columns.col(k);
    columns.col(k) *= state.sd;
  }
  return states > most ? together(columns, laid, most) : columns;
}

}  // namespace trussmap::fitting
