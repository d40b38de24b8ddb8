// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// First sight: which polygonal closes, and how far its landmarks move; and the heading's reset.
#include "map/first_sight.hpp"

#include "geometry/index.hpp"
#include "map/heading_reset.hpp"
#include "trussmap/truss.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::first_sight_test {
using namespace map;
namespace {

using Landmarks = std::vector<int>;

/// The chain's closed formula against a truss of the same bars, held at one end, moved at the
/// other.
TEST(ChainDisplacements, AreThoseOfTheTruss) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  for (const int bars : {1, 2, 7, 30}) {
    std::vector<Matrix2> stiffnesses;
    std::vector<Bar> truss;
    for (int k = 0; k < bars; ++k) {
      const Matrix2 root =
          (Matrix2() << normal(random), normal(random), normal(random), normal(random)).finished();
      stiffnesses.emplace_back(root * root.transpose() + Matrix2::Identity());
      truss.push_back({k, k + 1, stiffnesses.back()});
    }
    const Vector2 imposed(0.7, -1.1);
    const std::vector<Vector2> chain = chain_displacements(stiffnesses, imposed);
    const Deflection whole =
        solve_truss(bars + 1, truss, {{0, Vector2::Zero()}, {bars, imposed}}, {});
    ASSERT_EQ(chain.size(), idx(bars));
    for (int k = 0; k < bars; ++k) {
      EXPECT_LE((chain[idx(k)] - whole.displacements[idx(k + 1)]).norm(), 1e-12);
    }
  }
}

/// 0 - 1 - 2 - 3 and back to 0: the polygonal is closed, all hang on 0.
TEST(OpenChain, ALoopBackToItsStartIsClosed) {
  OpenChain chain;
  chain.restart(0);
  for (int k = 0; k < 3; ++k) chain.append(k, k + 1);
  const OpenChain::Closing closing = chain.closing(3, 0);
  EXPECT_TRUE(closing.closed);
  EXPECT_EQ(closing.landmarks, (Landmarks{0, 1, 2, 3}));
  chain.settle(closing, 0);
  EXPECT_EQ(chain.landmarks(), Landmarks{0});
}

/// 0 - 1 - 2 - 3 - 1: the loop hangs on 1; the way from 0 to 1 stays in the chain.
TEST(OpenChain, ALoopWithinTheChainLeavesItsStemOpen) {
  OpenChain chain;
  chain.restart(0);
  for (int k = 0; k < 3; ++k) chain.append(k, k + 1);
  const OpenChain::Closing closing = chain.closing(3, 1);
  EXPECT_TRUE(closing.closed);
  EXPECT_EQ(closing.landmarks, (Landmarks{1, 2, 3}));
  chain.settle(closing, 1);
  EXPECT_EQ(chain.landmarks(), (Landmarks{0, 1}));
  // On from 1 by 4 and 5 to 2, which hangs on 1: k is 1, and not 2 itself.
  chain.append(1, 4);
  chain.append(4, 5);
  const OpenChain::Closing second = chain.closing(5, 2);
  EXPECT_FALSE(second.closed);
  EXPECT_EQ(second.landmarks, (Landmarks{1, 4, 5}));
  chain.settle(second, 2);
  EXPECT_EQ(chain.landmarks(), Landmarks{2});
}

/// Settled landmarks that hang on nothing of the chain: open from the chain's start.
TEST(OpenChain, AMeetingElsewhereIsOpenFromItsStart) {
  OpenChain chain;
  chain.restart(7);
  chain.append(7, 8);
  const OpenChain::Closing closing = chain.closing(8, 3);
  EXPECT_FALSE(closing.closed);
  EXPECT_EQ(closing.landmarks, (Landmarks{7, 8}));
}

/// Between two settled landmarks nothing is fresh: a polygonal of no landmarks but its start.
TEST(OpenChain, ANewRouteBetweenSettledLandmarksMovesNothing) {
  OpenChain chain;
  chain.restart(0);
  const OpenChain::Closing closing = chain.closing(4, 5);
  EXPECT_EQ(closing.landmarks, Landmarks{4});
}

