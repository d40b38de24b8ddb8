// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/map_truss.hpp"

#include "geometry/index.hpp"
#include "linalg/connected_parts.hpp"
#include "linalg/dense.hpp"
#include "map/nearest_landmarks.hpp"
#include "map/refinement.hpp"
#include "trussmap/error.hpp"
#include "trussmap/truss.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace trussmap {
namespace {

constexpr double kNegligibleShare = 0.1;  // of the smallest standard deviation, for eta estimated

/// Number of a landmark's place among ascending ones, -1 if it is not among them.
int place_in(const std::vector<int>& landmarks, int landmark) {
  const auto place = std::lower_bound(landmarks.begin(), landmarks.end(), landmark);
  return place != landmarks.end() && *place == landmark
             ? static_cast<int>(place - landmarks.begin())
             : -1;
}

}  // namespace

/// A part of the map: its landmarks (ascending) and the routes with both ends among them.
struct MapTruss::Piece {
  std::vector<int> landmarks;
  std::vector<int> routes;
};

Vector2 Moves::of(int landmark) const {
  const int place = place_in(landmarks, landmark);
  return place < 0 ? Vector2(Vector2::Zero()) : displacements[idx(place)];
}

void require_finite(const Moves& moves) {
  double sum = moves.shift.squaredNorm();
  for (const Vector2& u : moves.displacements) sum += u.squaredNorm();
  if (!std::isfinite(sum)) {
    throw SolveError("the covariances of the map's traversals span too many magnitudes");
  }
}

Vector2 MapTruss::lies(const Route& route) const {
  return map_.landmark(route.target).position - map_.landmark(route.source).position;
}

Matrix2 MapTruss::stiffness(const Route& route) const {
  return bar_stiffness(StiffnessLaw::printed, route.covariance, direction(lies(route)),
                       route.traversals);
}

Moves MapTruss::refinement(int number, const Eta& eta,
                           const std::optional<double>& gain_limit) const {
  const Route& route = map_.route(number);
  const int i = route.source;
  const int j = route.target;
  const Vector2 present = lies(route);
  const Vector2 target = route.mean_vector();
  const RefinementLoads loads =
      refinement_loads(present, target, stiffness(route), stiffest_neighbour(i, number),
                       stiffest_neighbour(j, number));
  Moves moves = larger_structure(route, eta, {{i, loads.force_i}, {j, loads.force_j}});
  if (gain_limit) {
    const double gain = limited_gain(moves.of(j) - moves.of(i), target - present, *gain_limit);
    for (Vector2& u : moves.displacements) u *= gain;
  }
  // A floating piece that holds the first landmark moves it: count the map as shifted instead.
  moves.shift = -moves.of(0);
  require_finite(moves);
  return moves;
}

Moves MapTruss::rest() const {
  const Piece whole = everything();
  std::vector<Load> loads;
  for (const int number : whole.routes) {
    const Route& route = map_.route(number);
    const Vector2 force = stiffness(route) * (route.mean_vector() - lies(route));
    loads.push_back({route.source, -force});
    loads.push_back({route.target, force});
  }
  if (loads.empty()) return {};
  Moves moves = deflect(whole, loads, true);
  require_finite(moves);
  return moves;
}

std::optional<Matrix2> MapTruss::stiffest_neighbour(int landmark, int except) const {
  std::optional<Matrix2> stiffest;
  for (const int number : map_.routes_at(landmark)) {
    if (number == except) continue;
    const Matrix2 B = stiffness(map_.route(number));
    if (!stiffest || B.trace() > stiffest->trace()) stiffest = B;
  }
  return stiffest;
}

Moves MapTruss::larger_structure(const Route& route, const Eta& eta,
                                 const std::vector<Load>& loads) const {
  if (eta.kind == Eta::Kind::estimated) return growing_structure(route, eta, loads);
  if (eta.kind == Eta::Kind::all || eta.count >= map_.landmarks()) {
    return deflect(everything(), loads, eta.hold_first);
  }
  const Vector2 midpoint =
      0.5 * (map_.landmark(route.source).position + map_.landmark(route.target).position);
  std::vector<int> members = nearest_.nearest(map_, midpoint, eta.count);
  for (const int end : {route.source, route.target}) {  // both may be far from a long one's middle
    if (place_in(members, end) >= 0) continue;
    members.insert(std::lower_bound(members.begin(), members.end(), end), end);
  }
  fetch(members);
  return deflect(connected_to(route.source, std::move(members)), loads, false);
}

