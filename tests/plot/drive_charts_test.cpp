// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/drive_charts.hpp"

#include "other_drives.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::drive_charts_test {
using namespace plot;
namespace {

using testing::other_drive;
using testing::OtherDrive;
using testing::recorded;

const ChartLayer& layer_of(const Chart& chart, LayerKind kind, const std::string& colour) {
  const auto found =
      std::find_if(chart.layers.begin(), chart.layers.end(),
                   [&](const ChartLayer& one) { return one.kind == kind && one.colour == colour; });
  EXPECT_NE(found, chart.layers.end());
  return *found;
}

/// Ahead, and to the left, along the k-th stroke.
Vector2 stroke_of(const ChartLayer& layer, std::size_t k) {
  const auto at = [&](std::size_t column) { return layer.columns[column].numbers[k]; };
  return Vector2(at(3) - at(1), at(0) - at(2)).normalized();
}

/// A stroke lies along the way that its wheel shows of what the body does ahead and to the left.
TEST(WheelsChart, StrokesLieAlongTheWayThatWheelsRoll) {
  for (const DriveKind kind : {DriveKind::skid_steer, DriveKind::omni3, DriveKind::wheels}) {
    const OtherDrive drive = other_drive(kind);
    const Chart chart = wheels_chart(drive.model.robot, {});
    const ChartLayer& wheels = layer_of(chart, LayerKind::segments, "1");
    const std::vector<double> ahead = drive.wheels({1.0, 0.0, 0.0});
    const std::vector<double> left = drive.wheels({0.0, 1.0, 0.0});
    ASSERT_EQ(wheels.columns[0].size(), ahead.size());
    for (std::size_t k = 0; k < ahead.size(); ++k) {
      EXPECT_NEAR(stroke_of(wheels, k).dot(Vector2(ahead[k], left[k]).normalized()), 1.0, 1e-9);
    }
    const ChartLayer& names = layer_of(chart, LayerKind::labels, "ink");
    EXPECT_EQ(names.columns[2].texts, drive.model.robot.columns);
  }
}

/// Mecanum wheels show the way along their rollers' axes.
TEST(WheelsChart, RollersLieAlongTheWayThatTheyHold) {
  const OtherDrive drive = other_drive(DriveKind::mecanum);
  const Chart chart = wheels_chart(drive.model.robot, {});
  const ChartLayer& rollers = layer_of(chart, LayerKind::segments, "2");
  const std::vector<double> ahead = drive.wheels({1.0, 0.0, 0.0});
  const std::vector<double> left = drive.wheels({0.0, 1.0, 0.0});
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(stroke_of(rollers, k).dot(Vector2(ahead[k], left[k]).normalized()), 1.0, 1e-9);
  }
}

TEST(WheelsChart, IsEmptyWhereNobodySaidWhereTheWheelsAre) {
  Robot robot;
  robot.drive = DriveKind::wheels;
  robot.columns = {"a", "b", "c"};
  robot.matrix = Eigen::MatrixXd::Identity(3, 3);
  EXPECT_TRUE(wheels_chart(robot, {}).layers.empty());
}

TEST(WheelsChart, CanBeDrawnForEveryDrive) {
  for (const DriveKind kind :
       {DriveKind::differential, DriveKind::skid_steer, DriveKind::tricycle, DriveKind::ackermann,
        DriveKind::omni3, DriveKind::mecanum, DriveKind::wheels}) {
    Robot robot = other_drive(kind).model.robot;
    if (kind == DriveKind::differential) robot = {.columns = {"left", "right"}};
    EXPECT_FALSE(chart_json(wheels_chart(robot, Range{-0.3, 0.4})).empty());
  }
}

TEST(SteeringChart, SharesAreOfTheWayForwardsAndBackwards) {
  OtherDrive drive = other_drive(DriveKind::tricycle);
  Recording recording = recorded(drive, drive.wheels);
  // The last third backwards.
  std::vector<double>& travel = recording.drive.covariates[0].values;
  double way = 0.0;
  double back = 0.0;
  for (std::size_t row = 0; row < travel.size(); ++row) {
    way += travel[row];
    if (3 * row < 2 * travel.size()) continue;
    back += travel[row];
    travel[row] = -travel[row];
  }
  const auto steering = steering_of({with_wheels(recording, drive.model.robot)});
  ASSERT_TRUE(steering);
  const auto share = [&](std::size_t layer, std::size_t column) {
    const std::vector<double>& numbers = steering->chart.layers[layer].columns[column].numbers;
    return 0.5 * std::accumulate(numbers.begin(), numbers.end(), 0.0);  // two edges each
  };
  EXPECT_NEAR(share(0, 2), 100.0 * (1.0 - back / way), 1e-9);
  EXPECT_NEAR(share(1, 1), -100.0 * back / way, 1e-9);
  const std::vector<double>& angles = recording.drive.covariates[1].values;
  EXPECT_EQ(steering->angles.low, *std::min_element(angles.begin(), angles.end()));
  EXPECT_EQ(steering->angles.high, *std::max_element(angles.begin(), angles.end()));
}

TEST(SteeringChart, IsOfRobotsThatSteerAndMoveAlone) {
  const OtherDrive omni = other_drive(DriveKind::omni3);
  EXPECT_FALSE(steering_of({with_wheels(recorded(omni, omni.wheels), omni.model.robot)}));
  const OtherDrive drive = other_drive(DriveKind::tricycle);
  Recording still = recorded(drive, drive.wheels);
  for (double& one : still.drive.covariates[0].values) one = 0.0;
  EXPECT_FALSE(steering_of({with_wheels(still, drive.model.robot)}));
}

}  // namespace
}  // namespace trussmap::drive_charts_test
