// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// The elastic paper's experiment: a robot tours a mesh again and again, every method builds its map
// from the same measurements, and after each tour the maps are compared with the truth.
//
//   stretch_error      sigma: mean over routes of |s_map - s|/s
//   orientation_error  rho: mean over routes of |theta_map - theta|                    rad
//   position_error     mean distance of the landmarks from the truth, the first left out   m
//
//   raw               single measurements, the first of each route
//   dead_reckoning    positions where the landmarks were first met, never corrected
//   weighted_average  each route's own means; it has no positions
//   elastic_printed   the paper's two phases as printed; where it diverges beyond all numbers, its
//                     last map stays
//   elastic           refinement by relaxation, within a scope (map_builder.hpp)
//   gauss_markov      the same with stiffness 1/variance, of the whole map
//   adjustment        least squares of everything at once: of routes' means; from wheels of all
//                     poses and landmarks (pose_graph.hpp)
//
// What a traversal measures comes with errors of the paper's sizes, in map axes, or from simulated
// wheels: the chain as a robot has it, from wheels to map. Without a compass the map's axes are
// those of the robot's first heading: errors are then after the best rotation and translation.
//
// Golfarelli, Maio & Rizzi (1998), section 4. A seed's walk and measurements are shared by all
// methods, and do not depend on how many seeds or threads there are.
#pragma once

#include "trussmap/error.hpp"
#include "trussmap/map_builder.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/survey_comparison.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trussmap {

/// When a robot on wheels reads its compass.
enum class CompassReadings {
  none,      ///< it has none
  tour,      ///< once at the start of each tour
  landmark,  ///< once at each landmark, before it turns
  row        ///< at the end of each row of wheel travels
};

/// "none", "tour", "landmark" or "row"; std::invalid_argument on another name.
[[nodiscard]] CompassReadings parse_compass_readings(std::string_view name);

struct TourWheels {
  double noise = 0.003;     ///< k of both wheels, m^(1/2)
  double wheelbase = 0.34;  ///< m
  CompassReadings readings = CompassReadings::landmark;
};

/// One seed's errors, of all methods.
struct SeedErrors {
  std::vector<std::map<std::string, MapErrors>> tours;  ///< after tour 1, 2, ...
  MapErrors first_sight_before;
  MapErrors first_sight_after;
};

/// A map of the first seed, as a method has it after a tour.
struct TourMap {
  std::string method;  ///< of tour_methods(), or first_sight: by first sight alone, after tour 1
  int tour = 0;        ///< 1, 2, ...
  LandmarkGraph map;
  MapErrors errors;
  Laid laid = Laid::as_it_is;  ///< how it was compared with the truth
  LandmarkPositions truth;     ///< m
  /// Where the first traversal of each route led, and from where dead reckoning has its start, m.
  std::vector<std::pair<Vector2, Vector2>> measured;
};

struct TourOptions {
  Mesh mesh;
  WalkKind walk = WalkKind::euler;
  int tours = 20;
  std::uint64_t first_seed = 1;
  int seeds = 24;
  /// Mean absolute errors, as in the paper; standard deviations are sqrt(pi/2) times these.
  double odometry_error = 0.05;  ///< fraction of the stretch
  double compass_error = 0.03;   ///< rad
  /// Measurements from wheels, in place of `odometry_error`; `compass_error` is a reading's.
  std::optional<TourWheels> wheels = {};
  RefinementScope scope = {};            ///< of elastic and elastic_printed
  std::optional<StiffnessLaw> law = {};  ///< of elastic
  /// Gets the first seed's maps after each tour that `maps_after` lists. By one thread.
  std::function<void(const TourMap&)> maps = {};
  std::vector<int> maps_after = {};          ///< 1, 2, ...
  std::function<void(int)> seeds_done = {};  ///< called after each seed, by one thread at a time
};

/// Mean over the seeds, and its standard error.
struct SeedMean {
  double mean = 0.0;
  double standard_error = 0.0;
};

struct TourMetrics {
  SeedMean stretch_error;
  SeedMean orientation_error;              ///< rad
  std::optional<SeedMean> position_error;  ///< m, where the method has positions
};

using MethodMetrics = std::map<std::string, TourMetrics>;

struct TourResult {
  std::vector<MethodMetrics> tours;  ///< after tour 1, 2, ...
  TourMetrics first_sight_before;    ///< single measurements of the first tour
  TourMetrics first_sight_after;     ///< the map after first-sight correction alone, tour 1
};

/// Whether errors are after the best rotation and translation.
[[nodiscard]] bool errors_are_aligned(const TourOptions& options);

/// Names of the methods, in the order in which they are shown.
[[nodiscard]] const std::vector<std::string>& tour_methods();

/// Throws std::invalid_argument on options out of range.
[[nodiscard]] TourResult run_tours(const TourOptions& options);

/// The same in parts: errors of some of the seeds, which are numbered from 0 to options.seeds - 1,
/// and what the errors of all of them, in this order, come to. Throws like run_tours.
[[nodiscard]] std::vector<SeedErrors> run_tour_seeds(const TourOptions& options,
                                                     const std::vector<int>& seeds);
[[nodiscard]] TourResult average_tours(const std::vector<SeedErrors>& seeds);

// ----------------------------------------
// A run of many independent trials, done in shares: by the tasks of a job array, each of which
// leaves a file with what its trials came to, and by a last one that merges the files.
//
// A share keeps every trial's result by the trial's number, and nothing that is summed up: sums are
// taken when all results are there, in the order of the numbers. So the whole run's figures are the
// same, bit for bit, whatever the number of shares.

/// Share `number` of `of`, from 1.
struct Shard {
  int number = 1;
  int of = 1;

  /// Trials, numbered from 0, are dealt out one after the other.
  [[nodiscard]] bool has(std::size_t trial) const {
    return trial % static_cast<std::size_t>(of) == static_cast<std::size_t>(number - 1);
  }
};

/// Of "3/16". Throws std::invalid_argument on anything else.
[[nodiscard]] Shard parse_shard(std::string_view text);

struct ShardResults {
  std::string program;   ///< who made it and can merge it
  std::string settings;  ///< JSON: all that the results depend on
  Shard shard;
  std::size_t trials = 0;                      ///< of the whole run
  std::map<std::size_t, std::string> results;  ///< JSON, by the trial's number
};

/// As a file (JSON).
[[nodiscard]] std::string format_shard(const ShardResults& results);

/// The file again. Throws InputError where it is none, or lacks trials of its share.
[[nodiscard]] ShardResults parse_shard_results(std::string_view text, const std::string& name);

/// The whole run, as shard 1/1, of all its shares, by the names of their files, in any order.
/// Throws InputError where they are not of one run, and where shares are missing or there twice,
/// all of which it names.
[[nodiscard]] ShardResults merge_shards(
    const std::vector<std::pair<std::string, ShardResults>>& shares);

}  // namespace trussmap
