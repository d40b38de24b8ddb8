// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT

#include "trussmap/simulation.hpp"
#include "trussmap/wheel_noise.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::wall_distances_test {
namespace {

/// The paper's: two to the long side, at the robot's right, one to the short side, behind it.
WallSensors sonar_calibrator(double sd = 0.0) {
  return {{{Faces::right, {0.2, -0.15}, sd},
           {Faces::right, {-0.2, -0.15}, sd},
           {Faces::behind, {-0.25, 0.05}, sd}}};
}

/// By the points themselves: how far they are from where the walls' lines run.
WallDistances measured(const WallSensors& sensors, const Pose& pose) {
  WallDistances distances = {};
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = pose.x + std::cos(pose.heading) * sensors[k].at.x() -
                     std::sin(pose.heading) * sensors[k].at.y();
    const double y = pose.y + std::sin(pose.heading) * sensors[k].at.x() +
                     std::cos(pose.heading) * sensors[k].at.y();
    const bool by_x = sensors[k].faces == Faces::ahead || sensors[k].faces == Faces::behind;
    distances[k] = std::abs(by_x ? x : y);  // the walls are the axes
  }
  return distances;
}

/// A corner that sensors facing so look into: signs of x and y of the room.
Pose in_the_room(const WallSensors& sensors, double x, double y, double heading) {
  for (const WallSensor& sensor : sensors) {
    if (sensor.faces == Faces::ahead) x = -std::abs(x);
    if (sensor.faces == Faces::left) y = -std::abs(y);
  }
  return {x, y, heading};
}

const std::vector<WallSensors> kMountings = {
    sonar_calibrator(),
    {{{Faces::left, {0.3, 0.2}}, {Faces::left, {-0.1, 0.22}}, {Faces::ahead, {0.3, 0.0}}}},
    {{{Faces::ahead, {0.3, 0.2}}, {Faces::left, {0.1, 0.25}}, {Faces::ahead, {0.28, -0.2}}}},
    {{{Faces::right, {0.1, -0.2}}, {Faces::behind, {-0.2, -0.3}}, {Faces::behind, {-0.2, 0.3}}}}};

TEST(WallDistances, GiveBackWhereTheyWereMeasured) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(0.6, 3.0);
  std::uniform_real_distribution<double> heading(-0.7, 0.7);
  for (const WallSensors& sensors : kMountings) {
    for (int k = 0; k < 200; ++k) {
      const double x = place(random);
      const double y = place(random);
      const Pose truth = in_the_room(sensors, x, y, heading(random));
      const WallPose found = pose_by_walls(sensors, measured(sensors, truth));
      EXPECT_NEAR(found.pose.x, truth.x, 1e-12);
      EXPECT_NEAR(found.pose.y, truth.y, 1e-12);
      EXPECT_NEAR(found.pose.heading, truth.heading, 1e-12);
    }
  }
}

TEST(WallDistances, CovarianceIsThatOfScatteredDistances) {
  // 20000 draws: standard errors of a variance are 1 %.
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (WallSensors sensors : kMountings) {
    sensors[0].sd = 0.001;
    sensors[1].sd = 0.002;
    sensors[2].sd = 0.003;
    const Pose truth = in_the_room(sensors, 1.0, 1.5, 0.3);
    const WallDistances exact = measured(sensors, truth);
    const Matrix3 stated = pose_by_walls(sensors, exact).covariance;
    Matrix3 seen = Matrix3::Zero();
    constexpr int kDraws = 20000;
    for (int k = 0; k < kDraws; ++k) {
      WallDistances drawn = exact;
      for (std::size_t i = 0; i < 3; ++i) drawn[i] += sensors[i].sd * normal(random);
      const Pose found = pose_by_walls(sensors, drawn).pose;
      const Eigen::Vector3d off(found.x - truth.x, found.y - truth.y,
                                found.heading - truth.heading);
      seen += off * off.transpose() / kDraws;
    }
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index j = 0; j < 3; ++j) {
        EXPECT_NEAR(seen(i, j), stated(i, j), 0.05 * std::sqrt(stated(i, i) * stated(j, j)));
      }
    }
  }
}

TEST(WallDistances, ThePapersAccuracyIsThatOfSensorsFortyCentimetresApart) {
  // "within +-2 millimeters in the x and y directions, and to about +-0.4 degrees".
  const WallSensors sensors = sonar_calibrator(0.002);
  const Matrix3 covariance = pose_by_walls(sensors, measured(sensors, {1.0, 1.0, 0.0})).covariance;
  EXPECT_NEAR(std::sqrt(covariance(2, 2)) * 180.0 / std::numbers::pi, 0.4, 0.01);
  EXPECT_NEAR(std::sqrt(covariance(1, 1)), 0.002 / std::sqrt(2.0), 1e-6);  // the mean of two
}

TEST(WallEndError, IsWhatTheRunDidBesideWhatTheOdometryHas) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, 0.1);
  for (const WallSensors& sensors : kMountings) {
    for (int k = 0; k < 50; ++k) {
      const double askew = normal(random);
      const Pose start = in_the_room(sensors, 1.2, 1.4, askew);
      // Its end, from the start, and what its odometry made of it.
      const double ahead = normal(random);
      const double left = normal(random);
      const double turn = normal(random);
      const Pose end{start.x + std::cos(askew) * ahead - std::sin(askew) * left,
                     start.y + std::sin(askew) * ahead + std::cos(askew) * left, askew + turn};
      const Pose odometry{normal(random), normal(random), 2.0 * std::numbers::pi + normal(random)};
      const WallError found =
          end_error(sensors, {measured(sensors, start), measured(sensors, end), odometry});
      EXPECT_NEAR(found.error[0], ahead - odometry.x, 1e-12);
      EXPECT_NEAR(found.error[1], left - odometry.y, 1e-12);
      EXPECT_NEAR(found.error[2], wrap_angle(turn - odometry.heading), 1e-12);
    }
  }
}

