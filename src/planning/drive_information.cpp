// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "planning/drive_information.hpp"

#include "estimation/recording_system.hpp"
#include "fit/column_builder.hpp"
#include "fit/noise_free.hpp"
#include "linalg/dense.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace trussmap::planning {
namespace {

constexpr double kLeastMode = 1e-10;  // of the scaled information: below it nothing is known

/// The border with all its coefficients held where the fit has them.
estimation::EffectParameters held_at(estimation::EffectParameters border,
                                     const Eigen::VectorXd& offsets) {
  for (std::size_t k = 0; k < border.size(); ++k) {
    border[k].held = border[k].reference + offsets[static_cast<Eigen::Index>(k)];
  }
  return border;
}

/// Rows by the map's unknowns, landmarks, then orientations. A survey's stand at its own node.
Eigen::MatrixXd map_columns(const estimation::RecordingProblem& problem,
                            const estimation::RecordingSystem& system, bool survey) {
  const Eigen::Index places = Eigen::Index{2} * problem.landmark_count();
  const auto orientations = static_cast<Eigen::Index>(problem.oriented.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(system.rows(), places + orientations);
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const estimation::Measurement& one = problem.measurements[k];
    const bool surveyed = one.session < 0;
    const int node = surveyed ? one.from : one.to;
    if (node < 0 || (surveyed && !survey)) continue;
    const Eigen::Index row = system.first_row(k);
    if (problem.is_landmark(node)) {
      const Eigen::Index at = Eigen::Index{2} * node;
      if (surveyed) {
        result.block(row, at, one.rows, 2) =
            system.root_weight(k) * one.whitener.topLeftCorner(one.rows, 2);
      } else {
        result.block(row, at, one.rows, 2) = system.rows_by_to(k).leftCols(2);
      }
    } else if (problem.is_orientation(node)) {
      const Eigen::Index at = places + node - problem.pose_end();
      if (surveyed) {
        result(row, at) = system.root_weight(k) * one.whitener(0, 0);
      } else {
        result.block(row, at, one.rows, 1) = system.rows_by_to(k).leftCols(1);
      }
    }
  }
  return result;
}

Eigen::MatrixXd effect_columns_of(fitting::ColumnBuilder& builder,
                                  const std::vector<Effect>& effects) {
  Eigen::MatrixXd all(builder.rows(), 0);
  if (effects.empty()) return all;
  for (const Eigen::MatrixXd& one : builder.columns(effects)) linalg::append_columns(all, one);
  return all;
}

}  // namespace

Eigen::MatrixXd without(const Eigen::MatrixXd& A, const std::vector<Eigen::Index>& gone) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < A.cols(); ++k) {
    if (std::find(gone.begin(), gone.end(), k) == gone.end()) kept.push_back(k);
  }
  Eigen::MatrixXd left = A(kept, kept);
  if (gone.empty()) return left;
  const Eigen::MatrixXd D = A(gone, gone);
  const Eigen::ArrayXd sd = D.diagonal().array().max(0.0).sqrt();
  const Eigen::VectorXd scale = (sd > 0.0).select(1.0 / sd, 0.0);
  const linalg::SymmetricModes modes =
      linalg::symmetric_modes(scale.asDiagonal() * D * scale.asDiagonal());
  const Eigen::MatrixXd across = scale.asDiagonal() * A(gone, kept);
  Eigen::MatrixXd shown = modes.eigenvectors.transpose() * across;
  for (Eigen::Index k = 0; k < shown.rows(); ++k) {
    const double mode = modes.eigenvalues[k];
    shown.row(k) *= mode > kLeastMode ? 1.0 / std::sqrt(mode) : 0.0;
  }
  left.noalias() -= shown.transpose() * shown;
  return left;
}

Eigen::Index DriveInformation::column_of(const std::string& landmark) const {
  const auto found = std::find(landmarks.begin(), landmarks.end(), landmark);
  return found == landmarks.end() ? -1 : 2 * static_cast<Eigen::Index>(found - landmarks.begin());
}

DriveInformation information_of(const fitting::FitState& fit, const InformationOf& what) {
  const Eigen::VectorXd offsets = fitting::offsets_of(fit);
  const fitting::NoiseFree clean(fit.recordings, fit.model, fit.problem, fit.columns.border,
                                 offsets, fit.adjustment.state);
  const estimation::EffectParameters held = held_at(clean.border, offsets);
  const std::vector<double> weights =
      estimation::weights_without(fit.adjustment.left_out, fit.problem.measurements.size());
  estimation::RecordingSystem system(clean.problem, held,
                                     estimation::RecordingGauge{.hold_map = true});
  system.set_weights(weights);
  static_cast<void>(system.linearise(clean.state, {}));
  try {
    system.normal_equations().factorise();
  } catch (const linalg::NotPositiveDefinite&) {
    throw SolveError(clean.problem.sessions.front() +
                     ": its path is not determined where the landmarks are known; sight more of "
                     "them");
  }
  fitting::ColumnBuilder builder(clean.context, clean.problem, clean.border, offsets, clean.state,
                                 weights);
  Eigen::MatrixXd F = map_columns(clean.problem, system, what.survey);
  linalg::append_columns(F, effect_columns_of(builder, what.own));
  const Eigen::Index own_end = F.cols();
  linalg::append_columns(F, effect_columns_of(builder, what.effects));
  F = system.free_of_nodes(std::move(F));
  DriveInformation result;
  result.landmarks = clean.problem.landmarks;
  std::vector<Eigen::Index> gone(static_cast<std::size_t>(own_end - result.first_column()));
  std::iota(gone.begin(), gone.end(), result.first_column());
  result.H = without(F.transpose() * F, gone);
  return result;
}

namespace {

/// Adds a drive's information to a sum that has all of its landmarks.
void add_to(DriveInformation& sum, const DriveInformation& one) {
  std::vector<Eigen::Index> at;
  for (const std::string& name : one.landmarks) {
    const Eigen::Index first = sum.column_of(name);
    at.push_back(first);
    at.push_back(first + 1);
  }
  for (Eigen::Index k = one.first_column(); k < one.H.cols(); ++k) {
    at.push_back(sum.first_column() + k - one.first_column());
  }
  sum.H(at, at) += one.H;
}

}  // namespace

DriveInformation sum_of(const DriveInformation& one, const DriveInformation& other) {
  DriveInformation sum{one.landmarks, {}};
  for (const std::string& name : other.landmarks) {
    const auto& names = one.landmarks;
    if (std::find(names.begin(), names.end(), name) == names.end()) sum.landmarks.push_back(name);
  }
  const Eigen::Index columns = one.H.cols() - one.first_column();
  sum.H = Eigen::MatrixXd::Zero(sum.first_column() + columns, sum.first_column() + columns);
  add_to(sum, one);
  add_to(sum, other);
  return sum;
}

DriveInformation reduced_to(const DriveInformation& whole,
                            const std::vector<std::string>& landmarks) {
  DriveInformation result;
  std::vector<Eigen::Index> gone;
  for (std::size_t k = 0; k < whole.landmarks.size(); ++k) {
    const std::string& name = whole.landmarks[k];
    if (std::find(landmarks.begin(), landmarks.end(), name) != landmarks.end()) {
      result.landmarks.push_back(name);
      continue;
    }
    gone.push_back(2 * static_cast<Eigen::Index>(k));
    gone.push_back(2 * static_cast<Eigen::Index>(k) + 1);
  }
  result.H = without(whole.H, gone);
  return result;
}

Eigen::MatrixXd gram_of(const DriveInformation& whole) {
  return reduced_to(whole, {}).H;
}

}  // namespace trussmap::planning
