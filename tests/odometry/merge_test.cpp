// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Rows cut to a span of time, and rows merged into arcs.
#include "odometry/merge.hpp"

#include "driven.hpp"
#include "geometry/index.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::merge_test {
using namespace odometry;
namespace {

constexpr double kWheelbase = 0.34;  // m
constexpr WheelNoise kNoise{0.003, 0.003};

struct Stretch {
  int rows = 0;
  WheelTravel travel;  ///< m, of each row
};

/// Rows of uneven length in time, the first two 0.1 s each.
MotionRows drive_of(const std::vector<Stretch>& training_segments) {
  MotionRows drive;
  double t = 0.0;
  for (const Stretch& stretch : training_segments) {
    for (int k = 0; k < stretch.rows; ++k) {
      t += drive.rows() < 2 ? 0.1 : 0.05 + 0.01 * static_cast<double>(drive.rows() % 7);
      drive.t.push_back(t);
      testing::add_travels(drive, stretch.travel.left, stretch.travel.right, kWheelbase);
    }
  }
  return drive;
}

/// Of the wheels that show the motion.
WheelTravel travel_of(const BodyMotion& motion) {
  const double apart = 0.5 * kWheelbase * motion.turn;
  return {motion.forward - apart, motion.forward + apart};
}

std::vector<DriveArc> arcs_of(const MotionRows& drive) {
  return merge_rows(drive, rows_between(drive, 0.0, drive.t.back()), Robot{kWheelbase}, kNoise);
}

Motion row_by_row(const MotionRows& drive, const std::vector<DriveRow>& rows) {
  Motion motion;
  for (const DriveRow& row : rows) {
    motion = then(motion, arc_motion(travel_of(motion_of(drive, row)), kWheelbase, kNoise));
  }
  return motion;
}

Motion arc_by_arc(const std::vector<DriveArc>& arcs) {
  Motion motion;
  for (const DriveArc& arc : arcs) {
    motion = then(motion, arc_motion(travel_of(arc.motion), kWheelbase, kNoise));
  }
  return motion;
}

TEST(RowsBetween, PartsOfARowAddUpToIt) {
  const MotionRows drive = drive_of({{30, {0.03, 0.05}}});
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> time(0.0, drive.t.back());
  const auto sum_of = [&drive](double from, double to) {
    WheelTravel sum;
    double duration = 0.0;
    for (const DriveRow& row : rows_between(drive, from, to)) {
      EXPECT_GE(row.part, 0.0);
      EXPECT_LE(row.part, 1.0 + 1e-12);
      sum.left += travel_of(motion_of(drive, row)).left;
      sum.right += travel_of(motion_of(drive, row)).right;
      duration += row.duration;
    }
    EXPECT_NEAR(duration, to - from, 1e-12);
    return sum;
  };
  const WheelTravel whole = sum_of(0.0, drive.t.back());
  EXPECT_NEAR(whole.left, 0.9, 1e-13);
  for (int k = 0; k < 100; ++k) {
    const double cut = time(random);
    const WheelTravel before = sum_of(0.0, cut);
    const WheelTravel after = sum_of(cut, drive.t.back());
    EXPECT_NEAR(before.left + after.left, whole.left, 1e-13) << cut;
    EXPECT_NEAR(before.right + after.right, whole.right, 1e-13) << cut;
  }
}

TEST(RowsBetween, HoldARowsEndOnce) {
  const MotionRows drive = drive_of({{10, {0.1, 0.1}}});
  for (const double cut : {0.05, drive.t[3], 0.5 * (drive.t[3] + drive.t[4]), drive.t[8]}) {
    std::vector<int> ends(drive.rows(), 0);
    for (const auto& rows :
         {rows_between(drive, 0.0, cut), rows_between(drive, cut, drive.t.back())}) {
      for (const DriveRow& row : rows) ends[row.row] += row.ends ? 1 : 0;
    }
    EXPECT_EQ(ends, std::vector<int>(drive.rows(), 1)) << cut;
  }
}

TEST(RowsBetween, AreCutToTheDrive) {
  const MotionRows drive = drive_of({{10, {0.1, 0.1}}});
  const double last = drive.t.back();
  EXPECT_EQ(rows_between(drive, -5.0, 99.0).size(), drive.rows());
  EXPECT_NEAR(rows_between(drive, -5.0, 99.0).front().part, 1.0, 1e-14);
  EXPECT_TRUE(rows_between(drive, -5.0, 0.0).empty()) << "the drive starts at 0";
  EXPECT_TRUE(rows_between(drive, last, 99.0).empty());
  for (const double t : {0.0, 0.02, drive.t[4], last}) {
    for (const DriveRow& row : rows_between(drive, t, t)) {
      EXPECT_EQ(row.part, 0.0);
      EXPECT_FALSE(row.ends) << "an empty span holds no reading";
    }
  }
}

TEST(RowsBetween, AnyCutLeadsToTheSameEnd) {
  const MotionRows drive = drive_of({{12, {0.03, 0.05}}, {6, {-0.02, 0.02}}, {9, {-0.05, -0.04}}});
  const Motion whole = row_by_row(drive, rows_between(drive, 0.0, drive.t.back()));
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> time(0.0, drive.t.back());
  for (int k = 0; k < 50; ++k) {
    const double cut = time(random);
    const Motion parts = then(row_by_row(drive, rows_between(drive, 0.0, cut)),
                              row_by_row(drive, rows_between(drive, cut, drive.t.back())));
    EXPECT_LE((parts.displacement.position() - whole.displacement.position()).norm(), 1e-13);
    EXPECT_NEAR(parts.displacement.heading, whole.displacement.heading, 1e-13);
    EXPECT_LE((parts.covariance - whole.covariance).norm(), 1e-12 * whole.covariance.norm());
  }
}

TEST(MergeRows, KindsOfMotionStayApart) {
  const MotionRows drive = drive_of({{5, {0.0, 0.0}},
                                     {5, {-0.02, 0.02}},
                                     {5, {0.02, -0.02}},
                                     {5, {0.1, 0.1}},
                                     {5, {-0.1, -0.1}},
                                     {5, {0.1, 0.1}},
                                     {5, {0.05, 0.1}}});
  const std::vector<DriveArc> arcs = arcs_of(drive);
  ASSERT_EQ(arcs.size(), 7U);
  const double lefts[] = {0.0, -0.1, 0.1, 0.5, -0.5, 0.5, 0.25};
  for (std::size_t k = 0; k < 7; ++k)
    EXPECT_NEAR(travel_of(arcs[k].motion).left, lefts[k], 1e-14) << k;
}

TEST(MergeRows, LoseNeitherTravelNorTime) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  MotionRows drive = drive_of({{200, {0.0, 0.0}}});
  WheelTravel sum;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    sum.left += drive.pair.left[row] = 0.05 * normal(random);
    sum.right += drive.pair.right[row] = 0.05 * normal(random);
  }
  testing::retake(drive, kWheelbase);
  double duration = 0.0;
  for (const DriveArc& arc : arcs_of(drive)) {
    sum.left -= travel_of(arc.motion).left;
    sum.right -= travel_of(arc.motion).right;
    duration += arc.duration;
  }
  EXPECT_NEAR(sum.left, 0.0, 1e-13);
  EXPECT_NEAR(sum.right, 0.0, 1e-13);
  EXPECT_NEAR(duration, drive.t.back(), 1e-12);
}

