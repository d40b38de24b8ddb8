// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/data_snooping.hpp"

#include "criticism/noise_sources.hpp"
#include "estimation/kinds/kinds.hpp"
#include "estimation/simulated_recordings.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::data_snooping_test {
using namespace estimation;
namespace {

using testing::simulate_recording;
using testing::SimulatedRecording;

/// The sighting among some 500 that names another landmark than the one seen.
struct Spoilt {
  SimulatedRecording simulated;
  std::size_t wrong = 0;
};

Spoilt spoil_one_sighting(std::uint64_t seed) {
  Spoilt result{simulate_recording({true, false, true, 4}, seed), 0};
  std::vector<Sighting>& sightings = result.simulated.recording.sightings;
  result.wrong = sightings.size() / 2;
  while (sightings[result.wrong].standing()) ++result.wrong;
  const std::string& seen = sightings[result.wrong].landmark;
  sightings[result.wrong].landmark = seen == "L1_1" ? "L2_2" : "L1_1";
  return result;
}

TEST(DataSnooping, RedundanciesAddUpToTheDegreesOfFreedom) {
  const SimulatedRecording one = simulate_recording({true, true, true, 1}, 5);
  const RecordingProblem problem = make_problem({one.recording}, one.model);
  const RecordingAdjustment fit = adjust(problem);
  double sum = 0.0;
  for (const CheckedMeasurement& checked : snoop(problem, {}, fit)) sum += checked.redundancy;
  EXPECT_NEAR(sum, fit.dof, 1e-5 * fit.dof);
}

TEST(DataSnooping, ResidualsBySourceAreThriceAsLargeWhereNoiseIsStatedAThird) {
  const SimulatedRecording one = simulate_recording({true, false, true, 4}, 7);
  const auto residuals = [&one](double scale) {
    Model model = one.model;
    Noise& noise = model.noise;
    for (double* sd : {&noise.left, &noise.right, &noise.compass, &noise.sighting, &noise.range,
                       &noise.bearing, &noise.survey, &noise.range_relative, &noise.heading_per_s,
                       &noise.heading_per_rad, &noise.travel_per_s}) {
      *sd *= scale;
    }
    const RecordingProblem problem = make_problem({one.recording}, model);
    return criticism::residuals_by_source(problem, snoop(problem, {}, adjust(problem)));
  };
  const std::vector<SourceResiduals> stated = residuals(1.0);
  const std::vector<SourceResiduals> understated = residuals(1.0 / 3.0);
  ASSERT_GE(stated.size(), 3U);
  // Not exactly three times: noise bends the path, and what is believed of it goes with the square.
  ASSERT_EQ(stated.size(), understated.size());
  for (std::size_t k = 0; k < stated.size(); ++k) {
    EXPECT_EQ(stated[k].source, understated[k].source);
    ASSERT_EQ(stated[k].standardised.size(), understated[k].standardised.size());
    EXPECT_TRUE(std::is_sorted(stated[k].standardised.begin(), stated[k].standardised.end()));
    const double count = static_cast<double>(stated[k].standardised.size());
    double squares = 0.0;
    for (std::size_t i = 0; i < stated[k].standardised.size(); ++i) {
      EXPECT_NEAR(understated[k].standardised[i], 3.0 * stated[k].standardised[i],
                  0.1 + 0.1 * std::abs(understated[k].standardised[i]));
      squares += stated[k].standardised[i] * stated[k].standardised[i];
    }
    // The variance of a sample of n has the standard deviation sqrt(2/n).
    EXPECT_NEAR(squares / count, 1.0, 5.0 * std::sqrt(2.0 / count)) << stated[k].source;
  }
}

TEST(DataSnooping, StandardisedResidualsAreStandardNormal) {
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SimulatedRecording one = simulate_recording({true, false, true, 1}, seed);
    const RecordingProblem problem = make_problem({one.recording}, one.model);
    for (const CheckedMeasurement& checked : snoop(problem, {}, adjust(problem))) {
      for (const double value : checked.standardised) {
        if (value == 0.0) continue;  // not checked
        sum += value;
        squares += value * value;
        count += 1.0;
      }
    }
  }
  ASSERT_GT(count, 4000.0);
  // sd of the mean 1/sqrt(n), of the mean square sqrt(2/n); residuals are correlated in groups of
  // up to the 4 of a segment, hence twice that; 4 sd.
  EXPECT_NEAR(sum / count, 0.0, 8.0 / std::sqrt(count));
  EXPECT_NEAR(squares / count, 1.0, 8.0 * std::sqrt(2.0 / count));
}

