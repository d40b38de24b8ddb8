// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/noise_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace trussmap::noise_search_test {
using namespace fitting;
namespace {

Eigen::VectorXd free_of_bounds(Eigen::VectorXd x) {
  return x;
}

/// -2 log likelihood of log sds x where each source is seen alone in n values of mean square v:
/// n (2 x + v exp(-2 x)), least at log(v)/2, of curvature 4 n there.
struct Sources {
  Eigen::Vector3d n{20.0, 200.0, 60.0};
  Eigen::Vector3d v{0.04, 9.0, 1e-4};

  [[nodiscard]] double operator()(const Eigen::VectorXd& x) const {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < 3; ++k) sum += n[k] * (2.0 * x[k] + v[k] * std::exp(-2.0 * x[k]));
    return sum;
  }
  [[nodiscard]] Eigen::VectorXd likeliest() const { return 0.5 * v.array().log(); }
};

TEST(NoiseSearch, FindsSizesThatAreKnown) {
  const Sources sources;
  const Eigen::VectorXd expected = sources.likeliest();
  for (const double off : {0.0, -0.7, 2.0}) {
    const Eigen::VectorXd start = expected.array() + off;
    const LikeliestNoise found = likeliest_noise({sources, free_of_bounds, 30, 1e-3}, start);
    EXPECT_DOUBLE_EQ(found.loss, sources(found.x));
    // It stops where no more than 1e-3 is promised, twice that a generous bound.
    EXPECT_LT(found.loss - sources(expected), 2e-3) << "from " << off << " away";
    EXPECT_LE(found.loss, sources(start));
  }
}

TEST(NoiseSearch, StaysWithinBoundsAndAwayFromWhatHasNoLikelihood) {
  const Sources sources;
  const Eigen::VectorXd expected = sources.likeliest();
  const double limit = expected[1] - 0.5;
  const auto bounded = [limit](Eigen::VectorXd x) {
    x[1] = std::min(x[1], limit);
    return x;
  };
  const auto broken = [&](const Eigen::VectorXd& x) {
    return x[0] < expected[0] - 0.5 ? std::numeric_limits<double>::infinity() : sources(x);
  };
  const Eigen::VectorXd start = expected.array() + 2.0;
  const LikeliestNoise found = likeliest_noise({broken, bounded, 30, 1e-3}, start);
  EXPECT_DOUBLE_EQ(found.x[1], limit);
  EXPECT_NEAR(found.x[0], expected[0], 0.1);
}

TEST(NoiseSearch, CurvaturesAreThoseOfAQuadratic) {
  const Eigen::Matrix3d H =
      (Eigen::Matrix3d() << 4.0, -1.0, 0.5, -1.0, 3.0, 0.2, 0.5, 0.2, 50.0).finished();
  const Eigen::Vector3d x(0.3, -2.0, 1.0);
  const auto loss = [&](const Eigen::VectorXd& at) { return 7.0 + at[1] + 0.5 * at.dot(H * at); };
  EXPECT_LT((curvatures(loss, x) - H).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace trussmap::noise_search_test
