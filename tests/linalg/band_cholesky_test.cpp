// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The band factor against a dense one.
#include "linalg/band_cholesky.hpp"

#include <algorithm>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace trussmap::band_cholesky_test {
namespace {

TEST(BandMatrix, SolvesWhatADenseFactorSolves) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (const int n : {1, 2, 7, 40, 150}) {
    for (const int band : {0, 1, 5, 33, 200}) {
      Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
      linalg::BandMatrix banded;
      banded.resize(n, band);
      for (int c = 0; c < n; ++c) {
        for (int r = c; r <= std::min(n - 1, c + band); ++r) {
          const double value = r == c ? 2.0 * (band + 1) + 1.0 : normal(random) * 0.5;
          A(r, c) = A(c, r) = value;
          banded.add(r, c, value);
        }
      }
      const Eigen::VectorXd b = Eigen::VectorXd::Random(n);
      Eigen::VectorXd x = b;
      banded.factorise(1e-13);
      banded.solve_in_place(x);
      EXPECT_LE((A * x - b).norm(), 1e-11 * b.norm()) << n << ", band " << band;
    }
  }
}

TEST(BandMatrix, HoldsWhatIsFreeToMove) {
  linalg::BandMatrix A;
  A.resize(3, 1);  // two unknowns tied to each other, and one to nothing
  A.add(0, 0, 4.0);
  A.add(1, 0, -4.0);
  A.add(1, 1, 4.0);
  Eigen::VectorXd x = Eigen::Vector3d(2.0, -2.0, 0.0);
  A.factorise(1e-13);
  A.solve_in_place(x);
  EXPECT_NEAR(x[0] - x[1], 0.5, 1e-15);
  EXPECT_EQ(x[2], 0.0);
}

}  // namespace
}  // namespace trussmap::band_cholesky_test
