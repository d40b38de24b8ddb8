// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/wheel_noise.hpp"

#include "json_matrix.hpp"
#include "shared_data.hpp"
#include "trussmap/error.hpp"
#include "trussmap/simulation.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace trussmap::wheel_noise_test {
namespace {

constexpr double kLeft = 0.0004;  // Chong & Kleeman (1997), section 5.2
constexpr double kRight = 0.00058;
constexpr double kWheelbase = 0.5;  // assumed by the reference; the paper has none
constexpr int kRuns = 60;

NoiseExperiment out_and_back() {
  NoiseExperiment experiment;
  experiment.wheelbase = kWheelbase;
  return experiment;
}

/// Runs of the robot that rolls: its noise curves its path.
EndErrors rolled(const TapeRobot& robot, const TestPath& path, int runs, std::mt19937_64& random) {
  EndErrors errors;
  for (const Pose& end : drive_often(robot, path, runs, random)) {
    errors.push_back({end.x, end.y, end.heading});
  }
  return errors;
}

TapeRobot noisy_robot(double left, double right) {
  TapeRobot robot = misbuilt_robot(kWheelbase, 1.0, 1.0);
  robot.left_noise = left;
  robot.right_noise = right;
  robot.step = 0.25;  // 80 steps; the covariance is right to 1/80^2
  return robot;
}

/// Runs of the first-order model itself.
EndErrors drawn(const Matrix3& covariance, int runs, std::mt19937_64& random) {
  const Matrix3 root = covariance.llt().matrixL();
  std::normal_distribution<double> normal;
  EndErrors errors;
  for (int run = 0; run < runs; ++run) {
    const double a = normal(random);
    const double b = normal(random);
    errors.push_back(root * Eigen::Vector3d(a, b, normal(random)));
  }
  return errors;
}

struct Moments {
  Eigen::Array2d sum = Eigen::Array2d::Zero();
  Eigen::Array2d squares = Eigen::Array2d::Zero();
  int count = 0;

  void add(const Eigen::Array2d& value) {
    sum += value;
    squares += value * value;
    ++count;
  }
  [[nodiscard]] Eigen::Array2d mean() const { return sum / count; }
  [[nodiscard]] Eigen::Array2d sd() const {
    return ((squares / count - mean() * mean()) * count / (count - 1.0)).sqrt();
  }
};

TEST(WheelNoise, ShapeIsTheReferencesCovariance) {
  const nlohmann::json c = testing::reference("chong_kleeman.json")["forward_backward_10m"];
  const NoiseShape shape = noise_shape({{10.0, 0.0}, {-10.0, 0.0}}, c["B"]);
  const Matrix3 found = std::pow(c["kL"].get<double>(), 2) * shape.left +
                        std::pow(c["kR"].get<double>(), 2) * shape.right;
  const Matrix3 expected = testing::matrix<3, 3>(c["cov"]);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double scale = std::sqrt(expected(i, i) * expected(j, j));
      EXPECT_NEAR(found(i, j), expected(i, j), 1e-12 * scale);
    }
  }
  EXPECT_NEAR(ellipse95_scale(2), c["ellipse95_scale"].get<double>(), 1e-12);
}

TEST(WheelNoise, PerfectScatterGivesBackTheConstantsAndTheCramerRaoBounds) {
  // Six points whose scatter is the model's covariance exactly: S = sum of l l' over the columns l
  // of its root times 3.
  const nlohmann::json c = testing::reference("chong_kleeman.json")["forward_backward_10m"];
  const Matrix3 root = testing::matrix<3, 3>(c["cov"]).llt().matrixL();
  EndErrors errors;
  for (int repeat = 0; repeat < 10; ++repeat) {
    for (int k = 0; k < 3; ++k) {
      errors.push_back(std::sqrt(3.0) * root.col(k));
      errors.push_back(-std::sqrt(3.0) * root.col(k));
    }
  }
  const NoiseEstimate found = estimate_wheel_noise(errors, out_and_back());
  EXPECT_EQ(found.runs, kRuns);
  EXPECT_NEAR(found.left.k, kLeft, 1e-11);
  EXPECT_NEAR(found.right.k, kRight, 1e-11);
  EXPECT_NEAR(found.left.standard_error, c["crlb_n60_std_kL"].get<double>(), 1e-8);
  EXPECT_NEAR(found.right.standard_error, c["crlb_n60_std_kR"].get<double>(), 1e-8);
  // The mean subtracted: the same scatter over n - 1.
  NoiseExperiment centred = out_and_back();
  centred.subtract_mean = true;
  const NoiseEstimate about_mean = estimate_wheel_noise(errors, centred);
  EXPECT_NEAR(about_mean.left.k, kLeft * std::sqrt(60.0 / 59.0), 1e-11);
}

