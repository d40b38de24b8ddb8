// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/fit_charts.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::fit_charts_test {
using namespace plot;
namespace {

SourceResiduals normal_sample(const char* source, std::size_t count, double sd) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0.0, sd);
  SourceResiduals sample{source, {}};
  for (std::size_t k = 0; k < count; ++k) sample.standardised.push_back(normal(random));
  std::sort(sample.standardised.begin(), sample.standardised.end());
  return sample;
}

TEST(QuantileChart, NormalErrorsLieOnALineWhoseSlopeIsTheirSpread) {
  const Chart chart = quantile_chart("q", "Q", {normal_sample("wheels", 5000, 2.0)});
  ASSERT_EQ(chart.layers.size(), 2U);  // the line "as stated" and the dots
  const ChartLayer& dots = chart.layers[1];
  EXPECT_EQ(dots.name, "wheels");
  for (std::size_t k = 0; k < dots.columns[0].numbers.size(); ++k) {
    const double expected = dots.columns[0].numbers[k];
    if (std::abs(expected) > 2.0) continue;
    // Within +-2 the quantiles of 5000 values have standard errors of at most 0.08.
    EXPECT_NEAR(dots.columns[1].numbers[k], 2.0 * expected, 0.3);
  }
}

TEST(HistogramChart, SharesAreThoseOfTheSampleAndOfANormalDistribution) {
  const Chart chart = histogram_chart("h", "H", {normal_sample("wheels", 20000, 1.0)});
  ASSERT_EQ(chart.layers.size(), 3U);
  EXPECT_EQ(chart.layers[2].columns[1].numbers.size(), 20U);
  const std::vector<double>& normal = chart.layers[0].columns[1].numbers;
  const std::vector<double>& seen = chart.layers[1].columns[1].numbers;
  ASSERT_EQ(seen.size(), 40U);  // both ends of 20 steps
  double sum = 0.0;
  for (std::size_t k = 0; k < seen.size(); k += 2) {
    sum += seen[k];
    // Binomial: 20000 draws of a share of a fifth have a standard error of 0.28 %.
    EXPECT_NEAR(seen[k], normal[k], 1.2);
  }
  EXPECT_NEAR(sum, 100.0, 1e-9);
  EXPECT_NEAR(normal[20], 19.1462, 1e-3);  // from 0 to 0.5, of a printed table
  // What is beyond stands in the outermost steps.
  const Chart far = histogram_chart("h", "H", {{"range", {-99.0, -2.0, 0.1, 0.2, 77.0}}});
  EXPECT_NEAR(far.layers[1].columns[1].numbers.front(), 20.0, 1e-9);
  EXPECT_NEAR(far.layers[1].columns[1].numbers.back(), 20.0, 1e-9);
}

TEST(QuantileChart, EveryErrorStandsInTheMiddleOfItsShare) {
  // Of five errors each is a fifth: 0.1, 0.3, 0.5, 0.7, 0.9, with the quantiles of a printed table.
  const Chart chart = quantile_chart("q", "Q", {{"range", {-2.0, -1.0, 0.0, 1.0, 2.0}}});
  const std::vector<double>& expected = chart.layers.at(1).columns[0].numbers;
  const std::vector<double> table = {-1.281552, -0.524401, 0.0, 0.524401, 1.281552};
  ASSERT_EQ(expected.size(), table.size());
  for (std::size_t k = 0; k < table.size(); ++k) EXPECT_NEAR(expected[k], table[k], 1e-6);
  // The line reaches as far as the farthest.
  EXPECT_NEAR(chart.layers[0].columns[0].numbers.back(), 1.281552, 1e-6);
}

TEST(QuantileChart, DrawsFewPointsAndBothEnds) {
  const SourceResiduals sample = normal_sample("compass", 40000, 1.0);
  const Chart chart = quantile_chart("q", "Q", {sample});
  const std::vector<double>& drawn = chart.layers.at(1).columns[1].numbers;
  EXPECT_LE(drawn.size(), 120U);
  EXPECT_GE(drawn.size(), 100U);
  EXPECT_EQ(drawn.front(), sample.standardised.front());
  EXPECT_EQ(drawn.back(), sample.standardised.back());
  EXPECT_TRUE(std::is_sorted(drawn.begin(), drawn.end()));
}

TEST(QuantileChart, AHandfulOfErrorsIsNoSample) {
  EXPECT_EQ(quantile_chart("q", "Q", {normal_sample("range", 4, 1.0)}).layers.size(), 1U);
  const Chart five = quantile_chart("q", "Q", {normal_sample("range", 5, 1.0)});
  ASSERT_EQ(five.layers.size(), 2U);
  EXPECT_EQ(five.layers[1].columns[0].size(), 5U);
}

TEST(LadderChart, HasTheFloorThatNoiseAloneLeaves) {
  const std::vector<LadderStep> steps{
      {"as given", 0.2, 100.0, 10}, {"+ drift", 0.1, 50.0, 10, 0.12}, {"+ drift", 0.05, 20.0, 10}};
  const Chart chart = ladder_chart("ladder", steps, 0.015);
  ASSERT_EQ(chart.layers.size(), 3U);  // bars, floor, predictions
  EXPECT_EQ(chart.layers[1].name, "noise alone");
  EXPECT_TRUE(chart.layers[1].dashed);
  EXPECT_DOUBLE_EQ(chart.layers[1].columns[0].numbers.front(), 15.0);
  EXPECT_EQ(chart.layers[2].columns[0].texts, std::vector<std::string>{"+ drift"});
  EXPECT_DOUBLE_EQ(chart.layers[2].columns[1].numbers.front(), 120.0);
  EXPECT_NE(chart.y.categories[1], chart.y.categories[2]);
  EXPECT_EQ(ladder_chart("ladder", {steps[0]}).layers.size(), 1U);
}

TEST(TrussChart, TheSameForceHasTheSameColourOnEveryMap) {
  FittedMap map;
  map.landmarks = {{"A", {0, 0}, 1e-4 * Matrix2::Identity(), {}},
                   {"B", {5, 0}, 1e-4 * Matrix2::Identity(), {}}};
  const auto shade = [&map](double force, double loudest) {
    const Chart chart = truss_chart("map", "Map", map, {{"A", "B", 1, 1.0, force, 0, 0}}, loudest);
    for (const ChartLayer& layer : chart.layers) {
      if (!layer.shade.empty()) return layer.shade.front();
    }
    return std::nan("");
  };
  EXPECT_DOUBLE_EQ(shade(30.0, 60.0), 0.5);
  EXPECT_DOUBLE_EQ(shade(-6.0, 60.0), -0.1);
}

TEST(TrussChart, NoiseAloneLooksCalm) {
  Comparison result;
  result.routes = {{"A", "B", 1, 1.0, 30.0, 0, 0}};
  result.chi2 = 100.0;
  result.dof = 100;
  EXPECT_DOUBLE_EQ(loudest_force(result), 90.0);  // a third of the strongest colour
  result.chi2 = 5000.0;
  EXPECT_DOUBLE_EQ(loudest_force(result), 30.0);
}

}  // namespace
}  // namespace trussmap::fit_charts_test
