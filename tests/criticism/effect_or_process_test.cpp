// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// An effect against noise that lasts: sums over modes beside plain matrices, the chance drawn
// beside its own frequency, and a process's columns beside the likelihood of its states.
#include "criticism/effect_or_process.hpp"

#include "criticism/score_test.hpp"
#include "driven.hpp"
#include "fit/noise_fit.hpp"
#include "fit/process_columns.hpp"
#include "trussmap/simulation.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace trussmap::effect_or_process_test {
using namespace criticism;
using namespace fitting;
namespace {

constexpr Eigen::Index kInstants = 40;

/// A walk that is read at every instant.
Eigen::MatrixXd walk_steps() {
  return Eigen::MatrixXd(
      Eigen::MatrixXd::Ones(kInstants, kInstants).triangularView<Eigen::Lower>());
}

/// A constant; a line and a parabola.
std::vector<Eigen::MatrixXd> trends() {
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(kInstants, -1.0, 1.0);
  Eigen::MatrixXd two(kInstants, 2);
  two << t, t.cwiseAbs2();
  return {Eigen::MatrixXd::Ones(kInstants, 1), two};
}

Eigen::VectorXd drawn(Eigen::Index count, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd result(count);
  for (double& value : result) value = normal(random);
  return result;
}

double deviance(const Eigen::VectorXd& y, const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  const Eigen::MatrixXd L = factor.matrixL();
  return 2.0 * L.diagonal().array().log().sum() + y.dot(factor.solve(y));
}

TEST(EffectOrProcess, ClaimIsThatOfTheWholeCovariances) {
  std::mt19937_64 random(1);
  const Eigen::MatrixXd Z = walk_steps();
  for (const double s : {0.0, 0.01, 1.0}) {
    const Eigen::VectorXd y =
        drawn(kInstants, random) + std::sqrt(s) * Z * drawn(kInstants, random);
    const EffectOrProcess question(y, Z, trends());
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(kInstants, kInstants);
    double process = deviance(y, one);
    for (double size = 1e-6; size < 1e3; size *= 1.1) {
      process = std::min(process, deviance(y, one + size * Z * Z.transpose()));
    }
    EXPECT_NEAR(question.gain_of_process(), y.squaredNorm() - process, 0.1);
    for (std::size_t k = 0; k < trends().size(); ++k) {
      const Eigen::MatrixXd C = trends()[k];
      const Eigen::VectorXd left = y - C * (C.transpose() * C).ldlt().solve(C.transpose() * y);
      const double claim = process - left.squaredNorm() - 2.0 * static_cast<double>(C.cols());
      EXPECT_NEAR(question.claim(k), claim, 0.1);
    }
  }
}

/// Of so many walks, those that are taken for an effect at 5 %.
int taken_for_effects(int walks, double s, std::mt19937_64& random) {
  int any = 0;
  for (int k = 0; k < walks; ++k) {
    const Eigen::VectorXd y =
        drawn(kInstants, random) + std::sqrt(s) * walk_steps() * drawn(kInstants, random);
    const EffectOrProcess question(y, walk_steps(), trends());
    const std::size_t best = question.claim(0) > question.claim(1) ? 0 : 1;
    if (question.chance_of_process(best) < 0.05) ++any;
  }
  return any;
}

/// Seed 2: 3 are expected, sd 1.7, four of them.
TEST(EffectOrProcess, AWalkIsSeldomAnEffect) {
  std::mt19937_64 random(2);
  EXPECT_LE(taken_for_effects(60, 0.03, random), 9);
}

/// Seed 2: 25 are expected, sd 4.9, four of them; the size is estimated, which has its part.
TEST(SlowEffectOrProcess, AWalkIsSeldomAnEffect) {
  std::mt19937_64 random(2);
  for (const double s : {0.003, 0.03, 0.3}) {
    EXPECT_LE(taken_for_effects(500, s, random), 45) << s;
  }
}

/// Seed 3.
TEST(EffectOrProcess, AConstantIsNoWalk) {
  std::mt19937_64 random(3);
  int found = 0;
  constexpr int kDrives = 50;
  for (int k = 0; k < kDrives; ++k) {
    const Eigen::VectorXd y =
        drawn(kInstants, random) + Eigen::VectorXd::Constant(kInstants, 15.0 / std::sqrt(40.0));
    if (EffectOrProcess(y, walk_steps(), trends()).chance_of_process(0) < 0.05) ++found;
  }
  EXPECT_GE(found, 45);
}

/// The likelihood that the columns give is that of the states, but for what a walk does within a
/// segment. Seed 4.
TEST(ProcessColumns, LikelihoodIsThatOfTheStates) {
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0}, {0.0, 3.5, 8.0});
  std::mt19937_64 random = random_stream(4, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, 2, random);
  WheeledRobot robot;
  robot.gyro = true;
  robot.noise.gyro_walk = 1e-4;
  Model model;
  const DrivenRecording recording =
      testing::driven(simulate_drive(mesh, tours.walk, {}, robot, 4, {}).recording);
  const FitState fit = fit_recordings({recording}, model);
  const ScoreTest tests(fit);
  NoiseProcess walk;
  walk.channel = Channel::gyro;
  walk.process = ProcessKind::walk_in_t;
  NoiseReml reml(fit, model.noise);
  const auto likelihood = [&](double sd) {
    Noise noise = model.noise;
    walk.sd = sd;
    if (sd > 0.0) noise.processes = {walk};
    return minus_two_log_under(reml, noise, Eigen::MatrixXd());
  };
  const Eigen::VectorXd& y = tests.residuals();
  for (const Eigen::Index most : {Eigen::Index{10000}, Eigen::Index{64}}) {
    const auto steps = process_columns(fit, walk, y.size(), most);
    ASSERT_TRUE(steps.has_value());
    EXPECT_LE(steps->cols(), most);
    const Eigen::MatrixXd Z = tests.projected(*steps);
    for (const double sd : {3e-5, 1e-4}) {
      const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(y.size(), y.size());
      const double gain = y.squaredNorm() - deviance(y, one + sd * sd * Z * Z.transpose());
      const double expected = likelihood(0.0) - likelihood(sd);
      EXPECT_GT(std::abs(expected), 3.0);
      EXPECT_NEAR(gain, expected, 0.05 * std::abs(expected) + 0.5) << most << " " << sd;
    }
  }
}

}  // namespace
}  // namespace trussmap::effect_or_process_test
