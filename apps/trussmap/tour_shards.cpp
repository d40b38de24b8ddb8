// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "tour_shards.hpp"

#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace trussmap::app {
namespace {

using Json = nlohmann::ordered_json;

Json errors_json(const MapErrors& errors) {
  Json result = {errors.stretch, errors.orientation};
  if (errors.position) result.push_back(*errors.position);
  return result;
}

MapErrors errors_of(const Json& json) {
  MapErrors errors{json.at(0).get<double>(), json.at(1).get<double>(), std::nullopt};
  if (json.size() > 2) errors.position = json.at(2).get<double>();
  return errors;
}

std::string seed_json(const SeedErrors& seed) {
  Json tours = Json::array();
  for (const auto& methods : seed.tours) {
    Json tour;
    for (const auto& [name, errors] : methods) tour[name] = errors_json(errors);
    tours.push_back(tour);
  }
  return Json{{"tours", tours},
              {"before", errors_json(seed.first_sight_before)},
              {"after", errors_json(seed.first_sight_after)}}
      .dump();
}

SeedErrors seed_of(const Json& json) {
  SeedErrors seed;
  for (const Json& tour : json.at("tours")) {
    std::map<std::string, MapErrors> methods;
    for (const auto& [name, errors] : tour.items()) methods.emplace(name, errors_of(errors));
    seed.tours.push_back(std::move(methods));
  }
  seed.first_sight_before = errors_of(json.at("before"));
  seed.first_sight_after = errors_of(json.at("after"));
  return seed;
}

Json mesh_json(const Mesh& mesh) {
  Json places = Json::array();
  for (const Vector2& place : mesh.positions) places.push_back({place.x(), place.y()});
  return places;
}

Json wheels_json(const TourOptions& options) {
  if (!options.wheels) return nullptr;
  return {options.wheels->noise, options.wheels->wheelbase,
          static_cast<int>(options.wheels->readings)};
}

}  // namespace

std::string tour_settings(const TourOptions& options, const std::string& world) {
  return Json{
      {"version", TRUSSMAP_VERSION},
      {"world", world},
      {"tours", options.tours},
      {"seeds", options.seeds},
      {"first_seed", options.first_seed},
      {"odometry_error", options.odometry_error},
      {"compass_error", options.compass_error},
      {"scope", {static_cast<int>(options.scope.kind), options.scope.eta, options.scope.groups}},
      {"law", options.law ? static_cast<int>(*options.law) : -1},
      {"wheels", wheels_json(options)},
      {"aligned", errors_are_aligned(options)},
      {"mesh", mesh_json(options.mesh)}}
      .dump();
}

ShardResults run_tour_shard(const TourOptions& options, const std::string& settings,
                            const Shard& shard) {
  ShardResults results{kTourProgram, settings, shard, static_cast<std::size_t>(options.seeds), {}};
  std::vector<int> seeds;
  for (std::size_t k = 0; k < results.trials; ++k) {
    if (shard.has(k)) seeds.push_back(static_cast<int>(k));
  }
  const std::vector<SeedErrors> errors = run_tour_seeds(options, seeds);
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    results.results.emplace(static_cast<std::size_t>(seeds[k]), seed_json(errors[k]));
  }
  return results;
}

void show_tour_run(const ShardResults& whole, TourOutput output) {
  std::vector<SeedErrors> seeds;
  for (const auto& [trial, result] : whole.results) seeds.push_back(seed_of(Json::parse(result)));
  const Json settings = Json::parse(whole.settings);
  output.world = settings.at("world").get<std::string>();
  output.seeds = settings.at("seeds").get<int>();
  output.aligned = settings.value("aligned", false);
  show_tours(average_tours(seeds), output);
}

}  // namespace trussmap::app
