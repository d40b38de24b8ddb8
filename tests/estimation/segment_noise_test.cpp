// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/segment_noise.hpp"

#include "criticism/inverted_recordings.hpp"
#include "driven.hpp"
#include "trussmap/arc.hpp"

#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace trussmap::segment_noise_test {
using namespace estimation;
namespace {

using Vector3 = Eigen::Vector3d;
using Point = std::complex<double>;

constexpr double kWheelbase = testing::kInvertedWheelbase;
const Robot kRobot{kWheelbase};

/// A bow, a turn on the spot, and back; the last row is cut.
struct Segment {
  MotionRows drive;
  std::vector<SegmentRow> rows;
};

Segment example(bool compass) {
  Segment segment;
  double heading = 2.9;
  for (int k = 0; k < 60; ++k) {
    const double ds = k < 30 ? 0.06 : k < 40 ? 0.0 : -0.05;
    const double turn = k < 30 ? 0.015 : k < 40 ? -0.11 : 0.002;
    heading += turn;
    segment.drive.t.push_back(0.1 * (k + 1));
    testing::add_travels(segment.drive, ds - 0.5 * kWheelbase * turn, ds + 0.5 * kWheelbase * turn,
                         kWheelbase);
    if (compass) {
      segment.drive.heading.push_back(
          k % 7 == 3 ? kAbsent : std::remainder(heading + 0.01 * std::sin(k), 2.0 * M_PI));
    }
  }
  segment.rows = segment_rows(segment.drive, 0.05, 5.96);
  return segment;
}

SegmentNoise noise_of(const Segment& segment, const std::vector<Vector3>& missing) {
  return segment_noise(segment.drive, segment.rows, kRobot, Noise(), missing);
}

std::vector<Vector3> some_noise(std::size_t rows, std::uint64_t seed, double size) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  std::vector<Vector3> result(rows);
  for (Vector3& one : result) one = {uniform(random), uniform(random), uniform(random)};
  return result;
}

/// The four numbers of steps with noise, laid end to end with complex numbers.
Vector4 laid(const Segment& segment, const std::vector<Vector3>& n) {
  Point place;
  double heading = 0.0;
  double sum = 0.0;
  int readings = 0;
  for (std::size_t k = 0; k < segment.rows.size(); ++k) {
    const SegmentRow& row = segment.rows[k];
    const Point arc = std::abs(row.turn) < 1e-9
                          ? Point(row.path, 0.0)
                          : row.path * (std::polar(1.0, row.turn) - 1.0) / Point(0.0, row.turn);
    place += std::polar(1.0, heading) * (arc + Point(n[k][0], n[k][1]));
    heading += row.turn + n[k][2];
    if (std::isnan(row.reading)) continue;
    sum += std::remainder(row.reading - heading - 2.9, 2.0 * M_PI);
    ++readings;
  }
  return {place.real(), place.imag(), heading, readings == 0 ? 0.0 : 2.9 + sum / readings};
}

TEST(SegmentNoise, WithNoNoiseBelievedItIsTheMotionAsRecorded) {
  for (const bool compass : {true, false}) {
    const Segment segment = example(compass);
    const SegmentNoise found = noise_of(segment, {});
    const SegmentMotion motion = segment_motion(segment.rows);
    EXPECT_NEAR(found.value[0], motion.displacement.x, 1e-12);
    EXPECT_NEAR(found.value[1], motion.displacement.y, 1e-12);
    EXPECT_NEAR(found.value[2], motion.displacement.heading, 1e-12);
    if (compass) {
      EXPECT_NEAR(found.value[3], motion.mean_heading, 1e-12);
    }
    EXPECT_EQ((found.value - found.recorded).norm(), 0.0);
    const Matrix4 expected = segment_covariance(segment.drive, segment.rows, kRobot, Noise());
    EXPECT_LT((found.covariance - expected).norm(), 1e-12 * expected.norm());
    // Noise of zero is the same as none.
    const SegmentNoise zero =
        noise_of(segment, std::vector<Vector3>(segment.rows.size(), {0, 0, 0}));
    EXPECT_EQ((zero.value - found.value).norm(), 0.0);
  }
}

TEST(SegmentNoise, ValueAndSlopesAreThoseOfTheStepsWithNoise) {
  const Segment segment = example(true);
  const std::vector<Vector3> believed = some_noise(segment.rows.size(), 1, 0.003);
  const SegmentNoise found = noise_of(segment, believed);
  constexpr double kStep = 1e-6;
  Vector4 value = laid(segment, believed);
  for (std::size_t k = 0; k < segment.rows.size(); ++k) {
    for (int c = 0; c < 3; ++c) {
      std::vector<Vector3> after = believed;
      std::vector<Vector3> before = believed;
      after[k][c] += kStep;
      before[k][c] -= kStep;
      const Vector4 slope = (laid(segment, after) - laid(segment, before)) / (2.0 * kStep);
      EXPECT_LT((found.H[k].col(c) - slope).norm(), 1e-8) << "row " << k << " entry " << c;
    }
    value -= found.H[k] * believed[k];
  }
  Vector4 difference = found.value - value;
  difference[3] = std::remainder(difference[3], 2.0 * M_PI);
  EXPECT_LT(difference.norm(), 1e-12);
}

