// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Is an effect missing? Asked of a fit that does not have it, without fitting anew.
//
//   r    whitened residuals of the fit          J   its whitened rows, poses and landmarks
//   M    columns of the candidate               M_  = M less its projections on J and on the
//                                                     columns of the effects that the model has
//   g = M_' r,  S = M_' M_,  P = phi (prior sd)^-2, a weak prior on each coefficient
//   score = g' (S + P)^-1 g: the chi^2 that adding the effect would take away;  chi^2(dof) if the
//           effect is absent
//   estimate = -(S + P)^-1 g,  sd^2 = diag (S + P)^-1
//   minimal detectable = sqrt(24.4 / S_kk): 90 % power at p = 0.05/200
//
// phi = max(1, chi^2/dof): under a large misfit a smaller map has smaller residuals, and without
// phi the pure scale would take credit for that (design of score tests: Rao 1948).
//
// J and M are taken at a state without noise of its own (noise_free.hpp): what cannot be seen at
// all then has no projection at all.
//
// The virtual work of the locked-in forces on the effect's strain pattern, in the truss's terms.
// One factorisation serves all candidates.
#pragma once

#include "estimation/fitted_rows.hpp"
#include "estimation/recording_system.hpp"
#include "fit/column_builder.hpp"
#include "fit/fit_state.hpp"
#include "fit/noise_free.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace trussmap::criticism {

inline constexpr double kDetectableScore = 24.4;

struct Score {
  double score = 0.0;
  int dof = 0;  ///< shapes that can be seen at all
  double p_value = 1.0;
  std::vector<double> coefficients;        ///< 0 where unseen
  std::vector<double> sd;                  ///< infinite where unseen
  std::vector<double> minimal_detectable;  ///< of each shape alone; infinite where unseen
  std::vector<double> largest;             ///< |f| of each shape
  std::vector<double> share;               ///< |M_|^2/|M|^2 of each shape
  std::vector<double> information;         ///< |M_|^2 of each shape
  Eigen::MatrixXd columns;                 ///< M, rows x shapes
  Eigen::MatrixXd projected;               ///< M_, rows x shapes; zero columns where unseen
  /// What one unit of each moves the landmarks by, two rows each, m; then orientations, rad.
  Eigen::MatrixXd landmarks;
};

/// Every row by itself; or a second of driving at a time, a tenth of the work, enough to find the
/// best of many places or thresholds; or quick, and exact for what shows something (p < 0.05) or
/// goes with events and accelerations, which a second's middle says nothing about.
enum class Resolution { exact, quick, screening };

/// What many sparse columns say at once: M_'M_ and M_'r.
struct ScoreInformation {
  Eigen::MatrixXd G;
  Eigen::VectorXd s;
};

class ScoreTest {
 public:
  /// Keeps a reference to the fit. A copy shares all but what it is conditioned on.
  explicit ScoreTest(const fitting::FitState& fit);

  /// The same of the model without some of its effects, from `first` on, to first order about this
  /// very fit: what they do there is put back into the residuals, and nothing of them is present. A
  /// fit without them would be elsewhere, as far off as they are large. They have coefficients.
  [[nodiscard]] ScoreTest lacking(std::size_t first, const std::vector<Effect>& fitted) const;

  /// Tests several candidates at once (their coefficients at 0). Throws
  /// std::invalid_argument like effect_columns.
  [[nodiscard]] std::vector<Score> test(const std::vector<Effect>& candidates,
                                        Resolution resolution = Resolution::exact) const;

  /// Columns that are worked on at once: whoever asks for about as many at a time keeps no more.
  [[nodiscard]] Eigen::Index batch() const;

  /// The chi^2 that adding all of these jointly would take away, without priors.
  [[nodiscard]] double joint_score(const std::vector<Effect>& effects) const;

  /// Whitened columns of an effect, M.
  [[nodiscard]] Eigen::MatrixXd columns(const Effect& effect) const {
    return builders_->exact.columns(effect);
  }
  /// M less what landmarks and poses absorb of it (its projection on J).
  [[nodiscard]] Eigen::MatrixXd free_of_map(const Eigen::MatrixXd& M) const;
  /// M less its projections on J and on what is present.
  [[nodiscard]] Eigen::MatrixXd projected(const Eigen::MatrixXd& M) const;

  /// A channel's whitened column cut in pieces, as ColumnBuilder::cut_column.
  [[nodiscard]] linalg::SparseMatrix cut_column(
      Channel channel, const std::vector<std::vector<fitting::RowShares>>& shares,
      int count) const {
    return builders_->exact.cut_column(channel, shares, count);
  }
  /// Of whitened columns, without ever holding M_: its cost is a solution of the map's system for
  /// each.
  [[nodiscard]] ScoreInformation information(const linalg::SparseMatrix& M) const;

  /// Whether the effect would be seen but for what is present: the model has it, or its like.
  [[nodiscard]] bool is_present(const Effect& effect) const;

  /// Takes further whitened columns as present from now on: what they explain is no longer there
  /// to be explained.
  void condition_on(const Eigen::MatrixXd& columns);

  /// What was kept to make further columns fast is dropped, until it is asked for again.
  void forget() const;

  [[nodiscard]] double dispersion() const { return dispersion_; }  ///< phi
  /// Of the fit, less what the columns that it is conditioned on explain.
  [[nodiscard]] const Eigen::VectorXd& residuals() const { return residuals_; }
  /// Orthonormal columns that the model's effects, and what it is conditioned on, span.
  [[nodiscard]] const Eigen::MatrixXd& present() const { return present_; }
  /// At the fit itself, noise and all.
  [[nodiscard]] const estimation::RecordingSystem& system() const { return *system_; }
  /// What that fit knows of its rows.
  [[nodiscard]] std::shared_ptr<const estimation::FittedRows> fitted_rows() const;
  [[nodiscard]] const fitting::ShapeContext& context() const { return clean_->context; }

 private:
  [[nodiscard]] std::vector<Score> test_with(fitting::ColumnBuilder& builder,
                                             const std::vector<Effect>& candidates) const;
  [[nodiscard]] Score score_of(const Effect& effect, const std::vector<double>& largest,
                               Eigen::MatrixXd columns, Eigen::MatrixXd projected) const;

  /// Rows of the landmarks, zero where held, then of orientations, among those of all nodes.
  [[nodiscard]] Eigen::MatrixXd landmark_rows(const Eigen::MatrixXd& nodes) const;

  const fitting::FitState& fit_;
  std::shared_ptr<fitting::NoiseFree> clean_;  ///< but for the rows of its problem
  std::shared_ptr<estimation::RecordingSystem> system_;
  mutable std::shared_ptr<const estimation::FittedRows> fitted_;  ///< made when first asked for
  std::shared_ptr<estimation::RecordingSystem> clean_system_;
  struct Builders {
    fitting::ColumnBuilder exact;
    std::optional<fitting::ColumnBuilder> quick;  ///< made when first asked for
  };
  std::shared_ptr<Builders> builders_;
  Eigen::MatrixXd present_;  ///< orthonormal: what the model's effects span, projected
  Eigen::VectorXd residuals_;
  double dispersion_ = 1.0;
};

}  // namespace trussmap::criticism
