// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The walks of a tour (trussmap/simulation.hpp), each over every route of a mesh at least once.
//
//   Euler         every route once but for the perimeter routes that join its odd landmarks, which
//                 are driven twice; closed at v0; drawn anew each time
//   face by face  faces row after row (there and back, as one ploughs), each walked round
//   depth first   an undriven route if there is one here (at random), else by the shortest known
//                 way to the nearest landmark that has one
//   random        uniform among the routes that meet here
//
// Golfarelli, Maio & Rizzi (1998), section 4, leave the walk open. The Euler walk is the one that
// the reference curves use. A walk is the sequence of landmarks met, first and last included.
#pragma once

#include "trussmap/simulation.hpp"

#include <random>
#include <vector>

namespace trussmap::simulation {

/// Routes of the mesh that an Euler walk drives twice: the perimeter's landmarks of odd degree are
/// paired in order (1st with 2nd, 3rd with 4th, ...), and the perimeter between each pair is
/// doubled. On a line of landmarks that is the whole line, on a polygon nothing.
[[nodiscard]] std::vector<MeshRoute> doubled_routes(const Mesh& mesh);

/// Closed walk from v0 over every route once, the doubled ones twice: Hierholzer's algorithm, at
/// every landmark a uniform choice among the routes still to be driven (a doubled one counts twice
/// until it is driven). It is driven in the order in which the algorithm settles it, the last
/// choice first. The reference curves decided that: driven the other way round, loops close
/// differently, and elastic_printed is off by 0.199 m after the first tour instead of 0.241 m (6x6,
/// 200 seeds; reference 0.242 +- 0.020 m).
[[nodiscard]] std::vector<int> euler_walk(const Mesh& mesh, std::mt19937_64& random);

/// From v0, round each face counter-clockwise. On a line of landmarks: from end to end; round a
/// polygon.
[[nodiscard]] std::vector<int> face_walk(const Mesh& mesh);

/// From `start` until every route has been driven; lengths [m] decide what is near.
[[nodiscard]] std::vector<int> depth_first_walk(const Mesh& mesh, int start,
                                                std::mt19937_64& random);

/// From `start` until every route has been driven.
[[nodiscard]] std::vector<int> random_walk(const Mesh& mesh, int start, std::mt19937_64& random);

}  // namespace trussmap::simulation
