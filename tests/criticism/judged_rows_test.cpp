// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One verdict everywhere: the same model is judged by the same sightings, whoever asks.
#include "trussmap/catalogue.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/wording.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::judged_rows_test {
namespace {

constexpr double kRow = 0.1;   // s
constexpr double kBase = 0.3;  // m
constexpr double kGyroScale = 0.2;

/// A robot that wanders among four landmarks, which it sees ever so many rows with white noise;
/// its gyro says a fifth too much.
Recording wandering(std::uint64_t seed, int rows = 450, int rows_per_frame = 2) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const std::vector<Vector2> landmarks{{3.0, 0.0}, {0.0, 2.6}, {-3.0, 0.0}, {0.0, -2.6}};
  Recording recording;
  Vector2 place(0.0, -1.0);
  double heading = 0.0;
  for (int row = 1; row <= rows; ++row) {
    const double t = kRow * row;
    const double turn = kRow * (0.35 + 0.5 * std::sin(0.31 * t));
    const double way = kRow * (0.35 + 0.1 * std::sin(0.17 * t));
    place += way * Vector2(std::cos(heading + 0.5 * turn), std::sin(heading + 0.5 * turn));
    heading += turn;
    const auto wheel = [&](double side) {
      const double travel = way + side * 0.5 * kBase * turn;
      return travel + 0.003 * std::sqrt(std::abs(travel)) * normal(random);
    };
    recording.drive.t.push_back(t);
    recording.drive.left.push_back(wheel(-1.0));
    recording.drive.right.push_back(wheel(1.0));
    recording.drive.yaw_rate.push_back((1.0 + kGyroScale) * turn / kRow +
                                       0.0005 / std::sqrt(kRow) * normal(random));
    if (row % rows_per_frame != 0) continue;
    for (std::size_t k = 0; k < landmarks.size(); ++k) {
      const Vector2 offset = landmarks[k] - place;
      Sighting seen;
      seen.t = t;
      seen.landmark = std::string(1, static_cast<char>('a' + k));
      seen.range = offset.norm() + 0.03 * normal(random);
      seen.bearing = wrap_angle(direction(offset) - heading + 0.02 * normal(random));
      if (offset.norm() > 0.5) recording.sightings.push_back(seen);
    }
  }
  return recording;
}

Model model_of_wandering() {
  Model model;
  model.robot.wheelbase = kBase;
  model.noise.left = model.noise.right = 0.003;
  model.noise.range = 0.03;
  model.noise.bearing = 0.02;
  model.noise.gyro = 0.0005;
  return model;
}

PreparedRecordings prepared(const Model& model, std::optional<double> every = {}) {
  return prepare_recordings({wandering(1)}, model, gated_fit(), every);
}

DiscoverOptions how() {
  DiscoverOptions options;
  options.diagnosis.fit = gated_fit();
  return options;
}

TEST(PreparedRecordings, AreOfTheModel) {
  const Model given = model_of_wandering();
  const PreparedRecordings rows = prepared(given);
  ASSERT_TRUE(rows.sightings.thinned());  // what the gyro says too much lasts
  Model with = given;
  with.effects.push_back(catalogue_effect("gyro scale"));
  const PreparedRecordings again = prepared_again(rows, with);
  EXPECT_FALSE(again.sightings.thinned());
  EXPECT_FALSE(use_the_same(rows, again));
  EXPECT_TRUE(use_the_same(rows, prepared_again(again, given)));
  const PreparedRecordings asked = prepared(given, 1.0);
  EXPECT_EQ(prepared_again(asked, with).sightings.used, asked.sightings.used);
}

