// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "ceres_rivals.hpp"
#include "geometry/index.hpp"
#include "grid_input.hpp"
#include "linalg/dissection.hpp"
#include "measure.hpp"
#include "parts.hpp"
#include "truss/measured_truss.hpp"

#include <numeric>

#include <fmt/format.h>

namespace trussmap::bench {
using namespace truss;
using namespace linalg;
namespace {

double chi_squared(const Grid& grid, const std::vector<Vector2>& positions) {
  double chi2 = 0.0;
  for (const RawMeasurement& one : grid.measurements) {
    const Vector2 off = positions[idx(one.j)] - positions[idx(one.i)] - one.displacement;
    chi2 += off.dot(one.information * off);
  }
  return chi2;
}

MeasuredTruss inserted(const Grid& grid) {
  MeasuredTruss truss;
  for (const Vector2& about : grid.about) truss.add_joint(about);
  for (const RawMeasurement& one : grid.measurements) {
    truss.add(one.i, one.j, one.displacement, one.information);
  }
  return truss;
}

double with_trussmap(const Grid& grid, Kernel kernel, Stages& stages) {
  MeasuredTruss truss = inserted(grid);
  stages.end("insert");
  const MeasuredTruss::Fit fit = truss.fit(kernel);
  stages.end("fit");
  return fit.chi2;
}

/// What anybody would write first: a triplet for every entry of every measurement.
double with_bare_cholmod(const Grid& grid, Ordering ordering, bool factor_again, Stages& stages) {
  std::vector<Eigen::Triplet<double, int>> entries;
  entries.reserve(10 * grid.measurements.size());
  const auto unknowns = 2 * (static_cast<Eigen::Index>(grid.about.size()) - 1);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(unknowns);
  for (const RawMeasurement& one : grid.measurements) {
    const int i = 2 * (one.i - 1);
    const int j = 2 * (one.j - 1);
    const Vector2 force = one.information * one.displacement;
    for (int c = 0; c < 2; ++c) {
      for (int r = c; r < 2; ++r) {
        if (i >= 0) entries.emplace_back(i + r, i + c, one.information(r, c));
        entries.emplace_back(j + r, j + c, one.information(r, c));
      }
      for (int r = 0; r < 2 && i >= 0; ++r) {
        entries.emplace_back(j + r, i + c, -one.information(r, c));
      }
    }
    if (i >= 0) b.segment<2>(i) -= force;
    b.segment<2>(j) += force;
  }
  stages.end("insert");
  SparseMatrix A(unknowns, unknowns);
  A.setFromTriplets(entries.begin(), entries.end());
  stages.end("assemble");
  SparseCholesky cholesky(ordering);
  cholesky.analyse(A);
  stages.end("analyse");
  cholesky.factorise(A);
  stages.end("factorise");
  const Eigen::VectorXd x = cholesky.solve(b);
  stages.end("solve");
  if (factor_again) return cholesky.factor_nonzeros();
  std::vector<Vector2> positions(grid.about.size(), Vector2::Zero());
  for (std::size_t k = 1; k < positions.size(); ++k) {
    positions[k] = x.segment<2>(2 * static_cast<Eigen::Index>(k) - 2);
  }
  return chi_squared(grid, positions);
}

/// The stages inside MeasuredTruss::fit, with any order and kernel; covariances as well.
double stage_by_stage(const Grid& grid, Kernel kernel, bool by_coordinates, Stages& stages) {
  std::vector<NodePair> pairs;
  std::vector<Matrix2> stiffness;
  {  // merged already
    const std::size_t n = grid.about.size();
    std::vector<std::vector<std::pair<int, int>>> known(n);
    for (const RawMeasurement& one : grid.measurements) {
      auto& at = known[idx(one.i)];
      auto found = at.begin();
      while (found != at.end() && found->first != one.j) ++found;
      if (found == at.end()) {
        at.emplace_back(one.j, static_cast<int>(pairs.size()));
        pairs.push_back({one.i, one.j});
        stiffness.push_back(one.information);
      } else {
        stiffness[idx(found->second)] += one.information;
      }
    }
  }
  stages.end("(merge)");
  const std::vector<int> order =
      by_coordinates ? dissection_order(grid.about, pairs)
                     : elimination_order(static_cast<int>(grid.about.size()), pairs);
  stages.end("order");
  std::vector<int> sizes(grid.about.size(), 2);
  sizes[0] = 0;
  BlockSystem K(sizes, pairs, order, kernel);
  stages.end("analyse");
  for (std::size_t bar = 0; bar < pairs.size(); ++bar) {
    K.add_diagonal(pairs[bar][0], stiffness[bar]);
    K.add_diagonal(pairs[bar][1], stiffness[bar]);
    K.add_coupling(static_cast<int>(bar), Matrix2(-stiffness[bar]));
  }
  stages.end("assemble");
  K.factorise();
  stages.end("factorise");
  K.factorise();
  stages.end("factorise-again");
  Eigen::VectorXd x = Eigen::VectorXd::Ones(K.unknowns());
  K.solve_in_place(x);
  stages.end("solve");
  const Eigen::MatrixXd blocks = K.inverse_blocks();
  stages.end("covariances");
  return blocks.sum();
}

}  // namespace

void grid_part(const std::vector<int>& sides, int repetitions, bool ceres) {
  for (const int side : sides) {
    const Grid grid = make_grid(side, 5, 1);
    const int rounds = side >= 1000 ? 1 : repetitions;
    fmt::print("\nGrid {0} x {0}: {1} raw measurements (ms of processor time, least of {2})\n",
               side, grid.measurements.size(), rounds);
    std::vector<Rival> rivals{
        {"bare Eigen + CHOLMOD, default",
         [&](Stages& s) { return with_bare_cholmod(grid, Ordering::automatic, false, s); }},
        {"trussmap", [&](Stages& s) { return with_trussmap(grid, Kernel::frontal, s); }},
        {"trussmap on CHOLMOD's kernel",
         [&](Stages& s) { return with_trussmap(grid, Kernel::cholmod, s); }}};
    if (side < 1000) {
      rivals.push_back({"bare CHOLMOD, METIS", [&](Stages& s) {
                          return with_bare_cholmod(grid, Ordering::metis, false, s);
                        }});
    }
    if (ceres && side < 1000) {
      rivals.push_back({"Ceres", [&](Stages& s) { return fit_with_ceres(grid, s); }});
    }
    const std::vector<Run> runs = race(rivals, rounds);
    print(rivals, runs);
    const double bare = runs[0].stages.total();
    verdict("total over bare CHOLMOD", runs[1].stages.total() / bare, side >= 1000 ? 0.85 : 0.75);
    if (ceres && side < 1000)
      verdict("total over Ceres", runs[1].stages.total() / runs.back().stages.total(), 0.35);
    verdict("memory over bare CHOLMOD", runs[1].megabytes / runs[0].megabytes, 1.0);
    if (side >= 1000) continue;

    const std::vector<Rival> inside{
        {"own kernel, coordinates",
         [&](Stages& s) { return stage_by_stage(grid, Kernel::frontal, true, s); }},
        {"own kernel, AMD",
         [&](Stages& s) { return stage_by_stage(grid, Kernel::frontal, false, s); }},
        {"CHOLMOD, coordinates",
         [&](Stages& s) { return stage_by_stage(grid, Kernel::cholmod, true, s); }},
    };
    const std::vector<Run> details = race(inside, rounds);
    print(inside, details);
    const auto& own = details[0].stages;
    verdict("all covariances over the factorisation", own.of("covariances") / own.of("factorise"),
            1.5);
    verdict("the same over a repeated factorisation",
            own.of("covariances") / own.of("factorise-again"), 1.5);
    fmt::print(
        "  factorisation: own kernel {:.2f} of CHOLMOD's on the same order, {:.2f} of bare\n",
        own.of("factorise") / details[2].stages.of("factorise"),
        own.of("factorise") / runs[0].stages.of("factorise"));
  }
}

}  // namespace trussmap::bench
