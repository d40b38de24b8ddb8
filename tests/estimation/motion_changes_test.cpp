// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/motion_changes.hpp"

#include "driven.hpp"

#include <gtest/gtest.h>

namespace trussmap::motion_changes_test {
namespace {

/// So many rows of 0.1 s of these travels.
void add(MotionRows& drive, int rows, double left, double right) {
  for (int k = 0; k < rows; ++k) {
    drive.t.push_back(0.1 * static_cast<double>(drive.rows() + 1));
    testing::add_travels(drive, left, right, 0.3);
  }
}

std::vector<double> changes(const MotionRows& drive) {
  const Robot robot{0.3};
  return estimation::motion_changes(
      drive, estimation::segment_rows(drive, drive.start(), drive.t.back()), robot, {});
}

TEST(MotionChanges, ASpinAndADriveAreTwoMotions) {
  MotionRows drive;
  add(drive, 10, -0.03, 0.03);
  add(drive, 10, 0.1, 0.1);
  ASSERT_EQ(changes(drive).size(), 1U);
  EXPECT_NEAR(changes(drive).front(), 1.0, 1e-12);
}

/// The heading after it is as uncertain as all that was turned.
TEST(MotionChanges, ASpinThereAndBackIsAMotion) {
  MotionRows drive;
  add(drive, 10, -0.03, 0.03);
  add(drive, 10, 0.03, -0.03);
  add(drive, 10, 0.1, 0.1);
  ASSERT_EQ(changes(drive).size(), 1U);
  EXPECT_NEAR(changes(drive).front(), 2.0, 1e-12);
}

TEST(MotionChanges, ATwitchIsNone) {
  MotionRows drive;
  add(drive, 10, 0.1, 0.1);
  add(drive, 1, -0.01, 0.01);
  add(drive, 10, 0.1, 0.1);
  EXPECT_TRUE(changes(drive).empty());
}

}  // namespace
}  // namespace trussmap::motion_changes_test