TEST(SegmentNoise, CovarianceIsThatOfTheRowsThroughTheSlopes) {
  const Segment segment = example(true);
  const SegmentNoise found = noise_of(segment, some_noise(segment.rows.size(), 2, 0.003));
  Matrix4 expected = Matrix4::Zero();
  for (std::size_t k = 0; k < segment.rows.size(); ++k) {
    const SegmentRow& row = segment.rows[k];
    const double left = row.path - 0.5 * kWheelbase * row.turn;
    const double right = row.path + 0.5 * kWheelbase * row.turn;
    const Matrix3 Q = arc_covariance({left, right}, kWheelbase, {0.003, 0.003});
    EXPECT_LT((found.Q[k] - Q).norm(), 1e-12 * Q.norm() + 1e-20);
    expected += found.H[k] * Q * found.H[k].transpose();
  }
  expected(3, 3) += 0.02 * 0.02 / readings_of(segment.rows);
  EXPECT_LT((found.covariance - expected).norm(), 1e-9 + 1e-6 * expected.norm());
}

TEST(SegmentNoise, LinearisedWhereTheNoiseIsItIsUnbiasedAsTheRecordIsNot) {
  // Many draws of a truth s + n with n ~ N(0, Q): z = h(n). The pull of the residual of the model
  // taken at n = 0 has a mean of second order; that of the model at the believed n has not.
  Segment segment;
  for (int k = 0; k < 60; ++k) {
    segment.drive.t.push_back(0.1 * (k + 1));
    testing::add_travels(segment.drive, 0.09, 0.0903, kWheelbase);
  }
  segment.rows = segment_rows(segment.drive, 0.0, 6.0);
  Noise noise;
  noise.left = noise.right = 0.005;
  const auto at = [&](const std::vector<Vector3>& missing) {
    return segment_noise(segment.drive, segment.rows, kRobot, noise, missing);
  };
  const SegmentNoise recorded = at({});
  std::vector<Matrix3> roots;
  for (const Matrix3& Q : recorded.Q) {
    // Sideways noise of a short row is all but nil.
    roots.emplace_back(Eigen::LLT<Matrix3>(Q + 1e-16 * Matrix3::Identity()).matrixL());
  }
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  constexpr int kDraws = 4000;
  Vector3 sum_recorded = Vector3::Zero();
  Vector3 sum_believed = Vector3::Zero();
  Vector3 squares = Vector3::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<Vector3> n(segment.rows.size());
    for (std::size_t k = 0; k < n.size(); ++k) {
      const Vector3 unit(normal(random), normal(random), normal(random));
      n[k] = roots[k] * unit;
    }
    const Vector4 z = laid(segment, n);
    // What the fit would believe, from z alone.
    SegmentNoise belief = recorded;
    std::vector<Vector3> missing(n.size());
    for (int look = 0; look < 4; ++look) {
      const Vector3 pull = belief.covariance.topLeftCorner<3, 3>().ldlt().solve(
          Vector3((z - belief.value).head<3>()));
      for (std::size_t k = 0; k < n.size(); ++k) {
        missing[k] = belief.Q[k] * belief.H[k].topRows<3>().transpose() * pull;
      }
      belief = at(missing);
    }
    // The score: how chi^2 would fall if z moved, the step that an adjustment takes.
    const Vector3 plain = recorded.covariance.topLeftCorner<3, 3>().ldlt().solve(
        Vector3((z - recorded.value).head<3>()));
    const Vector3 bent =
        belief.covariance.topLeftCorner<3, 3>().ldlt().solve(Vector3((z - belief.value).head<3>()));
    // Along the map's directions, in the frame that the chord of z gives.
    const double way = std::atan2(z[1], z[0]);
    const auto along = [way](const Vector3& v) {
      return Vector3(std::cos(way) * v[0] + std::sin(way) * v[1],
                     -std::sin(way) * v[0] + std::cos(way) * v[1], v[2]);
    };
    sum_recorded += along(plain);
    sum_believed += along(bent);
    squares += along(bent).cwiseAbs2();
  }
  const Vector3 standard_error = (squares / kDraws).cwiseSqrt() / std::sqrt(kDraws);
  const Vector3 with = (sum_believed / kDraws).cwiseQuotient(standard_error);
  const Vector3 without = (sum_recorded / kDraws).cwiseQuotient(standard_error);
  RecordProperty("along_with", std::to_string(with[0]));
  RecordProperty("along_without", std::to_string(without[0]));
  EXPECT_LT(std::abs(with[0]), 4.0);
  EXPECT_GT(std::abs(without[0]), 8.0);
}

}  // namespace
}  // namespace trussmap::segment_noise_test
