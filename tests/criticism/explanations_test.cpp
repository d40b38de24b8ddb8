// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Sets of effects in simulated worlds whose effects are known. Seeds are stated at each.
#include "criticism/explanations.hpp"

#include "criticism/noisy_recordings.hpp"
#include "fit/fit_state.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/running.hpp"
#include "trussmap/texts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::explanations_test {
using namespace criticism;
using namespace fitting;
namespace {

using testing::NoisyDrive;

/// simulate_world with two tours, a compass and a survey, and these effects.
NoisyDrive world_with(const std::vector<Effect>& effects, std::uint64_t seed) {
  NoisyDrive result;
  result.mesh = mesh_of_lines({0.0, 4.0, 9.0, 12.0}, {0.0, 3.0, 7.0, 12.0});
  DrivingStyle style;
  style.rest_share = 0.3;
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  const Tours tours = make_tours(result.mesh, WalkKind::euler, 2, random);
  SimulatedEffects acting;
  acting.effects = effects;
  SimulatedDrive drive =
      simulate_drive(result.mesh, tours.walk, style, WheeledRobot(), seed, acting);
  result.recordings.push_back(testing::driven(drive.recording));
  return result;
}

/// Two effects whose traces all but cancel: 250 of chi^2 are left of the sum, and neither by itself
/// takes more than a fifth of that away.
struct MaskedPair {
  std::vector<Effect> effects;
  double alone = 0.0;  ///< the larger share that one of them explains
};

MaskedPair masked_pair_in(std::uint64_t seed, const char* name, const char* other) {
  const NoisyDrive clean = world_with({}, seed);
  const FitState fit = fit_recordings(clean.recordings, clean.model);
  const ScoreTest tests(fit);
  const std::vector<Score> scores = tests.test({catalogue_effect(name), catalogue_effect(other)});
  const Eigen::VectorXd a = scores[0].projected.col(0);
  const Eigen::VectorXd b = scores[1].projected.col(0);
  const double sign = a.dot(b) > 0.0 ? -1.0 : 1.0;
  const Eigen::VectorXd both = a.normalized() + sign * b.normalized();
  const double size = std::sqrt(250.0) / both.norm();
  MaskedPair pair;
  pair.effects = {catalogue_effect(name, {size / a.norm()}),
                  catalogue_effect(other, {sign * size / b.norm()})};
  for (const Eigen::VectorXd& one : {a, b}) {
    pair.alone = std::max(pair.alone, std::pow(one.normalized().dot(both.normalized()), 2));
  }
  return pair;
}

bool has(const EffectSet& set, const std::string& name) {
  return std::any_of(set.effects.begin(), set.effects.end(), [&](const ExplainingEffect& one) {
    return one.effect.name == name ||
           std::find(one.otherwise.begin(), one.otherwise.end(), name) != one.otherwise.end();
  });
}

TEST(SlowExplanations, TwoThatHideEachOtherAreBothNamed) {
  const MaskedPair pair = masked_pair_in(3, "wheelbase", "turn scrub");
  ASSERT_LT(pair.alone, 0.2);
  const NoisyDrive world = world_with(pair.effects, 3);
  const Diagnosis result = diagnose(world.recordings, world.model);
  std::vector<std::string> names;
  for (const Finding* one : found_by(result)) names.push_back(one->effect.name);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"turn scrub", "wheelbase"}));
  ASSERT_FALSE(result.explanations.sets.empty());
  EXPECT_TRUE(has(result.explanations.sets.front(), "wheelbase"));
  EXPECT_TRUE(has(result.explanations.sets.front(), "turn scrub"));
  // Both at once, for either alone makes nothing better.
  const Discovery found = discover(world.recordings, world.model);
  ASSERT_EQ(found.found.model.effects.size(), 2U);
  for (const EffectEstimate& one : found.found.effects) {
    const Effect& truth =
        one.effect.name == pair.effects[0].name ? pair.effects[0] : pair.effects[1];
    EXPECT_EQ(one.effect.name, truth.name);
    EXPECT_NEAR(one.effect.coefficients[0], truth.coefficients[0], 4.0 * one.sd[0]);
  }
}

