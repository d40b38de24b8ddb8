// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Neighbours and perimeter of a mesh (trussmap/simulation.hpp).
#pragma once

#include "trussmap/simulation.hpp"

#include <vector>

namespace trussmap::simulation {

/// Whether it is a polygon: a row whose ends are joined.
[[nodiscard]] bool is_polygon(const Mesh& mesh);

/// The landmarks that a route joins to this one, in increasing order; of a mesh that is no polygon.
[[nodiscard]] std::vector<int> neighbours(const Mesh& mesh, int landmark);

/// The perimeter's landmarks in order round the mesh from v0, first along +x, each once. A line of
/// landmarks is its own perimeter, from end to end.
[[nodiscard]] std::vector<int> perimeter(const Mesh& mesh);

}  // namespace trussmap::simulation
