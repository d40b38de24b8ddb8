// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The restricted likelihood, against one dense QR of all rows by all unknowns.
#include "estimation/restricted_likelihood.hpp"

#include "estimation/kinds/kinds.hpp"
#include "estimation/recording_adjustment.hpp"
#include "estimation/recording_start.hpp"
#include "estimation/simulated_recordings.hpp"

#include <cmath>
#include <random>

#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

namespace trussmap::restricted_likelihood_test {
using namespace estimation;
namespace {

struct Dense {
  double chi2 = 0.0;         ///< of what no column explains
  double information = 0.0;  ///< log|X'X|
};

Dense dense(const Eigen::MatrixXd& X, const Eigen::VectorXd& r) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(X);
  const Eigen::VectorXd turned = qr.householderQ().transpose() * r;
  return {turned.tail(r.size() - X.cols()).squaredNorm(),
          2.0 * qr.matrixQR().diagonal().array().abs().log().sum()};
}

/// log|S| of all measurements, by determinants.
double log_covariance(const RecordingProblem& problem) {
  double sum = 0.0;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    const Eigen::MatrixXd W = one.whitener.topLeftCorner(one.rows, one.rows);
    sum -= std::log((W.transpose() * W).determinant());
  }
  return sum;
}

struct Asked {
  testing::SimulatedRecording world = testing::simulate_recording({.tours = 1}, 5);
  RecordingProblem problem = make_problem({world.recording}, world.model);
  RecordingState state = start_of(problem, {}).state;
  EffectParameters border;
  RecordingSystem system{problem, border};
};

Eigen::MatrixXd derivatives(const RecordingSystem& system) {
  const Eigen::Index n = system.normal_equations().unknowns();
  return system.times(Eigen::MatrixXd::Identity(n, n));
}

TEST(RestrictedLikelihood, IsThatOfADenseRegression) {
  Asked one;
  const RestrictedLikelihood found =
      restricted_likelihood(one.system, one.problem, one.state, Eigen::VectorXd());
  const Dense expected = dense(derivatives(one.system), one.system.residuals());
  const double whole = log_covariance(one.problem) + expected.information + expected.chi2;
  EXPECT_NEAR(found.integrated(), whole, 1e-8 * std::abs(whole));
  EXPECT_EQ(found.integrated(), found.at_likeliest());
}

TEST(RestrictedLikelihood, ColumnsAreFurtherUnknowns) {
  Asked one;
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd columns(one.system.rows(), 3);
  for (double& value : columns.reshaped()) value = normal(random);
  const RestrictedLikelihood found =
      restricted_likelihood(one.system, one.problem, one.state, Eigen::VectorXd(), columns);
  const Eigen::MatrixXd J = derivatives(one.system);
  Eigen::MatrixXd all(J.rows(), J.cols() + columns.cols());
  all << J, columns;
  const Dense without = dense(J, one.system.residuals());
  const Dense with = dense(all, one.system.residuals());
  EXPECT_NEAR(found.taken, without.chi2 - with.chi2, 1e-7 * without.chi2);
  EXPECT_NEAR(found.information, with.information - without.information, 1e-7);
  const double whole = log_covariance(one.problem) + with.information + with.chi2;
  EXPECT_NEAR(found.integrated(), whole, 1e-8 * std::abs(whole));
}

TEST(RestrictedLikelihood, WhatIsLeftOutCountsForNothing) {
  Asked one;
  const RestrictedLikelihood all =
      restricted_likelihood(one.system, one.problem, one.state, Eigen::VectorXd());
  std::vector<int> out;
  for (std::size_t k = 0; k < one.problem.measurements.size(); ++k) {
    if (one.problem.measurements[k].kind != &kinds::survey) continue;
    if (out.size() < 2) out.push_back(static_cast<int>(k));
  }
  ASSERT_EQ(out.size(), 2U);
  const std::vector<double> weights = weights_without(out, one.problem.measurements.size());
  one.system.set_weights(weights);
  const RestrictedLikelihood fewer =
      restricted_likelihood(one.system, one.problem, one.state, Eigen::VectorXd());
  RecordingProblem without = one.problem;
  for (std::size_t k = out.size(); k-- > 0;) {
    without.measurements.erase(without.measurements.begin() + out[k]);
  }
  const EffectParameters none;
  RecordingSystem system(without, none);
  const RestrictedLikelihood expected =
      restricted_likelihood(system, without, one.state, Eigen::VectorXd());
  EXPECT_NEAR(fewer.integrated(), expected.integrated(), 1e-8 * std::abs(expected.integrated()));
  EXPECT_GT(std::abs(all.integrated() - fewer.integrated()), 1.0);
}

}  // namespace
}  // namespace trussmap::restricted_likelihood_test
