// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Calibrated: with the right model chi^2 and the ellipses are what they claim to be.
#include "estimation/recording_adjustment.hpp"
#include "estimation/simulated_recordings.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::recording_calibration_test {
using namespace estimation;
namespace {

using testing::Equipment;

struct Statistics {
  double mean_reduced_chi2 = 0.0;
  double mean_dof = 0.0;
  double inside = 0.0;  ///< fraction of landmarks in their 95 % ellipses
  int recordings = 0;
  std::vector<double> p_values;
};

Statistics statistics_of(const Equipment& equipment, std::uint64_t seeds) {
  constexpr double k95 = 5.991;  // chi^2, 2 dof
  Statistics result;
  double inside = 0.0;
  double landmarks = 0.0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const testing::SimulatedRecording one = testing::simulate_recording(equipment, seed);
    const RecordingProblem problem = make_problem({one.recording}, one.model);
    const RecordingAdjustment fit = adjust(problem);
    EXPECT_TRUE(fit.converged) << seed;
    result.mean_reduced_chi2 += fit.chi2 / fit.dof;
    result.mean_dof += fit.dof;
    result.p_values.push_back(fit.p_value);
    for (std::size_t k = 0; k < problem.landmarks.size(); ++k) {
      const Matrix2& covariance = fit.landmark_covariances[k];
      if (covariance.norm() == 0.0) continue;  // held
      const Vector2 error = fit.state.landmarks[k] - one.truth.at(problem.landmarks[k]);
      inside += error.dot(covariance.inverse() * error) < k95 ? 1.0 : 0.0;
      landmarks += 1.0;
    }
  }
  result.recordings = static_cast<int>(seeds);
  result.mean_reduced_chi2 /= result.recordings;
  result.mean_dof /= result.recordings;
  result.inside = inside / landmarks;
  std::sort(result.p_values.begin(), result.p_values.end());
  return result;
}

/// Kolmogorov and Smirnov's largest distance from the uniform distribution.
double distance_from_uniform(const std::vector<double>& sorted) {
  const double n = static_cast<double>(sorted.size());
  double distance = 0.0;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    const auto place = static_cast<double>(k);
    distance = std::max({distance, sorted[k] - place / n, (place + 1.0) / n - sorted[k]});
  }
  return distance;
}

constexpr double kKolmogorov1Percent = 1.628;

const std::vector<Equipment> kEquipments = {
    {true, true, false}, {true, false, false}, {false, true, false}, {false, false, false},
    {true, false, true}, {false, false, true}, {true, true, true}};

std::string name_of(const Equipment& equipment) {
  return std::string(equipment.compass ? "compass " : "") + (equipment.survey ? "survey " : "") +
         (equipment.range_sensor ? "range sensor" : "");
}

TEST(RecordingCalibration, Chi2AndEllipsesAreRightOnAverage) {
  constexpr int kSeeds = 60;
  for (const Equipment& equipment : kEquipments) {
    const Statistics found = statistics_of(equipment, kSeeds);
    // The mean of n reduced chi^2 has the sd sqrt(2/(dof n)).
    const double sd = std::sqrt(2.0 / (found.mean_dof * kSeeds));
    EXPECT_NEAR(found.mean_reduced_chi2, 1.0, 3.5 * sd) << name_of(equipment);
    // A map's landmarks move together; as if 3 of its 16 were independent: sd sqrt(.05 .95/180).
    EXPECT_NEAR(found.inside, 0.95, 3.5 * 0.016) << name_of(equipment);
    EXPECT_LT(distance_from_uniform(found.p_values), kKolmogorov1Percent / std::sqrt(kSeeds))
        << name_of(equipment);
  }
}

TEST(SlowRecordingCalibration, Chi2EllipsesAndPValuesHoldOverAThousandRecordings) {
  constexpr int kSeeds = 1000;
  for (const Equipment& equipment : kEquipments) {
    const Statistics found = statistics_of(equipment, kSeeds);
    EXPECT_NEAR(found.mean_reduced_chi2, 1.0, 0.01) << name_of(equipment);
    EXPECT_NEAR(found.inside, 0.95, 0.01) << name_of(equipment);
    EXPECT_LT(distance_from_uniform(found.p_values), kKolmogorov1Percent / std::sqrt(kSeeds))
        << name_of(equipment);
  }
}

}  // namespace
}  // namespace trussmap::recording_calibration_test
