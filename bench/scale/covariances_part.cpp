// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// All covariances beside a repeated factorisation, and why the one cannot be had for the other's
// price. Operations (a multiplication or an addition is one) of a front that eliminates w unknowns
// above h remaining rows, terms of third order:
//
//   factor    L11 w^3/3,  L21 w^2 h,  L21 L21' w h^2
//   inverse   L11^-T L11^-1 2/3 w^3,  G = L21 L11^-1 w^2 h,  Z22 G 2 w h^2,  G' Z21 w^2 h
//
// where only a triangle of what is symmetric is computed: exactly twice as many, front by front.
#include "geometry/index.hpp"
#include "grid_input.hpp"
#include "linalg/block_system.hpp"
#include "linalg/dissection.hpp"
#include "linalg/front_kernels.hpp"
#include "measure.hpp"
#include "parts.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace trussmap::bench {
using namespace linalg;
namespace {

struct Work {
  double factor = 0.0;   ///< operations
  double inverse = 0.0;  ///< operations
  double bytes_factor = 0.0;
  double bytes_inverse = 0.0;
};

struct Rates {
  double factor = 0.0;   ///< s, kernels alone, all fronts
  double inverse = 0.0;  ///< s
};

std::vector<NodePair> routes_of(const Grid& grid) {
  std::vector<NodePair> pairs;
  for (const RawMeasurement& one : grid.measurements) {
    pairs.push_back({std::min(one.i, one.j), std::max(one.i, one.j)});
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// The fronts of BlockSystem with the first node held.
std::vector<Front> fronts_of(const std::vector<int>& order, const std::vector<NodePair>& pairs) {
  std::vector<int> place(order.size(), -1);
  int places = 0;
  for (const int node : order) {
    if (node > 0) place[idx(node)] = places++;
  }
  return plan_fronts(pattern_of(pairs, place, places), std::vector<int>(idx(places), 2)).fronts;
}

/// Numbers that go through memory at least once: a factorisation writes L and for every front
/// clears, sums, reads and gives up an update; an inverse reads L and fills and reads the whole
/// square of each front.
Work work_of(const std::vector<Front>& fronts) {
  Work work;
  for (const Front& front : fronts) {
    const double w = front.width;
    const double h = front.height;
    work.factor += w * w * w / 3.0 + w * w * h + w * h * h;
    work.bytes_factor += 8.0 * (2.0 * w * (w + h) + 3.0 * h * h);
    work.bytes_inverse += 8.0 * (2.0 * w * (w + h) + 2.0 * (w + h) * (w + h));
  }
  work.inverse = 2.0 * work.factor;
  return work;
}

/// The kernels alone, on fronts of these sizes.
Rates time_kernels(const std::vector<Front>& fronts) {
  Rates rates;
  std::vector<double> panel;
  std::vector<double> update;
  std::vector<double> inverse;
  std::vector<double> space;
  for (const Front& front : fronts) {
    const int rows = front.width + front.height;
    panel.assign(area(rows, front.width), 1e-3);
    for (int c = 0; c < front.width; ++c) panel[idx(at(c, c, rows))] = rows;
    update.assign(area(front.height, front.height), 1.0);
    inverse.assign(area(rows, rows), 1e-3);
    space.assign(std::max<std::size_t>(area(rows, front.width), 16), 0.0);
    const double begin = cpu_seconds();
    static_cast<void>(eliminate(panel.data(), rows, front.width, update.data()));
    const double between = cpu_seconds();
    invert_front(panel.data(), rows, front.width, inverse.data(), space.data());
    rates.factor += between - begin;
    rates.inverse += cpu_seconds() - between;
  }
  return rates;
}

/// Bytes per second, read and written, of a copy much larger than the caches.
double memory_speed() {
  const std::size_t count = std::size_t{1} << 25U;
  std::vector<double> from(count, 1.0);
  std::vector<double> to(count, 0.0);
  double least = 1e300;
  for (int round = 0; round < 3; ++round) {
    const double begin = cpu_seconds();
    std::copy(from.begin(), from.end(), to.begin());
    least = std::min(least, cpu_seconds() - begin);
    from[static_cast<std::size_t>(round)] += to[count / 2];
  }
  return 16.0 * static_cast<double>(count) / least;
}

}  // namespace

void covariances_part(const std::vector<int>& sides, int repetitions) {
  const double memory = memory_speed();
  for (const int side : sides) {
    if (side >= 1000) continue;
    const Grid grid = make_grid(side, 1, 1);
    const std::vector<NodePair> pairs = routes_of(grid);
    const std::vector<int> order = dissection_order(grid.about, pairs);
    std::vector<int> sizes(grid.about.size(), 2);
    sizes[0] = 0;
    BlockSystem K(sizes, pairs, order);
    for (std::size_t bar = 0; bar < pairs.size(); ++bar) {
      const Matrix2 one = Matrix2::Identity();
      K.add_diagonal(pairs[bar][0], one);
      K.add_diagonal(pairs[bar][1], one);
      K.add_coupling(static_cast<int>(bar), Matrix2(-one));
    }
    const std::vector<Front> fronts = fronts_of(order, pairs);
    const Work work = work_of(fronts);
    K.factorise();
    std::vector<double> factor;
    std::vector<double> inverse;
    std::vector<double> kernels_factor;
    std::vector<double> kernels_inverse;
    std::vector<double> ratios;
    for (int round = 0; round < repetitions; ++round) {
      const double begin = cpu_seconds();
      K.factorise();
      const double between = cpu_seconds();
      const Eigen::MatrixXd blocks = K.inverse_blocks();
      const double end = cpu_seconds();
      factor.push_back(between - begin);
      inverse.push_back(end - between);
      ratios.push_back(inverse.back() / factor.back());
      const Rates rates = time_kernels(fronts);
      kernels_factor.push_back(rates.factor);
      kernels_inverse.push_back(rates.inverse);
    }
    const auto line = [&](const char* what, double operations, double bytes,
                          const std::vector<double>& all, const std::vector<double>& kernels) {
      const double time = percentile(all, 0.5);
      const double kernel = percentile(kernels, 0.5);
      fmt::print(
          "  {:<9} {:8.1f} Mflop, {:7.2f} ms ({:5.2f} Gflop/s), kernels alone {:7.2f} ms ({:5.2f} "
          "Gflop/s); {:6.1f} MB, {:.2f} ms at the memory's {:.1f} GB/s\n",
          what, 1e-6 * operations, 1e3 * time, 1e-9 * operations / time, 1e3 * kernel,
          1e-9 * operations / kernel, 1e-6 * bytes, 1e3 * bytes / memory, 1e-9 * memory);
    };
    fmt::print("\nAll covariances, grid {0} x {0}: {1} fronts, medians of {2} in turn\n", side,
               fronts.size(), repetitions);
    line("factor", work.factor, work.bytes_factor, factor, kernels_factor);
    line("inverse", work.inverse, work.bytes_inverse, inverse, kernels_inverse);
    verdict("all covariances over a repeated factorisation", percentile(ratios, 0.5), 1.5);
  }
}

}  // namespace trussmap::bench
