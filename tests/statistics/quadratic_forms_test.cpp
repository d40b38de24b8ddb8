// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Tails against Imhof's table, chi^2, and drawing.
#include "statistics/quadratic_forms.hpp"

#include "statistics/distributions.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::quadratic_forms_test {
using namespace statistics;
namespace {

TEST(QuadraticForm, TailsAreThoseOfImhofsTable) {
  // Imhof (1961), Biometrika 48, table 1, Q1: 0.6, 0.3 and 0.1 of chi^2 with one degree each.
  const std::vector<double> weights{0.6, 0.3, 0.1};
  EXPECT_NEAR(quadratic_form_p_value(0.1, weights), 0.9458, 0.02);
  EXPECT_NEAR(quadratic_form_p_value(0.7, weights), 0.5064, 0.02);
  EXPECT_NEAR(quadratic_form_p_value(2.0, weights), 0.1240, 0.005);
}

TEST(QuadraticForm, EqualWeightsAreChi2EvenFarOut) {
  for (const int dof : {1, 2, 5, 20}) {
    const std::vector<double> weights(static_cast<std::size_t>(dof), 3.0);
    for (const double p : {0.5, 0.1, 1e-3, 1e-8}) {
      const double value = 3.0 * chi2_quantile(1.0 - p, dof);
      EXPECT_NEAR(quadratic_form_p_value(value, weights) / p, 1.0, 0.12) << dof << " " << p;
    }
  }
}

TEST(QuadraticForm, AtTheMeanItIsInBetween) {
  const std::vector<double> weights{2.0, 1.0, 0.5, 0.25};
  const double mean = 3.75;
  const double at = quadratic_form_p_value(mean, weights);
  EXPECT_NEAR(at, quadratic_form_p_value(0.99 * mean, weights), 0.01);
  EXPECT_NEAR(at, quadratic_form_p_value(1.01 * mean, weights), 0.01);
}

TEST(QuadraticForm, WithoutWeightsNothingIsLarge) {
  EXPECT_EQ(quadratic_form_p_value(5.0, {}), 1.0);
  EXPECT_EQ(quadratic_form_p_value(5.0, {0.0, -1.0}), 1.0);
  EXPECT_EQ(quadratic_form_p_value(0.0, {1.0}), 1.0);
}

/// Standardised sums of the first k of n normal draws less their share of all: a step's scores.
std::vector<double> bridge(int n, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<double> sums(1, 0.0);
  for (int k = 0; k < n; ++k) sums.push_back(sums.back() + normal(random));
  std::vector<double> z;
  for (int k = 1; k < n; ++k) {
    const double share = static_cast<double>(k) / n;
    z.push_back((sums[static_cast<std::size_t>(k)] - share * sums.back()) /
                std::sqrt(n * share * (1.0 - share)));
  }
  return z;
}

TEST(LargestSquare, IsBoundedCloselyFarOut) {
  constexpr int kParts = 24;
  constexpr int kDraws = 200000;
  std::vector<double> cosines;
  for (int k = 1; k + 1 < kParts; ++k) {
    const double a = k;
    const double b = k + 1;
    cosines.push_back(std::sqrt(a * (kParts - b) / (b * (kParts - a))));
  }
  std::mt19937_64 random(61);
  std::vector<double> largest;
  for (int draw = 0; draw < kDraws; ++draw) {
    double most = 0.0;
    for (const double z : bridge(kParts, random)) most = std::max(most, z * z);
    largest.push_back(most);
  }
  for (const double value : {9.0, 12.0, 16.0}) {
    const auto beyond =
        std::count_if(largest.begin(), largest.end(), [value](double one) { return one > value; });
    const double share = static_cast<double>(beyond) / kDraws;
    const double bound = largest_square_p_value(value, cosines);
    EXPECT_GT(bound, share - 3.0 * std::sqrt(share / kDraws)) << value;
    EXPECT_LT(bound, 2.5 * share) << value;
  }
}

}  // namespace
}  // namespace trussmap::quadratic_forms_test
