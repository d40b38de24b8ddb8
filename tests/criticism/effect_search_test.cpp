// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How many tests count, and who has the better claim.
#include "criticism/effect_search.hpp"

#include "criticism/known_events.hpp"
#include "criticism/noisy_recordings.hpp"
#include "criticism/tested_candidate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::effect_search_test {
using namespace criticism;
using namespace fitting;
namespace {

Tested tested(Form form, const std::string& family, double score, int tried) {
  Tested one;
  one.candidate.form = form;
  one.candidate.family = family;
  if (!family.empty()) one.candidate.parameters = {{"c", 0.0}};
  one.score.score = score;
  one.score.dof = 1;
  one.tried = tried;
  return one;
}

/// Upper tail of chi^2 of one degree of freedom.
double tail(double score) {
  return std::erfc(std::sqrt(0.5 * score));
}

TEST(Judge, AFamilyCountsForAllThatWereTriedOfIt) {
  // Two known effects; a family of 10 of which the best is listed, and two by themselves.
  std::vector<Tested> all = {tested(Form::catalogue, "", 16.0, 1),
                             tested(Form::catalogue, "", 9.0, 1),
                             tested(Form::threshold, "speed above a threshold", 20.0, 10),
                             tested(Form::line, "", 18.0, 1), tested(Form::line, "", 15.0, 1)};
  constexpr int kTried = 14;
  judge(all, 100.0, 200, kTried);
  // Holm's rule by hand, twice: the known ones have half of the level, all others the other half.
  EXPECT_NEAR(all[0].p_adjusted, 2.0 * 2.0 * tail(16.0), 1e-12);
  EXPECT_NEAR(all[1].p_adjusted, 2.0 * 1.0 * tail(9.0), 1e-12);
  EXPECT_NEAR(all[2].p_adjusted, 2.0 * 12.0 * tail(20.0), 1e-12);
  EXPECT_NEAR(all[3].p_adjusted, 2.0 * 12.0 * tail(20.0), 1e-12);  // no less than the one before
  EXPECT_NEAR(all[4].p_adjusted, 2.0 * 1.0 * tail(15.0), 1e-12);

  // Its best pays as if the other nine had been listed, of which none explains anything. What comes
  // after need not: once a family is found, no member of it is in question.
  std::vector<Tested> listed = all;
  listed[2].tried = 1;
  for (int member = 1; member < 10; ++member) {
    listed.push_back(tested(Form::threshold, "speed above a threshold", 0.0, 1));
  }
  judge(listed, 100.0, 200, kTried);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_DOUBLE_EQ(listed[k].p_adjusted, all[k].p_adjusted) << k;
  }
}

TEST(Judge, TheEvidencePaysForEveryMemberTried) {
  std::vector<Tested> all = {tested(Form::threshold, "few", 20.0, 10),
                             tested(Form::threshold, "many", 20.0, 40)};
  judge(all, 100.0, 200, 50);
  EXPECT_NEAR(all[0].evidence - all[1].evidence, std::log(4.0), 1e-12);
}

TEST(EffectSearch, EveryCandidateCountsOnce) {
  const testing::NoisyDrive world = testing::simulate_world({true, true, false, 1}, 3);
  const FitState fit = fit_recordings(world.recordings, world.model);
  const ScoreTest tests(fit);
  EffectSearch search(fit, tests, {}, nullptr);
  search.run();
  int sum = 0;
  int families = 0;
  for (const Tested& one : search.tested()) {
    sum += one.tried;
    families += one.tried > 1 ? 1 : 0;
  }
  EXPECT_EQ(sum, search.tried());
  EXPECT_EQ(sum, static_cast<int>(candidates_for(fit, tests.context()).size()));
  EXPECT_GT(families, 0);
}

TEST(EffectSearch, AJumpOfOneWheelIsNoEffect) {
  // So large a jump in one row of one wheel that effects look significant until it is set aside.
  for (const std::uint64_t seed : {1U, 7U}) {
    const testing::Bump bump = testing::bumped({true, true, false, 1}, 12.0, seed);
    const FitState fit = fit_recordings(bump.world.recordings, bump.world.model);
    const ScoreTest tests(fit);
    std::vector<Effect> effects;
    for (const Candidate& one : candidates_for(fit, tests.context())) effects.push_back(one.effect);
    double most = 0.0;
    for (const Score& one : tests.test(effects, Resolution::quick)) {
      most = std::max(most, one.score / tests.dispersion());
    }
    EXPECT_GT(most, 40.0) << seed;
    EffectSearch search(fit, tests, {}, nullptr);
    search.run();
    EXPECT_TRUE(search.missing().empty()) << seed;
  }
}

/// Iron near the compass, and a bump that stands out by itself: an effect that is surer than any
/// event is asked of all that there is, and not of what events leave.
TEST(EffectSearch, AnEffectWithTheBetterClaimComesBeforeEvents) {
  testing::Bump bump = testing::bumped({true, true, false, 1}, 9.0, 3);
  for (double& heading : bump.world.recordings.front().drive.heading) {
    heading += 0.006 * std::sin(heading);
  }
  const FitState fit = fit_recordings(bump.world.recordings, bump.world.model);
  const ScoreTest tests(fit);
  EffectSearch search(fit, tests, {}, nullptr);
  search.run();
  std::vector<Tested> asked = search.tested();  // of all that there is
  judge(asked, fit.adjustment.chi2, fit.adjustment.dof, search.tried());
  double p = 1.0;
  for (const Tested& one : asked) p = std::min(p, one.p_adjusted);
  const TestedEvent event = test_events(fit, tests).front();
  ASSERT_LT(event.p_adjusted, 1e-3);
  ASSERT_LT(p, 1e-3 * event.p_adjusted);
  ASSERT_FALSE(search.missing().empty());
  EXPECT_EQ(search.tested()[search.missing().front().tested].candidate.effect.name, "hard iron");
  for (std::size_t k = 0; k < asked.size(); ++k) {
    ASSERT_DOUBLE_EQ(search.tested()[k].p_value, asked[k].p_value)
        << asked[k].candidate.effect.name;
  }
}

NoiseTest law(const char* name, double score, double p_adjusted, const char* unit) {
  NoiseTest one;
  one.law = name;
  one.score = score;
  one.p_adjusted = p_adjusted;
  one.unit = unit;
  return one;
}

TEST(LeadingLaw, IsBeyondChanceAndExplainsMoreThanAnyEffect) {
  std::vector<Tested> effects = {tested(Form::line, "", 30.0, 1), tested(Form::line, "", 50.0, 1)};
  effects[0].p_adjusted = 0.04;
  effects[1].p_adjusted = 0.06;  // not significant: it has no claim
  const auto leads = [&effects](const std::vector<NoiseTest>& laws) {
    const NoiseTest* first = leading_law(laws, effects, 0.05);
    return first == nullptr ? std::string() : first->law;
  };
  EXPECT_EQ(leads({law("per metre", 31.0, 0.0099, "m")}), "per metre");
  EXPECT_EQ(leads({law("per metre", 31.0, 0.0101, "m")}), "");
  EXPECT_EQ(leads({law("per metre", 30.0, 0.001, "m")}), "");
  // A shape of noise is no amount; of amounts the first speaks for all.
  EXPECT_EQ(leads({law("heavy tails", 60.0, 0.001, ""), law("per start", 40.0, 0.001, "m")}),
            "per start");
  EXPECT_EQ(leads({law("per metre", 29.0, 0.001, "m"), law("per start", 40.0, 0.001, "m")}), "");
  EXPECT_EQ(leads({}), "");
}

}  // namespace
}  // namespace trussmap::effect_search_test