TEST(WallEndError, CovarianceFollowsFromDifferences) {
  WallSensors sensors = sonar_calibrator();
  for (std::size_t i = 0; i < 3; ++i) sensors[i].sd = 0.001 * static_cast<double>(i + 1);
  const WallRun run{measured(sensors, {1.0, 1.1, 0.1}), measured(sensors, {1.4, 0.9, -0.2}), {}};
  Matrix3 expected = Matrix3::Zero();
  constexpr double h = 1e-6;
  for (std::size_t i = 0; i < 3; ++i) {
    for (WallDistances WallRun::*which : {&WallRun::start, &WallRun::end}) {
      WallRun more = run;
      WallRun less = run;
      (more.*which)[i] += h;
      (less.*which)[i] -= h;
      const Eigen::Vector3d slope =
          (end_error(sensors, more).error - end_error(sensors, less).error) / (2.0 * h);
      expected += sensors[i].sd * sensors[i].sd * slope * slope.transpose();
    }
  }
  const Matrix3 stated = end_error(sensors, run).covariance;
  EXPECT_LT((stated - expected).cwiseAbs().maxCoeff(), 1e-9 * expected.cwiseAbs().maxCoeff());
}

TEST(WallEndError, SensorsThatAlwaysReadTooFarCancel) {
  const WallSensors sensors = sonar_calibrator();
  WallRun run{measured(sensors, {1.0, 1.1, 0.01}), measured(sensors, {1.1, 0.9, -0.02}), {}};
  const Eigen::Vector3d exact = end_error(sensors, run).error;
  for (WallDistances* one : {&run.start, &run.end}) {
    (*one)[0] += 0.01;
    (*one)[1] += 0.004;
    (*one)[2] -= 0.02;
  }
  // The heading at the start is off by 15 mrad, and turns what is a difference of 0.2 m.
  EXPECT_LT((end_error(sensors, run).error - exact).norm(), 0.015 * 0.25);
  EXPECT_GT((end_error(sensors, run).error - exact).norm(), 0.0);
}

TEST(WallDistances, TheirNoiseStatedLeavesTheWheelsUnbiased) {
  // 60 runs out and back; 2 mm per distance blur the heading as much as the wheels do.
  constexpr double kNoise = 0.0005;
  const WallSensors sensors = sonar_calibrator(0.002);
  NoiseExperiment experiment;
  const TapeRobot still = misbuilt_robot(experiment.wheelbase, 1.0, 1.0);
  TapeRobot robot = still;
  robot.left_noise = robot.right_noise = kNoise;
  robot.step = 0.25;
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0.0, 0.002);
  const Pose start{1.0, 1.2, 0.02};
  constexpr int kTrials = 60;
  Vector2 with = Vector2::Zero();
  Vector2 without = Vector2::Zero();
  Vector2 squares = Vector2::Zero();
  for (int trial = 0; trial < kTrials; ++trial) {
    EndErrors errors;
    for (const Pose& drift : drive_often(robot, experiment.path, 60, random)) {
      const Pose end{
          start.x + std::cos(start.heading) * drift.x - std::sin(start.heading) * drift.y,
          start.y + std::sin(start.heading) * drift.x + std::cos(start.heading) * drift.y,
          start.heading + drift.heading};
      WallRun run{measured(sensors, start), measured(sensors, end), {}};
      for (WallDistances* one : {&run.start, &run.end}) {
        for (double& distance : *one) distance += normal(random);
      }
      const WallError one = end_error(sensors, run);
      errors.push_back(one.error);
      experiment.sensor_covariance = one.covariance;
    }
    const Vector2 squared = estimate_wheel_noise(errors, experiment).squared;
    with += squared / kTrials;
    squares += squared.cwiseAbs2() / kTrials;
    NoiseExperiment silent = experiment;
    silent.sensor_covariance.setZero();
    without += estimate_wheel_noise(errors, silent).squared / kTrials;
  }
  const Vector2 error = ((squares - with.cwiseAbs2()) / kTrials).cwiseSqrt();
  for (Eigen::Index wheel = 0; wheel < 2; ++wheel) {
    EXPECT_NEAR(with[wheel], kNoise * kNoise, 4.0 * error[wheel]);
    EXPECT_GT(without[wheel], 1.2 * kNoise * kNoise);
  }
}

TEST(WallDistances, RefuseSensorsAndDistancesThatSayNothing) {
  const WallSensors good = sonar_calibrator();
  WallSensors opposite = good;
  opposite[2].faces = Faces::left;
  WallSensors three_ways = good;
  three_ways[1].faces = Faces::ahead;
  WallSensors together = good;
  together[1].at = together[0].at;
  WallSensors unsure = good;
  unsure[0].sd = -1.0;
  for (const WallSensors& bad : {opposite, three_ways, together, unsure}) {
    EXPECT_THROW(check_wall_sensors(bad), std::invalid_argument);
  }
  check_wall_sensors(good);
  EXPECT_THROW((void)pose_by_walls(good, {1.0, 1.5, 1.0}), std::invalid_argument);   // 0.5 m on 0.4
  EXPECT_THROW((void)pose_by_walls(good, {1.0, 1.35, 1.0}), std::invalid_argument);  // 61 degrees
}

}  // namespace
}  // namespace trussmap::wall_distances_test
