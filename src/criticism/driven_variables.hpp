// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the drives of a fit hold: how variables spread, and where the robot was.
#pragma once

#include "fit/effect_columns.hpp"
#include "fit/fit_state.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace trussmap::criticism {

/// How a variable spreads over the rows of all sessions in which the robot moves.
struct Spread {
  std::string name;
  double least = 0.0;
  double most = 0.0;
  double mean = 0.0;
  std::vector<double> sorted;  ///< thinned
  std::size_t distinct = 0;    ///< up to 10

  [[nodiscard]] double quantile(double share) const {
    const double at = share * static_cast<double>(sorted.size() - 1);
    return sorted[static_cast<std::size_t>(std::lround(at))];
  }
  [[nodiscard]] bool two_sided() const { return least < 0.0 && most > 0.0; }
};

/// Of a variable that all sessions have.
[[nodiscard]] Spread spread_of(const std::string& name, const fitting::ShapeContext& context);

/// Covariates that all sessions have.
[[nodiscard]] std::vector<std::string> covariates_of(const fitting::ShapeContext& context);

/// Whether an effect is a matter of these variables alone; a constant is a matter of none.
[[nodiscard]] bool goes_with_only(const Effect& effect, const std::vector<std::string>& names);

struct Area {
  Vector2 low = Vector2(1e300, 1e300);
  Vector2 high = Vector2(-1e300, -1e300);
  double step = 0.0;             ///< m between centres tried
  std::vector<Vector2> centres;  ///< that the robot came near
};

[[nodiscard]] Area driven_area(const fitting::FitState& fit);

}  // namespace trussmap::criticism
