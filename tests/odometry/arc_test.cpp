// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Arc covariance against quadrature (tests/reference/chong_kleeman.json).
#include "trussmap/arc.hpp"

#include "shared_data.hpp"

#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

namespace trussmap::arc_test {
namespace {

using nlohmann::json;

Matrix3 matrix3(const json& rows) {
  Matrix3 m;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c)
      m(r, c) = rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
  }
  return m;
}

/// |error| <= tolerance * sqrt(P_ii P_jj); an entry with P_ii = 0 must be 0.
void expect_covariance(const Matrix3& found, const Matrix3& expected, double tolerance) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double scale = std::sqrt(expected(i, i) * expected(j, j));
      EXPECT_LE(std::abs(found(i, j) - expected(i, j)), tolerance * scale)
          << "entry " << i << "," << j;
    }
  }
}

Matrix3 in_map(const Matrix3& covariance, double heading) {
  const Matrix3 T = pose_rotation(heading);
  return T * covariance * T.transpose();
}

TEST(ChongKleeman, ClosedFormEqualsQuadrature) {
  testing::for_each(testing::cases("chong_kleeman.json", "cases"), [](const nlohmann::json& c) {
    const Motion motion = arc_motion({c["L"], c["R"]}, c["B"], {c["kL"], c["kR"]});
    expect_covariance(in_map(motion.covariance, c["theta0"]), matrix3(c["cov"]), 1e-12);
    const Vector2 step = rotation(c["theta0"]) * motion.displacement.position();
    const double path = std::abs(c["L"].get<double>()) + std::abs(c["R"].get<double>());
    EXPECT_NEAR(step.x(), c["dx"].get<double>(), 1e-13 * (1.0 + path));
    EXPECT_NEAR(step.y(), c["dy"].get<double>(), 1e-13 * (1.0 + path));
    EXPECT_NEAR(motion.displacement.heading, c["dtheta"].get<double>(),
                1e-13 * (1.0 + std::abs(c["dtheta"].get<double>())));
  });
}

TEST(ChongKleemanPath, SegmentsComposeToTheQuadrature) {
  testing::for_each(
      testing::cases("chong_kleeman.json", "compositions"), [](const nlohmann::json& c) {
        Motion path;
        for (const json& segment : c["segments_LR"]) {
          path = then(path, arc_motion({segment[0], segment[1]}, c["B"], {c["kL"], c["kR"]}));
        }
        const double theta0 = c["theta0"];
        expect_covariance(in_map(path.covariance, theta0), matrix3(c["cov"]), 1e-12);
        const Vector2 end = rotation(theta0) * path.displacement.position();
        EXPECT_NEAR(end.x(), c["x"].get<double>(), 1e-12);
        EXPECT_NEAR(end.y(), c["y"].get<double>(), 1e-12);
        EXPECT_NEAR(theta0 + path.displacement.heading, c["theta"].get<double>(), 1e-12);
      });
}

/// Integral of f from 0 to 1, composite Gauss-Legendre with five points each.
template <typename T, typename F>
T integral(const T& zero, const F& f) {
  constexpr int kPieces = 64;
  constexpr double kAt[] = {0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr double kWeight[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  T sum = zero;
  for (int piece = 0; piece < kPieces; ++piece) {
    for (int k = -2; k <= 2; ++k) {
      const double at = (k < 0 ? -1.0 : 1.0) * kAt[std::abs(k)];
      sum += 0.5 / kPieces * kWeight[std::abs(k)] * f((piece + 0.5 + 0.5 * at) / kPieces);
    }
  }
  return sum;
}

struct Slanting {
  Vector2 way;
  double turn;
  ArcNoise noise;
};

class SlantingArc : public ::testing::TestWithParam<Slanting> {};

TEST_P(SlantingArc, ClosedFormEqualsDenseIntegration) {
  const auto& [way, turn, noise] = GetParam();
  const auto place = [&way = way, turn = turn](double share) {
    return integral(Vector2(Vector2::Zero()),
                    [&](double u) { return Vector2(share * (rotation(u * share * turn) * way)); });
  };
  const Vector2 end = place(1.0);
  const Pose found = slanting_displacement(way, turn);
  EXPECT_NEAR((found.position() - end).norm(), 0.0, 1e-12 * (1.0 + way.norm()));
  EXPECT_EQ(found.heading, turn);
  Matrix3 source;
  source << noise.along, noise.along_lateral, noise.shared,       //
      noise.along_lateral, noise.lateral, noise.heading_lateral,  //
      noise.shared, noise.heading_lateral, noise.heading;
  // What moves the robot in its own axes where a share of the arc is behind it.
  const Matrix3 expected = integral(Matrix3(Matrix3::Zero()), [&](double share) {
    Matrix3 J = pose_rotation(share * turn);
    J.topRightCorner<2, 1>() = quarter_turn(end - place(share));
    return Matrix3(J * source * J.transpose());
  });
  expect_covariance(slanting_covariance(way, turn, noise), expected, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(
    Arcs, SlantingArc,
    ::testing::Values(Slanting{{1.0, 0.0}, 0.5, {1e-4, 2e-4, 3e-5, 5e-5, 1e-5, 2e-5}},
                      Slanting{{0.3, 1.2}, 0.0, {1e-4, 2e-4, 3e-5, 5e-5, 1e-5, -2e-5}},
                      Slanting{{-0.7, 0.4}, 1e-5, {1e-4, 2e-4, -3e-5, 5e-5, 1e-5, 2e-5}},
                      Slanting{{0.0, -2.0}, -1.9, {2e-4, 1e-4, 3e-5, 5e-5, -1e-5, 2e-5}},
                      Slanting{{1.0, 1.0}, 6.9, {1e-4, 2e-4, 3e-5, 5e-5, 1e-5, 2e-5}},
                      Slanting{{0.0, 0.0}, 2.0, {1e-4, 2e-4, 3e-5, 5e-5, 1e-5, 2e-5}},
                      Slanting{{-1.0, 0.2}, -0.3, {0.0, 0.0, 0.0, 1e-4, 0.0, 0.0}}));

TEST(SlantingArc, StraightAheadIsTheArcOfTwoWheels) {
  const WheelTravel travel{0.9, 1.3};
  const ArcNoise noise = wheel_arc_noise(travel, 0.34, {0.003, 0.004});
  EXPECT_EQ(slanting_covariance({1.1, 0.0}, 0.4 / 0.34, noise),
            arc_covariance(1.1, 0.4 / 0.34, noise));
}

}  // namespace
}  // namespace trussmap::arc_test
