// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Fleets: sums say what all recordings together would say, and few robots cannot hide.
#include "trussmap/fleet.hpp"

#include "criticism/score_test.hpp"
#include "driven.hpp"
#include "fit/fit_state.hpp"
#include "statistics/random_effects.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/error.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::fleet_test {
using namespace fitting;
using namespace statistics;
namespace {

/// A surveyed 3x3 mesh with landmark names of its own.
DrivenRecording recording_of(std::uint64_t seed, const std::vector<Effect>& effects) {
  const Mesh mesh = even_mesh({3, 3}, 3.0);
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, 2, random);
  SimulatedDrive drive = simulate_drive(mesh, tours.walk, {}, {}, seed, {effects});
  const std::string own = "s" + std::to_string(seed) + "_";
  for (Sighting& one : drive.recording.sightings) one.landmark = own + one.landmark;
  for (SurveyPoint& one : drive.recording.survey) one.landmark = own + one.landmark;
  return testing::driven(drive.recording);
}

struct Robots {
  std::vector<DrivenRecording> recordings;
  std::vector<FleetRow> rows;
};

/// Of seeds 1 to 3, all with one wheelbase that is off.
Robots three_robots(const Model& model) {
  Robots robots;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    robots.recordings.push_back(recording_of(seed, {catalogue_effect("wheelbase", {0.004})}));
    robots.rows.push_back(fleet_row("R" + std::to_string(seed), "2026-03-01",
                                    {robots.recordings.back()}, model, "model"));
  }
  return robots;
}

TEST(Fleet, SumsSayWhatAllRecordingsTogetherSay) {
  const Model model;
  const auto [recordings, rows] = three_robots(model);
  const std::vector<PooledTest> pooled = pooled_tests(rows);
  // A fit of all ends where its worst segment is still; so far that only the sums are compared.
  FitterOptions how = fitter_options({});
  how.still_offset = 1e-7;
  const FitState fit = fit_recordings(recordings, model, how);
  const criticism::ScoreTest joint(fit);
  std::vector<Effect> effects;
  for (const PooledTest& one : pooled) {
    Effect effect;
    effect.name = one.effect;
    effect.channel = channel_named(one.channel);
    effect.shape.assign(one.shape.begin(), one.shape.end());
    effects.push_back(effect);
  }
  const std::vector<criticism::Score> scores = joint.test(effects);
  int seen = 0;
  for (std::size_t k = 0; k < pooled.size(); ++k) {
    const criticism::Score& score = scores[k];
    ASSERT_EQ(pooled[k].dof, score.dof) << pooled[k].effect;
    if (score.dof == 0) continue;
    ++seen;
    EXPECT_NEAR(pooled[k].score, score.score, 1e-6 * score.score + 1e-9) << pooled[k].effect;
    EXPECT_NEAR(pooled[k].p_value, score.p_value, 1e-5 * score.p_value) << pooled[k].effect;
    for (std::size_t c = 0; c < score.coefficients.size(); ++c) {
      EXPECT_NEAR(pooled[k].coefficients[c], score.coefficients[c],
                  1e-6 * std::abs(score.coefficients[c]) + 1e-9 * std::min(1.0, score.sd[c]))
          << pooled[k].effect;
    }
  }
  EXPECT_GT(seen, 10);
}

TEST(Fleet, OneStepFromTheStatedCoefficientsIsTheFit) {
  Model model;
  model.effects = {catalogue_effect("wheelbase", {0.004})};
  const auto [recordings, rows] = three_robots(model);
  const ModelFit fit = fit_model(recordings, model);
  const FleetReport report = fleet_report(rows);
  ASSERT_EQ(report.findings.front().effect, "wheelbase");
  ASSERT_TRUE(report.findings.front().of_model);
  const double sd = fit.effects[0].sd[0];
  // The fit goes on from that step: what is left is second order, far below the standard error.
  EXPECT_NEAR(report.findings.front().coefficients[0].mean, fit.effects[0].effect.coefficients[0],
              0.2 * sd);
}

TEST(Fleet, RowsOfOtherModelsDoNotPool) {
  FleetRow one = fleet_row("R1", "2026-03-01", {recording_of(1, {})}, {}, "one");
  FleetRow other = one;
  other.robot = "R2";
  other.model = "other";
  EXPECT_THROW(static_cast<void>(pooled_tests({one, other})), InputError);
  EXPECT_THROW(static_cast<void>(fleet_report({})), InputError);
  EXPECT_THROW(static_cast<void>(day_number("2026-02-30")), InputError);
  EXPECT_EQ(day_number("1970-01-02"), 1);
}

TEST(RandomEffects, AFewCannotHideEachOther) {
  std::mt19937_64 random(4);  // seed 4
  std::normal_distribution<double> normal;
  std::vector<MemberEstimate> members;
  for (int k = 0; k < 100; ++k) {
    members.push_back({1.0 + 0.5 * normal(random) + 0.3 * normal(random), 0.09, 0});
  }
  for (const std::size_t k : {3U, 7U, 8U, 50U, 99U}) members[k].value += 8.0;
  const RandomEffects found = random_effects(members, 1, 0.01);
  for (std::size_t k = 0; k < members.size(); ++k) {
    EXPECT_EQ(found.outlying[k], k == 3 || k == 7 || k == 8 || k == 50 || k == 99) << k;
  }
  // sd of tau is about tau/sqrt(2 n) (1 + s^2/tau^2) = 0.05, of the mean 0.06: 4 of them.
  EXPECT_NEAR(found.tau, 0.5, 0.2);
  EXPECT_NEAR(found.mean, 1.0, 0.24);
  EXPECT_LT(found.p_tau, 1e-3);
}

TEST(RandomEffects, EqualErrorsGiveTheAnalysisOfVariance) {
  // With equal variances REML is s^2 of the values less the error, and the mean is the plain one.
  const std::vector<double> values{1.0, 2.5, 0.5, 3.0, 2.0, 1.2};
  std::vector<MemberEstimate> members;
  double mean = 0.0;
  for (const double one : values) {
    members.push_back({one, 0.1, 0});
    mean += one / 6.0;
  }
  double squares = 0.0;
  for (const double one : values) squares += (one - mean) * (one - mean);
  const RandomEffects found = random_effects(members, 1, 1e-6);
  EXPECT_NEAR(found.mean, mean, 1e-12);
  EXPECT_NEAR(found.tau * found.tau, squares / 5.0 - 0.1, 1e-6);
  EXPECT_NEAR(found.Q, squares / 0.1, 1e-9);
}

}  // namespace
}  // namespace trussmap::fleet_test
