// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/slow_covariates.hpp"

#include "driven.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::slow_covariates_test {
using namespace drive;
namespace {

/// 20 minutes of rows of 0.1 s, with columns of all kinds. Seed 1.
DrivenRecording day(double warmer = 0.0) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  DrivenRecording recording;
  std::vector<Covariate> columns{{"motor_heat", {}}, {"battery_V", {}}, {"noisy_heat", {}},
                                 {"payload_kg", {}}, {"lights", {}},    {"constant", {}},
                                 {"shaking", {}}};
  for (int row = 0; row < 12000; ++row) {
    const double t = 0.1 * (row + 1);
    recording.drive.t.push_back(t);
    testing::add_travels(recording.drive, 0.05, 0.05);
    const double heat = warmer + 20.0 + 15.0 * (1.0 - std::exp(-t / 300.0));
    const double values[] = {heat,
                             25.0 - 2e-3 * t,
                             heat + normal(random),
                             std::fmod(t, 45.0) < 20.0 ? 12.0 : 0.0,
                             std::fmod(t, 30.0) < 10.0 ? 1.0 : 0.0,
                             3.0,
                             normal(random)};
    for (std::size_t k = 0; k < columns.size(); ++k) columns[k].values.push_back(values[k]);
  }
  recording.drive.covariates = columns;
  return recording;
}

TEST(SlowCovariates, AreThoseThatGoWithTimeWhateverTheirNames) {
  const std::vector<std::string> expected{"motor_heat", "battery_V", "noisy_heat"};
  EXPECT_EQ(slow_covariates({day()}), expected);
  EXPECT_EQ(slow_covariates({day(), day(5.0)}), expected);
}

TEST(SlowCovariates, HaveToBeInEveryRecording) {
  DrivenRecording bare = day();
  bare.drive.covariates.erase(bare.drive.covariates.begin());
  EXPECT_EQ(slow_covariates({day(), bare}), (std::vector<std::string>{"battery_V", "noisy_heat"}));
  EXPECT_TRUE(slow_covariates({}).empty());
}

TEST(SlowCovariates, NeedEnoughRowsToSaySo) {
  DrivenRecording brief = day();
  for (Covariate& one : brief.drive.covariates) one.values.resize(50);
  brief.drive.t.resize(50);
  brief.drive.forward.resize(50);
  brief.drive.turn.resize(50);
  brief.drive.pair = {};
  EXPECT_TRUE(slow_covariates({brief}).empty());
}

}  // namespace
}  // namespace trussmap::slow_covariates_test
