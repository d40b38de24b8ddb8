// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A process's share of the truss: its landmarks, and the bars at them.
//
//   force   B (z - (p_j - p_i)) at the file's positions: what a bar pulls at j with, and at i the
//           opposite
#pragma once

#include "distributed/placing.hpp"

namespace trussmap::distributed {

struct ShareBar {
  std::int64_t from = 0;  ///< number of a landmark; one of both is this process's at least
  std::int64_t to = 0;
  double off_x = 0.0;  ///< z - (p_j - p_i), m
  double off_y = 0.0;
  double xx = 0.0;  ///< B, 1/m^2
  double xy = 0.0;
  double yy = 0.0;
  std::int32_t from_held = 0;  ///< 1: that landmark is fixed
  std::int32_t to_held = 0;
};

/// The bars at this process's landmarks, in the order of the file, whoever has read them. Throws
/// InputError in all processes where a route's end has no VERTEX line.
[[nodiscard]] std::vector<ShareBar> share_bars(const Communicator& all, Placing& placing,
                                               const std::vector<RouteLine>& routes,
                                               const std::string& file);

/// Throws SolveError in all processes where a landmark is tied to no fixed one.
void require_support(const Communicator& all, const Placing& placing,
                     const std::vector<ShareBar>& bars);

}  // namespace trussmap::distributed
