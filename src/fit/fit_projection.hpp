// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a fit leaves of its measurements' noise: r = P e (but for the sign, which is nobody's).
//
//   P = 1 - J A^-1 J' - Q Q'     J   whitened rows by landmarks and poses, A = J'J
//                                Q   orthonormal columns of the coefficients fitted, less their
//                                    projection on J, and of nuisance columns
//
// A measurement's own block P_kk costs no solve (estimation/fitted_rows.hpp).
#pragma once

#include "estimation/fitted_rows.hpp"
#include "fit/fit_state.hpp"

#include <memory>
#include <vector>

namespace trussmap::fitting {

class FitProjection {
 public:
  /// `problem` has the fit's measurements, perhaps with other weights; `system` is factorised.
  /// `nuisance`: columns that are already free of J. `fitted`: the system's, where they are there
  /// already. Keeps references to problem and system.
  FitProjection(const FitState& fit, const estimation::RecordingProblem& problem,
                const estimation::RecordingSystem& system, const Eigen::MatrixXd& nuisance,
                std::shared_ptr<const estimation::FittedRows> fitted = nullptr);

  /// P times the columns, some at a time.
  [[nodiscard]] Eigen::MatrixXd times(Eigen::MatrixXd columns) const;
  /// P_kk, rows x rows of the measurement; the unit matrix where it is left out.
  [[nodiscard]] Eigen::MatrixXd own_block(std::size_t measurement) const;
  /// A sighting's whitened rows by the landmark, rows x 2; zero where it is left out.
  [[nodiscard]] Eigen::MatrixXd rows_by_landmark(std::size_t measurement) const {
    return system_.rows_by_to(measurement).leftCols<2>();
  }
  [[nodiscard]] const Eigen::MatrixXd& set_aside() const { return Q_; }
  [[nodiscard]] bool left_out(std::size_t measurement) const { return left_out_[measurement]; }

 private:
  const estimation::RecordingProblem& problem_;
  const estimation::RecordingSystem& system_;
  std::shared_ptr<const estimation::FittedRows> fitted_;
  std::vector<bool> left_out_;
  Eigen::MatrixXd Q_;
};

/// Columns count as one that differ by no more than this share of the largest pivot.
inline constexpr double kSameDirection = 1e-10;

}  // namespace trussmap::fitting
