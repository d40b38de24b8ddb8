// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The stages of a fit (fit_state.hpp), on what they are passed.
//
//   lay_out_recordings   as delays and steering have them, and the problem that they make
//   start_fit            a first state, and the path by it
//   take_columns         the effects along that path, coefficients held or free
//   adjust_once          the best state and coefficients by them; path and rows as these have it
//   fit_from             all of it, from one start
//   hold_one             a coefficient that the data tell nothing of, or too little
#pragma once

#include "fit/fit_state.hpp"

namespace trussmap::fitting {

/// What is asked.
struct FitTask {
  const std::vector<DrivenRecording>& raw;
  std::vector<DrivenRecording> recorded;  ///< with the gyro taken in, where there is one
  Model model;                            ///< common errors in it, and the coefficients at first
  const FitterOptions& options;
};

/// A fit on its way: it is at `fit.adjustment.state`.
struct Fitting {
  FitState fit;
  std::vector<Effect>
      laid_out;  ///< with the coefficients by which delays and steering are laid out
  /// Per effect and place; nothing where fitted.
  std::vector<std::vector<std::optional<UnfittedCoefficient>>> not_fitted;
  int round = 0;
  /// Of the fit without the effects that are sought, what the gate left out counted.
  std::optional<double> chi2_without = std::nullopt;

  /// Whether it is one of the common errors, which have a prior and so are always determined.
  [[nodiscard]] bool is_common(std::size_t effect) const {
    return effect + fit.common_errors >= fit.model.effects.size();
  }
  /// Common errors alone need no path: their columns follow from the record.
  [[nodiscard]] bool only_common() const {
    return fit.common_errors > 0 && fit.common_errors == fit.model.effects.size();
  }
  [[nodiscard]] bool columns_see_paths() const {
    return !fit.model.effects.empty() && !only_common();
  }
};

/// The most that an adjustment changed.
struct FitChange {
  double coefficients = 0.0;  ///< in what is negligible
  double path = 0.0;          ///< m and rad
  double offsets = 0.0;       ///< of the linearisation, in sds
};

/// From the model's coefficients; fit_recordings is that, and from others where it is lost.
[[nodiscard]] Fitting fit_from(const std::vector<DrivenRecording>& recordings, const Model& model,
                               const FitterOptions& options);
/// chi^2, each measurement that the gate left out counted as if it just passed.
[[nodiscard]] double chi2_of_all(const estimation::RecordingAdjustment& adjustment,
                                 const FitterOptions& options);

/// Errors far beyond any noise: perhaps the fit is lost.
[[nodiscard]] bool is_gross_misfit(const FitState& fit);

void lay_out_recordings(const FitTask& task, Fitting& now);
/// Since delays and steering were laid out, by more than their columns can stand for.
[[nodiscard]] bool layout_moved(const Fitting& now);
/// The poses of the new instants lie on the old path.
void lay_out_again(const FitTask& task, Fitting& now);
/// With these landmarks, every pose on the fit's path.
[[nodiscard]] estimation::RecordingState placed(const FitState& fit,
                                                const std::map<std::string, Vector2>& landmarks);

/// A step of steering coefficients, from those of `from` on, shortened until it leaves the measured
/// wheel a way ahead in every row.
void shorten_steering(const FitTask& task, const std::vector<Effect>& from, FitState& fit);

void start_fit(const FitTask& task, Fitting& now);
/// From other starts where the first is lost. Throws SolveError where none leads anywhere.
[[nodiscard]] FitChange adjust_from_starts(const FitTask& task, Fitting& now);

void take_columns(const FitTask& task, Fitting& now);
/// As the model has them.
[[nodiscard]] Eigen::VectorXd unknown_values(const FitState& fit);
/// At the value that it had at first.
void hold_coefficient(const FitTask& task, int column, NotFitted why, double uncertainty,
                      Fitting& now);
/// False where there is none to hold.
[[nodiscard]] bool hold_one(const FitTask& task, Fitting& now);

/// What an adjustment `near` left out is only looked at again.
[[nodiscard]] FitChange adjust_once(const FitTask& task,
                                    const estimation::RecordingAdjustment* near, Fitting& now);

/// The coefficient of a column, as the model has it.
[[nodiscard]] inline double coefficient_at(const FitState& fit, std::size_t column) {
  const Coefficient& one = fit.columns.coefficients[column];
  return fit.model.effects[one.effect].coefficients[one.place];
}

/// Standard deviation of the k-th unknown one.
[[nodiscard]] double sd_of_unknown(const FitState& fit, std::size_t k);

[[nodiscard]] std::map<std::string, Vector2> places_in(const estimation::RecordingProblem& problem,
                                                       const estimation::RecordingState& state);

}  // namespace trussmap::fitting
