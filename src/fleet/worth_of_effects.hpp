// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What some effects together are worth to a robot: by it, lists of effects that look the same over
// a fleet are compared.
//
//   worth = chi^2 that the effects it needs take away - sum of their penalties
//   penalty = quantile of chi^2(dof) at 1 - level
//
// With level = 0.05/robots the penalty is what an effect that is not there would explain by chance
// in the luckiest robot (risk inflation criterion, Foster & George 1994). Which effects a robot
// needs is found by backward elimination: all at first, then the worst goes as long as it explains
// less than its penalty. A robot that needs two effects for what one would say pays twice.
#pragma once

#include "fleet/pooled_sums.hpp"

#include <vector>

namespace trussmap::fleet {

/// `days` of one robot, what the model has swept; each day has coefficients of its own.
[[nodiscard]] double worth_of_effects(const std::vector<const ColumnSums*>& days,
                                      const std::vector<FleetBlock>& effects, double level);

}  // namespace trussmap::fleet
