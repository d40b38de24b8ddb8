// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/diagnosis.hpp"

#include "criticism/inverted_recordings.hpp"
#include "criticism/known_events.hpp"
#include "driven.hpp"
#include "estimation/simulated_recordings.hpp"
#include "shared_data.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/wording.hpp"
#include "validation/held_out_legs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::diagnosis_test {
namespace {

/// An answer that counts: a channel, and a word that the shape must contain ("1": a constant).
struct Answer {
  Channel channel;
  std::string word;
};

bool is(const Effect& effect, const Answer& answer) {
  if (effect.channel != answer.channel) return false;
  if (answer.word == "1") return effect.is_constant();
  return std::any_of(effect.shape.begin(), effect.shape.end(), [&](const Shape& shape) {
    return shape.text().find(answer.word) != std::string::npos;
  });
}

bool is_any(const Effect& effect, const std::vector<Answer>& answers) {
  return std::any_of(answers.begin(), answers.end(),
                     [&](const Answer& answer) { return is(effect, answer); });
}

struct Hidden {
  std::string folder;
  std::vector<std::vector<Answer>> effects;  ///< per effect, the answers that count
};

void PrintTo(const Hidden& one, std::ostream* stream) {
  *stream << one.folder;
}

class HiddenEffect : public ::testing::TestWithParam<Hidden> {
 protected:
  void read() {
    const std::filesystem::path folder = testing::shared("data/hidden") / GetParam().folder;
    model_ = read_model(folder / "model.toml");
    recordings_ = {testing::driven(read_recording(folder))};
  }
  Model model_;
  std::vector<DrivenRecording> recordings_;
};

TEST_P(HiddenEffect, IsNamedFirst) {
  TRUSSMAP_NEEDS_SHARED("data/hidden");
  read();
  const Diagnosis result = diagnose(recordings_, model_);
  EXPECT_GT(result.tried, 200U);
  if (GetParam().effects.empty()) {
    EXPECT_EQ(result.verdict, Diagnosis::Verdict::nothing_missing) << result.missing;
    return;
  }
  ASSERT_EQ(result.verdict, Diagnosis::Verdict::missing);
  const Finding& first = result.findings.front();
  EXPECT_EQ(first.status, Status::missing);
  EXPECT_TRUE(std::any_of(
      GetParam().effects.begin(), GetParam().effects.end(),
      [&](const std::vector<Answer>& answers) { return is_any(first.effect, answers); }))
      << result.missing;
  EXPECT_LT(first.held_out.arrival_rms, result.held_out.arrival_rms);
  // What really is there is never said to be told apart from what was named.
  for (const LookAlike& rival : first.look_alikes) {
    for (const std::vector<Answer>& answers : GetParam().effects) {
      if (!is_any(first.effect, answers) && is_any(rival.effect, answers)) {
        EXPECT_FALSE(rival.told_apart()) << rival.effect.name;
      }
    }
  }
}

/// A compass with hard iron on many legs: a body's tilt leaves the same trace, and a creep across
/// the slope one that is much alike, which many measurements tell apart and few do not.
TEST(Diagnosis, LookAlikesAreToldApartByManyMeasurementsOnly) {
  const auto creep_behind = [](int tours, double size) {
    testing::SimulatedRecording one = testing::simulate_recording({true, true, false, tours}, 61);
    for (double& heading : one.recording.drive.heading) heading += size * std::sin(heading);
    DiagnoseOptions options;
    options.estimate_noise = false;
    const Diagnosis result = diagnose({one.recording}, one.model, options);
    EXPECT_EQ(result.verdict, Diagnosis::Verdict::missing);
    const Finding& first = result.findings.front();
    EXPECT_EQ(first.effect.channel, Channel::compass) << first.effect.name;
    double behind = std::numeric_limits<double>::quiet_NaN();
    for (const LookAlike& rival : first.look_alikes) {
      if (rival.effect.name == "body tilt") {
        EXPECT_NEAR(rival.behind, 0.0, 1e-6);
      }
      if (rival.effect.name == "cross-slope creep") behind = rival.behind;
    }
    EXPECT_TRUE(result.next_drive.has_value());  // tilt and iron are one in any recording
    return behind;
  };
  const double few = creep_behind(1, 0.05);
  const double many = creep_behind(6, 0.05);
  EXPECT_GT(many, 2.0 * few);
  EXPECT_GE(many, kToldApart);
}

class SlowHiddenEffect : public HiddenEffect {};

TEST_P(SlowHiddenEffect, IsDiscoveredAndNothingElse) {
  TRUSSMAP_NEEDS_SHARED("data/hidden");
  read();
  const Discovery result = discover(recordings_, model_);
  EXPECT_TRUE(result.consistent);
  EXPECT_EQ(result.found.model.effects.size(), GetParam().effects.size());
  for (const std::vector<Answer>& answers : GetParam().effects) {
    EXPECT_TRUE(std::any_of(result.found.model.effects.begin(), result.found.model.effects.end(),
                            [&](const Effect& effect) { return is_any(effect, answers); }))
        << name_of(answers.front().channel);
  }
  for (std::size_t k = 1; k < result.steps.size(); ++k) {
    // A second effect may show in the fit and yet change held-out ends by less than chance.
    EXPECT_LT(result.steps[k].held_out.arrival_rms,
              (k == 1 ? 1.0 : 1.05) * result.steps[k - 1].held_out.arrival_rms);
    EXPECT_EQ(result.steps[k].held_out.legs.size(), result.steps[0].held_out.legs.size());
  }
}

const auto kPractice = ::testing::Values(
    Hidden{"a", {{{Channel::turn, "1"}}}}, Hidden{"b", {{{Channel::compass, "heading"}}}},
    Hidden{"c", {{{Channel::wheels, "payload_kg"}, {Channel::travel, "payload_kg"}}}},
    Hidden{"d", {{{Channel::wheels, "x-"}, {Channel::travel, "x-"}}}},
    Hidden{"e", {{{Channel::creep, "heading"}}}},
    Hidden{"f", {{{Channel::turn, "sign(turn_rate)"}}, {{Channel::compass, "lights"}}}},
    Hidden{"g", {{{Channel::turn, "abs(turn_rate)"}}}}, Hidden{"h", {}}, Hidden{"i", {}},
    Hidden{"j", {{{Channel::compass, "turn_rate"}}}});
const auto kFolder = [](const auto& which) { return which.param.folder; };

INSTANTIATE_TEST_SUITE_P(Diagnosis, HiddenEffect, kPractice, kFolder);
INSTANTIATE_TEST_SUITE_P(Discovery, SlowHiddenEffect, kPractice, kFolder);

TEST(SlowDiagnosis, NothingIsNamedWhereNothingIsMissing) {
  // Seeds 1 to 24, all equipments in turn. Named at a chance of at most 5 %: more than 4 of 24 has
  // a chance of 0.6 %.
  int named = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const testing::SimulatedRecording one =
        testing::simulate_recording({seed % 2 == 0, seed % 3 != 0, seed % 5 == 0}, seed);
    const Diagnosis result = diagnose({one.recording}, one.model);
    named += result.verdict == Diagnosis::Verdict::missing ? 1 : 0;
  }
  EXPECT_LE(named, 4);
}