TEST(MergeRows, OfConstantCurvatureGiveTheCovarianceOfTheRows) {
  for (const WheelTravel& travel :
       {WheelTravel{0.1, 0.1}, WheelTravel{0.03, 0.05}, WheelTravel{0.0, 0.05},
        WheelTravel{-0.04, -0.02}, WheelTravel{-0.03, 0.03}, WheelTravel{0.01, 0.1}}) {
    const MotionRows drive = drive_of({{60, travel}});
    const std::vector<DriveArc> arcs = arcs_of(drive);
    ASSERT_EQ(arcs.size(), 1U) << travel.left << ", " << travel.right;
    const Motion rows = row_by_row(drive, rows_between(drive, 0.0, drive.t.back()));
    const Motion merged = arc_by_arc(arcs);
    EXPECT_LE((merged.covariance - rows.covariance).norm(), 1e-12 * rows.covariance.norm());
  }
}

/// Bends and spins with wheel noise: the merged covariance is that of the rows within 2 %, from a
/// small part of as many arcs.
TEST(MergeRows, OfANoisyDriveGiveNearlyTheCovarianceOfTheRows) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  MotionRows drive = drive_of(
      {{40, {-0.02, 0.02}}, {400, {0.05, 0.05}}, {30, {0.02, -0.02}}, {300, {0.05, 0.05}}});
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double bend = 1.0 + 0.04 * std::sin(0.02 * static_cast<double>(row));
    drive.pair.left[row] *= 1.0 / bend;
    drive.pair.right[row] *= bend;
    drive.pair.left[row] +=
        kNoise.left * std::sqrt(std::abs(drive.pair.left[row])) * normal(random);
    drive.pair.right[row] +=
        kNoise.right * std::sqrt(std::abs(drive.pair.right[row])) * normal(random);
  }
  testing::retake(drive, kWheelbase);
  const std::vector<DriveArc> arcs = arcs_of(drive);
  EXPECT_LE(arcs.size(), drive.rows() / 20);
  const Matrix3 rows = row_by_row(drive, rows_between(drive, 0.0, drive.t.back())).covariance;
  const Matrix3 merged = arc_by_arc(arcs).covariance;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_LE(std::abs(merged(i, j) - rows(i, j)), 0.02 * std::sqrt(rows(i, i) * rows(j, j)));
    }
  }
}

}  // namespace
}  // namespace trussmap::merge_test
