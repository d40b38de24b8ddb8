// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What one session says of the map and the effects' coefficients, its path gone.
//
//   u       what it shares with other sessions: landmarks (2 each), orientations (1 each), the
//           effects' unknown coefficients
//   p       what is its own: poses, states of noise that lasts
//   f(u, p) half of its chi^2, without priors, survey and all else that is no measurement of its
//
//   phi(u) = min over p of f(u, p)                                    what is left of the session
//          = phi(u0) + g'(u - u0) + (u - u0)'H (u - u0)/2 + ...       what is kept of it
//
//   g = f_u                              where p is the best for u0
//   H = f_uu - f_up f_pp^-1 f_pu         the Schur complement
//
// The second derivatives are whole, f's own (second_order.hpp): with those of Gauss and Newton
// alone g would be wrong by a residual's share of the move as soon as u moves, and sums of such
// quadratics would miss the fit of all sessions to first order. As it is they miss it to second.
//
// Where f_pp is not positive definite (residuals far too large) H is Gauss and Newton's; g is right
// even so.
//
// Cost: chains of poses are eliminated in the order of their number times that of the landmarks.
// Memory: the session's rows, and H.
//
// Errors with heavy tails count as student_tails.hpp took them when the rows were laid: half_chi2
// is then not that of their distribution.
#pragma once

#include "estimation/effect_parameters.hpp"
#include "estimation/recording_problem.hpp"
#include "estimation/recording_system.hpp"
#include "estimation/second_order.hpp"

#include <memory>
#include <utility>
#include <vector>

namespace trussmap::estimation {

/// A session's rows as a problem of its own (of one session, without survey), with its columns.
struct SessionRows {
  RecordingProblem problem;
  EffectParameters border;      ///< of one session; a coefficient each, the same for all sessions
  RecordingState state;         ///< near the best
  std::vector<double> weights;  ///< per measurement; empty: all 1
  bool tells_position = true;   ///< whether anything of it, or survey, measures one in the map
  bool tells_direction = true;  ///< likewise
};

/// Takes the survey out, which comes last among the measurements: who takes sessions together has
/// it.
void drop_survey(SessionRows& rows);

/// Gauss and Newton's are positive semidefinite, wherever they are taken; the whole ones where the
/// sum of all sessions has its minimum.
enum class SecondDerivatives { whole, gauss_newton };

class SessionSummary {
 public:
  /// Throws std::invalid_argument where the rows are not of one session alone.
  explicit SessionSummary(SessionRows rows);

  struct Quadratic {
    Eigen::VectorXd at;                                 ///< u0
    double half_chi2 = 0.0;                             ///< phi(u0)
    Eigen::VectorXd gradient;                           ///< g
    Eigen::MatrixXd information;                        ///< H; empty where it was not asked for
    SecondDerivatives kind = SecondDerivatives::whole;  ///< of H, as it was asked for
  };

  [[nodiscard]] const RecordingProblem& problem() const { return rows_->problem; }
  [[nodiscard]] int coefficients() const { return coefficients_; }
  /// Numbers in u.
  [[nodiscard]] int shared() const;
  /// Where they begin: landmarks, then orientations, then coefficients.
  [[nodiscard]] int first_orientation() const { return 2 * problem().landmark_count(); }
  [[nodiscard]] int first_coefficient() const { return shared() - coefficients_; }
  /// Poses and states of noise: unknowns of its own.
  [[nodiscard]] int own_unknowns() const;
  /// Measured values, those of weight 0 apart.
  [[nodiscard]] int measured_values() const;

  /// Where the summary was taken, with all that the next one goes on from.
  struct Taken {
    Quadratic quadratic;
    RecordingState state;  ///< with the best path
    /// Per measurement, of segments; shared, for hardly one summary in ten has new ones.
    std::shared_ptr<const std::vector<SegmentBends>> bends;
    Eigen::VectorXd bent_at;  ///< offsets of the coefficients there
  };

  /// Takes the summary at u. Throws SolveError where its path is not determined there, and is then
  /// as before.
  void linearise(const Eigen::VectorXd& u, SecondDerivatives kind = SecondDerivatives::whole);
  [[nodiscard]] const Taken& taken() const { return taken_; }
  /// Goes back to an earlier one of this session.
  void restore(Taken taken) { taken_ = std::move(taken); }
  /// The last one; empty before.
  [[nodiscard]] const Quadratic& quadratic() const { return taken_.quadratic; }
  /// phi and g at another u, exactly; the summary stays as it is.
  [[nodiscard]] Quadratic value_at(const Eigen::VectorXd& u);
  /// g as the summary has it there.
  [[nodiscard]] Eigen::VectorXd predicted_gradient(const Eigen::VectorXd& u) const {
    return quadratic().gradient + quadratic().information * (u - quadratic().at);
  }
  /// u of a state and coefficients.
  [[nodiscard]] Eigen::VectorXd shared_of(const RecordingState& state,
                                          const Eigen::VectorXd& coefficients) const;

 private:
  struct Coupled;
  struct Touched;
  [[nodiscard]] Touched touched_by(std::size_t k) const;
  [[nodiscard]] Eigen::MatrixXd numbers_by(std::size_t k, const Touched& touched) const;
  [[nodiscard]] Eigen::MatrixXd curvature_of(std::size_t k, const Touched& touched,
                                             RecordingState& state,
                                             const Eigen::VectorXd& offsets) const;
  void place(const Eigen::VectorXd& u, RecordingState& state) const;
  [[nodiscard]] Coupled couple(RecordingState& state, const Eigen::VectorXd& coefficients,
                               bool curved);
  void relax(RecordingState& state, const Eigen::VectorXd& coefficients, double still);
  void require_determined(const Eigen::VectorXd& u);
  void factorise();
  [[noreturn]] void refuse_loose() const;
  void bend(const Eigen::VectorXd& offsets);
  [[nodiscard]] Quadratic reduced(const Eigen::VectorXd& u, RecordingState& state,
                                  SecondDerivatives kind, bool with_information);

  std::unique_ptr<SessionRows> rows_;  ///< the system refers to them
  std::unique_ptr<RecordingSystem> system_;
  int coefficients_ = 0;
  Taken taken_;
};

}  // namespace trussmap::estimation
