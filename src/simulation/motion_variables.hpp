// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The variables that shapes speak of, as a true motion has them. The names are those of
// drive/row_variables.hpp; how they are found is the simulator's own.
//
//   middle   at the middle of each row, for all that acts on the motion
//   instant  heading, x, y, t, distance at the end of each row, for readings taken then; the rest
//            as in the middle
//
// speed, turn_rate and acceleration are means over about a second (half of it to either side) of
// resting, spinning or driving without a break. Estimators have them from the wheels: a rate that
// an effect changes by a fraction g differs there by g of itself, so a coefficient of such a rate
// is found too large or too small by about g of itself. `Rates::as_recorded` is the way out where
// exactness counts more than physics. An event that takes more travel from a row than the row has
// makes its wheel look as if it had turned round: there, recorded events differ from true ones.
#pragma once

#include "trussmap/recording.hpp"
#include "trussmap/simulation.hpp"

#include <vector>

namespace trussmap::simulation {

struct MotionVariables {
  RowVariables middle;
  RowVariables instant;
};

/// Speeds and turn rate of a row, constant within it.
struct RowRates {
  double speed = 0.0;      ///< m/s ahead
  double turn_rate = 0.0;  ///< rad/s
  double sideways = 0.0;   ///< m/s to the left, by the wheels
};

/// The rates of the true motion.
[[nodiscard]] std::vector<RowRates> true_rates(const TrueMotion& motion);

/// The variables of a motion whose speed, turn_rate, acceleration and distance come from these
/// rates, one per row; all else is the true motion's, events included.
[[nodiscard]] MotionVariables motion_variables(const TrueMotion& motion,
                                               const std::vector<RowRates>& rates,
                                               double wheelbase);

}  // namespace trussmap::simulation
