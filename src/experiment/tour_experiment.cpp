// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/tour_experiment.hpp"

#include "experiment/tour_robot.hpp"
#include "geometry/index.hpp"
#include "map/linear_truss.hpp"
#include "parallel/parallel_for.hpp"
#include "trussmap/error.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>

namespace trussmap {
using namespace experiment;

namespace {

using Errors = MapErrors;
using MethodErrors = std::map<std::string, MapErrors>;

/// Errors of routes whose vectors (from -> to of the mesh) are given; they have no positions.
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

LandmarkPositions truth_of(const Mesh& mesh) {
  LandmarkPositions truth;
  for (int k = 0; k < mesh.landmarks(); ++k) {
    truth[landmark_name(mesh, k)] = mesh.positions[idx(k)];
  }
  return truth;
}

/// One seed's robot and all the maps it builds.
class SeedRun {
 public:
  SeedRun(const TourOptions& options, std::uint64_t seed, bool shows_maps)
      : options_(options),
        shows_maps_(shows_maps && options.maps != nullptr),
        laid_(errors_are_aligned(options) ? Laid::aligned : Laid::as_it_is),
        truth_(truth_of(options.mesh)),
        walk_random_(random_stream(seed, Stream::walk)),
        robot_(options, seed) {
    for (const Method method : {Method::elastic_printed, Method::elastic, Method::gauss_markov}) {
      MapBuilderOptions builder;
      builder.method = method;
      builder.scope = options.scope;
      // As the paper has it: all landmarks, with the first held.
      const bool automatic = options.scope.kind == RefinementScope::Kind::automatic;
      if (method == Method::elastic_printed && automatic) {
        builder.scope.kind = RefinementScope::Kind::all;
      }
      if (method == Method::elastic) builder.law = options.law;
      builder.pooled = true;
      builder.gate = std::numeric_limits<double>::infinity();
      builders_.emplace(name_of(method), MapBuilder(builder));
    }
    MapBuilderOptions only_first_sight;
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
      robot_.begin_tour();
      for (; step < end; ++step) drive(tours.walk[step], tours.walk[step + 1]);
      errors.tours.push_back(errors_now(static_cast<int>(errors.tours.size()) + 1));
      if (errors.tours.size() == 1) {
        errors.first_sight_before = errors.tours.back().at("raw");
        const LandmarkGraph map = builders_.at(kFirstSight).map();
        errors.first_sight_after = errors_of(map);
        show("first_sight", 1, map, errors.first_sight_after);
        builders_.erase(kFirstSight);
      }
    }
    return errors;
  }

 private:
  static constexpr const char* kFirstSight = "first sight";

  [[nodiscard]] Errors errors_of(const LandmarkGraph& map) const {
    return map_errors(map, truth_, laid_);
  }

  void drive(int from, int to) {
    const Mesh& mesh = options_.mesh;
    const TourLeg leg = robot_.drive(mesh.displacement(from, to));
    reckoned_ += leg.in_map.displacement;
    const std::string name = landmark_name(mesh, to);
    if (!averages_.find(name)) averages_.add_landmark(name, reckoned_);
    const int a = *averages_.find(landmark_name(mesh, from));
    const int route = averages_.add_traversal(a, *averages_.find(name), leg.in_map);
    if (averages_.route(route).traversals == 1) raw_.push_back(averages_.route(route).displacement);
    for (auto& [method, builder] : builders_) {
      if (lost_.contains(method)) continue;
      try {
        take(builder, name, leg);
      } catch (const SolveError&) {
        if (method != name_of(Method::elastic_printed)) throw;
        lost_.insert(method);  // it has diverged beyond all numbers: its last map stays
      }
    }
    if (leg.motion) graph_.add(landmark_name(mesh, from), name, *leg.motion, leg.reading);
  }

  static void take(MapBuilder& builder, const std::string& name, const TourLeg& leg) {
    if (leg.reading) builder.compass(leg.reading->heading, std::sqrt(leg.reading->variance));
    if (leg.motion) {
      builder.arrive(name, *leg.motion);
    } else {
      builder.arrive(name, leg.in_map);
    }
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

  MethodErrors errors_now(int tour) {
    const Mesh& mesh = options_.mesh;
    MethodErrors errors;
    errors["raw"] = route_errors(mesh, by_mesh([this](int k) { return raw_[idx(k)]; }));
    errors["weighted_average"] =
        route_errors(mesh, by_mesh([this](int k) { return averages_.route(k).mean_vector(); }));
    errors["dead_reckoning"] = errors_of(averages_);
    std::map<std::string, LandmarkGraph> maps;
    maps["adjustment"] =
        graph_.empty() ? map::adjust_linear(averages_).map : graph_.adjusted(averages_);
    for (const auto& [method, builder] : builders_) {
      if (method != kFirstSight) maps[method] = builder.map();
    }
    for (const auto& [method, map] : maps) {
      errors[method] = errors_of(map);
      show(method, tour, map, errors.at(method));
    }
    show("dead_reckoning", tour, averages_, errors.at("dead_reckoning"));
    return errors;
  }

  void show(const std::string& method, int tour, const LandmarkGraph& map,
            const Errors& of_map) const {
    if (!shows_maps_ || std::ranges::count(options_.maps_after, tour) == 0) return;
    TourMap shown{method, tour, map, of_map, laid_, truth_, {}};
    for (int k = 0; k < averages_.routes(); ++k) {
      const Vector2& from = averages_.landmark(averages_.route(k).source).position;
      shown.measured.emplace_back(from, from + raw_[idx(k)]);
    }
    options_.maps(shown);
  }

  const TourOptions& options_;
  bool shows_maps_;
  Laid laid_;
  LandmarkPositions truth_;
  std::mt19937_64 walk_random_;
  TourRobot robot_;
  std::map<std::string, MapBuilder> builders_;
  std::set<std::string> lost_;  // builders that have diverged
  LandmarkGraph averages_;      // positions: where dead reckoning first met the landmarks
  std::vector<Vector2> raw_;    // per route of averages_: its first traversal
  Vector2 reckoned_ = Vector2::Zero();
  TourGraph graph_;  // of legs by wheels
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
  if (options.wheels && (!(options.wheels->noise > 0.0) || !(options.wheels->wheelbase > 0.0))) {
    throw std::invalid_argument("the noise and the distance of the wheels must be above 0");
  }
}

}  // namespace

CompassReadings parse_compass_readings(std::string_view name) {
  if (name == "none") return CompassReadings::none;
  if (name == "tour") return CompassReadings::tour;
  if (name == "landmark") return CompassReadings::landmark;
  if (name == "row") return CompassReadings::row;
  throw std::invalid_argument("'" + std::string(name) +
                              "' is no rate of compass readings, expected none, tour, landmark or "
                              "row");
}

bool errors_are_aligned(const TourOptions& options) {
  return options.wheels && options.wheels->readings == CompassReadings::none;
}

std::vector<SeedErrors> run_tour_seeds(const TourOptions& options, const std::vector<int>& seeds) {
  check(options);
  std::vector<SeedErrors> results(seeds.size());
  std::mutex reporting;
  int done = 0;
  parallel::parallel_for(seeds.size(), [&](std::size_t k) {
    const auto seed = static_cast<std::uint64_t>(seeds[k]);
    results[k] = SeedRun(options, options.first_seed + seed, seeds[k] == 0).run();
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
