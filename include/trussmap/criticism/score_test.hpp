// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Is an effect missing? Asked of a fit that does not have it, without fitting anew.
//
//   r    whitened residuals of the fit          J   its whitened rows, poses and landmarks
//   M    columns of the candidate               M_  = M less its projections on J and on the
//                                                     columns of the effects that the model has
//   g = M_' r,  S = M_' M_,  P = phi (plausible size)^-2 (a weak prior on each coefficient)
//   score = g' (S + P)^-1 g: the chi^2 that adding the effect would take away;  chi^2(dof) if the
//           effect is absent
//   estimate = -(S + P)^-1 g,  sd^2 = diag (S + P)^-1
//   smallest detectable = sqrt(24.4 / S_kk): 90 % power at p = 0.05/200
//
// phi = max(1, chi^2/dof): under a large misfit a smaller map has smaller residuals, and without
// phi the pure scale would take credit for that (design of score tests: Rao 1948).
//
// The virtual work of the locked-in forces on the effect's strain pattern, in the truss's terms.
// One factorisation serves all candidates.
#pragma once

#include "trussmap/adjustment/recording_system.hpp"
#include "trussmap/criticism/model_fit.hpp"

#include <memory>
#include <vector>

namespace trussmap {

inline constexpr double kDetectableScore = 24.4;

struct Score {
  double score = 0.0;
  int dof = 0;  ///< shapes that can be seen at all
  double p_value = 1.0;
  std::vector<double> coefficients;         ///< 0 where unseen
  std::vector<double> sd;                   ///< infinite where unseen
  std::vector<double> smallest_detectable;  ///< of each shape alone; infinite where unseen
  Eigen::MatrixXd projected;                ///< M_, rows x shapes; zero columns where unseen
};

class ScoreTest {
 public:
  /// Keeps a reference to the fit.
  explicit ScoreTest(const ModelFit& fit);

  /// Columns of one effect (resolved), its coefficients at 0. Throws std::invalid_argument like
  /// effect_columns.
  [[nodiscard]] EffectColumns columns(const Effect& effect) const;

  /// Tests several candidates at once, which shares their cost. Each is a set of columns.
  [[nodiscard]] std::vector<Score> test(const std::vector<Effect>& candidates) const;

  /// The chi^2 that adding all of these together would take away, without priors.
  [[nodiscard]] double joint_score(const std::vector<Effect>& effects) const;

  /// M less its projections on J and on the columns of the effects that the model has.
  [[nodiscard]] Eigen::MatrixXd projected(const Eigen::MatrixXd& M) const;

  [[nodiscard]] double dispersion() const { return dispersion_; }  ///< phi
  [[nodiscard]] const Eigen::VectorXd& residuals() const { return system_->residuals(); }
  [[nodiscard]] const RecordingSystem& system() const { return *system_; }
  /// Orthonormal columns that those effects span, projected.
  [[nodiscard]] const Eigen::MatrixXd& present() const { return present_; }
  [[nodiscard]] const ShapeContext& context() const { return context_; }

 private:
  [[nodiscard]] Score score_of(const EffectColumns& columns, const Effect& effect,
                               const Eigen::MatrixXd& whole,
                               const Eigen::MatrixXd& projected) const;

  const ModelFit& fit_;
  ShapeContext context_;
  std::unique_ptr<RecordingSystem> system_;
  Eigen::MatrixXd present_;  ///< orthonormal columns that the model's effects span, projected
  double dispersion_ = 1.0;
};

}  // namespace trussmap