/// The reset is the best mean of two measurements of one angle: the inverse variances add up.
TEST(HeadingReset, WeighsByTheInverseVariances) {
  const HeadingEstimate before{1.0, 0.04};
  const HeadingEstimate after = reset_heading(before, 0.3, 0.01);
  EXPECT_NEAR(1.0 / after.variance, 1.0 / 0.04 + 1.0 / 0.01, 1e-10);
  EXPECT_NEAR(after.heading, (1.0 / 0.04 + 1.3 / 0.01) / (1.0 / 0.04 + 1.0 / 0.01), 1e-14);
  EXPECT_NEAR(reset_heading(before, 0.3 + 8.0 * std::atan(1.0), 0.01).heading, after.heading,
              1e-12);
  EXPECT_EQ(reset_heading({1.0, 0.0}, 0.3, 0.0).heading, 1.0);
}

/// Against 40000 samples (seed 3): a variance's standard error is sqrt(2/40000) = 0.7 %.
TEST(HeadingReset, DirectionVarianceIsThatOfTheDirection) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const Vector2 mean(4.0, -3.0);
  const Matrix2 L = (Matrix2() << 0.05, 0.0, 0.02, 0.03).finished();
  double sum = 0.0;
  for (int k = 0; k < 40000; ++k) {
    const Vector2 sample = mean + L * Vector2(normal(random), normal(random));
    sum += std::pow(wrap_angle(direction(sample) - direction(mean)), 2);
  }
  const double expected = direction_variance(mean, L * L.transpose());
  EXPECT_NEAR(sum / 40000.0, expected, 0.03 * expected);
}

/// The same by the letter of the definition: step by step up the loops.
class PlainChain {
 public:
  void append(int a, int b) {
    if (chain_.empty() || chain_.back() != a) chain_ = {a};
    chain_.push_back(b);
  }
  [[nodiscard]] OpenChain::Closing closing(int a, int b) const {
    const std::vector<int> chain = chain_.empty() || chain_.back() != a ? std::vector{a} : chain_;
    const auto find = [&chain](int landmark) {
      return std::find(chain.begin(), chain.end(), landmark);
    };
    int k = b;
    while (find(k) == chain.end() && root_.contains(k)) k = root_.at(k);
    const auto place = find(k) == chain.end() ? chain.begin() : find(k);
    return {std::vector<int>(place, chain.end()), *place == b};
  }
  void settle(const OpenChain::Closing& closing, int b) {
    const int k = closing.landmarks.front();
    for (std::size_t n = 1; n < closing.landmarks.size(); ++n) root_[closing.landmarks[n]] = k;
    const auto place = std::find(chain_.begin(), chain_.end(), k);
    if (!closing.closed) {
      chain_ = {b};
    } else if (place != chain_.end()) {
      chain_.erase(place + 1, chain_.end());
    } else {
      chain_ = {k};
    }
  }
  void restart(int landmark) { chain_ = {landmark}; }

 private:
  std::vector<int> chain_;
  std::map<int, int> root_;
};

TEST(OpenChain, ShortcutsChangeNothing) {
  std::mt19937_64 random(1);
  for (int drive = 0; drive < 200; ++drive) {
    OpenChain chain;
    PlainChain plain;
    chain.restart(0);
    plain.restart(0);
    int here = 0;
    int landmarks = 1;
    for (int leg = 0; leg < 60; ++leg) {
      const auto what = random() % 10;
      const int known = static_cast<int>(random() % static_cast<unsigned>(landmarks));
      if (what == 0) {
        here = known;
        chain.restart(here);
        plain.restart(here);
      } else if (what < 6) {
        chain.append(here, landmarks);
        plain.append(here, landmarks);
        here = landmarks++;
      } else if (known != here) {
        const OpenChain::Closing closing = chain.closing(here, known);
        const OpenChain::Closing expected = plain.closing(here, known);
        ASSERT_EQ(closing.landmarks, expected.landmarks) << "drive " << drive << ", leg " << leg;
        ASSERT_EQ(closing.closed, expected.closed);
        chain.settle(closing, known);
        plain.settle(expected, known);
        here = known;
      }
    }
  }
}

}  // namespace
}  // namespace trussmap::first_sight_test
