// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Downhill from one start: Gauss-Newton steps, damped (Levenberg-Marquardt) where a step does not
// pay, so that chi^2 never rises.
//
//   H d = -g          undamped, as long as that lowers chi^2
//   (H + m D) d = -g  D the diagonal of H; m falls by ten where chi^2 falls as the quadratic model
//                     predicts (by half of it at least), and rises by ten where it does not
//
// Nielsen, "Damping parameter in Marquardt's method" (1999) discusses such rules. Two more are for
// trusses: turning a stiff part by a finite angle strains it, to second order in the angle, so
// where a step pays badly, the positions that suit its headings best are found first. And a step
// that promises next to nothing and gains nothing is the bottom, to rounding.
//
// A problem offers
//
//   State, Step
//   double linearise(state, hold_headings)   chi^2, and H and g there, of positions alone or of all
//   Step solve_step(damping)     throws NotPositiveDefinite where H + m D is not; its `predicted`
//   is
//                                what the quadratic model says that it takes off chi^2
//   State moved(state, step)
//   State placed(state, step)    the same of a step with headings held: of nothing but positions
//   bool rounding(state, step)   the step is nothing but rounding
#pragma once

#include "linalg/sparse_cholesky.hpp"
#include "trussmap/running.hpp"

#include <algorithm>
#include <concepts>
#include <utility>

namespace trussmap::linalg {

template <typename Problem>
concept LeastSquaresProblem = requires(Problem& problem, const typename Problem::State& state,
                                       const typename Problem::Step& step, double damping) {
  { problem.linearise(state, true) } -> std::same_as<double>;
  { problem.solve_step(damping) } -> std::same_as<typename Problem::Step>;
  { step.predicted } -> std::convertible_to<double>;
  { problem.moved(state, step) } -> std::same_as<typename Problem::State>;
  { problem.placed(state, step) } -> std::same_as<typename Problem::State>;
  { problem.rounding(state, step) } -> std::same_as<bool>;
};

struct DescentOptions {
  int max_iterations = 200;
  double tolerance = 1e-13;  ///< relative decrease of chi^2 that a next step may still promise
  double negligible = 0.0;   ///< of chi^2, where it is all but zero
};

template <typename State>
struct DescentResult {
  State state;
  double chi2 = 0.0;
  int iterations = 0;  ///< steps taken
  bool converged = false;
};

/// The step for the first damping from `damping` on with which the system can be solved.
template <LeastSquaresProblem Problem>
typename Problem::Step solve_damped(Problem& problem, double& damping);

/// The best positions for the state's headings. The problem is left linearised elsewhere.
template <LeastSquaresProblem Problem>
typename Problem::State relaxed(Problem& problem, const typename Problem::State& state);

/// The problem is left linearised at the result.
template <LeastSquaresProblem Problem>
DescentResult<typename Problem::State> levenberg_marquardt(Problem& problem,
                                                           typename Problem::State start,
                                                           const DescentOptions& options);

namespace damping_rule {

inline constexpr double kFirst = 1e-4;
inline constexpr double kLeast = 1e-9;
inline constexpr double kMost = 1e12;
inline constexpr double kGood = 0.5;     // of the predicted decrease
inline constexpr double kPoor = 0.25;    // of the predicted decrease
inline constexpr double kBottom = 1e-9;  // of chi^2, predicted where nothing is gained

inline double raised(double damping) {
  return std::max(kFirst, 10.0 * damping);
}
inline double lowered(double damping) {
  return damping > 10.0 * kLeast ? damping / 10.0 : 0.0;
}

}  // namespace damping_rule

template <LeastSquaresProblem Problem>
typename Problem::Step solve_damped(Problem& problem, double& damping) {
  for (;;) {
    try {
      return problem.solve_step(damping);
    } catch (const NotPositiveDefinite&) {
      if (damping >= damping_rule::kMost) throw;
      damping = damping_rule::raised(damping);
    }
  }
}

template <LeastSquaresProblem Problem>
typename Problem::State relaxed(Problem& problem, const typename Problem::State& state) {
  problem.linearise(state, true);
  double damping = 0.0;
  return problem.placed(state, solve_damped(problem, damping));
}

template <LeastSquaresProblem Problem>
DescentResult<typename Problem::State> levenberg_marquardt(Problem& problem,
                                                           typename Problem::State start,
                                                           const DescentOptions& options) {
  using namespace damping_rule;
  DescentResult<typename Problem::State> result{std::move(start)};
  result.chi2 = problem.linearise(result.state, false);
  double damping = 0.0;
  while (!result.converged && result.iterations < options.max_iterations) {
    stop_if_asked();
    const typename Problem::Step step = solve_damped(problem, damping);
    const double predicted = step.predicted;
    const bool rounding = problem.rounding(result.state, step);
    if (rounding && damping == 0.0) {
      result.converged = true;
      break;
    }
    bool last = damping == 0.0 && predicted <= options.tolerance * result.chi2 + options.negligible;
    typename Problem::State next = problem.moved(result.state, step);
    double chi2 = problem.linearise(next, false);
    if (!last && result.chi2 - chi2 < kPoor * predicted) {
      next = relaxed(problem, next);
      chi2 = problem.linearise(next, false);
    }
    const double decrease = result.chi2 - chi2;
    if (decrease >= 0.0) {
      result.state = std::move(next);
      result.chi2 = chi2;
      ++result.iterations;
      if (decrease > kGood * predicted) {
        damping = lowered(damping);
      } else if (decrease < kPoor * predicted) {
        damping = raised(damping);
      }
    } else {
      problem.linearise(result.state, false);
      last = last || rounding || predicted <= kBottom * result.chi2 + options.negligible;
      if (damping >= kMost) {
        break;
      }
      damping = raised(damping);
    }
    result.converged = last;
  }
  return result;
}

}  // namespace trussmap::linalg
