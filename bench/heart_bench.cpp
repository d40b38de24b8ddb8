// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How good elastic maps are beside least squares of everything, and beside dead reckoning, on
// worlds of all sizes: the chain as a robot has it, tour by tour (tour_experiment.hpp).
//
//   meshes      the default, beside gauss_markov; postulated errors and wheels
//   scales      a few nearest landmarks, then groups at every scale
//   alone       a quarter of the landmarks alone, beside all of them: the paper's claim on eta
//   no_compass  wheels alone, after alignment, beside the batch adjustment
#include "scale/measure.hpp"
#include "trussmap/tour_experiment.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace trussmap::bench {
namespace {

using Kind = RefinementScope::Kind;
using Tours = std::vector<MethodMetrics>;

struct Errors {
  double odometry;  ///< mean, of the stretch
  double compass;   ///< mean, rad
};
constexpr Errors kErrors[] = {{0.05, 0.03},   {0.08, 0.08}, {0.10, 0.02},
                              {0.02, 0.0035}, {0.01, 0.03}, {0.001, 0.03}};

double position(const MethodMetrics& tour, const std::string& method) {
  return tour.at(method).position_error.value().mean;
}

/// The largest of one method's errors over another's, from tour 3 on.
double largest_ratio(const Tours& tours, const std::string& method, const std::string& other) {
  double largest = 0.0;
  for (std::size_t k = 2; k < tours.size(); ++k) {
    largest = std::max(largest, position(tours[k], method) / position(tours[k], other));
  }
  return largest;
}

/// The same beside dead reckoning, after any tour but the first of any seed.
double beside_reckoning(const std::vector<SeedErrors>& seeds) {
  double largest = 0.0;
  for (const SeedErrors& seed : seeds) {
    for (std::size_t k = 1; k < seed.tours.size(); ++k) {
      largest = std::max(largest, seed.tours[k].at("elastic").position.value() /
                                      seed.tours[k].at("dead_reckoning").position.value());
    }
  }
  return largest;
}

std::vector<SeedErrors> all_seeds(const TourOptions& options) {
  std::vector<int> numbers;
  for (int k = 0; k < options.seeds; ++k) numbers.push_back(k);
  return run_tour_seeds(options, numbers);
}

/// Of this spacing, m, or uneven.
Mesh mesh_of(int side, bool uneven, double spacing, std::uint64_t seed) {
  if (!uneven) return even_mesh({side, side}, spacing);
  std::mt19937_64 random(seed);
  const std::vector<double> x = random_lines(side, 1.0, 10.0, random);
  return mesh_of_lines(x, random_lines(side, 1.0, 10.0, random));
}

/// What is left of an error after tour 3: of the elastic map, and of the optimal one, which says
/// what the measurements can give.
void measure_rest(const std::string& error, const Tours& tours, SeedMean TourMetrics::*which) {
  const auto left = [&](const std::string& method) {
    return (tours[2].at(method).*which).mean / (tours.front().at("raw").*which).mean;
  };
  verdict(
      fmt::format("{} of tour 3 over before (gauss_markov: {:.3f})", error, left("gauss_markov")),
      left("elastic"), 0.5);
}

void measure_world(const std::string& name, const TourOptions& options) {
  const std::vector<SeedErrors> seeds = all_seeds(options);
  const Tours tours = average_tours(seeds).tours;
  fmt::print("{}, {} seeds\n", name, options.seeds);
  verdict("over gauss_markov, from tour 3 on", largest_ratio(tours, "elastic", "gauss_markov"),
          1.1);
  measure_rest("sigma", tours, &TourMetrics::stretch_error);
  measure_rest("rho", tours, &TourMetrics::orientation_error);
  verdict("over dead reckoning, after tour 1, any seed", beside_reckoning(seeds), 1.0);
}

void measure_meshes(const std::vector<int>& sides, int seeds, std::uint64_t first_seed) {
  for (const int side : sides) {
    for (const bool uneven : {false, true}) {
      TourOptions options;
      options.mesh = mesh_of(side, uneven, 1.0, first_seed);
      options.first_seed = first_seed;
      options.seeds = std::max(1, std::min(seeds, seeds * 36 / (side * side)));
      options.tours = 4;
      const std::string world = fmt::format("\n{0} x {0}, {1}", side, uneven ? "uneven" : "even");
      for (const Errors& errors : kErrors) {
        options.odometry_error = errors.odometry;
        options.compass_error = errors.compass;
        measure_world(fmt::format("{}, {} and {} rad", world, errors.odometry, errors.compass),
                      options);
      }
      options.compass_error = 0.03;
      for (const double noise : {0.001, 0.003}) {
        options.wheels = TourWheels{.noise = noise};
        measure_world(fmt::format("{}, wheels {}", world, noise), options);
      }
    }
  }
}

void measure_scales(int seeds, std::uint64_t first_seed) {
  struct Size {
    int side, eta, share;
  };
  for (const Size& size : {Size{8, 25, 1}, Size{20, 50, 8}, Size{30, 50, 24}}) {
    TourOptions options;
    options.mesh = even_mesh({size.side, size.side}, 1.0);
    options.scope = {Kind::nearest, size.eta, true};
    options.first_seed = first_seed;
    options.seeds = std::max(1, seeds / size.share);
    options.tours = 3;
    for (const Errors& errors : kErrors) {
      options.odometry_error = errors.odometry;
      options.compass_error = errors.compass;
      const double limit = size.side < 30 ? 1.3 : errors.odometry < 0.005 ? 4.0 : 1.5;
      verdict(fmt::format("{0} x {0}, eta {1} at every scale, {2} and {3} rad, over gauss_markov",
                          size.side, size.eta, errors.odometry, errors.compass),
              largest_ratio(run_tours(options).tours, "elastic", "gauss_markov"), limit);
    }
  }
}

void measure_alone(int seeds, std::uint64_t first_seed) {
  TourOptions options;
  options.mesh = even_mesh({6, 6}, 1.0);
  options.first_seed = first_seed;
  options.seeds = seeds;
  for (int k = 0; k < 3; ++k) {
    options.odometry_error = kErrors[k].odometry;
    options.compass_error = kErrors[k].compass;
    options.scope = {Kind::nearest, 9, false};
    const Tours alone = run_tours(options).tours;
    options.scope = {Kind::all};
    const Tours all = run_tours(options).tours;
    for (const int tour : {3, 5, 10, 20}) {
      const auto sigma = [tour](const Tours& tours) {
        return tours[static_cast<std::size_t>(tour - 1)].at("elastic").stretch_error.mean;
      };
      verdict(fmt::format("6 x 6, eta 9 alone, {} and {} rad, sigma of tour {} over eta all",
                          options.odometry_error, options.compass_error, tour),
              sigma(alone) / sigma(all), tour == 3 ? 1.15 : 1.1);
    }
  }
}

void measure_without_compass(int worlds, std::uint64_t first_seed) {
  std::vector<double> by_default;
  std::vector<double> by_scales;
  double beside = 0.0;
  for (int k = 0; k < worlds; ++k) {
    std::mt19937_64 random(first_seed + static_cast<std::uint64_t>(k));
    const int side = 5 + static_cast<int>(random() % 6);
    TourOptions options;
    options.wheels =
        TourWheels{.noise = random() % 2 == 0 ? 0.001 : 0.003, .readings = CompassReadings::none};
    options.mesh = mesh_of(side, k % 2 == 1, 5.0, random());
    options.first_seed = first_seed + static_cast<std::uint64_t>(k);
    options.seeds = 1;
    options.tours = 4;
    for (const bool scales : {false, true}) {
      if (scales) options.scope = {Kind::nearest, 16, true};
      const std::vector<SeedErrors> seeds = all_seeds(options);
      (scales ? by_scales : by_default)
          .push_back(largest_ratio(average_tours(seeds).tours, "elastic", "adjustment"));
      beside = std::max(beside, beside_reckoning(seeds));
    }
  }
  fmt::print("\nNo compass, {} worlds of 5 x 5 to 10 x 10\n", worlds);
  verdict("default over batch, 95 % of the worlds", percentile(by_default, 0.95), 1.5);
  verdict("eta 16 at every scale over batch, 95 %", percentile(by_scales, 0.95), 1.7);
  verdict("over dead reckoning, after tour 1, any world", beside, 1.0);
}

}  // namespace
}  // namespace trussmap::bench

