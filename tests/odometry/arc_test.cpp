// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Arc covariance against quadrature (tests/reference/chong_kleeman.json).
#include "trussmap/arc.hpp"

#include "shared_data.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace trussmap {
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

class ChongKleeman : public ::testing::TestWithParam<testing::Case> {};

TEST_P(ChongKleeman, ClosedFormEqualsQuadrature) {
  const json& c = GetParam().content;
  const Motion motion = arc_motion({c["L"], c["R"]}, c["B"], {c["kL"], c["kR"]});
  expect_covariance(in_map(motion.covariance, c["theta0"]), matrix3(c["cov"]), 1e-12);
  const Vector2 step = rotation(c["theta0"]) * motion.displacement.position();
  const double path = std::abs(c["L"].get<double>()) + std::abs(c["R"].get<double>());
  EXPECT_NEAR(step.x(), c["dx"].get<double>(), 1e-13 * (1.0 + path));
  EXPECT_NEAR(step.y(), c["dy"].get<double>(), 1e-13 * (1.0 + path));
  EXPECT_NEAR(motion.displacement.heading, c["dtheta"].get<double>(),
              1e-13 * (1.0 + std::abs(c["dtheta"].get<double>())));
}

std::string category(const ::testing::TestParamInfo<testing::Case>& info) {
  return info.param.content["category"].get<std::string>() + "_" + std::to_string(info.index);
}

INSTANTIATE_TEST_SUITE_P(EveryCase, ChongKleeman,
                         ::testing::ValuesIn(testing::cases("chong_kleeman.json", "cases")),
                         category);

class ChongKleemanPath : public ::testing::TestWithParam<testing::Case> {};

TEST_P(ChongKleemanPath, SegmentsComposeToTheQuadrature) {
  const json& c = GetParam().content;
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
}

INSTANTIATE_TEST_SUITE_P(EveryCase, ChongKleemanPath,
                         ::testing::ValuesIn(testing::cases("chong_kleeman.json", "compositions")));

}  // namespace
}  // namespace trussmap
