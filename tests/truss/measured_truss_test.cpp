// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Merged measurements against dense least squares over every single one of them.
#include "truss/measured_truss.hpp"

#include "trussmap/error.hpp"

#include <cmath>
#include <random>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::measured_truss_test {
using namespace truss;
namespace {

struct Measurement {
  int i, j;
  Vector2 z;
  Matrix2 information;
};

/// A chain with chords, each bar measured several times and in both directions.
std::vector<Measurement> random_measurements(int joints, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<Measurement> result;
  for (int k = 0; k < 12 * joints; ++k) {
    const int j =
        k < joints - 1 ? k + 1 : static_cast<int>(random() % static_cast<unsigned>(joints));
    const int i = k < joints - 1 ? k : static_cast<int>(random() % static_cast<unsigned>(joints));
    if (i == j) continue;
    const Matrix2 W =
        (Matrix2() << normal(random), normal(random), normal(random), normal(random)).finished();
    result.push_back({i, j, Vector2(j - i + 0.1 * normal(random), 0.1 * normal(random)),
                      W * W.transpose() + Matrix2::Identity()});
  }
  return result;
}

TEST(MeasuredTruss, EqualsDenseLeastSquaresOfAllMeasurements) {
  std::mt19937_64 random(3);
  for (const int joints : {2, 3, 8, 30}) {
    const std::vector<Measurement> measurements = random_measurements(joints, random);
    MeasuredTruss truss;
    for (int k = 0; k < joints; ++k) truss.add_joint({k == 0 ? 5.0 : k, 0.0});
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2 * joints, 2 * joints);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(2 * joints);
    for (const Measurement& one : measurements) {
      truss.add(one.i, one.j, one.z, one.information);
      Eigen::MatrixXd J = Eigen::MatrixXd::Zero(2, 2 * joints);
      J.middleCols(2 * one.i, 2) = -Matrix2::Identity();
      J.middleCols(2 * one.j, 2) = Matrix2::Identity();
      H += J.transpose() * one.information * J;
      b += J.transpose() * one.information * one.z;
    }
    const int n = 2 * joints - 2;
    Eigen::VectorXd p = Eigen::VectorXd::Zero(2 * joints);
    p.tail(n) = H.bottomRightCorner(n, n).ldlt().solve(b.tail(n));
    const Eigen::MatrixXd inverse = H.bottomRightCorner(n, n).inverse();
    double chi2 = 0.0;
    for (const Measurement& one : measurements) {
      const Vector2 off = p.segment<2>(2 * one.j) - p.segment<2>(2 * one.i) - one.z;
      chi2 += off.dot(one.information * off);
    }
    for (const linalg::Kernel kernel : {linalg::Kernel::frontal, linalg::Kernel::cholmod}) {
      const MeasuredTruss::Fit fit = truss.fit(kernel);
      EXPECT_NEAR(fit.chi2, chi2, 1e-10 * chi2);
      EXPECT_EQ(fit.dof, 2 * (static_cast<int>(measurements.size()) - joints + 1));
      const std::vector<Matrix2> covariances = truss.covariances();
      EXPECT_EQ(covariances[0], Matrix2::Zero());
      for (int k = 0; k < joints; ++k) {
        const Vector2 expected = Vector2(5.0, 0.0) + p.segment<2>(2 * k);
        EXPECT_LT((fit.positions[idx(k)] - expected).norm(), 1e-11);
        if (k == 0) continue;
        EXPECT_LT((covariances[idx(k)] - inverse.block<2, 2>(2 * k - 2, 2 * k - 2)).norm(), 1e-12);
      }
    }
  }
}

TEST(MeasuredTruss, CountsABarOnceHoweverOftenItWasMeasured) {
  MeasuredTruss truss;
  truss.add_joint({0.0, 0.0});
  truss.add_joint({1.0, 0.0});
  truss.add(0, 1, {1.0, 0.0}, Matrix2::Identity());
  truss.add(1, 0, {-1.2, 0.0}, Matrix2::Identity());
  EXPECT_EQ(truss.bars(), 1);
  const MeasuredTruss::Fit fit = truss.fit();
  EXPECT_NEAR(fit.positions[1].x(), 1.1, 1e-14);
  EXPECT_NEAR(fit.chi2, 0.02, 1e-14);
  EXPECT_EQ(fit.dof, 2);
}

TEST(MeasuredTruss, SaysWhatIsWrong) {
  MeasuredTruss truss;
  EXPECT_TRUE(truss.fit().positions.empty());
  for (int k = 0; k < 4; ++k) truss.add_joint({k, 0.0});
  EXPECT_THROW(truss.add(0, 0, {1.0, 0.0}, Matrix2::Identity()), std::invalid_argument);
  EXPECT_THROW(truss.add(0, 4, {1.0, 0.0}, Matrix2::Identity()), std::invalid_argument);
  EXPECT_THROW(truss.add(0, 1, {1.0, 0.0}, -Matrix2::Identity()), std::invalid_argument);
  EXPECT_THROW(truss.add(0, 1, {NAN, 0.0}, Matrix2::Identity()), std::invalid_argument);
  EXPECT_THROW((void)truss.covariances(), std::logic_error);
  truss.add(0, 1, {1.0, 0.0}, Matrix2::Identity());
  truss.add(2, 3, {1.0, 0.0}, Matrix2::Identity());
  try {
    (void)truss.fit();
    FAIL() << "joints 2 and 3 hang in the air";
  } catch (const SolveError& error) {
    EXPECT_NE(std::string(error.what()).find("joint 2 is tied to nothing"), std::string::npos);
  }
}

}  // namespace
}  // namespace trussmap::measured_truss_test