TEST(SlowDiagnosis, NoiseOfAnotherLawMakesNoEffect) {
  // A typical leg's spread doubled. Unguarded, seven of the eight with starts name an effect.
  constexpr int kSeeds = 8;
  int named = 0;
  for (const char* law : {"per second", "per start"}) {
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      testing::NoisyDrive world = testing::simulate_world({}, seed);
      testing::add_noise(world, law, 2.0, seed);
      const Diagnosis result = diagnose(world.recordings, world.model);
      named += result.verdict == Diagnosis::Verdict::missing ? 1 : 0;
    }
  }
  EXPECT_LE(named, 3);  // 5 % of 16 and 2.5 sds of a count
}

TEST(SlowDiagnosis, ASingleEventMakesNoEffect) {
  constexpr int kSeeds = 10;
  int named = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const testing::Bump bump = testing::bumped({}, 8.0, seed);
    const Diagnosis result = diagnose(bump.world.recordings, bump.world.model);
    named += result.verdict == Diagnosis::Verdict::missing ? 1 : 0;
    EXPECT_EQ(result.events.front().name, bump.name) << seed;
  }
  EXPECT_LE(named, 2);  // 5 % of 10 and 2 sds of a count
}

TEST(Diagnosis, WithoutASurveyWhatOnlyASurveyShowsIsNamedAsUnobservable) {
  const testing::SimulatedRecording one = testing::simulate_recording({true, false, false}, 3);
  const Diagnosis result = diagnose({one.recording}, one.model);
  for (const char* name : {"travel scale", "constant creep", "compass offset"}) {
    const auto found =
        std::find_if(result.unobservable.begin(), result.unobservable.end(),
                     [&](const Unobservable& unseen) { return unseen.effect.name == name; });
    ASSERT_NE(found, result.unobservable.end()) << name;
    EXPECT_EQ(found->why, Unseen::in_the_map);
    EXPECT_NE(advice_on(*found).drive.find("survey.csv"), std::string::npos);
    EXPECT_TRUE(found->effect.coefficients.empty());
  }
}

