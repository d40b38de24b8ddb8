// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
// Tails and quantiles against closed forms, quadrature and one another.
#include "statistics/distributions.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace trussmap::distributions_test {
using namespace statistics;
namespace {

/// Simpson's rule.
template <typename Density>
double integral(const Density& density, double from, double to) {
  constexpr int kSteps = 20000;
  const double step = (to - from) / kSteps;
  double sum = density(from) + density(to);
  for (int k = 1; k < kSteps; ++k) sum += (k % 2 == 0 ? 2.0 : 4.0) * density(from + k * step);
  return sum * step / 3.0;
}

TEST(Distributions, Chi2OfTwoDegreesIsAnExponential) {
  for (const double x : {0.0, 0.3, 2.0, 40.0}) {
    EXPECT_NEAR(chi2_p_value(x, 2), std::exp(-0.5 * x), 1e-14);
    EXPECT_NEAR(chi2_p_value_real(x, 2.0), std::exp(-0.5 * x), 1e-14);
  }
}

TEST(Distributions, Chi2OfOneDegreeIsASquaredNormal) {
  for (const double z : {0.5, 1.0, 1.959964, 4.0}) {
    EXPECT_NEAR(chi2_p_value(z * z, 1), 2.0 * normal_p_value(z), 1e-12);
    EXPECT_NEAR(normal_p_value(z), 0.5 * std::erfc(z / std::numbers::sqrt2), 1e-14);
  }
}

TEST(Distributions, Chi2OfSevenAndAHalfDegreesIsTheIntegralOfItsDensity) {
  constexpr double kDof = 7.5;
  const auto density = [](double x) {
    return std::exp((0.5 * kDof - 1.0) * std::log(x) - 0.5 * x - std::lgamma(0.5 * kDof) -
                    0.5 * kDof * std::numbers::ln2);
  };
  EXPECT_NEAR(chi2_p_value_real(9.0, kDof), integral(density, 9.0, 150.0), 1e-9);
}

TEST(Distributions, WithoutDegreesOfFreedomNothingIsSaid) {
  EXPECT_EQ(chi2_p_value(5.0, 0), 1.0);
  EXPECT_EQ(log_chi2_p_value(5.0, 0), 0.0);
}

TEST(Distributions, TheLogarithmGoesOnWhereTheTailItselfIsZero) {
  for (const double x : {10.0, 1000.0, 1e5}) {
    EXPECT_NEAR(log_chi2_p_value(x, 2), -0.5 * x, 1e-9 * x);
  }
  // No jump where one formula takes over from the other.
  for (const int dof : {1, 3, 9}) {
    double last = log_chi2_p_value(1250.0, dof);
    for (double x = 1251.0; x < 1350.0; x += 1.0) {
      const double next = log_chi2_p_value(x, dof);
      EXPECT_NEAR(next - last, -0.5, 0.02) << x << ", " << dof;
      last = next;
    }
  }
}

TEST(Distributions, QuantilesInvertTheTails) {
  for (const double p : {0.025, 0.5, 0.95, 0.999}) {
    EXPECT_NEAR(1.0 - chi2_p_value(chi2_quantile(p, 5.0), 5), p, 1e-12);
    EXPECT_NEAR(1.0 - normal_p_value(normal_quantile(p)), p, 1e-12);
    EXPECT_NEAR(1.0 - student_p_value(student_quantile(p, 3.5), 3.5), p, 1e-12);
  }
}

TEST(Distributions, ABinomialTailIsTheSumOfItsTerms) {
  // Two or fewer of 10 at 0.5: (1 + 10 + 45)/1024, and as many on the other side.
  EXPECT_NEAR(binomial_p_value(2, 10, 0.5), 2.0 * 56.0 / 1024.0, 1e-12);
  EXPECT_NEAR(binomial_p_value(8, 10, 0.5), 2.0 * 56.0 / 1024.0, 1e-12);
  EXPECT_DOUBLE_EQ(binomial_p_value(5, 10, 0.5), 1.0);
  EXPECT_NEAR(binomial_p_value(0, 3, 0.95), 2.0 * std::pow(0.05, 3), 1e-15);
}

TEST(Distributions, StudentOfOneDegreeIsCauchyAndFisherItsSquare) {
  for (const double t : {0.2, 1.0, 7.0}) {
    EXPECT_NEAR(student_p_value(t, 1.0), 0.5 - std::atan(t) / std::numbers::pi, 1e-12);
    EXPECT_NEAR(fisher_p_value(t * t, 1.0, 6.0), 2.0 * student_p_value(t, 6.0), 1e-12);
  }
}

}  // namespace
}  // namespace trussmap::distributions_test
