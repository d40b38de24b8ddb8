// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Pieces of a drive: covariances against simulation, responses against differences.
#include "trussmap/odometry/piece.hpp"

#include "trussmap/core/index.hpp"

#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace trussmap {
namespace {

constexpr double kWheelbase = 0.34;

/// Spin, straight, arc, reverse, spin; a compass reading in every other row.
Drive varied_drive() {
  Drive drive;
  const WheelTravel kinds[] = {
      {-0.02, 0.02}, {0.1, 0.1}, {0.08, 0.12}, {-0.05, -0.06}, {0.02, -0.02}};
  double heading = 0.4;
  for (const WheelTravel& kind : kinds) {
    for (int k = 0; k < 20; ++k) {
      drive.t.push_back(0.1 * static_cast<double>(drive.rows() + 1));
      drive.left.push_back(kind.left);
      drive.right.push_back(kind.right);
      heading += (kind.right - kind.left) / kWheelbase;
      drive.heading.push_back(k % 2 == 0 ? heading : kAbsent);
    }
  }
  return drive;
}

Model noisy_model() {
  Model model;
  model.noise.left = 0.003;
  model.noise.right = 0.005;
  model.noise.heading_per_s = 0.002;
  return model;
}

TEST(Piece, MeasuresTheExactDriveAndItsStartHeading) {
  const Drive drive = varied_drive();
  const Piece piece = reckon_piece(drive, 1.0, 9.0, noisy_model());
  Pose end;
  for (std::size_t row = 10; row < 90; ++row) {
    end = compose(end, arc_displacement({drive.left[row], drive.right[row]}, kWheelbase));
  }
  EXPECT_NEAR(piece.displacement.x, end.x, 1e-13);
  EXPECT_NEAR(piece.displacement.heading, end.heading, 1e-13);
  EXPECT_EQ(piece.readings, 40);
  EXPECT_NEAR(piece.compass, 0.4 + 10 * 0.04 / kWheelbase, 1e-12);
}

/// 20000 noisy copies (seed 4): entries of the joint covariance are sure to 0.7 % of the product of
/// the standard deviations. Here the truth is fixed, the rows are noisy: errors change sign, their
/// covariance does not.
TEST(Piece, JointCovarianceIsThatOfManyDrives) {
  constexpr int kDrives = 20000;
  const Drive truth = varied_drive();
  Model model = noisy_model();
  const Piece exact = reckon_piece(truth, 0.0, 10.0, model);
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  Matrix4 sum = Matrix4::Zero();
  for (int k = 0; k < kDrives; ++k) {
    Drive drive = truth;
    double wander = 0.0;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      drive.left[row] += 0.003 * std::sqrt(std::abs(truth.left[row])) * normal(random);
      drive.right[row] += 0.005 * std::sqrt(std::abs(truth.right[row])) * normal(random);
      // Heading noise per second, as wheels would show it: a turn without travel.
      const double twist = 0.002 * std::sqrt(0.1) * normal(random);
      drive.left[row] -= 0.5 * kWheelbase * twist;
      drive.right[row] += 0.5 * kWheelbase * twist;
      wander += twist;
      drive.heading[row] += 0.02 * normal(random);
    }
    const Piece noisy = reckon_piece(drive, 0.0, 10.0, model);
    Vector4 error;
    error << exact.displacement.position() - noisy.displacement.position(),
        exact.displacement.heading - noisy.displacement.heading, noisy.compass - exact.compass;
    sum += error * error.transpose();
  }
  const Matrix4 found = sum / kDrives;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const double scale = std::sqrt(exact.covariance(i, i) * exact.covariance(j, j));
      EXPECT_NEAR(found(i, j), exact.covariance(i, j), 0.04 * scale) << i << j;
    }
  }
}

/// Without a compass the covariance is the arcs' own, composed.
TEST(Piece, WithoutACompassItIsTheComposedArcs) {
  Drive drive = varied_drive();
  drive.heading.clear();
  Model model;
  model.noise.left = 0.003;
  model.noise.right = 0.005;
  const Piece piece = reckon_piece(drive, 0.25, 9.75, model);
  Motion motion;
  for (const DriveRow& row : rows_between(drive, 0.25, 9.75)) {
    motion = then(motion, arc_motion(travel_of(drive, row), kWheelbase, {0.003, 0.005}));
  }
  EXPECT_LE((piece.covariance.topLeftCorner<3, 3>() - motion.covariance).norm(),
            1e-12 * motion.covariance.norm());
  EXPECT_EQ(piece.covariance.col(3).norm(), 0.0);
}

TEST(Piece, ResponseIsTheDerivative) {
  const Drive drive = varied_drive();
  const Model model = noisy_model();
  const Piece piece = reckon_piece(drive, 0.33, 9.9, model);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  RowPerturbation perturbation;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    perturbation.along.push_back(0.01 * normal(random));
    perturbation.turn.push_back(0.01 * normal(random));
    perturbation.compass.push_back(normal(random));
  }
  const auto perturbed = [&](double by) {
    Drive changed = drive;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      const double half = 0.5 * kWheelbase * perturbation.turn[row];
      changed.left[row] += by * (perturbation.along[row] - half);
      changed.right[row] += by * (perturbation.along[row] + half);
      changed.heading[row] -= by * perturbation.compass[row];
    }
    const Piece moved = reckon_piece(changed, 0.33, 9.9, model);
    Vector4 value;
    value << moved.displacement.position(), moved.displacement.heading, moved.compass;
    return value;
  };
  constexpr double h = 1e-4;
  const Vector4 difference = (perturbed(h) - perturbed(-h)) / (2.0 * h);
  EXPECT_LE((response(piece, drive, perturbation) - difference).norm(), 1e-6 * difference.norm());
}

TEST(Piece, SpinsAndDrivesAreToldApart) {
  const std::vector<double> changes = changes_of_motion(varied_drive());
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_NEAR(changes[0], 2.0, 1e-12);
  EXPECT_NEAR(changes[1], 8.0, 1e-12);
}

}  // namespace
}  // namespace trussmap