/// The mean of 1000 estimates has a standard error of sd/sqrt(1000), some 0.5 % of k^2; of their
/// scatter, 1/sqrt(2000) = 2.2 %, so that 10 % is 4.5 of those.
void expect_unbiased(const Moments& squared, const Moments& stated) {
  const Eigen::Array2d truth(kLeft * kLeft, kRight * kRight);
  for (int k = 0; k < 2; ++k) {
    EXPECT_LT(std::abs(squared.mean()[k] - truth[k]), 3.0 * squared.sd()[k] / std::sqrt(1000.0))
        << "wheel " << k;
    EXPECT_NEAR(stated.mean()[k] / squared.sd()[k], 1.0, 0.1) << "wheel " << k;
  }
}

TEST(WheelNoise, SixtyRunsGiveUnbiasedConstantsAndTrueStandardErrors) {
  std::mt19937_64 random(20240611);
  Moments squared;
  Moments stated;
  Moments k;
  const NoiseExperiment experiment = out_and_back();
  const TapeRobot robot = noisy_robot(kLeft, kRight);
  for (int trial = 0; trial < 1000; ++trial) {
    const NoiseEstimate found =
        estimate_wheel_noise(rolled(robot, experiment.path, kRuns, random), experiment);
    squared.add(found.squared.array());
    stated.add(found.squared_covariance.diagonal().array().sqrt());
    k.add({found.left.k, found.right.k});
  }
  expect_unbiased(squared, stated);
  // The reference's own 300 simulated estimates, by another program: their mean is sure to
  // 4.8e-5/sqrt(300) = 2.8e-6, their scatter to 4 %.
  const nlohmann::json c = testing::reference("chong_kleeman.json")["forward_backward_10m"];
  EXPECT_NEAR(k.mean()[0], c["ml_mc300_mean"][0].get<double>(), 4 * 2.2e-6);
  EXPECT_NEAR(k.mean()[1], c["ml_mc300_mean"][1].get<double>(), 4 * 3.2e-6);
  EXPECT_NEAR(k.sd()[0] / c["ml_mc300_std"][0].get<double>(), 1.0, 0.2);
  EXPECT_NEAR(k.sd()[1] / c["ml_mc300_std"][1].get<double>(), 1.0, 0.2);
}

/// Noise that bends the path: the exact moments stay right where those of first order are off by
/// half. Each mean of 300 is sure to its scatter/sqrt(300), the scatter itself to 4 %, of
/// long-tailed bends to some 8.
TEST(WheelNoise, ExactMomentsServeNoisyWheelsToo) {
  std::mt19937_64 random(20240612);
  const Eigen::Array2d truth(9e-6, 25e-6);
  NoiseExperiment experiment;
  experiment.order = NoiseOrder::exact;
  TapeRobot robot = misbuilt_robot(experiment.wheelbase, 1.0, 1.0);
  robot.left_noise = 0.003;
  robot.right_noise = 0.005;
  robot.step = 0.25;
  for (const bool subtract : {false, true}) {
    experiment.subtract_mean = subtract;
    Moments squared;
    Moments stated;
    for (int trial = 0; trial < 300; ++trial) {
      const NoiseEstimate found =
          estimate_wheel_noise(rolled(robot, experiment.path, kRuns, random), experiment);
      squared.add(found.squared.array());
      stated.add(found.squared_covariance.diagonal().array().sqrt());
    }
    for (int k = 0; k < 2; ++k) {
      EXPECT_LT(std::abs(squared.mean()[k] - truth[k]), 4.0 * squared.sd()[k] / std::sqrt(300.0));
      EXPECT_NEAR(stated.mean()[k] / squared.sd()[k], 1.0, 0.2);
    }
  }
}

TEST(WheelNoise, TheEstimatorItselfIsUnbiasedWithSensorNoiseAndASubtractedMean) {
  std::mt19937_64 random(7);
  NoiseExperiment experiment = out_and_back();
  experiment.sensor_sd = {0.002, 0.002, 0.4 * std::numbers::pi / 180.0};
  experiment.subtract_mean = true;
  const NoiseShape shape = noise_shape(experiment.path, kWheelbase);
  const Matrix3 sensor = experiment.sensor_sd.cwiseAbs2().asDiagonal();
  const Matrix3 covariance = kLeft * kLeft * shape.left + kRight * kRight * shape.right + sensor;
  Moments squared;
  Moments stated;
  for (int trial = 0; trial < 1000; ++trial) {
    EndErrors errors = drawn(covariance, kRuns, random);
    for (Eigen::Vector3d& e : errors) e += Eigen::Vector3d(0.1, -0.2, 0.05);
    const NoiseEstimate found = estimate_wheel_noise(errors, experiment);
    squared.add(found.squared.array());
    stated.add(found.squared_covariance.diagonal().array().sqrt());
  }
  expect_unbiased(squared, stated);
}