TEST(DataSnooping, TheStatisticIsWhatLeavingTheMeasurementOutTakesOffChi2) {
  const Spoilt one = spoil_one_sighting(3);
  const RecordingProblem problem = make_problem({one.simulated.recording}, one.simulated.model);
  const RecordingAdjustment fit = adjust(problem);
  const std::vector<CheckedMeasurement> checked = snoop(problem, {}, fit);
  std::size_t some = 0;
  while (problem.measurements[some].kind != &kinds::view) ++some;
  RecordingProblem without = problem;
  without.measurements.erase(without.measurements.begin() + static_cast<std::ptrdiff_t>(some));
  // Exact for a linear problem; this one is nearly.
  EXPECT_NEAR(checked[some].statistic, fit.chi2 - adjust(without).chi2,
              0.02 * checked[some].statistic + 0.02);
}

TEST(DataSnooping, TheSmallestDetectableOutlierIsSeenInFourOfFiveCases) {
  // Baarda: at 0.1 % either way (3.2905 standard deviations) with a power of 80 %. The outlier
  // moves the standardised residual, whose spread stays 1.
  const SimulatedRecording one = simulate_recording({true, false, true, 1}, 5);
  const RecordingProblem problem = make_problem({one.recording}, one.model);
  const std::vector<CheckedMeasurement> before = snoop(problem, {}, adjust(problem));
  int asked = 0;
  for (std::size_t k = 0; k < problem.measurements.size() && asked < 5; k += 7) {
    if (problem.measurements[k].kind != &kinds::view) continue;
    ++asked;
    const Eigen::Index value = asked % 2;  // bearing, range, ...
    RecordingProblem spoilt = problem;
    spoilt.measurements[k].value[value] += before[k].minimal_detectable[value];
    const CheckedMeasurement after = snoop(spoilt, {}, adjust(spoilt))[k];
    const double moved = std::abs(after.standardised[value] - before[k].standardised[value]);
    const double power = 0.5 * std::erfc((3.2905 - moved) / std::sqrt(2.0));
    EXPECT_NEAR(power, 0.80, 0.03) << k << ", value " << value;
  }
  EXPECT_EQ(asked, 5);
}

TEST(DataSnooping, AWrongSightingIsTheFirstOfTheOutliers) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Spoilt one = spoil_one_sighting(seed);
    ASSERT_GT(one.simulated.recording.sightings.size(), 400U);
    const RecordingProblem problem = make_problem({one.simulated.recording}, one.simulated.model);
    const std::vector<OutlierTest> found = outliers(snoop(problem, {}, adjust(problem)));
    ASSERT_FALSE(found.empty());
    const Measurement& first = problem.measurements[idx(found.front().measurement)];
    EXPECT_EQ(first.source, one.wrong);
    EXPECT_EQ(first.kind, &kinds::view);
  }
}

TEST(DataSnooping, RobustlyAWrongSightingMovesNoLandmarkOutOfItsEllipse) {
  constexpr double k95 = 5.991;  // chi^2, 2 dof
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Spoilt one = spoil_one_sighting(seed);
    const SimulatedRecording clean = simulate_recording({true, false, true, 4}, seed);
    const RecordingProblem problem = make_problem({one.simulated.recording}, one.simulated.model);
    RecordingAdjustmentOptions robust;
    robust.gate = 25.0;
    const RecordingAdjustment fit = adjust(problem, {}, robust);
    ASSERT_EQ(fit.left_out.size(), 1U) << seed;
    EXPECT_EQ(problem.measurements[idx(fit.left_out.front())].source, one.wrong);
    const RecordingAdjustment right = adjust(make_problem({clean.recording}, clean.model));
    for (std::size_t k = 1; k < problem.landmarks.size(); ++k) {
      const Vector2 moved = fit.state.landmarks[k] - right.state.landmarks[k];
      EXPECT_LT(moved.dot(right.landmark_covariances[k].inverse() * moved), k95);
    }
    // It is listed still, against the fit without it.
    const std::vector<OutlierTest> found = outliers(snoop(problem, {}, fit));
    EXPECT_EQ(found.front().measurement, fit.left_out.front());
  }
}

TEST(DataSnooping, WithoutWrongSightingsTheRobustOptionLeavesNothingOut) {
  const SimulatedRecording one = simulate_recording({true, false, true, 2}, 1);
  const RecordingProblem problem = make_problem({one.recording}, one.model);
  RecordingAdjustmentOptions robust;
  robust.gate = 30.0;
  const RecordingAdjustment fit = adjust(problem, {}, robust);
  EXPECT_TRUE(fit.left_out.empty());
  EXPECT_NEAR(fit.chi2, adjust(problem).chi2, 1e-6);
}

}  // namespace
}  // namespace trussmap::data_snooping_test
