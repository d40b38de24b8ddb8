// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The variables of shapes as a robot knows them when a row ends.
#include "drive/causal_variables.hpp"

#include "drive/added_rows.hpp"
#include "driven.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::causal_variables_test {
using namespace drive;
namespace {

using testing::add_rows;

constexpr double kWheelbase = 0.4;  // m

/// Rows of 0.1 s: 2 s at rest, 2 s spin left, 3 s ahead at 0.5 m/s, 3 s of a bend, 3 s back.
MotionRows plain_drive() {
  MotionRows drive;
  add_rows(drive, 20, 0.0, 0.0, kWheelbase);
  add_rows(drive, 20, -0.02, 0.02, kWheelbase);
  add_rows(drive, 30, 0.05, 0.05, kWheelbase);
  add_rows(drive, 30, 0.03, 0.05, kWheelbase);
  add_rows(drive, 30, -0.05, -0.05, kWheelbase);
  return drive;
}

const Robot kRobot{.wheelbase = kWheelbase};

/// By two wheels, without a gyro.
CausalRow next(const CausalVariables& variables, double left, double right, double duration) {
  return variables.next({{left, right}}, body_motion({left, right}, kWheelbase), duration);
}
void take(CausalVariables& variables, double left, double right, double duration) {
  variables.take({{left, right}}, body_motion({left, right}, kWheelbase), duration);
}

std::vector<CausalRow> causal_rows(const MotionRows& drive) {
  CausalVariables variables;
  std::vector<CausalRow> rows;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    rows.push_back(
        next(variables, drive.pair.left[row], drive.pair.right[row], drive.duration(row)));
    take(variables, drive.pair.left[row], drive.pair.right[row], drive.duration(row));
  }
  return rows;
}

TEST(CausalVariables, AreThoseOfTheWholeDriveButForRates) {
  const MotionRows drive = plain_drive();
  const std::vector<CausalRow> rows = causal_rows(drive);
  const std::vector<Pose> nowhere(drive.rows());
  const RowVariables middle = row_variables(drive, kRobot, {}, nowhere, 0);
  const RowVariables end = instant_variables(drive, kRobot, drive.t, nowhere, 0);
  const std::vector<MotionKind> kinds = motion_kinds(drive, kRobot);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_EQ(rows[k].kind, kinds[k]);
    EXPECT_NEAR(rows[k].t, middle.at("t")[k], 1e-9);
    EXPECT_NEAR(rows[k].t_end, end.at("t")[k], 1e-9);
    EXPECT_NEAR(rows[k].distance, middle.at("distance")[k], 1e-12);
    EXPECT_NEAR(rows[k].distance_end, end.at("distance")[k], 1e-12);
    EXPECT_EQ(rows[k].session, middle.at("session")[k]);
    EXPECT_EQ(rows[k].starts, middle.at("starts")[k]);
    EXPECT_EQ(rows[k].spins, middle.at("spins")[k]);
    EXPECT_EQ(rows[k].reverses_left, middle.at("reverses_left")[k]);
    EXPECT_EQ(rows[k].reverses_right, middle.at("reverses_right")[k]);
  }
}

/// Row by row, with loops. Eleven rows of 0.1 s have middles within a second.
TEST(CausalVariables, RatesAreMeansOverTheLastSecondOfOneKindOfMotion) {
  const MotionRows drive = plain_drive();
  const std::vector<CausalRow> rows = causal_rows(drive);
  const std::vector<MotionKind> kinds = motion_kinds(drive, kRobot);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    double travel = 0.0;
    double turn = 0.0;
    std::size_t first = k + 1;
    while (first > 0 && k - (first - 1) <= 10 && kinds[first - 1] == kinds[k]) {
      --first;
      travel += 0.5 * (drive.pair.left[first] + drive.pair.right[first]);
      turn += (drive.pair.right[first] - drive.pair.left[first]) / kWheelbase;
    }
    const double time = 0.1 * static_cast<double>(k - first + 1);
    EXPECT_NEAR(rows[k].speed, travel / time, 1e-9) << k;
    EXPECT_NEAR(rows[k].turn_rate, turn / time, 1e-9) << k;
    const double since = 0.1 * static_cast<double>(k - first);
    EXPECT_NEAR(rows[k].acceleration,
                k == first ? 0.0 : (rows[k].speed - rows[first].speed) / since, 1e-9)
        << k;
    const bool drives = kinds[k] == MotionKind::driving;
    const bool spins = kinds[k] == MotionKind::spinning;
    EXPECT_NEAR(rows[k].arc_angle, drives ? 0.1 * std::abs(turn / time) : 0.0, 1e-9);
    EXPECT_NEAR(rows[k].spin_angle, spins ? 0.1 * std::abs(turn / time) : 0.0, 1e-9);
    EXPECT_NEAR(rows[k].curvature, drives ? turn / travel : 0.0, 1e-9);
  }
}

/// From 0.5 m/s on at 0.2 m/s^2: the mean over the last second is 0.1 m/s behind.
TEST(CausalVariables, RatesAreHalfASecondLateWhileTheyChange) {
  MotionRows drive;
  for (int k = 0; k < 100; ++k) {
    const double speed = 0.5 + 0.2 * 0.1 * (k + 0.5);  // at the row's middle
    drive.t.push_back(0.1 * (k + 1));
    testing::add_travels(drive, 0.1 * speed, 0.1 * speed, kWheelbase);
  }
  const std::vector<CausalRow> rows = causal_rows(drive);
  const RowVariables whole = row_variables(drive, kRobot, {}, std::vector<Pose>(drive.rows()), 0);
  for (std::size_t k = 20; k < 90; ++k) {
    EXPECT_NEAR(whole.at("speed")[k] - rows[k].speed, 0.1, 1e-9);
    EXPECT_NEAR(rows[k].acceleration, 0.2, 1e-9);
  }
}

TEST(CausalVariables, AskingChangesNothing) {
  CausalVariables variables;
  take(variables, 0.05, 0.06, 0.1);
  const CausalRow first = next(variables, 0.05, 0.05, 0.1);
  static_cast<void>(next(variables, -1.0, 2.0, 3.0));
  const CausalRow again = next(variables, 0.05, 0.05, 0.1);
  EXPECT_EQ(first.speed, again.speed);
  EXPECT_EQ(first.t, again.t);
}

}  // namespace
}  // namespace trussmap::causal_variables_test
