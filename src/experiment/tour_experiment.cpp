// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/tour_experiment.hpp"

#include "geometry/index.hpp"
#include "map/linear_truss.hpp"
#include "parallel/parallel_for.hpp"
#include "simulation/route_robot.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>
#include <numeric>
#include <stdexcept>

namespace trussmap {
namespace {

using Errors = MapErrors;
using MethodErrors = std::map<std::string, MapErrors>;

/// Errors of routes whose vectors (from -> to of the mesh) are given.
Errors route_errors(const Mesh& mesh, const std::function<Vector2(const MeshRoute&)>& vector) {
  Errors errors;
  for (const MeshRoute& route : mesh.routes) {
    const Vector2 truth = mesh.displacement(route.from, route.to);
    const Vector2 found = vector(route);
    errors.stretch += std::abs(found.norm() - truth.norm()) / truth.norm();
    errors.orientation += std::abs(wrap_angle(direction(found) - direction(truth)));
  }
  errors.stretch /= static_cast<double>(mesh.routes.size());
  errors.orientation /= static_cast<double>(mesh.routes.size());
  return errors;
}

/// Errors of a map, by the positions of the mesh's landmarks; landmark 0 is the first.
Errors map_errors(const Mesh& mesh, const std::vector<Vector2>& positions) {
  Errors errors = route_errors(mesh, [&positions](const MeshRoute& route) -> Vector2 {
    return positions[idx(route.to)] - positions[idx(route.from)];
  });
  double sum = 0.0;
  for (int k = 1; k < mesh.landmarks(); ++k) {
    sum += (positions[idx(k)] - mesh.positions[idx(k)]).norm();
  }
  errors.position = mesh.landmarks() > 1 ? sum / (mesh.landmarks() - 1) : 0.0;
  return errors;
}

std::vector<Vector2> positions_by_mesh(const Mesh& mesh, const LandmarkGraph& map) {
  std::vector<Vector2> positions;
  positions.reserve(idx(mesh.landmarks()));
  for (int k = 0; k < mesh.landmarks(); ++k) {
    positions.push_back(map.landmark(*map.find(landmark_name(mesh, k))).position);
  }
  return positions;
}

/// One seed's robot and all the maps it builds.
class SeedRun {
 public:
  SeedRun(const TourOptions& options, std::uint64_t seed)
      : options_(options),
        walk_random_(random_stream(seed, Stream::walk)),
        error_random_(random_stream(seed, Stream::wheels)) {
    for (const Method method : {Method::elastic_printed, Method::elastic, Method::gauss_markov}) {
      MapBuilderOptions builder;
      builder.method = method;
      builder.eta = options.eta;
      builder.pooled = true;
      builders_.emplace(name_of(method), MapBuilder(builder));
    }
    MapBuilderOptions only_first_sight;
    only_first_sight.method = Method::elastic_printed;
    only_first_sight.eta = options.eta;
    only_first_sight.refine = false;
    builders_.emplace(kFirstSight, MapBuilder(only_first_sight));
  }

  SeedErrors run() {
    const Mesh& mesh = options_.mesh;
    const Tours tours = make_tours(mesh, options_.walk, options_.tours, walk_random_);
    const int first = tours.walk.front();
    reckoned_ = mesh.positions[idx(first)];
    averages_.add_landmark(landmark_name(mesh, first), reckoned_);
    for (auto& [name, builder] : builders_) builder.start(landmark_name(mesh, first), reckoned_);

    SeedErrors errors;
    std::size_t step = 0;
    for (const std::size_t end : tours.ends) {
      for (; step < end; ++step) drive(tours.walk[step], tours.walk[step + 1]);
      errors.tours.push_back(errors_now());
      if (errors.tours.size() == 1) {
        errors.first_sight_before = errors.tours.back().at("raw");
        errors.first_sight_after =
            map_errors(mesh, positions_by_mesh(mesh, builders_.at(kFirstSight).map()));
        builders_.erase(kFirstSight);
      }
    }
    return errors;
  }

 private:
  static constexpr const char* kFirstSight = "first sight";

  void drive(int from, int to) {
    const Mesh& mesh = options_.mesh;
    const MeasuredRoute measured =
        measure_route(mesh.displacement(from, to),
                      {options_.odometry_error, options_.compass_error}, error_random_);
    const Traversal traversal{measured.displacement, measured.covariance};
    reckoned_ += measured.displacement;

    const std::string name = landmark_name(mesh, to);
    if (!averages_.find(name)) averages_.add_landmark(name, reckoned_);
    const int a = *averages_.find(landmark_name(mesh, from));
    const int route = averages_.add_traversal(a, *averages_.find(name), traversal);
    if (averages_.route(route).traversals == 1) raw_.push_back(averages_.route(route).displacement);
    for (auto& [method, builder] : builders_) builder.arrive(name, traversal);
  }

