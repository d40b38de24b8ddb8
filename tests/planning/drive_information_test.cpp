// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "planning/drive_information.hpp"

#include "criticism/score_test.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/simulation.hpp"

#include <cmath>
#include <random>

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace trussmap::drive_information_test {
using namespace planning;
namespace {

/// Two drives over all routes of 3 x 3 landmarks, with noise.
std::vector<DrivenRecording> two_drives(bool surveyed, bool compass) {
  const Mesh mesh = even_mesh({3, 3}, 4.0);
  WheeledRobot robot;
  robot.compass = compass;
  std::vector<DrivenRecording> drives;
  for (const std::uint64_t seed : {11U, 12U}) {
    std::mt19937_64 random(seed);
    const std::vector<int> walk = make_tours(mesh, WalkKind::euler, 2, random).walk;
    Recording recording = simulate_drive(mesh, walk, {}, robot, seed).recording;
    recording.name = seed == 11U ? "one" : "two";
    if (!surveyed || seed == 12U) recording.survey.clear();
    drives.push_back(with_wheels(recording, Robot()));
  }
  return drives;
}

const std::vector<Effect> kAsked = {
    catalogue_effect("wheel diameter ratio"), catalogue_effect("wheelbase"),
    catalogue_effect("slip with speed"), catalogue_effect("turn asymmetry")};

class DriveInformationOf : public ::testing::TestWithParam<std::pair<bool, bool>> {};

/// What score tests know of both drives, adjusted at once, against the sum of what each says alone.
/// Each alone has a path and a map of its own, noise and all, so the columns differ by a share of
/// the noise's: 2 % of the larger norm.
TEST_P(DriveInformationOf, TwoDrivesIsThatOfTheirJointFit) {
  const auto [surveyed, compass] = GetParam();
  const std::vector<DrivenRecording> drives = two_drives(surveyed, compass);
  const ModelFit both = fit_model(drives, Model());
  const criticism::ScoreTest tests(*both.state);
  Eigen::MatrixXd columns(tests.system().rows(), 0);
  for (const Effect& one : kAsked) {
    const Eigen::MatrixXd own = tests.free_of_map(tests.columns(one));
    columns.conservativeResize(Eigen::NoChange, columns.cols() + own.cols());
    columns.rightCols(own.cols()) = own;
  }
  const Eigen::MatrixXd expected = columns.transpose() * columns;
  const ModelFit one = fit_model(std::vector<DrivenRecording>{drives[0]}, Model());
  const ModelFit two = fit_model(std::vector<DrivenRecording>{drives[1]}, Model());
  const Eigen::MatrixXd gram = gram_of(sum_of(information_of(*one.state, {kAsked, {}, true}),
                                              information_of(*two.state, {kAsked, {}, true})));
  ASSERT_EQ(gram.cols(), expected.cols());
  for (Eigen::Index i = 0; i < gram.rows(); ++i) {
    for (Eigen::Index j = 0; j < gram.cols(); ++j) {
      const double scale = std::sqrt(expected(i, i) * expected(j, j));
      EXPECT_NEAR(gram(i, j) / scale, expected(i, j) / scale, 0.02) << i << ", " << j;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Drives, DriveInformationOf,
                         ::testing::Values(std::pair(true, true), std::pair(false, true),
                                           std::pair(true, false), std::pair(false, false)));

TEST(DriveInformation, OfOneRecordingIsThatOfItsScoreTests) {
  const std::vector<DrivenRecording> drives = two_drives(true, true);
  const ModelFit fit = fit_model(std::vector<DrivenRecording>{drives[0]}, Model());
  const criticism::ScoreTest tests(*fit.state);
  const Eigen::MatrixXd gram = gram_of(information_of(*fit.state, {kAsked, {}, true}));
  for (std::size_t k = 0; k < kAsked.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    const double expected = tests.test({kAsked[k]}).front().information.front();
    EXPECT_NEAR(gram(at, at), expected, 1e-6 * expected) << kAsked[k].name;
  }
}

/// The Schur complement against least squares of random columns.
TEST(Without, IsWhatProjectionLeaves) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd X(30, 5);
  for (double& value : X.reshaped()) value = normal(random);
  X.col(3) *= 1e4;  // of another unit
  const Eigen::MatrixXd gone = X(Eigen::all, std::vector<Eigen::Index>{1, 3});
  const Eigen::MatrixXd kept = X(Eigen::all, std::vector<Eigen::Index>{0, 2, 4});
  const Eigen::MatrixXd left = kept - gone * gone.colPivHouseholderQr().solve(kept);
  const Eigen::MatrixXd found = without(X.transpose() * X, {1, 3});
  EXPECT_LT((found - left.transpose() * left).norm(), 1e-9);
}

}  // namespace
}  // namespace trussmap::drive_information_test
