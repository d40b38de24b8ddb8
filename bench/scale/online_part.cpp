// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/linear_truss.hpp"
#include "measure.hpp"
#include "parts.hpp"
#include "trussmap/map_builder.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include <Eigen/LU>
#include <fmt/format.h>

namespace trussmap::bench {
namespace {

/// Drives on a grid of `side` columns, landmarks named by their number row by row.
class Driver {
 public:
  Driver(const MapBuilderOptions& options, int side) : builder(options), side_(side) {
    builder.start(name(0));
  }

  Arrival drive(int to) {
    const int from = here;
    here = to;
    return builder.arrive(name(to), leg(from, to));
  }

  /// To any landmark of the map, by a session of its own.
  void put(int landmark) {
    builder.start(name(landmark));
    here = landmark;
  }

  MapBuilder builder;
  int here = 0;

 private:
  [[nodiscard]] static std::string name(int landmark) { return std::to_string(landmark); }

  Traversal leg(int from, int to) {
    const Vector2 along((to % side_) - (from % side_), (to / side_) - (from / side_));
    const Vector2 sd(0.05, 0.03);
    const Matrix2 axes = (Matrix2() << along.x(), -along.y(), along.y(), along.x()).finished();
    const Vector2 error = axes * Vector2(sd.x() * normal_(random_), sd.y() * normal_(random_));
    return {along + error, axes * sd.cwiseAbs2().asDiagonal() * axes.transpose()};
  }

  int side_;
  std::mt19937_64 random_{1};
  std::normal_distribution<double> normal_;
};

/// Every route of the grid: row after row, and on the way down to the row before and back.
void tour(int side, const std::function<void(int)>& drive_to) {
  for (int y = 0; y < side; ++y) {
    for (int k = 0; k < side; ++k) {
      const int x = y % 2 == 0 ? k : side - 1 - k;
      const int landmark = y * side + x;
      if (landmark > 0) drive_to(landmark);
      if (y > 0 && k > 0) {
        drive_to(landmark - side);
        drive_to(landmark);
      }
    }
  }
}

struct Times {
  double median = 0.0;  ///< us
  double late = 0.0;    ///< 99th percentile, us
};

/// Corrections at random places, what `before` does before each not counted.
Times time_corrections(Driver& driver, int side, int corrections,
                       const std::function<void()>& before) {
  std::mt19937_64 random(2);
  std::vector<double> times;
  for (int k = -corrections / 10; k < corrections; ++k) {
    const int place = static_cast<int>(random() % static_cast<unsigned>(side * side));
    driver.put(place);
    const int to = place % side + 1 < side ? place + 1 : place - 1;
    before();
    const double start = cpu_seconds();
    (void)driver.drive(to);
    if (k >= 0) times.push_back(1e6 * (cpu_seconds() - start));
  }
  return {percentile(times, 0.5), percentile(times, 0.99)};
}

/// Within a neighbourhood the cost of a correction must not grow with the map.
void refinement_of(const RefinementScope& scope, const std::vector<int>& landmarks,
                   int corrections) {
  MapBuilderOptions options{.scope = scope};
  Times first;
  std::vector<double> other(std::size_t{1} << 24U, 1.0);  // larger than the caches
  for (const int count : landmarks) {
    const int side = static_cast<int>(std::lround(std::sqrt(count)));
    Driver driver(options, side);
    MapBuilderOptions quick = options;
    quick.refine = false;  // only to have the map
    driver.builder.set_options(quick);
    const double begin = cpu_seconds();
    tour(side, [&](int landmark) { (void)driver.drive(landmark); });
    const double built = cpu_seconds() - begin;
    driver.builder.set_options(options);
    const Times times = time_corrections(driver, side, corrections, [] {});
    fmt::print("  {:>8} landmarks: median {:.1f}, 99th percentile {:.1f}; map built in {:.2f} s\n",
               side * side, times.median, times.late, built);
    if (first.median == 0.0) {
      first = times;
      const Times cold = time_corrections(driver, side, corrections / 5, [&] {
        for (double& number : other) number += 1.0;
      });
      fmt::print("    the same, its map and program no longer in the caches: {:.1f}, {:.1f}\n",
                 cold.median, cold.late);
    }
    if (count == landmarks.back()) {
      verdict("median over the smallest map's", times.median / first.median,
              scope.groups ? 3.0 : 1.2);
      verdict("99th percentile over the smallest map's", times.late / first.late,
              scope.groups ? 3.0 : 1.5);
      verdict("us", scope.groups ? times.late : times.median, scope.groups ? 3000.0 : 100.0);
    }
  }
}

}  // namespace

void refinement_part(const std::vector<int>& landmarks, int corrections) {
  using Kind = RefinementScope::Kind;
  fmt::print("\nRefinement, the 50 nearest alone (us of processor time per correction)\n");
  refinement_of({Kind::nearest, 50, false}, landmarks, corrections);
  fmt::print("\nThe same at every scale\n");
  refinement_of({Kind::nearest, 50, true}, landmarks, corrections);
}

/// Mean of the steps of a tour, ms.
double tour_in_steps(Driver& driver, int side, const std::string& what) {
  std::vector<double> times;
  tour(side, [&](int landmark) {
    const double start = cpu_seconds();
    (void)driver.drive(landmark);
    times.push_back(1e3 * (cpu_seconds() - start));
  });
  double sum = 0.0;
  for (const double time : times) sum += time;
  const double mean = sum / static_cast<double>(times.size());
  fmt::print(
      "\n{3}, {0} x {0} toured: {1} legs, mean {2:.3f} ms, median {4:.3f}, 99th percentile "
      "{5:.3f}, longest {6:.1f}\n",
      side, times.size(), mean, what, percentile(times, 0.5), percentile(times, 0.99),
      percentile(times, 1.0));
  verdict("99th percentile, ms", percentile(times, 0.99), 3.0);
  return mean;
}

void increments_part(int side) {
  Driver elastic({.scope = {RefinementScope::Kind::all}}, side);
  verdict("mean step, ms", tour_in_steps(elastic, side, "The equilibrium of all"), 0.6);
  MapBuilderOptions options;
  options.method = Method::gauss_markov;
  Driver driver(options, side);
  const double mean = tour_in_steps(driver, side, "The same by gauss_markov");

  const LandmarkGraph map = driver.builder.map();
  double chi2 = 0.0;
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    const Vector2 off = map.landmark(route.target).position - map.landmark(route.source).position -
                        route.displacement;
    chi2 += route.traversals * off.dot(route.covariance.inverse() * off);
  }
  const map::LinearAdjustment batch = map::adjust_linear(map);
  fmt::print("  chi2 {:.12g}, batch {:.12g}\n", chi2, batch.chi2);
  verdict("mean step, ms", mean, 0.6);
  verdict("difference of chi2 from the batch, relative, 1e-9",
          1e9 * std::abs(chi2 - batch.chi2) / batch.chi2, 1.0);
}

}  // namespace trussmap::bench
