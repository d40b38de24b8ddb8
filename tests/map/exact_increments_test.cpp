// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The live factor against a truss that is solved anew after every step.
#include "map/exact_increments.hpp"

#include <random>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

Matrix2 random_stiffness(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Matrix2 W =
      (Matrix2() << uniform(random), 0.0, uniform(random), uniform(random)).finished();
  return 100.0 * (W * W.transpose() + 0.1 * Matrix2::Identity());
}

struct Twins {
  ExactIncrements live;
  std::vector<Bar> bars;

  void add_joint(int i, const Matrix2& B) {
    bars.push_back({i, live.joints(), B});
    live.add_joint(i, B);
  }
  void add_bar(int i, int j, const Matrix2& B) {
    bars.push_back({i, j, B});
    live.add_bar(i, j, B);
  }
  void set_stiffness(int bar, const Matrix2& B) {
    bars[idx(bar)].stiffness = B;
    live.set_stiffness(bar, B);
  }
  void expect_alike(int i, int j) {
    const Vector2 force(3.0, -2.0);
    const std::vector<Vector2> u = live.pull(i, j, force);
    const Deflection fresh =
        solve_truss(live.joints(), bars, {{0, Vector2::Zero()}}, {{j, force}, {i, -force}});
    double largest = 0.0;
    double off = 0.0;
    for (std::size_t k = 0; k < u.size(); ++k) {
      largest = std::max(largest, fresh.displacements[k].norm());
      off = std::max(off, (u[k] - fresh.displacements[k]).norm());
    }
    ASSERT_LE(off, 1e-10 * largest) << "with " << live.joints() << " joints";
  }
};

TEST(ExactIncrements, TheLiveFactorEqualsANewOneAtEveryStep) {
  std::mt19937_64 random(4);
  const auto draw = [&random](int below) {
    return static_cast<int>(random() % static_cast<unsigned>(below));
  };
  Twins twins;
  twins.add_joint(0, random_stiffness(random));
  for (int step = 0; step < 400; ++step) {  // more joints than were kept places for, several times
    const int joints = twins.live.joints();
    const int what = draw(4);
    if (what < 2) {
      twins.add_joint(draw(joints), random_stiffness(random));
    } else if (what == 2) {
      twins.set_stiffness(draw(static_cast<int>(twins.bars.size())), random_stiffness(random));
    } else {
      const int i = draw(joints);
      const int j = draw(joints);
      if (i != j) twins.add_bar(i, j, random_stiffness(random));
    }
    const int end = draw(twins.live.joints() - 1);
    if (step % 7 == 0) twins.expect_alike(end, twins.live.joints() - 1);
  }
}

TEST(ExactIncrements, RefusesJointsThatAreNotThere) {
  ExactIncrements increments;
  increments.add_joint(0, Matrix2::Identity());
  EXPECT_THROW(increments.add_joint(2, Matrix2::Identity()), std::invalid_argument);
  EXPECT_THROW(increments.add_bar(1, 1, Matrix2::Identity()), std::invalid_argument);
  EXPECT_THROW((void)increments.pull(0, 2, Vector2::Zero()), std::invalid_argument);
}

}  // namespace
}  // namespace trussmap
