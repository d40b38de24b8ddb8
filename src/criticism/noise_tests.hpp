// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Is there more noise than the model states, and by what law does it grow?
//
//   r     whitened residuals of the fit, -P e: e whitened noise, P = 1 - the hat matrix of all
//         unknowns, the model's effects among them
//   V     what a law adds to the covariance of e per unit of its variance l: e ~ N(0, 1 + l V);
//         block-diagonal, a block per measurement (a segment's rows carry it as segment_noise.hpp
//         says)
//
//   q = r' V r,   E q = tr(P V),   Var q = 2 tr(P V P V)   where the law adds nothing
//
// The test of l = 0 against l > 0 that is best for small l. Its p-value is that of the chi^2-like
// law with the same mean, variance and skewness (Pearson 1959). tr(P V) is exact, the other two
// traces are means over 48 random vectors of signs, good to some 2 %.
//
// Laws are set against each other by their restricted likelihood, which gives l too:
//
//   -2 log R(l) = log|S| + log|X' S^-1 X| + least chi^2,   S = 1 + l V,   X all unknowns
//
//   score   fall of -2 log R from l = 0 to its best; while p >= 0.01, z^2 = (q - Eq)^2/Var q,
//           which is the same for small l
//
// It is on the scale of ScoreTest's scores: noise that only stands in for a missing effect gains
// less than the effect takes away (x - log(1 + x) < x), so the larger of the two has the better
// claim; `nuisance` asks what noise there is besides.
//
// "heavy tails" and "autocorrelation" are shapes of noise rather than amounts. They are asked of
// the fit under the best law, and their score is z^2: fourth powers of what each measurement misses
// by (few large errors instead of many small); products of successive drives' whitened errors.
//
// Order: by score, from which seconds give up 1, the readings' own noise 2, a single wheel 3, and
// radians turned and other variants 6: of laws that explain as much the plainer is first.
//
// What cannot be told apart: laws whose amounts are in proportion, such as metres and seconds at
// one speed without rests, metres and starts on legs of one length, spins and radians turned by
// turns of one size; starts and the standing there, where both are a few millimetres. On 56 legs
// of 2 to 5 m at 0.25 to 0.9 m/s, a typical one with twice its spread, the right law of four is
// first in some 90 (metres, seconds, starts) to 100 (spins) of 100. Noise below what the model
// states is no law's excess and goes unseen.
#pragma once

#include "criticism/score_test.hpp"
#include "trussmap/diagnose.hpp"

#include <vector>

namespace trussmap::criticism {

/// All laws that the recordings could show, best explanation first. `nuisance`: projected columns
/// (of Score or EventTest) of what else may be missing, which is left out of the question. Costs
/// some hundred solves, and some 4 factorisations for each law of which p < 0.01.
[[nodiscard]] std::vector<NoiseTest> test_noise_laws(const fitting::FitState& fit,
                                                     const ScoreTest& tests,
                                                     const Eigen::MatrixXd& nuisance = {});

/// The same fit, its measurements as noisy as one of these laws has them besides. Throws
/// std::invalid_argument on a shape of noise.
[[nodiscard]] fitting::FitState with_noise(const fitting::FitState& fit, const ScoreTest& tests,
                                           const NoiseTest& law);

}  // namespace trussmap::criticism
