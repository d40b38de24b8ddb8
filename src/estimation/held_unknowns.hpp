// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What of a node stays where it is, because nothing measures it or because only positions move.
#pragma once

#include "linalg/block_system.hpp"

#include <cstdint>
#include <vector>

namespace trussmap::estimation {

/// What of a node is held, bit by bit. A node's unknowns are x, y and, of a pose, its heading.
enum Held : std::uint8_t { held_nothing = 0, held_position = 1, held_heading = 2, held_all = 3 };

/// Whether a node's k-th unknown is.
[[nodiscard]] constexpr bool is_held(std::uint8_t held, int k) {
  return (held & (k < 2 ? held_position : held_heading)) != 0;
}

/// Gives each held unknown of A step = -gradient the equation 1 * step = 0. Its row and column must
/// be empty but for the diagonal. `held`: of the nodes, those from its end on are free.
void hold_unknowns(linalg::BlockSystem& A, Eigen::VectorXd& gradient,
                   const std::vector<std::uint8_t>& held);

}  // namespace trussmap::estimation