  /// A route's vector in the mesh's direction, out of per-route vectors in the averages' order.
  template <class Vector>
  [[nodiscard]] std::function<Vector2(const MeshRoute&)> by_mesh(const Vector& vector) const {
    return [this, vector](const MeshRoute& of) -> Vector2 {
      const int a = *averages_.find(landmark_name(options_.mesh, of.from));
      const int b = *averages_.find(landmark_name(options_.mesh, of.to));
      const int number = *averages_.route_between(a, b);
      const Vector2 found = vector(number);
      return averages_.route(number).source == a ? found : Vector2(-found);
    };
  }

  MethodErrors errors_now() {
    const Mesh& mesh = options_.mesh;
    MethodErrors errors;
    errors["raw"] = route_errors(mesh, by_mesh([this](int k) { return raw_[idx(k)]; }));
    errors["weighted_average"] =
        route_errors(mesh, by_mesh([this](int k) { return averages_.route(k).mean_vector(); }));
    errors["dead_reckoning"] = map_errors(mesh, positions_by_mesh(mesh, averages_));
    errors["adjustment"] = map_errors(mesh, positions_by_mesh(mesh, adjust_linear(averages_).map));
    for (const auto& [method, builder] : builders_) {
      if (method != kFirstSight) {
        errors[method] = map_errors(mesh, positions_by_mesh(mesh, builder.map()));
      }
    }
    return errors;
  }

  const TourOptions& options_;
  std::mt19937_64 walk_random_;
  std::mt19937_64 error_random_;
  std::map<std::string, MapBuilder> builders_;
  LandmarkGraph averages_;    // positions: where dead reckoning first met the landmarks
  std::vector<Vector2> raw_;  // per route of averages_: its first traversal
  Vector2 reckoned_ = Vector2::Zero();
};

SeedMean seed_mean(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  SeedMean result;
  for (const double value : values) result.mean += value / n;
  double squares = 0.0;
  for (const double value : values) squares += std::pow(value - result.mean, 2);
  if (n > 1.0) result.standard_error = std::sqrt(squares / (n - 1.0) / n);
  return result;
}

TourMetrics metrics_of(const std::vector<Errors>& errors) {
  std::vector<double> stretch;
  std::vector<double> orientation;
  std::vector<double> position;
  for (const Errors& one : errors) {
    stretch.push_back(one.stretch);
    orientation.push_back(one.orientation);
    if (one.position) position.push_back(*one.position);
  }
  TourMetrics metrics{seed_mean(stretch), seed_mean(orientation), std::nullopt};
  if (!position.empty()) metrics.position_error = seed_mean(position);
  return metrics;
}

void check(const TourOptions& options) {
  if (options.tours < 1 || options.seeds < 1) {
    throw std::invalid_argument("the experiment needs a tour and a seed at least");
  }
  if (!(options.odometry_error > 0.0) || !(options.compass_error > 0.0)) {
    throw std::invalid_argument("the odometry and compass errors must be above 0");
  }
}

}  // namespace

std::vector<SeedErrors> run_tour_seeds(const TourOptions& options, const std::vector<int>& seeds) {
  check(options);
  std::vector<SeedErrors> results(seeds.size());
  std::mutex reporting;
  int done = 0;
  parallel_for(seeds.size(), [&](std::size_t k) {
    const auto seed = static_cast<std::uint64_t>(seeds[k]);
    results[k] = SeedRun(options, options.first_seed + seed).run();
    const std::scoped_lock lock(reporting);
    ++done;
    if (options.seeds_done) options.seeds_done(done);
  });
  return results;
}

const std::vector<std::string>& tour_methods() {
  static const std::vector<std::string> names{
      "raw",     "dead_reckoning", "weighted_average", "elastic_printed",
      "elastic", "gauss_markov",   "adjustment"};
  return names;
}

TourResult run_tours(const TourOptions& options) {
  check(options);
  std::vector<int> all(idx(options.seeds));
  std::iota(all.begin(), all.end(), 0);
  return average_tours(run_tour_seeds(options, all));
}

TourResult average_tours(const std::vector<SeedErrors>& seeds) {
  if (seeds.empty()) throw std::invalid_argument("the experiment needs a seed at least");
  const auto over_seeds = [&seeds](const std::function<Errors(const SeedErrors&)>& pick) {
    std::vector<Errors> errors;
    errors.reserve(seeds.size());
    for (const SeedErrors& seed : seeds) errors.push_back(pick(seed));
    return metrics_of(errors);
  };
  TourResult result;
  for (std::size_t tour = 0; tour < seeds.front().tours.size(); ++tour) {
    MethodMetrics metrics;
    for (const std::string& method : tour_methods()) {
      metrics[method] =
          over_seeds([&](const SeedErrors& seed) { return seed.tours[tour].at(method); });
    }
    result.tours.push_back(std::move(metrics));
  }
  result.first_sight_before =
      over_seeds([](const SeedErrors& seed) { return seed.first_sight_before; });
  result.first_sight_after =
      over_seeds([](const SeedErrors& seed) { return seed.first_sight_after; });
  return result;
}

}  // namespace trussmap