TEST(SlowJudgedRows, OneModelHasOneVerdict) {
  const Model given = model_of_wandering();
  PreparedRecordings rows = prepared(given);
  const std::size_t few = rows.sightings.used;
  const Discovery discovery = discover(rows, given, how());
  ASSERT_EQ(discovery.found.effects.size(), 1U) << verdict_in_words(discovery);
  EXPECT_FALSE(discovery.sightings.thinned()) << verdict_in_words(discovery);
  EXPECT_GT(rows.sightings.used, 5 * few);
  EXPECT_EQ(verdict_in_words(discovery).find("judged by"), std::string::npos);

  PreparedRecordings all = prepared(given, 0.0);
  const Discovery by_all = discover(all, given, how());
  ASSERT_EQ(by_all.found.effects.size(), 1U);
  const EffectEstimate& one = discovery.found.effects.front();
  const EffectEstimate& other = by_all.found.effects.front();
  EXPECT_EQ(one.effect.name, other.effect.name);
  EXPECT_NEAR(one.effect.coefficients.front(), other.effect.coefficients.front(),
              0.3 * other.sd.front());
  EXPECT_NEAR(std::abs(one.effect.coefficients.front()), kGyroScale, 0.05);
  for (std::size_t k = 1; k < discovery.steps.size(); ++k) {
    EXPECT_LE(discovery.steps[k].dof,
              discovery.steps[k - 1].dof + 2 * static_cast<int>(discovery.steps[k - 1].left_out));
  }

  const Model& found = discovery.found.model;
  PreparedRecordings of_found = prepared(found);
  CompareOptions held;
  held.fit = gated_fit();
  held.fit.fit_effects = false;
  const Comparison compared =
      compare(of_found, fit_model(of_found.recordings, found, held.fit), held);
  EXPECT_EQ(compared.consistent(), discovery.consistent) << verdict_in_words(compared);
  ModelFit fit = fit_model(of_found.recordings, found, gated_fit());
  const Diagnosis diagnosis = diagnose(of_found, fit, how().diagnosis);
  EXPECT_EQ(diagnosis.verdict == Diagnosis::Verdict::nothing_missing, discovery.consistent)
      << verdict_in_words(diagnosis);

  // And diagnose names it by all sightings, from the few on.
  PreparedRecordings of_given = prepared(given);
  ModelFit without = fit_model(of_given.recordings, given, gated_fit());
  const Diagnosis missing = diagnose(of_given, without, how().diagnosis);
  EXPECT_EQ(missing.verdict, Diagnosis::Verdict::missing);
  EXPECT_FALSE(missing.sightings.thinned());
  EXPECT_EQ(missing.missing, one.effect.name);
}

/// 800 s instead of 45 s, and ten frames a second.
TEST(SlowPreparedRecordings, OfVeryManySightingsEnoughAreUsed) {
  const Recording recording = wandering(2, 8000, 1);
  ASSERT_GT(recording.sightings.size(), 30000U);
  Model model = model_of_wandering();
  model.effects.push_back(catalogue_effect("gyro scale"));
  const PreparedRecordings rows = prepare_recordings({recording}, model, gated_fit());
  EXPECT_EQ(rows.sightings.all, recording.sightings.size());
  EXPECT_LE(rows.sightings.used, kEnoughSightings);
  EXPECT_GT(rows.sightings.used, kEnoughSightings / 2);
  EXPECT_EQ(rows.sightings.every, rows.pace);
  EXPECT_FALSE(rows.could_be_more());
  ASSERT_EQ(rows.notes.size(), 1U);
  EXPECT_NE(rows.notes.front().find("--every 0: all"), std::string::npos) << rows.notes.front();
  EXPECT_TRUE(use_the_same(rows, prepared_again(rows, model)));
  // The gyro says a fifth too much, and the fit holds that to within its error.
  const ModelFit fit = fit_model(rows.recordings, model, gated_fit());
  const EffectEstimate& scale = fit.effects.front();
  EXPECT_NEAR(scale.effect.coefficients.front(), -kGyroScale / (1.0 + kGyroScale),
              4.0 * scale.sd.front());
  // Asked for all, all are used.
  const PreparedRecordings all = prepare_recordings({recording}, model, gated_fit(), 0.0);
  EXPECT_EQ(all.sightings.used, recording.sightings.size());
}

TEST(UsedSightings, AreInTheVerdict) {
  Comparison comparison;
  comparison.dof = 20;
  comparison.sightings = {104, 976, 5.0};
  EXPECT_NE(verdict_in_words(comparison).find("judged by 104 of 976 sightings, one frame in 5 s"),
            std::string::npos);
  comparison.sightings = {976, 976, 0.0};
  EXPECT_EQ(verdict_in_words(comparison).find("judged by"), std::string::npos);
}

}  // namespace
}  // namespace trussmap::judged_rows_test