int main(int argc, char** argv) {
  using namespace trussmap;
  try {
    CLI::App app("Elastic maps beside least squares and dead reckoning");
    std::vector<std::string> parts{"meshes", "scales", "alone", "no_compass"};
    std::vector<int> sides{6, 12, 20, 30};
    int seeds = 24;
    int worlds = 200;
    std::uint64_t first_seed = 1;
    app.add_option("parts", parts, "which parts")
        ->check(CLI::IsMember({"meshes", "scales", "alone", "no_compass"}));
    app.add_option("--sides", sides, "of the meshes")->check(CLI::Range(3, 100));
    app.add_option("--seeds", seeds, "of a mesh of 6 x 6; larger ones get fewer")
        ->check(CLI::PositiveNumber);
    app.add_option("--worlds", worlds, "without a compass")->check(CLI::PositiveNumber);
    app.add_option("--first-seed", first_seed, "of all");
    CLI11_PARSE(app, argc, argv);
    for (const std::string& part : parts) {
      if (part == "meshes") bench::measure_meshes(sides, seeds, first_seed);
      if (part == "scales") bench::measure_scales(seeds, first_seed);
      if (part == "alone") bench::measure_alone(seeds, first_seed);
      if (part == "no_compass") bench::measure_without_compass(worlds, first_seed);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
