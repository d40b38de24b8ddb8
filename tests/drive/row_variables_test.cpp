// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The variables that shapes speak of.
#include "drive/row_variables.hpp"

#include "drive/added_rows.hpp"
#include "driven.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace trussmap::row_variables_test {
using namespace recording;
namespace {

using testing::add_rows;

using Values = std::vector<double>;

/// 2 s at rest, 2 s spin left, 3 s ahead at 0.5 m/s, 3 s back; rows of 0.1 s.
MotionRows plain_drive() {
  MotionRows drive;
  add_rows(drive, 20, 0.0, 0.0, 0.4);
  add_rows(drive, 20, -0.02, 0.02, 0.4);
  add_rows(drive, 30, 0.05, 0.05, 0.4);
  add_rows(drive, 30, -0.05, -0.05, 0.4);
  drive.covariates.push_back({"lights", Values(100, 1.0)});
  return drive;
}

RowVariables variables_of(const MotionRows& drive) {
  return drive::row_variables(drive, Robot{.wheelbase = 0.4}, {}, std::vector<Pose>(drive.rows()),
                              2);
}

TEST(RowVariables, AreTheReservedOnesAndTheCovariates) {
  std::vector<std::string> names;
  for (const auto& [name, values] : variables_of(plain_drive())) names.push_back(name);
  std::vector<std::string> expected = reserved_variables();
  expected.emplace_back("lights");
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(names, expected);
  EXPECT_TRUE(is_event("spins") && is_rate("speed"));
  EXPECT_FALSE(is_event("speed") || is_rate("lights") || is_event("x"));
}

TEST(RowVariables, RatesAreThoseOfTheMotionAndStayWithinIt) {
  const RowVariables v = variables_of(plain_drive());
  EXPECT_NEAR(v.at("speed")[39], 0.0, 1e-12);  // the last of the spin
  EXPECT_NEAR(v.at("speed")[40], 0.5, 1e-12);  // the first of the drive
  EXPECT_NEAR(v.at("turn_rate")[20], 1.0, 1e-12);
  EXPECT_NEAR(v.at("turn_rate")[19], 0.0, 1e-12);
  EXPECT_NEAR(v.at("turn_rate")[40], 0.0, 1e-12);
  EXPECT_EQ(v.at("lights")[7], 1.0);
  EXPECT_EQ(v.at("session")[7], 2.0);
}

/// An angle belongs to the kind of motion in which it is turned, and counts without sign.
TEST(RowVariables, TurningIsToldByTheMotionItBelongsTo) {
  MotionRows drive = plain_drive();
  for (int k = 0; k < 20; ++k) {  // a bend to the right: 0.4 m/s, -0.5 rad/s
    drive.t.push_back(drive.t.back() + 0.1);
    testing::add_travels(drive, 0.05, 0.03, 0.4);
  }
  drive.covariates.front().values.resize(drive.rows(), 1.0);
  const RowVariables v = variables_of(drive);
  EXPECT_NEAR(v.at("spin_angle")[25], 0.1, 1e-12);
  EXPECT_EQ(v.at("arc_angle")[25], 0.0);
  EXPECT_EQ(v.at("curvature")[25], 0.0);
  EXPECT_EQ(v.at("arc_angle")[50], 0.0);  // straight
  const std::size_t bend = drive.rows() - 1;
  EXPECT_NEAR(v.at("arc_angle")[bend], 0.05, 1e-12);
  EXPECT_EQ(v.at("spin_angle")[bend], 0.0);
  EXPECT_NEAR(v.at("curvature")[bend], -0.5 / 0.4, 1e-12);
}

TEST(RowVariables, EventsComeOnce) {
  const RowVariables v = variables_of(plain_drive());
  const auto count = [&v](const char* name) {
    double sum = 0.0;
    for (const double value : v.at(name)) sum += value;
    return sum;
  };
  EXPECT_EQ(count("starts"), 1.0);
  EXPECT_EQ(v.at("starts")[40], 1.0);
  EXPECT_EQ(count("spins"), 1.0);
  EXPECT_EQ(v.at("spins")[20], 1.0);
  EXPECT_EQ(count("reverses_left"), 2.0);  // backwards, ahead, backwards
  EXPECT_EQ(v.at("reverses_left")[40], 1.0);
  EXPECT_EQ(v.at("reverses_right")[70], 1.0);
}

TEST(RowVariables, TimeAndDistanceAreAtTheRowsMiddle) {
  const RowVariables v = variables_of(plain_drive());
  EXPECT_NEAR(v.at("t")[0], 0.05, 1e-12);
  EXPECT_NEAR(v.at("t")[99], 9.95, 1e-12);
  EXPECT_NEAR(v.at("distance")[40], 0.025, 1e-12);
  EXPECT_NEAR(v.at("distance")[99], 3.0 - 0.025, 1e-12);
}

/// Encoder noise of single rows is averaged over ten of them.
TEST(RowVariables, RatesAreSmoothed) {
  MotionRows drive = plain_drive();
  for (std::size_t row = 40; row < 70; ++row) {
    drive.pair.left[row] += row % 2 == 0 ? 0.01 : -0.01;
    drive.pair.right[row] += row % 2 == 0 ? 0.01 : -0.01;
  }
  testing::retake(drive, 0.4);
  const RowVariables v = variables_of(drive);
  for (std::size_t row = 45; row < 65; ++row) {
    EXPECT_NEAR(v.at("speed")[row], 0.5, 0.1 / 11.0 + 1e-9) << row;  // a single row is off by 0.1
  }
}

}  // namespace
}  // namespace trussmap::row_variables_test