TEST(Diagnosis, PredictsWhatTheFitThenGives) {
  // Predicted held-out error and decrease of chi^2 against those of a fit.
  const testing::InvertedOptions plain;
  testing::InvertedOptions options = plain;
  options.noisy = true;
  options.rounds = 6;
  testing::Disturbance disturbance;
  disturbance.motion = [](const testing::RecordedRow& row) {
    return testing::Travelled{row.ds() * 1.004, row.dtheta()};
  };
  const testing::InvertedRecording simulated = testing::invert(disturbance, options, 8);
  Model model;
  model.robot.wheelbase = testing::kInvertedWheelbase;
  DiscoverOptions as_stated;  // under other noise chi^2 is another
  as_stated.diagnosis.estimate_noise = false;
  const Discovery result = discover({simulated.recording}, model, as_stated);
  ASSERT_GE(result.steps.size(), 2U);
  const DiscoveryStep& before = result.steps[0];
  const DiscoveryStep& after = result.steps[1];
  EXPECT_NEAR(after.predicted_decrease, before.chi2 - after.chi2, 0.1 * (before.chi2 - after.chi2));
  EXPECT_NEAR(after.predicted.arrival_rms, after.held_out.arrival_rms,
              0.2 * after.held_out.arrival_rms);
}

TEST(HeldOutLegs, MoveAsTheSlopesSay) {
  // An effect is the same as a recording with its action already in it.
  constexpr double kSize = 2e-3;
  const testing::SimulatedRecording one = testing::simulate_recording({true, true, true}, 9);
  const fitting::FitState fit = fitting::fit_recordings({one.recording}, one.model);
  const validation::HeldOutLegs legs({one.recording}, fit, {}, {});
  ASSERT_TRUE(legs.has_slopes());
  const criticism::ScoreTest tests(fit);
  for (const Channel channel :
       {Channel::wheels, Channel::turn, Channel::compass, Channel::bearing, Channel::range}) {
    Effect effect;
    effect.name = name_of(channel);
    effect.channel = channel;
    effect.shape = {"1"};
    const criticism::Score score = tests.test({effect}).front();
    const HeldOut told = legs.moved(kSize * legs.slopes(effect, score.columns, score.landmarks));
    DrivenRecording changed = one.recording;
    for (std::size_t row = 0; row < changed.drive.rows(); ++row) {
      double& left = changed.drive.pair.left[row];
      double& right = changed.drive.pair.right[row];
      if (channel == Channel::wheels) {
        left *= 1.0 + kSize;
        right *= 1.0 + kSize;
      } else if (channel == Channel::turn) {
        const double more = 0.5 * kSize * (right - left);
        left -= more;
        right += more;
      } else if (channel == Channel::compass) {
        changed.drive.heading[row] -= kSize;
      }
    }
    testing::retake(changed.drive, one.model.robot.wheelbase);
    for (Sighting& sighting : changed.sightings) {
      if (std::isnan(sighting.range)) continue;
      if (channel == Channel::bearing) sighting.bearing -= kSize;
      if (channel == Channel::range) sighting.range -= kSize;
    }
    const HeldOut realised = predict_held_out({changed}, fit_model({changed}, one.model));
    ASSERT_EQ(told.legs.size(), realised.legs.size());
    const HeldOut before = legs.metrics();
    double off = 0.0;
    double change = 0.0;
    for (std::size_t k = 0; k < told.legs.size(); ++k) {
      off += (told.legs[k].arrival_error - realised.legs[k].arrival_error).squaredNorm();
      change += (told.legs[k].arrival_error - before.legs[k].arrival_error).squaredNorm();
    }
    EXPECT_LT(std::sqrt(off), 0.1 * std::sqrt(change)) << name_of(channel);
  }
}

/// Wheels twice as noisy as stated, and a wheelbase that is wrong: what is missing says why errors
/// are large, and no warning blames the noise that was estimated anyway. Seed 5.
TEST(Diagnosis, UnderNoiseThatItEstimatedNoWarningBlamesTheStated) {
  testing::SimulatedRecording world = testing::simulate_recording({}, 5);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  MotionRows& drive = world.recording.drive;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    for (std::vector<double>* wheel : {&drive.pair.left, &drive.pair.right}) {
      double& travel = (*wheel)[row];
      travel += 0.009 * std::sqrt(std::abs(travel)) * normal(random);
    }
    const double apart = 0.02 * (drive.pair.right[row] - drive.pair.left[row]);
    drive.pair.left[row] -= apart;
    drive.pair.right[row] += apart;
  }
  testing::retake(drive);
  const ModelFit fit = fit_model({world.recording}, world.model);
  const auto blames = [](const std::string& one) { return one.rfind("chi^2 = ", 0) == 0; };
  ASSERT_TRUE(std::any_of(fit.warnings.begin(), fit.warnings.end(), blames));
  const Diagnosis found = diagnose({world.recording}, fit);
  ASSERT_EQ(found.verdict, Diagnosis::Verdict::missing);
  ASSERT_TRUE(found.under->noise.changed());
  EXPECT_TRUE(std::none_of(found.warnings.begin(), found.warnings.end(), blames));
}

}  // namespace
}  // namespace trussmap::diagnosis_test
