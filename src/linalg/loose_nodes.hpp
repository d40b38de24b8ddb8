// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A minimum may be a point or a valley: which nodes can move without straining anything?
//
//   A      normal matrix; its diagonal D says how stiff each unknown is by itself
//   mode   the direction of least v'Av with v'Dv = 1, by inverse iteration
//
// A chain may be slender, not loose: only a mode that strains nothing but rounding counts, and its
// strain is not v'Av, which rounding spoils, but what the caller sums measurement by measurement.
#pragma once

#include "linalg/block_system.hpp"

#include <functional>
#include <vector>

namespace trussmap::linalg {

struct LooseLimits {
  double strain = 0.0;     ///< energy of a mode with v'Dv = 1 that only rounding strains
  double stiffness = 0.0;  ///< least entry of D, as a share of its largest
};

/// Nodes of the system that move most in a loose mode, the most mobile first; none if all is
/// determined. `strain`: twice the energy that a displacement of all unknowns would store. Leaves A
/// as it is, factorised.
[[nodiscard]] std::vector<int> find_loose_nodes(
    BlockSystem& A, const std::function<double(const Eigen::VectorXd&)>& strain,
    const LooseLimits& limits);

}  // namespace trussmap::linalg
