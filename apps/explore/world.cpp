// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "world.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <boost/pending/disjoint_sets.hpp>

namespace trussmap::explore {
namespace {

Mesh drawn_mesh(const WorldOptions& options, std::mt19937_64& random) {
  if (!options.uneven) return even_mesh(options.size, options.spacing);
  const std::vector<double> x = random_lines(options.size.columns, 1.0, 10.0, random);
  return mesh_of_lines(x, random_lines(options.size.rows, 1.0, 10.0, random));
}

/// Draws the share of the mesh's routes that are walled up, and leaves the others. Those of a
/// spanning tree stay: of Kruskal's, with the routes in the order that was drawn, the last first.
std::vector<MeshRoute> open_routes(const Mesh& mesh, double walls, std::mt19937_64& random) {
  std::vector<MeshRoute> routes = mesh.routes;
  std::shuffle(routes.begin(), routes.end(), random);
  boost::disjoint_sets_with_storage<> joined(static_cast<std::size_t>(mesh.landmarks()));
  const auto set_of = [&](int k) { return joined.find_set(static_cast<std::size_t>(k)); };
  std::vector<char> in_tree(routes.size(), 0);
  for (std::size_t k = routes.size(); k-- > 0;) {
    const std::size_t from = set_of(routes[k].from);
    const std::size_t to = set_of(routes[k].to);
    if (from == to) continue;
    in_tree[k] = 1;
    joined.link(from, to);
  }
  auto left = static_cast<int>(walls * static_cast<double>(routes.size()));
  std::vector<MeshRoute> open;
  for (std::size_t k = 0; k < routes.size(); ++k) {
    if (in_tree[k] != 0 || left-- <= 0) open.push_back(routes[k]);
  }
  return open;
}

}  // namespace

World::World(const WorldOptions& options)
    : options_(options), random_(random_stream(options.seed, Stream::mesh)) {
  if (!(options.walls >= 0.0 && options.walls < 1.0) || !(options.wheels > 0.0) ||
      !(options.wheelbase > 0.0) || !(options.reach >= 0.0)) {
    throw std::invalid_argument("a world's sizes and noise are above 0, its walls a share below 1");
  }
  if (!(options.air_loss >= 0.0 && options.air_loss < 1.0)) {
    throw std::invalid_argument("a tyre loses a share of its radius below 1");
  }
  const Mesh mesh = drawn_mesh(options, random_);
  for (int k = 0; k < mesh.landmarks(); ++k) {
    const Vector2& at = mesh.positions[static_cast<std::size_t>(k)];
    plan_.add_landmark(landmark_name(mesh, k), at);
  }
  for (const MeshRoute& route : open_routes(mesh, options.walls, random_)) {
    plan_.add_traversal(route.from, route.to,
                        {mesh.displacement(route.from, route.to), Matrix2::Identity()});
  }
}

Vector2 World::displacement_to(int landmark) const {
  return plan_.landmark(landmark).position - plan_.landmark(here_).position;
}

std::optional<double> World::read_compass() {
  if (!options_.compass) return std::nullopt;
  std::normal_distribution<double> error(0.0, options_.compass_sd);
  return wrap_angle(heading_ + error(random_));
}

std::vector<Seen> World::look_round() {
  std::vector<Seen> seen;
  std::normal_distribution<double> normal;
  for (int k = 0; k < plan_.landmarks() && options_.reach > 0.0; ++k) {
    const Vector2 to = displacement_to(k);
    const double range = to.norm() + options_.range_sd * normal(random_);
    const double bearing =
        wrap_angle(direction(to) - heading_ + options_.bearing_sd * normal(random_));
    if (k == here_ || to.norm() > options_.reach || !(range > 0.0)) continue;
    seen.push_back({plan_.landmark(k).name, range, bearing});
  }
  return seen;
}

Driven World::leave_by(int way) {
  const int route = plan_.routes_at(here_).at(static_cast<std::size_t>(way));
  const int to = other_end(plan_.route(route), here_);
  const Vector2 along = displacement_to(to);
  const double turn = wrap_angle(direction(along) - heading_);
  heading_ += turn;
  way_ += along.norm();
  here_ = to;
  const std::vector<int>& back = plan_.routes_at(to);
  std::vector<DrivenRow> rows =
      drive_route(turn, along.norm(), options_.wheelbase, options_.wheels, random_);
  if (legs_++ >= options_.air_loss_leg) {  // a smaller wheel turns more often
    for (DrivenRow& row : rows) row.left /= 1.0 - options_.air_loss;
  }
  return {std::move(rows), landmark(),
          static_cast<int>(std::find(back.begin(), back.end(), route) - back.begin())};
}

double World::length_of_all_routes() const {
  double sum = 0.0;
  for (int number = 0; number < plan_.routes(); ++number) sum += plan_.route(number).stretch;
  return sum;
}

}  // namespace trussmap::explore
