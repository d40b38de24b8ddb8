// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "world.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trussmap::explore {
namespace {

constexpr double kTurnPerRow = 0.2;  // rad
constexpr double kWayPerRow = 0.25;  // m

Mesh drawn_mesh(const WorldOptions& options, std::mt19937_64& random) {
  if (!options.uneven) return even_mesh(options.size, options.spacing);
  std::uniform_real_distribution<double> length(1.0, 10.0);
  const auto lines = [&](int count) {
    std::vector<double> places{0.0};
    while (static_cast<int>(places.size()) < count)
      places.push_back(places.back() + length(random));
    return places;
  };
  const std::vector<double> x = lines(options.size.columns);
  return mesh_of_lines(x, lines(options.size.rows));
}

/// Whether all landmarks can be reached from the first.
bool is_connected(const std::vector<std::vector<int>>& beyond) {
  std::vector<char> met(beyond.size(), 0);
  std::vector<int> next{0};
  met[0] = 1;
  std::size_t count = 0;
  while (!next.empty()) {
    const int at = next.back();
    next.pop_back();
    ++count;
    for (const int other : beyond[static_cast<std::size_t>(at)]) {
      if (met[static_cast<std::size_t>(other)] != 0) continue;
      met[static_cast<std::size_t>(other)] = 1;
      next.push_back(other);
    }
  }
  return count == beyond.size();
}

}  // namespace

World::World(const WorldOptions& options)
    : options_(options), random_(random_stream(options.seed, Stream::mesh)) {
  if (!(options.walls >= 0.0 && options.walls < 1.0) || !(options.wheels > 0.0) ||
      !(options.wheelbase > 0.0) || !(options.reach >= 0.0)) {
    throw std::invalid_argument("a world's sizes and noise are above 0, its walls a share below 1");
  }
  mesh_ = drawn_mesh(options, random_);
  for (int k = 0; k < mesh_.landmarks(); ++k) names_.push_back(landmark_name(mesh_, k));
  beyond_.resize(names_.size());
  for (const MeshRoute& route : mesh_.routes) {
    beyond_[static_cast<std::size_t>(route.from)].push_back(route.to);
    beyond_[static_cast<std::size_t>(route.to)].push_back(route.from);
  }
  wall_up();
}

void World::wall_up() {
  std::vector<MeshRoute> routes = mesh_.routes;
  std::shuffle(routes.begin(), routes.end(), random_);
  auto left = static_cast<int>(options_.walls * static_cast<double>(routes.size()));
  for (const MeshRoute& route : routes) {
    if (left == 0) return;
    const std::vector<std::vector<int>> before = beyond_;
    std::erase(beyond_[static_cast<std::size_t>(route.from)], route.to);
    std::erase(beyond_[static_cast<std::size_t>(route.to)], route.from);
    if (is_connected(beyond_)) {
      --left;
    } else {
      beyond_ = before;
    }
  }
}

std::vector<int> World::ways_out() const {
  std::vector<int> ways(beyond_[here_].size());
  for (std::size_t k = 0; k < ways.size(); ++k) ways[k] = static_cast<int>(k);
  return ways;
}

std::optional<double> World::read_compass() {
  if (!options_.compass) return std::nullopt;
  std::normal_distribution<double> error(0.0, options_.compass_sd);
  return wrap_angle(heading_ + error(random_));
}

std::vector<Seen> World::look_round() {
  std::vector<Seen> seen;
  std::normal_distribution<double> normal;
  for (int k = 0; k < mesh_.landmarks() && options_.reach > 0.0; ++k) {
    const Vector2 to = displacement(static_cast<int>(here_), k);
    const double range = to.norm() + options_.range_sd * normal(random_);
    const double bearing =
        wrap_angle(direction(to) - heading_ + options_.bearing_sd * normal(random_));
    const bool here = k == static_cast<int>(here_);
    if (here || to.norm() > options_.reach || !(range > 0.0)) continue;
    seen.push_back({names_[static_cast<std::size_t>(k)], range, bearing});
  }
  return seen;
}

Driven World::leave_by(int way) {
  const int to = beyond_[here_].at(static_cast<std::size_t>(way));
  const Vector2 along = displacement(static_cast<int>(here_), to);
  const double turn = wrap_angle(direction(along) - heading_);
  Driven driven;
  std::normal_distribution<double> normal;
  const auto drive = [&](double left, double right, double per_row) {
    const int rows = std::max(1, static_cast<int>(std::ceil(std::abs(right) / per_row)));
    for (int row = 0; row < rows; ++row) {
      const double l = left / rows;
      const double r = right / rows;
      const double seen_left = l + options_.wheels * std::sqrt(std::abs(l)) * normal(random_);
      const double seen_right = r + options_.wheels * std::sqrt(std::abs(r)) * normal(random_);
      driven.rows.push_back({seen_left, seen_right});
    }
  };
  const double arc = 0.5 * turn * options_.wheelbase;
  if (turn != 0.0) drive(-arc, arc, 0.5 * kTurnPerRow * options_.wheelbase);
  drive(along.norm(), along.norm(), kWayPerRow);
  const int from = static_cast<int>(here_);
  heading_ += turn;
  way_ += along.norm();
  here_ = static_cast<std::size_t>(to);
  driven.landmark = names_[here_];
  const std::vector<int>& back = beyond_[here_];
  driven.way_back = static_cast<int>(std::find(back.begin(), back.end(), from) - back.begin());
  return driven;
}

LandmarkPositions World::truth() const {
  LandmarkPositions truth;
  for (std::size_t k = 0; k < names_.size(); ++k) truth[names_[k]] = mesh_.positions[k];
  return truth;
}

double World::length_of_all_routes() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < beyond_.size(); ++k) {
    for (const int other : beyond_[k]) sum += displacement(static_cast<int>(k), other).norm();
  }
  return 0.5 * sum;
}

}  // namespace trussmap::explore
