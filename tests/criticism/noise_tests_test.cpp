// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Tests of noise laws against brute force with the dense projection, and against drives whose noise
// is known.
#include "criticism/noise_tests.hpp"

#include "criticism/noise_laws.hpp"
#include "criticism/noisy_recordings.hpp"
#include "driven.hpp"
#include "estimation/kinds/kinds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <boost/math/special_functions/gamma.hpp>
#include <gtest/gtest.h>

namespace trussmap::noise_tests_test {
using namespace fitting;
using namespace estimation;
using namespace criticism;
namespace {

using testing::add_noise;
using testing::NoisyDrive;
using testing::simulate_world;

std::vector<NoiseTest> noise_of(const NoisyDrive& world) {
  const FitState fit = fit_recordings(world.recordings, world.model);
  return test_noise_laws(fit, ScoreTest(fit));
}

const NoiseTest& find(const std::vector<NoiseTest>& tests, const std::string& law) {
  return *std::find_if(tests.begin(), tests.end(),
                       [&](const NoiseTest& one) { return one.law == law; });
}

/// Variance that a unit of the law adds to the whitened rows; both laws have a diagonal one.
Eigen::MatrixXd dense_law(const FitState& fit, const RecordingSystem& system,
                          const std::string& law) {
  Eigen::MatrixXd V = Eigen::MatrixXd::Zero(system.rows(), system.rows());
  for (std::size_t k = 0; k < fit.problem.measurements.size(); ++k) {
    const Measurement& one = fit.problem.measurements[k];
    Matrix4 added = Matrix4::Zero();
    if (law == "sighting" && one.kind == &kinds::standing) {
      added.topLeftCorner<2, 2>().setIdentity();
    }
    if (law == "compass" && one.kind == &kinds::segment && one.rows == 4) {
      added(3, 3) = 1.0 / readings_of(fit.problem.segments[one.source]);
    }
    const int at = system.first_row(k);
    V.block(at, at, one.rows, one.rows) =
        (one.whitener * added * one.whitener.transpose()).topLeftCorner(one.rows, one.rows);
  }
  return V;
}

TEST(NoiseTests, ThePValueIsThatOfTheDenseProjection) {
  NoisyDrive world = simulate_world({true, true, false, 1}, 5);
  const FitState fit = fit_recordings(world.recordings, world.model);
  const ScoreTest tests(fit);
  const std::vector<NoiseTest> found = test_noise_laws(fit, tests);
  const Eigen::Index rows = tests.system().rows();
  const Eigen::MatrixXd P = tests.projected(Eigen::MatrixXd::Identity(rows, rows));
  const Eigen::VectorXd r = P * tests.residuals();
  for (const char* law : {"sighting", "compass"}) {
    const Eigen::MatrixXd PV = P * dense_law(fit, tests.system(), law);
    const double second = PV.cwiseProduct(PV.transpose()).sum();
    const double third = (PV * PV).cwiseProduct(PV.transpose()).sum();
    const double excess = r.dot(dense_law(fit, tests.system(), law) * r) - PV.trace();
    const double z = excess / std::sqrt(2.0 * second);
    const double dof = second * second * second / (third * third);
    const double p = boost::math::gamma_q(0.5 * dof, 0.5 * (dof + std::sqrt(2.0 * dof) * z));
    // 48 vectors of signs: some 2 % of the variance, 1 % of z.
    EXPECT_NEAR(find(found, law).p_value, p, 0.02) << law;
    const double score = std::pow(std::max(0.0, z), 2);
    EXPECT_NEAR(find(found, law).score, score, 0.1 * score) << law;
  }
}

TEST(NoiseTests, TheScoreIsTheFallOfTheRestrictedLikelihood) {
  NoisyDrive world = simulate_world({true, true, false, 1}, 7);
  world.model.noise.sighting /= 3.0;
  const FitState fit = fit_recordings(world.recordings, world.model);
  const ScoreTest tests(fit);
  const NoiseTest found = find(test_noise_laws(fit, tests), "sighting");
  const RecordingSystem& system = tests.system();
  const Eigen::Index nodes = system.normal_equations().unknowns();
  const Eigen::MatrixXd J = system.times(Eigen::MatrixXd::Identity(nodes, nodes));
  const Eigen::MatrixXd V = dense_law(fit, system, "sighting");
  const auto deviance = [&](double variance) {
    const Eigen::MatrixXd S = Eigen::MatrixXd::Identity(J.rows(), J.rows()) + variance * V;
    const Eigen::LLT<Eigen::MatrixXd> covariance(S);
    const Eigen::MatrixXd white_J = covariance.matrixL().solve(J);
    const Eigen::VectorXd white_r = covariance.matrixL().solve(system.residuals());
    const Eigen::LLT<Eigen::MatrixXd> normal(white_J.transpose() * white_J);
    const Eigen::VectorXd pull = white_J.transpose() * white_r;
    const auto log_of = [](const Eigen::LLT<Eigen::MatrixXd>& factor) {
      return 2.0 * factor.matrixLLT().diagonal().array().log().sum();
    };
    return log_of(covariance) + log_of(normal) + white_r.squaredNorm() -
           pull.dot(normal.solve(pull));
  };
  const double variance = found.size * found.size;
  EXPECT_NEAR(found.score, deviance(0.0) - deviance(variance), 1e-6 * found.score);
  EXPECT_GT(found.score, 10.0);
  // And that is the best, to some 10 % of the variance.
  EXPECT_LT(deviance(variance), deviance(1.2 * variance));
  EXPECT_LT(deviance(variance), deviance(variance / 1.2));
}

TEST(NoiseTests, RarerLawsHaveToExplainMore) {
  NoisyDrive world = simulate_world({true, true, true, 1}, 2);
  const FitState fit = fit_recordings(world.recordings, world.model);
  const ScoreTest tests(fit);
  const std::map<std::string, double> documented = {{"per metre", 0.0},
                                                    {"per metre, left wheel", 3.0},
                                                    {"per metre, right wheel", 3.0},
                                                    {"per second", 1.0},
                                                    {"per second, heading", 6.0},
                                                    {"per second, travel", 6.0},
                                                    {"per radian turned", 6.0},
                                                    {"per start", 0.0},
                                                    {"per spin", 0.0},
                                                    {"compass", 2.0},
                                                    {"sighting", 2.0},
                                                    {"range", 2.0},
                                                    {"bearing", 2.0}};
  std::map<std::string, double> margins;
  for (const NoiseLaw& law : noise_laws(fit, tests.context())) margins[law.name] = law.margin;
  EXPECT_EQ(margins, documented);
  double before = std::numeric_limits<double>::infinity();
  for (const NoiseTest& one : test_noise_laws(fit, tests)) {
    const auto law = documented.find(one.law);  // not found: a shape of noise
    const double claim = one.score - (law == documented.end() ? 0.0 : law->second);
    EXPECT_LE(claim, before) << one.law;
    before = claim;
  }
}

TEST(NoiseTests, TheLikelihoodIsAskedFromAPValueOfAHundredthOn) {
  // The less noise is stated, the smaller the p-value. Above 0.01 the score is z^2, below it is the
  // fall of the likelihood, which is another number: z^2 holds for small noise alone.
  NoisyDrive world = simulate_world({true, true, false, 1}, 7);
  const double stated = world.model.noise.sighting;
  const auto test_at = [&](double factor) {
    world.model.noise.sighting = factor * stated;
    return find(noise_of(world), "sighting");
  };
  double low = 0.4;
  double high = 1.2;
  const NoiseTest most = test_at(low);
  const NoiseTest least = test_at(high);
  ASSERT_LT(most.p_value, 0.01);
  ASSERT_GT(least.p_value, 0.01);
  NoiseTest below = most;
  NoiseTest above = least;
  while (above.p_value - below.p_value > 0.001) {
    const double middle = 0.5 * (low + high);
    const NoiseTest one = test_at(middle);
    (one.p_value < 0.01 ? low : high) = middle;
    (one.p_value < 0.01 ? below : above) = one;
  }
  EXPECT_GT(std::abs(above.score - below.score), 0.1 * above.score);
}

TEST(NoiseTests, WheelsWithTwiceTheNoiseAreRecognisedInSize) {
  double sum = 0.0;
  constexpr int kSeeds = 10;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    NoisyDrive world = simulate_world({}, seed);
    add_noise(world, "per metre", 2.0, seed);
    sum += find(noise_of(world), "per metre").size;
  }
  // sqrt 3 k; each from some 150 redundant values of which half are wheels: 10 % sd.
  EXPECT_NEAR(sum / kSeeds, std::sqrt(3.0) * 0.003, 4.0 * 0.1 * 0.0052 / std::sqrt(kSeeds));
}

TEST(NoiseTests, WhatIsSetAsideIsNoNoise) {
  // A wheelbase off by 4 % looks like noisy turns, until its column is set aside.
  NoisyDrive world = simulate_world({}, 3);
  world.model.robot.wheelbase *= 1.04;
  for (DrivenRecording& one : world.recordings) {
    testing::retake(one.drive, world.model.robot.wheelbase);
  }
  const FitState fit = fit_recordings(world.recordings, world.model);
  const ScoreTest tests(fit);
  Effect wheelbase;
  wheelbase.name = "turn";
  wheelbase.channel = Channel::turn;
  wheelbase.shape = {"1"};
  const Score effect = tests.test({wheelbase}).front();
  const std::vector<NoiseTest> before = test_noise_laws(fit, tests);
  const std::vector<NoiseTest> after = test_noise_laws(fit, tests, effect.projected);
  EXPECT_LT(before.front().p_adjusted, 1e-6);
  EXPECT_LT(before.front().score, effect.score);  // the effect has the better claim
  for (const NoiseTest& one : after) EXPECT_GT(one.p_adjusted, 0.05) << one.law;
}

TEST(NoiseTests, CorrelatedDrivesAreRecognised) {
  // All along a drive both wheels err by a share, 0.9 of the last drive's plus something new: some
  // 4 cm in 5 m.
  NoisyDrive world = simulate_world({true, true, false, 3}, 4);
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  double share = 0.0;
  const TrueMotion& motion = world.motions.front();
  for (std::size_t row = 1; row < motion.rows.size(); ++row) {
    if (motion.rows[row].activity != Activity::drive) continue;
    if (motion.rows[row - 1].activity != Activity::drive) {
      share = 0.9 * share + std::sqrt(1.0 - 0.81) * 0.008 * normal(random);
    }
    world.recordings.front().drive.pair.left[row] *= 1.0 + share;
    world.recordings.front().drive.pair.right[row] *= 1.0 + share;
  }
  testing::retake(world.recordings.front().drive);
  EXPECT_LT(find(noise_of(world), "autocorrelation").p_adjusted, 0.01);
}

TEST(NoiseTests, AFewLargeErrorsAreHeavyTails) {
  NoisyDrive world = simulate_world({true, true, false, 3}, 6);
  const std::vector<std::size_t> drives =
      testing::beginnings(world.motions.front(), Activity::drive);
  for (std::size_t k = 4; k < drives.size(); k += 15) {
    testing::add_to_row(world.recordings.front().drive, drives[k] + 8, 0.0, 0.3, 0.34);
  }
  EXPECT_LT(find(noise_of(world), "heavy tails").p_adjusted, 0.01);
}

class SlowNoiseLaw : public ::testing::TestWithParam<const char*> {};

TEST_P(SlowNoiseLaw, IsNamedFirstAmongAll) {
  // 56 legs, a typical one with twice the spread; seeds 1 ... 20.
  constexpr int kSeeds = 20;
  int first = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    NoisyDrive world = simulate_world({}, seed);
    add_noise(world, GetParam(), 2.0, seed);
    first += noise_of(world).front().law == GetParam() ? 1 : 0;
  }
  EXPECT_GE(first, 0.9 * kSeeds - 2.0);
}

INSTANTIATE_TEST_SUITE_P(Laws, SlowNoiseLaw,
                         ::testing::Values("per metre", "per second", "per start", "per spin"));

TEST(SlowNoiseTests, WithTheRightNoiseNoneIsNamed) {
  constexpr int kSeeds = 50;
  int named = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    bool any = false;
    for (const NoiseTest& one : noise_of(simulate_world({}, seed))) {
      any = any || one.p_adjusted < 0.05;
    }
    named += any ? 1 : 0;
  }
  // 5 % and 3 sds of a count.
  EXPECT_LE(named, 0.05 * kSeeds + 3.0 * std::sqrt(0.05 * 0.95 * kSeeds));
}

}  // namespace
}  // namespace trussmap::noise_tests_test
