// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Who factorises what: calls of CHOLMOD are counted by the linker (--wrap, tests/CMakeLists.txt).
#include "geometry/index.hpp"
#include "linalg/block_system.hpp"
#include "trussmap/map_builder.hpp"
#include "trussmap/truss.hpp"

#include <random>
#include <string>
#include <vector>

#include <cholmod.h>
#include <gtest/gtest.h>

namespace {

int analyses = 0;
int factorisations = 0;
int solutions = 0;

}  // namespace

extern "C" {

cholmod_factor* __real_cholmod_analyze(cholmod_sparse* a, cholmod_common* common);
int __real_cholmod_factorize(cholmod_sparse* a, cholmod_factor* factor, cholmod_common* common);
int __real_cholmod_solve2(int system, cholmod_factor* factor, cholmod_dense* b,
                          cholmod_sparse* rows, cholmod_dense** x, cholmod_sparse** x_rows,
                          cholmod_dense** y, cholmod_dense** e, cholmod_common* common);

cholmod_factor* __wrap_cholmod_analyze(cholmod_sparse* a, cholmod_common* common) {
  ++analyses;
  return __real_cholmod_analyze(a, common);
}

int __wrap_cholmod_factorize(cholmod_sparse* a, cholmod_factor* factor, cholmod_common* common) {
  ++factorisations;
  return __real_cholmod_factorize(a, factor, common);
}

int __wrap_cholmod_solve2(int system, cholmod_factor* factor, cholmod_dense* b,
                          cholmod_sparse* rows, cholmod_dense** x, cholmod_sparse** x_rows,
                          cholmod_dense** y, cholmod_dense** e, cholmod_common* common) {
  ++solutions;
  return __real_cholmod_solve2(system, factor, b, rows, x, x_rows, y, e, common);
}

}  // extern "C"

namespace trussmap::cholmod_calls_test {
namespace {

void count_anew() {
  analyses = factorisations = solutions = 0;
}

std::vector<Bar> grid_of(int side) {
  std::vector<Bar> bars;
  for (int k = 0; k < side * side; ++k) {
    if (k % side > 0) bars.push_back({k - 1, k, Matrix2::Identity()});
    if (k >= side) bars.push_back({k - side, k, 2.0 * Matrix2::Identity()});
  }
  return bars;
}

/// Whoever solved it: every joint but the one that is held is in equilibrium with its load.
void solve_and_check(int joints, const std::vector<Bar>& bars) {
  const Deflection result =
      solve_truss(joints, bars, {{0, Vector2::Zero()}}, {{joints - 1, {3.0, -1.0}}});
  std::vector<Vector2> sum(idx(joints), Vector2::Zero());
  for (const Bar& bar : bars) {
    const Vector2 force =
        bar.stiffness * (result.displacements[idx(bar.j)] - result.displacements[idx(bar.i)]);
    sum[idx(bar.j)] += force;
    sum[idx(bar.i)] -= force;
  }
  sum.back() -= Vector2(3.0, -1.0);
  for (int k = 1; k < joints; ++k) ASSERT_LE(sum[idx(k)].norm(), 1e-9) << k;
}

TEST(CholmodCalls, ItSolvesTrussesUpToWhereOurKernelIsFaster) {
  for (const int side : {2, 6, 10, 20, 26}) {
    count_anew();
    solve_and_check(side * side, grid_of(side));
    EXPECT_EQ(factorisations, 1) << side;
    EXPECT_GE(solutions, 1) << side;
    EXPECT_EQ(analyses, 2) << side;  // of the joints, for their order, and of the matrix
  }
  for (const int side : {36, 60}) {
    count_anew();
    solve_and_check(side * side, grid_of(side));
    EXPECT_EQ(factorisations, 0) << side;
    EXPECT_EQ(solutions, 0) << side;
    EXPECT_EQ(analyses, 1) << side;
  }
}

/// It is the work that decides, not the number of joints.
TEST(CholmodCalls, ItSolvesAChainOfAnyLength) {
  std::vector<Bar> chain;
  for (int k = 1; k < 20000; ++k) chain.push_back({k - 1, k, Matrix2::Identity()});
  count_anew();
  solve_and_check(20000, chain);
  EXPECT_EQ(factorisations, 1);
}

/// The stiffness matrix of elastic corrections: CHOLMOD factorises it, and again when 32 landmarks
/// have been added to it; in between the factor is updated.
TEST(CholmodCalls, ItFactorisesForElasticCorrections) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> any(0, 79);
  std::vector<Vector2> truth;
  for (int k = 0; k < 80; ++k) truth.emplace_back(10.0 * normal(random), 10.0 * normal(random));
  for (const Method method : {Method::elastic, Method::gauss_markov}) {
    MapBuilder builder({.method = method});
    builder.start("0");
    count_anew();
    int corrections = 0;
    int here = 0;
    for (int leg = 0; leg < 400; ++leg) {
      const int to = any(random);
      if (to == here) continue;
      const Vector2 error(0.1 * normal(random), 0.1 * normal(random));
      const Traversal drive{truth[idx(to)] - truth[idx(here)] + error, 0.01 * Matrix2::Identity()};
      if (builder.arrive(std::to_string(to), drive).eta > 0) ++corrections;
      here = to;
    }
    EXPECT_GT(corrections, 200);
    EXPECT_GE(factorisations, 2);
    EXPECT_LE(factorisations, 5);
    const int before = factorisations;
    static_cast<void>(builder.covariance_between(3, 4));
    EXPECT_EQ(factorisations, before + 1);
    static_cast<void>(builder.covariances());  // our kernel: CHOLMOD has no inverse of this kind
    EXPECT_EQ(factorisations, before + 1);
  }
}

}  // namespace
}  // namespace trussmap::cholmod_calls_test