/// Ring by ring round the route, until the outer ring hardly moves.
Moves MapTruss::growing_structure(const Route& route, const Eta& eta,
                                  const std::vector<Load>& loads) const {
  std::vector<int> members{std::min(route.source, route.target),
                           std::max(route.source, route.target)};
  std::vector<int> ring = members;
  while (true) {
    ring = next_ring(members, ring);
    members.insert(members.end(), ring.begin(), ring.end());
    std::sort(members.begin(), members.end());
    const bool all = static_cast<int>(members.size()) == map_.landmarks();
    Moves moves = deflect(piece_of(members), loads, all && eta.hold_first);
    if (all || ring.empty() || hardly_moves(moves, ring)) return moves;
  }
}

std::vector<int> MapTruss::next_ring(const std::vector<int>& members,
                                     const std::vector<int>& ring) const {
  std::vector<int> next;
  for (const int landmark : ring) {
    for (const int number : map_.routes_at(landmark)) {
      const int other = other_end(map_.route(number), landmark);
      if (!std::binary_search(members.begin(), members.end(), other)) next.push_back(other);
    }
  }
  std::sort(next.begin(), next.end());
  next.erase(std::unique(next.begin(), next.end()), next.end());
  return next;
}

bool MapTruss::hardly_moves(const Moves& moves, const std::vector<int>& ring) const {
  double largest = 0.0;
  double smallest_variance = std::numeric_limits<double>::infinity();
  for (const int landmark : ring) {
    largest = std::max(largest, moves.of(landmark).norm());
    for (const int number : map_.routes_at(landmark)) {
      const Route& route = map_.route(number);
      const double smallest = planar_modes(route.covariance).eigenvalues[0];
      smallest_variance = std::min(smallest_variance, smallest / route.traversals);
    }
  }
  return largest < kNegligibleShare * std::sqrt(smallest_variance);
}

MapTruss::Piece MapTruss::everything() const {
  std::vector<int> all(idx(map_.landmarks()));
  std::iota(all.begin(), all.end(), 0);
  return piece_of(std::move(all));
}

/// Asks memory for all of a piece at once: in a large map none of it is in the cache, and one after
/// the other these are some hundred waits.
void MapTruss::fetch(const std::vector<int>& members) const {
  for (const int landmark : members) {
    __builtin_prefetch(&map_.routes_at(landmark));
    __builtin_prefetch(&map_.landmark(landmark).position);
  }
  for (const int landmark : members) __builtin_prefetch(map_.routes_at(landmark).data());
  for (const int landmark : members) {
    for (const int number : map_.routes_at(landmark)) {
      const Route& route = map_.route(number);
      __builtin_prefetch(&route.source);
      __builtin_prefetch(&route.covariance);
    }
  }
}

MapTruss::Piece MapTruss::piece_of(std::vector<int> members) const {
  Piece piece{std::move(members), {}};
  for (const int landmark : piece.landmarks) {
    for (const int number : map_.routes_at(landmark)) {
      const Route& route = map_.route(number);
      if (route.source == landmark && place_in(piece.landmarks, route.target) >= 0) {
        piece.routes.push_back(number);
      }
    }
  }
  return piece;
}

/// Of the members, those that routes among them tie to landmark i.
MapTruss::Piece MapTruss::connected_to(int i, std::vector<int> members) const {
  Piece piece = piece_of(std::move(members));
  std::vector<NodePair> pairs;
  for (const int number : piece.routes) {
    const Route& route = map_.route(number);
    pairs.push_back(
        {place_in(piece.landmarks, route.source), place_in(piece.landmarks, route.target)});
  }
  const std::vector<int> part = connected_parts(static_cast<int>(piece.landmarks.size()), pairs);
  const int mine = part[idx(place_in(piece.landmarks, i))];
  std::vector<int> tied;
  for (std::size_t k = 0; k < part.size(); ++k) {
    if (part[k] == mine) tied.push_back(piece.landmarks[k]);
  }
  return tied.size() == piece.landmarks.size() ? piece : piece_of(std::move(tied));
}

/// Loads on landmarks of a piece of the map: `held` at the first landmark, or floating.
Moves MapTruss::deflect(const Piece& piece, std::vector<Load> loads, bool held) const {
  std::vector<Bar> bars;
  bars.reserve(piece.routes.size());
  for (const int number : piece.routes) {
    const Route& route = map_.route(number);
    bars.push_back({place_in(piece.landmarks, route.source),
                    place_in(piece.landmarks, route.target), stiffness(route)});
  }
  for (Load& load : loads) load.joint = place_in(piece.landmarks, load.joint);
  const int joints = static_cast<int>(piece.landmarks.size());
  try {
    Deflection deflection = held ? solve_truss(joints, bars, {{0, Vector2::Zero()}}, loads)
                                 : solve_floating_truss(joints, bars, loads);
    return {piece.landmarks, std::move(deflection.displacements), Vector2::Zero()};
  } catch (const UnsupportedJoint& error) {
    throw SolveError("landmark " + map_.landmark(piece.landmarks[idx(error.joint())]).name + " " +
                     error.why());
  }
}

}  // namespace trussmap
