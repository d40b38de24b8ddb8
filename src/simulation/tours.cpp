// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/tours.hpp"

#include "geometry/index.hpp"
#include "simulation/mesh_world.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <queue>
#include <stdexcept>
#include <string>
#include <utility>

namespace trussmap {
using namespace simulation;

namespace {

/// A route as seen from one of its ends.
struct Exit {
  int to = -1;        ///< landmark
  std::size_t route;  ///< number of the route
};

using Exits = std::vector<std::vector<Exit>>;

Exits exits_of(const Mesh& mesh, const std::vector<MeshRoute>& routes) {
  Exits exits(idx(mesh.landmarks()));
  for (std::size_t k = 0; k < routes.size(); ++k) {
    exits[idx(routes[k].from)].push_back({routes[k].to, k});
    exits[idx(routes[k].to)].push_back({routes[k].from, k});
  }
  return exits;
}

std::size_t pick(std::size_t count, std::mt19937_64& random) {
  return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

/// Shortest ways [m] from a landmark over the routes that are `open`.
struct Ways {
  std::vector<double> length;  ///< infinite where there is no way
  std::vector<int> previous;   ///< landmark before this one, -1 at the start
};

Ways shortest_ways(const Mesh& mesh, const Exits& exits, const std::vector<bool>& open, int from) {
  Ways ways{std::vector<double>(exits.size(), std::numeric_limits<double>::infinity()),
            std::vector<int>(exits.size(), -1)};
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  ways.length[idx(from)] = 0.0;
  queue.emplace(0.0, from);
  while (!queue.empty()) {
    const auto [length, here] = queue.top();
    queue.pop();
    if (length > ways.length[idx(here)]) continue;
    for (const Exit& exit : exits[idx(here)]) {
      const double longer = length + mesh.displacement(here, exit.to).norm();
      if (!open[exit.route] || longer >= ways.length[idx(exit.to)]) continue;
      ways.length[idx(exit.to)] = longer;
      ways.previous[idx(exit.to)] = here;
      queue.emplace(longer, exit.to);
    }
  }
  return ways;
}

/// Appends the way's landmarks but for its start, where the walk already is.
void follow(const Ways& ways, int to, std::vector<int>& walk) {
  const auto start = static_cast<std::ptrdiff_t>(walk.size());
  for (int here = to; ways.previous[idx(here)] >= 0; here = ways.previous[idx(here)]) {
    walk.push_back(here);
  }
  std::reverse(walk.begin() + start, walk.end());
}

std::vector<Exit> undriven_exits(const std::vector<Exit>& exits, const std::vector<bool>& driven) {
  std::vector<Exit> found;
  for (const Exit& exit : exits) {
    if (!driven[exit.route]) found.push_back(exit);
  }
  return found;
}

int nearest_with_undriven_exit(const Ways& ways, const Exits& exits,
                               const std::vector<bool>& driven) {
  int nearest = -1;
  for (int k = 0; k < static_cast<int>(exits.size()); ++k) {
    if (undriven_exits(exits[idx(k)], driven).empty()) continue;
    if (nearest < 0 || ways.length[idx(k)] < ways.length[idx(nearest)]) nearest = k;
  }
  return nearest;
}

std::vector<int> one_tour(const Mesh& mesh, WalkKind kind, int start, std::mt19937_64& random) {
  switch (kind) {
    case WalkKind::euler:
      return euler_walk(mesh, random);
    case WalkKind::face_by_face:
      return face_walk(mesh);
    case WalkKind::depth_first:
      return depth_first_walk(mesh, start, random);
    case WalkKind::random:
      return random_walk(mesh, start, random);
  }
  throw std::invalid_argument("unknown kind of walk");
}

}  // namespace

WalkKind parse_walk_kind(std::string_view name) {
  if (name == "euler") return WalkKind::euler;
  if (name == "face") return WalkKind::face_by_face;
  if (name == "depth-first") return WalkKind::depth_first;
  if (name == "random") return WalkKind::random;
  throw std::invalid_argument("unknown walk '" + std::string(name) +
                              "', expected euler, face, depth-first or random");
}

}  // namespace trussmap

namespace trussmap::simulation {

std::vector<MeshRoute> doubled_routes(const Mesh& mesh) {
  std::vector<MeshRoute> doubled;
  if (is_polygon(mesh)) return doubled;
  const std::vector<int> round = perimeter(mesh);
  bool between = false;  // after an odd landmark that still lacks its partner
  for (std::size_t k = 0; k < round.size(); ++k) {
    if (between) {
      doubled.push_back({std::min(round[k - 1], round[k]), std::max(round[k - 1], round[k])});
    }
    if (neighbours(mesh, round[k]).size() % 2 == 1) between = !between;
  }
  return doubled;
}

std::vector<int> euler_walk(const Mesh& mesh, std::mt19937_64& random) {
  std::vector<MeshRoute> routes = mesh.routes;
  for (const MeshRoute& route : doubled_routes(mesh)) routes.push_back(route);
  const Exits exits = exits_of(mesh, routes);
  std::vector<bool> driven(routes.size(), false);
  std::vector<int> trail = {0};
  std::vector<int> walk;
  while (!trail.empty()) {
    const std::vector<Exit> choice = undriven_exits(exits[idx(trail.back())], driven);
    if (choice.empty()) {
      walk.push_back(trail.back());
      trail.pop_back();
    } else {
      const Exit& chosen = choice[pick(choice.size(), random)];
      driven[chosen.route] = true;
      trail.push_back(chosen.to);
    }
  }
  return walk;
}

std::vector<int> face_walk(const Mesh& mesh) {
  const int faces_x = mesh.size.columns - 1;
  const int faces_y = mesh.size.rows - 1;
  std::vector<int> walk;
  if (faces_x == 0 || faces_y == 0) {
    walk = perimeter(mesh);
    if (is_polygon(mesh)) walk.push_back(walk.front());
    return walk;
  }
  for (int j = 0; j < faces_y; ++j) {
    for (int k = 0; k < faces_x; ++k) {
      const int i = j % 2 == 0 ? k : faces_x - 1 - k;
      // Ploughing there and back, the corner of the next face is always one route away.
      for (const auto& [di, dj] :
           std::array<std::pair<int, int>, 5>{{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}}) {
        walk.push_back(mesh.landmark(i + di, j + dj));
      }
    }
  }
  return walk;
}

std::vector<int> depth_first_walk(const Mesh& mesh, int start, std::mt19937_64& random) {
  const Exits exits = exits_of(mesh, mesh.routes);
  std::vector<bool> driven(mesh.routes.size(), false);
  std::vector<int> walk = {start};
  for (std::size_t left = mesh.routes.size(); left > 0;) {
    const std::vector<Exit> choice = undriven_exits(exits[idx(walk.back())], driven);
    if (choice.empty()) {
      const Ways ways = shortest_ways(mesh, exits, driven, walk.back());
      follow(ways, nearest_with_undriven_exit(ways, exits, driven), walk);
    } else {
      const Exit& chosen = choice[pick(choice.size(), random)];
      driven[chosen.route] = true;
      walk.push_back(chosen.to);
      --left;
    }
  }
  return walk;
}

std::vector<int> random_walk(const Mesh& mesh, int start, std::mt19937_64& random) {
  const Exits exits = exits_of(mesh, mesh.routes);
  std::vector<bool> driven(mesh.routes.size(), false);
  std::vector<int> walk = {start};
  for (std::size_t left = mesh.routes.size(); left > 0;) {
    const std::vector<Exit>& choice = exits[idx(walk.back())];
    const Exit& chosen = choice[pick(choice.size(), random)];
    if (!driven[chosen.route]) --left;
    driven[chosen.route] = true;
    walk.push_back(chosen.to);
  }
  return walk;
}

}  // namespace trussmap::simulation

namespace trussmap {

Tours make_tours(const Mesh& mesh, WalkKind kind, int count, std::mt19937_64& random) {
  if (count < 1) throw std::invalid_argument("a drive takes one tour or more");
  const Exits exits = exits_of(mesh, mesh.routes);
  const std::vector<bool> open(mesh.routes.size(), true);
  Tours tours;
  tours.walk = {0};
  for (int k = 0; k < count; ++k) {
    const std::vector<int> tour = one_tour(mesh, kind, tours.walk.back(), random);
    follow(shortest_ways(mesh, exits, open, tours.walk.back()), tour.front(), tours.walk);
    tours.walk.insert(tours.walk.end(), tour.begin() + 1, tour.end());
    tours.ends.push_back(tours.walk.size() - 1);
  }
  return tours;
}

}  // namespace trussmap
