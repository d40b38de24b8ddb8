// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where the robot was, by a model.
#include "driven.hpp"
#include "estimation/simulated_recordings.hpp"
#include "fit/fit_state.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/recording_files.hpp"

#include <cmath>
#include <complex>
#include <sstream>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace trussmap::robot_poses_test {
namespace {

using testing::Equipment;
using testing::simulate_recording;
using testing::SimulatedRecording;

SimulatedRecording simulated(bool compass, std::uint64_t seed) {
  Equipment equipment;
  equipment.compass = compass;
  return simulate_recording(equipment, seed);
}

/// Row by row, with complex numbers: chords along the mean heading, as replayed elsewhere.
TEST(DeadReckonedPoses, AreTheRowsOneAfterTheOther) {
  const SimulatedRecording world = simulated(false, 3);
  Model model = world.model;
  model.effects = {catalogue_effect("wheelbase", {0.03}),
                   catalogue_effect("travel scale", {-0.02})};
  const std::vector<TimedPose> poses = dead_reckoned_poses(world.recording, model);
  const MotionRows& drive = world.recording.drive;
  ASSERT_EQ(poses.size(), drive.rows() + 1);
  EXPECT_EQ(poses.front().t, drive.start());
  EXPECT_EQ(poses.front().estimate.covariance, Matrix3(Matrix3::Zero()));
  std::complex<double> place;
  double heading = 0.0;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double turn =
        1.03 * (drive.pair.right[row] - drive.pair.left[row]) / model.robot.wheelbase;
    const double way = 0.98 * 0.5 * (drive.pair.right[row] + drive.pair.left[row]);
    const double chord = std::abs(turn) < 1e-9 ? way : way * std::sin(0.5 * turn) / (0.5 * turn);
    place += std::polar(chord, heading + 0.5 * turn);
    heading += turn;
    const Pose& pose = poses[row + 1].estimate.pose;
    EXPECT_NEAR(pose.x, place.real(), 1e-9);
    EXPECT_NEAR(pose.y, place.imag(), 1e-9);
    EXPECT_NEAR(pose.heading, heading, 1e-9);
  }
}

/// 200 robots that go astray as the model says are as far off as their covariances say.
TEST(DeadReckonedPoses, CovariancesAreThoseOfTheModelsNoise) {
  const SimulatedRecording world = simulated(false, 4);
  DrivenRecording recording = world.recording;
  recording.drive.t.resize(400);
  recording.drive.pair.left.resize(400);
  recording.drive.pair.right.resize(400);
  testing::retake(recording.drive);
  for (Covariate& one : recording.drive.covariates) one.values.resize(400);
  recording.sightings.clear();
  const Model& model = world.model;
  const std::vector<TimedPose> right = dead_reckoned_poses(recording, model);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const int runs = 400;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (int run = 0; run < runs; ++run) {
    DrivenRecording astray = recording;
    for (std::size_t row = 0; row < astray.drive.rows(); ++row) {
      double& left = astray.drive.pair.left[row];
      double& wheel = astray.drive.pair.right[row];
      left += model.noise.left * std::sqrt(std::abs(left)) * normal(random);
      wheel += model.noise.right * std::sqrt(std::abs(wheel)) * normal(random);
    }
    testing::retake(astray.drive);
    const Pose end = dead_reckoned_poses(astray, model).back().estimate.pose;
    const Pose& truth = right.back().estimate.pose;
    squares +=
        Eigen::Vector3d(end.x - truth.x, end.y - truth.y, end.heading - truth.heading).cwiseAbs2();
  }
  const Matrix3& covariance = right.back().estimate.covariance;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(squares[k] / runs / covariance(k, k), 1.0, 0.3) << k;  // 4 sds of a variance
  }
}