TEST(SlowExplanations, SayWhatTheFindingsSay) {
  const std::vector<Effect> effects{catalogue_effect("hard iron", {0.02, 0.01}),
                                    catalogue_effect("wheelbase", {0.02})};
  const NoisyDrive world = world_with(effects, 5);
  const Diagnosis result = diagnose(world.recordings, world.model);
  const Explanations& all = result.explanations;
  ASSERT_FALSE(all.sets.empty());
  // What is named is a set, its sizes those of the true effects; the probabilities are of one
  // whole.
  const auto named = std::find_if(all.sets.begin(), all.sets.end(),
                                  [](const EffectSet& one) { return one.named; });
  ASSERT_NE(named, all.sets.end());
  EXPECT_EQ(named->effects.size(), found_by(result).size());
  for (const Finding* one : found_by(result)) EXPECT_TRUE(has(*named, one->effect.name));
  for (const ExplainingEffect& one : named->effects) {
    for (const Effect& truth : effects) {
      if (truth.name != one.effect.name) continue;
      for (std::size_t k = 0; k < truth.coefficients.size(); ++k) {
        EXPECT_NEAR(one.effect.coefficients[k], truth.coefficients[k], 4.0 * one.sd[k]);
      }
    }
  }
  double sum = all.none_of_these;
  for (const EffectSet& one : all.sets) {
    sum += one.probability;
    EXPECT_GE(one.behind, 0.0);
    EXPECT_TRUE(one.behind <= 6.0 || one.named);
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
  for (const EffectChance& one : all.effects) {
    EXPECT_GE(one.probability, 0.0);
    EXPECT_LE(one.probability, 1.0);
  }
  // Rivals that all measurements tell apart are in the place of nothing.
  for (const LookAlike& rival : result.findings.front().look_alikes) {
    if (!rival.told_apart()) continue;
    for (const EffectSet& one : all.sets) {
      for (const ExplainingEffect& effect : one.effects) {
        if (effect.effect.name != result.findings.front().effect.name) continue;
        EXPECT_EQ(std::count(effect.otherwise.begin(), effect.otherwise.end(), rival.effect.name),
                  0)
            << rival.effect.name;
      }
    }
  }
  // The same on more threads, to the last digit.
  set_threads(3);
  const Diagnosis again = diagnose(world.recordings, world.model);
  set_threads(1);
  ASSERT_EQ(again.explanations.sets.size(), all.sets.size());
  for (std::size_t k = 0; k < all.sets.size(); ++k) {
    EXPECT_EQ(again.explanations.sets[k].probability, all.sets[k].probability);
    EXPECT_EQ(again.explanations.sets[k].chi2_decrease, all.sets[k].chi2_decrease);
  }
}

TEST(Explanations, AreNoneWhereNothingIsMissing) {
  const NoisyDrive world = world_with({}, 11);
  const Diagnosis result = diagnose(world.recordings, world.model);
  ASSERT_NE(result.verdict, Diagnosis::Verdict::missing);
  EXPECT_TRUE(result.explanations.sets.empty());
  EXPECT_TRUE(result.explanations.effects.empty());
}

TEST(Explanations, AsksProductsOnlyBesideWhatIsIn) {
  const NoisyDrive world = world_with({}, 2);
  const FitState fit = fit_recordings(world.recordings, world.model);
  const ScoreTest tests(fit);
  std::vector<Tested> tested;
  for (const Candidate& one : candidates_for(fit, tests.context())) {
    tested.emplace_back();
    tested.back().candidate = one;
  }
  const auto scrub = std::find_if(tested.begin(), tested.end(), [](const Tested& one) {
    return one.candidate.effect.name == "cross-slope creep";
  });
  ASSERT_NE(scrub, tested.end());
  const auto at = static_cast<std::size_t>(scrub - tested.begin());
  bool creep = false;
  bool load = false;
  for (const Tested& one : interactions(tested, {{at, {}, {}, {}}}, fit, tests)) {
    const Effect& effect = one.candidate.effect;
    const Shape& shape = effect.shape.front();
    creep = creep || effect.channel == Channel::creep;
    const bool motion = shape.speaks_of("speed") || shape.speaks_of("turn_rate");
    // Of channels in which nothing is: what is carried, with how fast it is driven and turned.
    if (effect.channel == Channel::creep) continue;
    load = load || (motion && shape.speaks_of("payload_kg"));
    EXPECT_TRUE(motion && (shape.speaks_of("payload_kg") || shape.speaks_of("lights") ||
                           shape.speaks_of("temperature_C")))
        << effect.name;
  }
  EXPECT_TRUE(creep);
  EXPECT_TRUE(load);
}

}  // namespace
}  // namespace trussmap::explanations_test
