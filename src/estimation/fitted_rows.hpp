// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a fit knows of the whitened rows of each measurement, without a solve:
//
//   J    its rows by landmarks and poses        Z = A^-1, of which only neighbours are looked up
//   M    its rows by the coefficients           N   the inverse of the whole normal matrix
//
//   by nodes  J Z J'
//   all       J Z J' + F S^-1 F',  F = M - J A^-1 B:   [J M] N [J M]'
//
// The nodes of a measurement are neighbours in A, whose inverse is known there once it has been
// taken down the fronts (linalg/frontal_cholesky.hpp): one pass serves all measurements.
#pragma once

#include "estimation/recording_system.hpp"

#include <cstddef>

namespace trussmap::estimation {

class FittedRows {
 public:
  /// `fit` is factorised. Keeps a reference to it.
  explicit FittedRows(const RecordingSystem& fit);

  /// rows x rows. `rows`: a system of the same problem that has the measurement's rows, the fit
  /// itself or one with other weights.
  [[nodiscard]] Eigen::MatrixXd by_nodes(const RecordingSystem& rows,
                                         std::size_t measurement) const;
  [[nodiscard]] Eigen::MatrixXd covariance(const RecordingSystem& rows,
                                           std::size_t measurement) const;

 private:
  const RecordingSystem& fit_;
  linalg::FrontalInverse inverse_;
  Eigen::MatrixXd coefficient_covariance_;
};

}  // namespace trussmap::estimation