/// At what was measured they are the adjustment's own; in between they are never better known than
/// the better of both ends by more than rounding, and grow towards the middle.
TEST(AdjustedPoses, AreTheFitsWithItsCovariances) {
  for (const bool compass : {true, false}) {
    const SimulatedRecording world = simulated(compass, 5);
    const ModelFit fit = fit_model({world.recording}, world.model);
    const std::vector<TimedPose> poses = adjusted_poses(fit);
    const fitting::FitState& state = *fit.state;
    ASSERT_EQ(poses.size(), world.recording.drive.rows() + 1);
    int compared = 0;
    for (std::size_t k = 0; k < state.problem.poses.size(); k += 7) {
      const double t = state.problem.poses[k].t;
      const auto at = std::find_if(poses.begin(), poses.end(), [t](const TimedPose& one) {
        return std::abs(one.t - t) < 1e-9;
      });
      if (at == poses.end()) continue;
      const Pose& pose = state.adjustment.state.poses[k];
      EXPECT_NEAR(at->estimate.pose.x, pose.x, 1e-6);
      EXPECT_NEAR(at->estimate.pose.heading, pose.heading, 1e-6);
      const Eigen::MatrixXd covariance =
          estimation::joint_covariance(state.problem, state.columns.border, state.adjustment,
                                       {state.problem.pose_node(static_cast<int>(k))});
      EXPECT_LT((at->estimate.covariance - covariance.topLeftCorner<3, 3>()).norm(),
                1e-6 * covariance.norm() + 1e-12)
          << "t = " << t;
      ++compared;
    }
    EXPECT_GT(compared, 5);
    for (const TimedPose& one : poses) {
      EXPECT_GE(one.estimate.covariance(0, 0), 0.0);
      EXPECT_GE(one.estimate.covariance(2, 2), 0.0);
    }
  }
  const SimulatedRecording world = simulated(true, 5);
  EXPECT_THROW(static_cast<void>(adjusted_poses(fit_model({world.recording}, world.model), 1)),
               std::invalid_argument);
}

TEST(PoseText, ReadsBackToTheSameNumbers) {
  const SimulatedRecording world = simulated(true, 6);
  const std::vector<TimedPose> poses = dead_reckoned_poses(world.recording, world.model);
  std::istringstream csv(format_poses(poses));
  std::istringstream tum(format_tum(poses));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "t,x,y,heading,c_xx,c_xy,c_xh,c_yy,c_yh,c_hh");
  std::getline(tum, line);
  for (const TimedPose& one : poses) {
    ASSERT_TRUE(std::getline(csv, line));
    std::istringstream fields(line);
    std::vector<double> values;
    for (std::string field; std::getline(fields, field, ',');) values.push_back(std::stod(field));
    ASSERT_EQ(values.size(), 10U);
    EXPECT_EQ(values[0], one.t);
    EXPECT_EQ(values[3], one.estimate.pose.heading);
    EXPECT_EQ(values[5], one.estimate.covariance(0, 1));
    EXPECT_EQ(values[9], one.estimate.covariance(2, 2));
    double t = 0.0, x = 0.0, y = 0.0, z = 0.0, qx = 0.0, qy = 0.0, qz = 0.0, qw = 0.0;
    ASSERT_TRUE(static_cast<bool>(tum >> t >> x >> y >> z >> qx >> qy >> qz >> qw));
    EXPECT_EQ(t, one.t);
    EXPECT_EQ(x, one.estimate.pose.x);
    EXPECT_EQ(y, one.estimate.pose.y);
    const double half = 0.5 * wrap_angle(one.estimate.pose.heading);
    EXPECT_EQ(qz, std::sin(half));
    EXPECT_EQ(qw, std::cos(half));
    EXPECT_EQ(z, 0.0);
    EXPECT_EQ(qx, 0.0);
    EXPECT_EQ(qy, 0.0);
    EXPECT_NEAR(wrap_angle(2.0 * std::atan2(qz, qw) - one.estimate.pose.heading), 0.0, 1e-12);
  }
}

/// What the benchmark's own programs and evo read: twelve numbers a line, nothing else.
TEST(PoseText, KittiLinesAreTheMatricesOfThePoses) {
  const SimulatedRecording world = simulated(true, 6);
  const std::vector<TimedPose> poses = dead_reckoned_poses(world.recording, world.model);
  std::istringstream kitti(format_kitti(poses));
  std::string line;
  for (const TimedPose& one : poses) {
    ASSERT_TRUE(std::getline(kitti, line));
    std::istringstream numbers(line);
    Eigen::Matrix<double, 3, 4> matrix;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 4; ++j) ASSERT_TRUE(static_cast<bool>(numbers >> matrix(i, j)));
    }
    EXPECT_TRUE(numbers.eof());
    const Pose& pose = one.estimate.pose;
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(pose.heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    EXPECT_LT((matrix.leftCols<3>() - rotation).norm(), 1e-14);
    EXPECT_EQ(matrix(0, 0), std::cos(pose.heading));
    EXPECT_EQ(matrix(1, 0), std::sin(pose.heading));
    EXPECT_EQ(matrix(0, 3), pose.x);
    EXPECT_EQ(matrix(1, 3), pose.y);
    EXPECT_EQ(matrix(2, 3), 0.0);
  }
  EXPECT_FALSE(std::getline(kitti, line));
}

}  // namespace
}  // namespace trussmap::robot_poses_test
