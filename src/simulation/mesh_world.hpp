// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Square meshes: the worlds in which robots are simulated.
//
//   y ^   L0_2 ---- L1_2 ---- L2_2        columns along x, rows along y; L{column}_{row}
//     |    |         |         |          landmark number = column * rows + row, so that numbers
//     |   L0_1 ---- L1_1 ---- L2_1        and names have the same order
//     |    |         |         |          routes join neighbours of a column or a row
//     |   L0_0 ---- L1_0 ---- L2_0        v0 is landmark 0, the corner L0_0
//     +------------------------------> x
//
// A mesh of a single column or row is a line of landmarks; two landmarks are the least.
#pragma once

#include "geometry/index.hpp"
#include "trussmap/planar.hpp"

#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap {

struct MeshSize {
  int columns = 0;  ///< landmarks along x
  int rows = 0;     ///< landmarks along y
};

struct MeshRoute {
  int from = -1;  ///< landmark
  int to = -1;    ///< landmark, to the right of `from` or above it
};

struct Mesh {
  MeshSize size;
  std::vector<Vector2> positions;  ///< true landmark positions, m
  std::vector<MeshRoute> routes;   ///< every pair of neighbours once

  [[nodiscard]] int landmarks() const { return size.columns * size.rows; }
  [[nodiscard]] int landmark(int column, int row) const { return column * size.rows + row; }
  [[nodiscard]] int column(int landmark) const { return landmark / size.rows; }
  [[nodiscard]] int row(int landmark) const { return landmark % size.rows; }
  /// From one landmark to another, m.
  [[nodiscard]] Vector2 displacement(int from, int to) const {
    return positions[idx(to)] - positions[idx(from)];
  }
};

/// "6x6": columns, then rows. Throws std::invalid_argument on anything else, and on fewer than two
/// or more than a million landmarks.
[[nodiscard]] MeshSize parse_mesh_size(std::string_view text);

/// Equal spacing [m] both ways, v0 at the origin.
[[nodiscard]] Mesh even_mesh(MeshSize size, double spacing);

/// Columns at the given x, rows at the given y [m], both increasing.
[[nodiscard]] Mesh mesh_of_lines(const std::vector<double>& x, const std::vector<double>& y);

/// `count` coordinates from 0 on, with gaps drawn uniformly from [shortest, longest] m.
[[nodiscard]] std::vector<double> random_lines(int count, double shortest, double longest,
                                               std::mt19937_64& random);

/// The mesh with every landmark moved by up to `reach` m along x and along y, uniformly. The reach
/// must leave neighbours apart: below half the shortest route.
[[nodiscard]] Mesh jittered(Mesh mesh, double reach, std::mt19937_64& random);

/// "L{column}_{row}".
[[nodiscard]] std::string landmark_name(const Mesh& mesh, int landmark);

/// The landmarks that a route joins to this one, in increasing order.
[[nodiscard]] std::vector<int> neighbours(const Mesh& mesh, int landmark);

/// The perimeter's landmarks in order round the mesh from v0, first along +x, each once. A line of
/// landmarks is its own perimeter, from end to end.
[[nodiscard]] std::vector<int> perimeter(const Mesh& mesh);

/// Length of the shortest route, m.
[[nodiscard]] double shortest_route(const Mesh& mesh);

}  // namespace trussmap
