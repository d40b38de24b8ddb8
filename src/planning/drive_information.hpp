// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What drives tell of the map and of effects' sizes, their paths gone.
//
//   L    whitened rows by the landmarks, two columns each     J   by the poses: the drive's own
//   M    whitened rows by the effects, a column per shape
//   H    = F'F,  F = [L M] less its projection on J
//
// Drives over the same landmarks add: H = H1 + H2. Once all are there the landmarks go, too, and
// what is left is the Gram matrix of the effects' columns, projected on all that is unknown beside
// them (score_test.hpp has it for recordings as they are):
//
//   G = H_MM - H_ML H_LL^+ H_LM
//
// with the pseudoinverse, for where nothing measures it the map may shift and turn. Rows are taken
// where they would be without noise (noise_free.hpp).
#pragma once

#include "fit/fit_state.hpp"
#include "trussmap/model.hpp"

#include <string>
#include <vector>

#include <Eigen/Core>

namespace trussmap::planning {

struct DriveInformation {
  std::vector<std::string> landmarks;
  Eigen::MatrixXd H;  ///< two per landmark, m; then one per shape of each effect

  [[nodiscard]] Eigen::Index first_column() const {
    return 2 * static_cast<Eigen::Index>(landmarks.size());
  }
  /// The first of a landmark's two; -1 where it is not there.
  [[nodiscard]] Eigen::Index column_of(const std::string& landmark) const;
};

struct InformationOf {
  std::vector<Effect> effects;  ///< of one size in all drives
  std::vector<Effect> own;      ///< of a size of its own in each: gone with the path
  bool survey = true;           ///< what the survey says counts
};

/// Throws SolveError where the landmarks do not determine the path, std::invalid_argument on a
/// shape that the recordings do not have.
[[nodiscard]] DriveInformation information_of(const fitting::FitState& fit,
                                              const InformationOf& what);

/// The first one's landmarks, then those that only the second has; their effects are the same.
[[nodiscard]] DriveInformation sum_of(const DriveInformation& one, const DriveInformation& other);

/// Without all landmarks but these, as far as it has them.
[[nodiscard]] DriveInformation reduced_to(const DriveInformation& whole,
                                          const std::vector<std::string>& landmarks);

/// G.
[[nodiscard]] Eigen::MatrixXd gram_of(const DriveInformation& whole);

/// A less what the unknowns `gone` explain of it, the others in their order.
[[nodiscard]] Eigen::MatrixXd without(const Eigen::MatrixXd& A,
                                      const std::vector<Eigen::Index>& gone);

}  // namespace trussmap::planning