TEST(WheelNoise, AnyPathServes) {
  // 4000 runs: sd(k) is 60/4000 of that of 60 runs in square, 1.1 to 1.6 % for these paths.
  std::mt19937_64 random(11);
  for (const TestPath& path : {TestPath{{3.0, 0.0}, {0.0, 1.5}, {2.0, -0.8}}, TestPath{{-2.0, 0.5}},
                               TestPath{{5.0, 0.0}}, TestPath{{0.0, 2.0}, {1.0, 0.0}}}) {
    NoiseExperiment experiment = out_and_back();
    experiment.path = path;
    TapeRobot robot = noisy_robot(0.002, 0.004);
    robot.step = 0.02;
    const NoiseEstimate found = estimate_wheel_noise(rolled(robot, path, 4000, random), experiment);
    EXPECT_NEAR(found.left.k, 0.002, 4.0 * found.left.standard_error);
    EXPECT_NEAR(found.right.k, 0.004, 4.0 * found.right.standard_error);
    EXPECT_LT(found.left.standard_error, 0.06 * 0.002);
  }
}

TEST(WheelNoise, AWheelHiddenBySensorNoiseGetsAnUpperLimit) {
  std::mt19937_64 random(3);
  NoiseExperiment experiment = out_and_back();
  experiment.sensor_sd = {0.01, 0.01, 0.02};
  const Matrix3 sensor = experiment.sensor_sd.cwiseAbs2().asDiagonal();
  const NoiseShape shape = noise_shape(experiment.path, kWheelbase);
  int at_zero = 0;
  int limited = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const NoiseEstimate found = estimate_wheel_noise(
        drawn(kRight * kRight * shape.right + sensor, kRuns, random), experiment);
    if (found.left.k > 0.0) continue;
    ++at_zero;
    EXPECT_TRUE(std::isnan(found.left.standard_error));
    EXPECT_GT(found.left.upper_limit, 0.0);
    EXPECT_GT(found.right.k, 0.0);
    limited += found.left.upper_limit < kRight ? 1 : 0;
  }
  // Half of the estimates of a true 0 are negative: 100 +- 7.
  EXPECT_NEAR(at_zero, 100, 30);
  EXPECT_GT(limited, at_zero / 2);
}

TEST(WheelNoise, RefusesWhatItCannotTell) {
  const EndErrors some = {{0.001, 0.01, 0.002}, {-0.002, 0.03, -0.001}, {0.001, -0.02, 0.004}};
  NoiseExperiment experiment = out_and_back();
  EXPECT_THROW((void)estimate_wheel_noise({some[0]}, experiment), std::invalid_argument);
  EXPECT_THROW((void)estimate_wheel_noise({some[0], some[0]}, experiment), SolveError);
  experiment.path = {{0.0, 2.0 * std::numbers::pi}};  // both wheels alike
  EXPECT_THROW((void)estimate_wheel_noise(some, experiment), SolveError);
  experiment.wheelbase = 0.0;
  EXPECT_THROW((void)estimate_wheel_noise(some, experiment), std::invalid_argument);
}

TEST(NoiseChecks, EllipsesHold95PercentAndTestsAreFair) {
  std::mt19937_64 random(5);
  constexpr int kTrials = 400;
  const NoiseExperiment experiment = out_and_back();
  const NoiseShape shape = noise_shape(experiment.path, kWheelbase);
  const Matrix3 covariance = kLeft * kLeft * shape.left + kRight * kRight * shape.right;
  Eigen::Array4d inside = Eigen::Array4d::Zero();
  int shape_rejected = 0;
  int distance_rejected = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const EndErrors errors = drawn(covariance, kRuns, random);
    const NoiseFit fit = check_noise(errors, experiment, estimate_wheel_noise(errors, experiment));
    for (int k = 0; k < 4; ++k) inside[k] += fit.ellipses[static_cast<std::size_t>(k)].inside;
    shape_rejected += fit.shape_p_value < 0.05 ? 1 : 0;
    distance_rejected += fit.distance_p_value < 0.05 ? 1 : 0;
  }
  // 24000 runs: 0.14 % standard error; constants fitted to the same runs hold a little more.
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(inside[k] / (kTrials * kRuns), 0.95, 0.006) << k;
  // 20 of 400 expected, +- 4.4.
  EXPECT_NEAR(shape_rejected, 20, 14);
  EXPECT_LE(distance_rejected, 34);
}

