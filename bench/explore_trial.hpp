// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One robot in one world, twice: on Euler tours, for which it must know all routes before, and
// exploring. Both by the same wheels, the same map builder and the same driver.
//
//   Euler tour   every route at least once, closed at the first landmark, drawn anew each time;
//                between landmarks where an odd number of routes meet, routes are driven twice
#pragma once

#include "explorer.hpp"
#include "trussmap/landmark_map.hpp"
#include "trussmap/survey_comparison.hpp"
#include "world.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace trussmap::bench {

struct ExploreTrial {
  int landmarks = 0;
  int found = 0;
  double way = 0.0;       ///< m, of the Euler tours
  double euler = 0.0;     ///< m, error of the map after them
  double explored = 0.0;  ///< m, after the same way
  double earlier = 0.0;   ///< m, after 80 % of it
  double reached = 0.0;   ///< share of the way after which exploring had the tours' error at first
};

/// The landmarks at which an odd number of routes meets, two by two, so that the ways between are
/// short: the nearest two first, then exchanged while that makes them shorter.
inline std::vector<std::pair<int, int>> paired_odd_landmarks(const LandmarkGraph& plan) {
  std::vector<int> odd;
  for (int k = 0; k < plan.landmarks(); ++k) {
    if (plan.routes_at(k).size() % 2 == 1) odd.push_back(k);
  }
  const auto length = [&](int a, int b) {
    const std::vector<int> way = path(plan, a, b);
    double sum = 0.0;
    for (std::size_t k = 1; k < way.size(); ++k) {
      sum += plan.route(*plan.route_between(way[k - 1], way[k])).stretch;
    }
    return sum;
  };
  const auto count = static_cast<std::size_t>(plan.landmarks());
  std::vector<std::vector<double>> between(count, std::vector<double>(count, 0.0));
  for (const int a : odd) {
    for (const int b : odd) {
      between[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] = length(a, b);
    }
  }
  const auto apart = [&](int a, int b) {
    return between[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)];
  };
  std::vector<std::pair<int, int>> pairs;
  std::vector<int> alone = odd;
  while (!alone.empty()) {
    std::pair<int, int> nearest{alone[0], alone[1]};
    for (const int a : alone) {
      for (const int b : alone) {
        if (a < b && apart(a, b) < apart(nearest.first, nearest.second)) nearest = {a, b};
      }
    }
    pairs.push_back(nearest);
    std::erase(alone, nearest.first);
    std::erase(alone, nearest.second);
  }
  for (bool better = true; better;) {
    better = false;
    for (auto& [a, b] : pairs) {
      for (auto& [c, d] : pairs) {
        if (a == c) continue;
        for (int way = 0; way < 2; ++way) {
          std::swap(c, d);
          if (apart(a, c) + apart(b, d) > apart(a, b) + apart(c, d) - 1e-9) continue;
          std::swap(b, c);
          better = true;
        }
      }
    }
  }
  return pairs;
}

/// Landmarks in order.
inline std::vector<int> euler_tour(const LandmarkGraph& plan, std::mt19937_64& random) {
  std::vector<std::pair<int, int>> routes;
  for (int number = 0; number < plan.routes(); ++number) {
    routes.emplace_back(plan.route(number).source, plan.route(number).target);
  }
  for (const auto& [a, b] : paired_odd_landmarks(plan)) {
    const std::vector<int> twice = path(plan, a, b);
    for (std::size_t k = 1; k < twice.size(); ++k) routes.emplace_back(twice[k - 1], twice[k]);
  }
  std::shuffle(routes.begin(), routes.end(), random);
  std::vector<char> driven(routes.size(), 0);
  std::vector<int> trail{0};
  std::vector<int> walk;
  while (!trail.empty()) {  // Hierholzer
    const int here = trail.back();
    std::size_t exit = 0;
    while (exit < routes.size() &&
           (driven[exit] != 0 || (routes[exit].first != here && routes[exit].second != here))) {
      ++exit;
    }
    if (exit == routes.size()) {
      walk.push_back(here);
      trail.pop_back();
    } else {
      driven[exit] = 1;
      trail.push_back(routes[exit].first == here ? routes[exit].second : routes[exit].first);
    }
  }
  return walk;
}

/// A mix of meshes of 5 x 5 to 9 x 9, even and uneven, with and without walls and compass.
inline explore::WorldOptions drawn_world(std::uint64_t seed) {
  std::mt19937_64 random = random_stream(seed, Stream::hidden);
  std::uniform_int_distribution<int> lines(5, 9);
  explore::WorldOptions world;
  world.size = {lines(random), lines(random)};
  world.uneven = seed % 2 == 1;
  world.compass = seed / 2 % 2 == 1;
  world.wheels = seed / 4 % 2 == 1 ? 0.001 : 0.003;
  world.walls = seed / 8 % 2 == 1 ? 0.0 : 0.15;
  world.seed = seed;
  return world;
}

inline ExploreTrial explore_trial(const explore::WorldOptions& options,
                                  const MapBuilderOptions& how, int tours = 3) {
  const explore::World world(options);
  const LandmarkGraph& plan = world.plan();
  const LandmarkPositions truth = positions_of(plan);
  const Laid laid = options.compass ? Laid::as_it_is : Laid::aligned;
  const auto error_of = [&](const explore::Explorer& robot) {
    return *map_errors(robot.map().map(), truth, laid).position;
  };
  ExploreTrial trial;
  trial.landmarks = plan.landmarks();

  explore::World toured = world;
  explore::Explorer on_tours(toured, how);
  std::mt19937_64 random = random_stream(options.seed, Stream::walk);
  for (int tour = 0; tour < tours; ++tour) {
    const std::vector<int> walk = euler_tour(plan, random);
    for (std::size_t k = 1; k < walk.size(); ++k) {
      const std::vector<int>& ways = plan.routes_at(walk[k - 1]);
      const int route = *plan.route_between(walk[k - 1], walk[k]);
      on_tours.drive(static_cast<int>(std::find(ways.begin(), ways.end(), route) - ways.begin()));
    }
  }
  trial.way = toured.way_driven();
  trial.euler = error_of(on_tours);

  explore::World unknown = world;
  explore::Explorer robot(unknown, how);
  robot.explore(trial.way, [&](const Arrival& /*arrival*/) {
    if (unknown.way_driven() > trial.way) return;
    trial.found = robot.map().landmarks();
    trial.explored = error_of(robot);
    if (unknown.way_driven() <= 0.8 * trial.way) trial.earlier = trial.explored;
    const bool below = trial.found == trial.landmarks && trial.explored <= trial.euler;
    if (below && trial.reached == 0.0) trial.reached = unknown.way_driven() / trial.way;
  });
  if (trial.reached == 0.0) trial.reached = std::numeric_limits<double>::infinity();  // never
  return trial;
}

}  // namespace trussmap::bench
