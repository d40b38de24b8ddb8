// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a planned drive is asked: which effects are rivals, how large each would be, and what is
// fitted beside them.
#pragma once

#include "trussmap/session.hpp"

#include <string>
#include <vector>

#include <Eigen/Core>

namespace trussmap::planning {

struct RivalSubject {
  std::vector<Effect> rivals;  ///< with the sizes that the recordings give each alone
  std::vector<double> scores;  ///< chi^2 that each takes away
  std::vector<Effect> beside;  ///< of one size in all sessions
  std::vector<Effect> own;     ///< of a size of its own in each
  double phi = 1.0;            ///< of the noise, where the best of them is true
};

/// Throws std::invalid_argument where nothing is open, or the options name fewer than two rivals or
/// one that is neither the diagnosis's nor the catalogue's.
[[nodiscard]] RivalSubject rivals_of(const Diagnosis& diagnosis, const PlanOptions& options);

/// Throws std::invalid_argument.
void check_plan_options(const PlanOptions& options);

[[nodiscard]] bool speaks_of_sessions(const Effect& effect);

/// Columns of each effect, one after the other.
[[nodiscard]] std::vector<std::vector<Eigen::Index>> columns_of(const std::vector<Effect>& effects);

/// That their shapes speak of.
[[nodiscard]] std::vector<std::string> variables_in(const std::vector<Effect>& effects);

}  // namespace trussmap::planning