TEST(NoiseChecks, NoiseThatIsNotLinearIsNamed) {
  std::mt19937_64 random(12);
  NoiseExperiment experiment;
  experiment.order = NoiseOrder::exact;
  TapeRobot robot = misbuilt_robot(experiment.wheelbase, 1.0, 1.0);
  robot.left_noise = 0.003;
  robot.right_noise = 0.005;
  for (const double reach : {10.0, 1.0}) {
    experiment.path = {{reach, 0.0}, {-reach, 0.0}};
    const EndErrors errors = rolled(robot, experiment.path, kRuns, random);
    const NoiseEstimate found = estimate_wheel_noise(errors, experiment);
    const NoiseFit fit = check_noise(errors, experiment, found);
    EXPECT_EQ(fit.nonlinear, reach > 5.0);
    EXPECT_EQ(std::isnan(fit.shape_p_value), fit.nonlinear);
    EXPECT_EQ(noise_doubts(errors, experiment, found, fit).size(), fit.nonlinear ? 1U : 0U);
    EXPECT_GT(found.linearization_offset.norm(), 0.0);
  }
}

TEST(NoiseAnalysis, UsesTheExactMomentsWhereTheNoiseIsLarge) {
  std::mt19937_64 random(13);
  NoiseExperiment experiment = out_and_back();
  for (const double times : {1.0, 10.0}) {
    const EndErrors errors =
        rolled(noisy_robot(times * kLeft, times * kRight), experiment.path, kRuns, random);
    const NoiseAnalysis found = analyse_wheel_noise(errors, experiment);
    const bool exact = times > 1.0;
    EXPECT_EQ(found.experiment.order, exact ? NoiseOrder::exact : NoiseOrder::first);
    EXPECT_EQ(found.estimate.left.k, (exact ? found.exact : found.first_order).left.k);
    // Of 60 runs; the bounds of the paper's robot, times its noise.
    EXPECT_NEAR(found.estimate.left.k, times * kLeft, 4.0 * found.estimate.left.standard_error);
    EXPECT_EQ(found.fit.nonlinear, exact);
    // Which order is asked for makes no difference.
    experiment.order = NoiseOrder::exact;
    EXPECT_EQ(analyse_wheel_noise(errors, experiment).first_order.left.k, found.first_order.left.k);
    experiment.order = NoiseOrder::first;
  }
}

TEST(NoiseChecks, DoubtsNameTheirCause) {
  std::mt19937_64 random(9);
  const NoiseExperiment experiment = out_and_back();
  const auto doubts = [&](const EndErrors& errors) {
    const NoiseEstimate found = estimate_wheel_noise(errors, experiment);
    std::string all;
    for (const std::string& doubt :
         noise_doubts(errors, experiment, found, check_noise(errors, experiment, found))) {
      all += doubt + "\n";
    }
    return all;
  };
  const EndErrors good = rolled(noisy_robot(kLeft, kRight), experiment.path, kRuns, random);
  EXPECT_EQ(doubts(good), "");
  EndErrors shifted = good;
  for (Eigen::Vector3d& e : shifted) e[0] += 0.01;
  EXPECT_NE(doubts(shifted).find("--subtract-mean"), std::string::npos);
  EndErrors degrees = good;
  for (Eigen::Vector3d& e : degrees) e[2] *= 180.0 / std::numbers::pi;
  EXPECT_NE(doubts(degrees).find("degrees"), std::string::npos) << doubts(degrees);
  EndErrors millimetres = good;
  for (Eigen::Vector3d& e : millimetres) e.head<2>() *= 1000.0;
  EXPECT_NE(doubts(millimetres).find("metres"), std::string::npos) << doubts(millimetres);
  EndErrors uncorrelated = good;
  for (std::size_t k = 0; k < good.size(); ++k) uncorrelated[k][2] = good[(k + 7) % 60][2];
  EXPECT_NE(doubts(uncorrelated).find("check the path"), std::string::npos) << doubts(uncorrelated);
  EndErrors slipped = good;
  slipped[11].head<2>() += Vector2(1.0, -2.0);
  EXPECT_NE(doubts(slipped).find("run 12 ends far outside"), std::string::npos) << doubts(slipped);
}

}  // namespace
}  // namespace trussmap::wheel_noise_test
