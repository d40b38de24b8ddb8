// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/printed_refinement.hpp"

#include "geometry/index.hpp"
#include "linalg/connected_parts.hpp"
#include "map/refinement.hpp"
#include "trussmap/error.hpp"
#include "trussmap/truss.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace trussmap::map {
namespace {

/// Number of a landmark's place among ascending ones, -1 if it is not among them.
int place_in(const std::vector<int>& landmarks, int landmark) {
  const auto place = std::lower_bound(landmarks.begin(), landmarks.end(), landmark);
  return place != landmarks.end() && *place == landmark
             ? static_cast<int>(place - landmarks.begin())
             : -1;
}

Vector2 lies(const LandmarkGraph& map, const Route& route) {
  return map.landmark(route.target).position - map.landmark(route.source).position;
}

std::optional<Matrix2> stiffest_neighbour(const LandmarkGraph& map, int landmark, int except) {
  std::optional<Matrix2> stiffest;
  for (const int number : map.routes_at(landmark)) {
    if (number == except) continue;
    const Matrix2 B = printed_stiffness(map, map.route(number));
    if (!stiffest || B.trace() > stiffest->trace()) stiffest = B;
  }
  return stiffest;
}

/// A part of the map: its landmarks (ascending) and the routes with both ends among them.
struct Piece {
  std::vector<int> landmarks;
  std::vector<int> routes;
};

Piece piece_of(const LandmarkGraph& map, std::vector<int> members) {
  Piece piece{std::move(members), {}};
  for (const int landmark : piece.landmarks) {
    for (const int number : map.routes_at(landmark)) {
      const Route& route = map.route(number);
      if (route.source == landmark && place_in(piece.landmarks, route.target) >= 0) {
        piece.routes.push_back(number);
      }
    }
  }
  return piece;
}

/// Of the members, those that routes among them tie to landmark i.
Piece connected_to(const LandmarkGraph& map, int i, std::vector<int> members) {
  Piece piece = piece_of(map, std::move(members));
  std::vector<linalg::NodePair> pairs;
  for (const int number : piece.routes) {
    const Route& route = map.route(number);
    pairs.push_back(
        {place_in(piece.landmarks, route.source), place_in(piece.landmarks, route.target)});
  }
  const std::vector<int> part =
      linalg::connected_parts(static_cast<int>(piece.landmarks.size()), pairs);
  const int mine = part[idx(place_in(piece.landmarks, i))];
  std::vector<int> tied;
  for (std::size_t k = 0; k < part.size(); ++k) {
    if (part[k] == mine) tied.push_back(piece.landmarks[k]);
  }
  return tied.size() == piece.landmarks.size() ? piece : piece_of(map, std::move(tied));
}

/// Loads on landmarks of a piece of the map: `held` at the first landmark, or floating.
Moves deflect(const LandmarkGraph& map, const Piece& piece, std::vector<Load> loads, bool held) {
  std::vector<Bar> bars;
  bars.reserve(piece.routes.size());
  for (const int number : piece.routes) {
    const Route& route = map.route(number);
    bars.push_back({place_in(piece.landmarks, route.source),
                    place_in(piece.landmarks, route.target), printed_stiffness(map, route)});
  }
  for (Load& load : loads) load.joint = place_in(piece.landmarks, load.joint);
  const int joints = static_cast<int>(piece.landmarks.size());
  try {
    Deflection deflection = held ? solve_truss(joints, bars, {{0, Vector2::Zero()}}, loads)
                                 : solve_floating_truss(joints, bars, loads);
    return {piece.landmarks, std::move(deflection.displacements), Vector2::Zero()};
  } catch (const UnsupportedJoint& error) {
    throw SolveError("landmark " + map.landmark(piece.landmarks[idx(error.joint())]).name + " " +
                     error.why());
  }
}

void require_finite(const Moves& moves) {
  double sum = moves.shift.squaredNorm();
  for (const Vector2& u : moves.displacements) sum += u.squaredNorm();
  if (!std::isfinite(sum)) throw too_many_magnitudes();
}

}  // namespace

Vector2 Moves::of(int landmark) const {
  const int place = place_in(landmarks, landmark);
  return place < 0 ? Vector2(Vector2::Zero()) : displacements[idx(place)];
}

Matrix2 printed_stiffness(const LandmarkGraph& map, const Route& route) {
  return bar_stiffness(StiffnessLaw::mean_error, route.covariance, direction(lies(map, route)),
                       route.traversals);
}

Moves printed_refinement(const LandmarkGraph& map, int number, std::vector<int> members) {
  const Route& route = map.route(number);
  const int i = route.source;
  const int j = route.target;
  const RefinementLoads loads =
      refinement_loads(lies(map, route), route.mean_vector(), printed_stiffness(map, route),
                       stiffest_neighbour(map, i, number), stiffest_neighbour(map, j, number));
  const bool whole = static_cast<int>(members.size()) == map.landmarks();
  const Piece piece =
      whole ? piece_of(map, std::move(members)) : connected_to(map, i, std::move(members));
  Moves moves = deflect(map, piece, {{i, loads.force_i}, {j, loads.force_j}}, whole);
  // A floating piece that holds the first landmark moves it: count the map as shifted instead.
  moves.shift = -moves.of(0);
  require_finite(moves);
  return moves;
}

}  // namespace trussmap::map
