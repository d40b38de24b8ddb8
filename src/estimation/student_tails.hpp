// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Heavy tails: errors of a sighting that have Student's t distribution.
//
//   e     error of n values, d^2 = e' C^-1 e, C its covariance
//   nu    degrees of freedom, above 2
//   psi   = (nu + n)/(nu - 2 + d^2) C^-1 e      the score, bounded: far errors pull less, not more
//   F     = nu (nu + n)/((nu - 2)(nu + n + 2)) C^-1      its covariance, the information
//
// (Lange, Little & Taylor, "Robust statistical modeling using the t distribution", 1989.) At the
// fit the error counts as F^-1 psi, with the covariance F^-1: an error as if normal, of the same
// score and information. So estimates, standard errors, score tests and chi^2 are those of the t
// distribution though all that reckons with them takes errors as normal. With it the fit moves, and
// is done again until it stays.
//
// Of white noise in sightings alone (white processes with `tails`). The rows of a drive are summed
// between sightings, which makes them normal; noise that lasts is taken as normal, too.
#pragma once

#include "estimation/effect_parameters.hpp"
#include "estimation/recording_problem.hpp"

namespace trussmap::estimation {

/// Whether tails of such a process are used.
[[nodiscard]] bool has_used_tails(const NoiseProcess& process);

/// F in units of C^-1; 1 for 0 degrees of freedom, which is the normal distribution.
[[nodiscard]] double tail_information(double tails, int rows);

/// -2 log density but for its constant, of squared whitened error d^2; d^2 itself if normal.
[[nodiscard]] double tail_deviance(double tails, int rows, double squared_error);

/// Takes sightings' tails at the errors that the state leaves: changes their value_offset.
/// Returns the largest change, in standard deviations.
double take_tails(RecordingProblem& problem, const EffectParameters& border,
                  const Eigen::VectorXd& offsets, const RecordingState& state);

}  // namespace trussmap::estimation
