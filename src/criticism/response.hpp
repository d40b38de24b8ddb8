// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A channel's error along a variable, bin by bin, as the residuals of a fit have it: the picture
// that shows an effect, with the curve that a formula draws through it.
//
//   g  |      +     +          +   estimate of a bin with its standard error
//      |   +  ~~~~~~~~  +      ~   the effect's own curve
//      |~~~              ~~~
//      +-------------------->  variable
//
// Every bin is an effect of its own, channel x (1 in the bin, else 0), and all are estimated
// together, as a score test would (score_test.hpp): what poses and landmarks have absorbed of the
// error is given back. Combinations of bins of which the data tell next to nothing (all alike, say,
// for a compass with nothing to check its zero) are taken as 0. Standard errors are for the
// dispersion that the bins leave: small where they explain all there is, large where they do not.
//
// A rival is drawn by its own curve, or, where it acts on another channel, by what the same bins
// would show if it were the truth: where that meets the estimates, these data do not tell the two
// apart.
#pragma once

#include "criticism/score_test.hpp"

#include <string>
#include <vector>

namespace trussmap {

struct ResponseBin {
  double at = 0.0;   ///< mean of the variable over the rows in the bin
  double low = 0.0;  ///< the bin
  double high = 0.0;
  double estimate = 0.0;  ///< of g, in the channel's unit
  double sd = 0.0;
};

struct Response {
  Channel channel = Channel::travel;
  std::string unit;      ///< of g; "" = none
  std::string variable;  ///< heading (0 to 2 pi), speed, payload_kg ...
  std::vector<ResponseBin> bins;
  std::vector<Vector2> curve;  ///< (variable, g) of the effect; empty where it is no curve
  /// Of each rival asked of, with its coefficients: (variable, g).
  std::vector<std::vector<Vector2>> rivals;
};

/// The variable that stands for the distance from an effect's place, m.
inline constexpr const char* kPlace = "place";

/// The variable that shows an effect best: the one that its shapes name; for a constant, turn rate
/// or speed, whichever the channel acts with. Empty for a place.
[[nodiscard]] std::string natural_variable(const Effect& effect);

/// The effect's channel along a variable (kPlace: from its place), and the curve of its
/// coefficients, if it has any. What is taken out of the tests is not in the picture.
[[nodiscard]] Response response_along(const std::string& variable, const Effect& effect,
                                      const ModelFit& fit, const ScoreTest& tests,
                                      const std::vector<Effect>& rivals = {});

/// Least and largest g of an effect over all rows in which the robot moves.
struct EffectRange {
  double least = 0.0;
  double most = 0.0;
};
[[nodiscard]] EffectRange range_of(const Effect& effect, const ShapeContext& context);

/// g of an effect at values of one variable: empty where it needs others.
[[nodiscard]] std::vector<Vector2> effect_curve(const Effect& effect, const std::string& variable,
                                                double low, double high);

}  // namespace trussmap
