// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Responses (trussmap/evidence.hpp): a channel's error along a variable, bin by bin.
//
// Every bin is an effect of its own, channel x (1 in the bin, else 0), and all are estimated
// jointly, as a score test would (score_test.hpp): what poses and landmarks have absorbed of the
// error is given back. Combinations of bins of which the data tell next to nothing (all alike, say,
// for a compass with nothing to check its zero) are taken as 0. Standard errors are for the
// dispersion that the bins leave: small where they explain all there is, large where they do not.
//
// A rival is drawn by its own curve, or, where it acts on another channel, by what the same bins
// would show if it were the truth: where that meets the estimates, these data do not tell the two
// apart.
#pragma once

#include "criticism/score_test.hpp"
#include "trussmap/evidence.hpp"

#include <map>
#include <string>
#include <vector>

namespace trussmap::criticism {

/// The variable that shows an effect best: the one that its shapes name; for a constant, turn rate
/// or speed, whichever the channel acts with. Empty for a place.
[[nodiscard]] std::string natural_variable(const Effect& effect);

/// The effect's channel along a variable (kPlace: from its place), and the curve of its
/// coefficients, if it has any. What the tests are conditioned on is not in the picture. `rows`: of
/// each row of the fit's system 1 where bins are to show it, else 0; empty: all.
[[nodiscard]] Response response_along(const std::string& variable, const Effect& effect,
                                      const fitting::FitState& fit, const ScoreTest& tests,
                                      const std::vector<Effect>& rivals = {},
                                      const Eigen::VectorXd& rows = {});

/// Least and largest g of an effect over all rows in which the robot moves.
[[nodiscard]] EffectRange range_of(const Effect& effect, const fitting::ShapeContext& context);

/// The same for many effects, each shape evaluated once.
class ShapeRanges {
 public:
  /// Keeps a reference.
  explicit ShapeRanges(const fitting::ShapeContext& context) : context_(context) {}
  [[nodiscard]] EffectRange of(const Effect& effect);

 private:
  using Values = std::vector<std::vector<double>>;  ///< per session and row
  const Values& values(const Shape& shape);

  const fitting::ShapeContext& context_;
  std::map<Shape, Values> values_;
};

/// g of an effect at values of one variable: empty where it needs others.
[[nodiscard]] std::vector<Vector2> effect_curve(const Effect& effect, const std::string& variable,
                                                double low, double high);

}  // namespace trussmap::criticism
