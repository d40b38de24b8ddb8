// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
// Plans for worlds of which it is known what tells their rivals apart.
#include "fit/fit_state.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/running.hpp"
#include "trussmap/session.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::plan_drive_test {
namespace {

const Mesh kMesh = even_mesh({3, 3}, 5.0);

/// Round and round the outer landmarks, always to the left.
std::vector<int> rounds(int count) {
  std::vector<int> walk;
  for (int round = 0; round < count; ++round) {
    for (const auto& [i, j] :
         {std::pair(0, 0), std::pair(1, 0), std::pair(2, 0), std::pair(2, 1), std::pair(2, 2),
          std::pair(1, 2), std::pair(0, 2), std::pair(0, 1)}) {
      walk.push_back(kMesh.landmark(i, j));
    }
  }
  walk.push_back(0);
  return walk;
}

std::vector<int> tour() {
  std::mt19937_64 random(6);
  return make_tours(kMesh, WalkKind::euler, 2, random).walk;
}

Recording recorded(const std::vector<int>& walk, const DrivingStyle& style, const Effect& effect,
                   std::uint64_t seed) {
  Recording recording =
      simulate_drive(kMesh, walk, style, WheeledRobot(), seed, {{effect}}).recording;
  recording.name = "first";
  return recording;
}

Effect of_size(const char* name, double size) {
  return catalogue_effect(name, {size});
}

PlannedDrive planned(const Recording& recording, const std::vector<std::string>& rivals) {
  PlanOptions options;
  options.rivals = rivals;
  return plan_drive(diagnose(std::vector<Recording>{recording}, Model()), options);
}

DrivingStyle at_one_speed() {
  DrivingStyle style;
  style.slowest = 0.5;
  style.fastest = 0.5;
  style.bend = 0.0;
  style.corner_share = 0.0;
  return style;
}

/// Travel that is wrong by a share, and one that is wrong by a share per speed, are the same where
/// there is one speed.
TEST(PlanDrive, RivalsThatOnlySpeedTellsAreDrivenAtOthers) {
  const Recording recording = recorded(tour(), at_one_speed(), of_size("travel scale", 0.006), 21);
  const PlannedDrive drive = planned(recording, {"travel scale", "slip with speed"});
  ASSERT_EQ(drive.pairs.size(), 2U);
  EXPECT_LT(drive.pairs[0].power_before, 0.2);
  EXPECT_TRUE(drive.enough);
  EXPECT_GE(drive.power, 0.95);
  const auto clearly_slower = [](const Waypoint& one) {
    return one.speed > 0.0 && one.speed < 0.4;
  };
  EXPECT_TRUE(
      std::any_of(drive.plan.waypoints.begin(), drive.plan.waypoints.end(), clearly_slower));
}

/// A turn that is wrong by a share, and one that is so by its sense, are the same to the left.
TEST(PlanDrive, RivalsThatOnlyTheSenseTellsAreTurnedToTheOtherSide) {
  const Recording recording = recorded(rounds(4), at_one_speed(), of_size("wheelbase", 0.02), 22);
  const PlannedDrive drive = planned(recording, {"wheelbase", "turn asymmetry"});
  EXPECT_LT(drive.pairs[0].power_before, 0.3);
  EXPECT_TRUE(drive.enough);
  double right = 0.0;
  for (const Waypoint& one : drive.plan.waypoints) right += std::max(0.0, -one.turn);
  EXPECT_GT(right, std::numbers::pi);
}

/// Compass offset and creep: neither can be told from the other by positions alone, whatever is
/// driven; bearings of a sensor fixed to the body would.
TEST(PlanDrive, WhatNoDriveTellsIsSaidToBeBeyond) {
  const Recording recording = recorded(tour(), {}, of_size("compass offset", 0.04), 23);
  const PlannedDrive drive = planned(recording, {"compass offset", "constant creep"});
  EXPECT_TRUE(drive.plan.waypoints.empty());
  EXPECT_FALSE(drive.enough);
  for (const PlannedPair& one : drive.pairs) EXPECT_TRUE(one.beyond);
}

TEST(PlanDrive, GoesByRoutesThatWereDrivenFromWhereTheRecordingEnded) {
  const Recording recording = recorded(rounds(4), at_one_speed(), of_size("wheelbase", 0.02), 22);
  const DrivePlan plan = planned(recording, {"wheelbase", "turn asymmetry"}).plan;
  EXPECT_EQ(plan.waypoints.front().landmark, recording.sightings.back().landmark);
  for (std::size_t k = 1; k < plan.waypoints.size(); ++k) {
    const double apart = (plan.waypoints[k].place - plan.waypoints[k - 1].place).norm();
    EXPECT_NEAR(apart, 5.0, 0.1);                        // neighbours
    EXPECT_NE(plan.waypoints[k].landmark, "L1_1") << k;  // where it never was
  }
}

TEST(PlanDrive, StaysWithinItsLimits) {
  const Recording recording = recorded(tour(), at_one_speed(), of_size("travel scale", 0.002), 24);
  PlanOptions options;
  options.rivals = {"travel scale", "slip with speed"};
  options.most_length = 30.0;
  options.most_time = 90.0;
  options.max_speed = 0.6;
  const PlannedDrive drive =
      plan_drive(diagnose(std::vector<Recording>{recording}, Model()), options);
  EXPECT_LE(plan_length(drive.plan), 30.0);
  EXPECT_LE(plan_duration(drive.plan), 90.0);
  EXPECT_FALSE(drive.enough);
  for (const Waypoint& one : drive.plan.waypoints) EXPECT_LE(one.speed, 0.6);
}

TEST(PlanDrive, IsTheSameWhateverTheNumberOfThreads) {
  const Recording recording = recorded(rounds(4), at_one_speed(), of_size("wheelbase", 0.02), 22);
  const int before = threads();
  std::vector<std::string> plans;
  for (const int count : {1, 3}) {
    set_threads(count);
    plans.push_back(format_plan(planned(recording, {"wheelbase", "turn asymmetry"}).plan));
  }
  set_threads(before);
  EXPECT_EQ(plans[0], plans[1]);
}

/// Both sessions drawn anew 40 times, with the very size that the plan reckons with: the rival's
/// chi^2 less the truth's has the mean lambda and the variance 4 lambda, about. 4 sds, and 5 % for
/// what is beyond first order.
TEST(SlowPlanDrive, PredictsWhatRefitsOfManyDrawsSay) {
  const std::vector<int> walk = tour();
  const PlannedDrive drive =
      planned(recorded(walk, at_one_speed(), of_size("travel scale", 0.006), 21),
              {"travel scale", "slip with speed"});
  const PlannedPair& pair = drive.pairs.front();
  ASSERT_EQ(pair.truth.name, "travel scale");
  constexpr int kDraws = 40;
  double sum = 0.0;
  double before = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto seed = static_cast<std::uint64_t>(100 + draw);
    std::vector<Recording> both = {recorded(walk, at_one_speed(), pair.truth, seed)};
    const auto difference = [&both](const PlannedPair& of) {
      Model true_one;
      true_one.effects = {of.truth};
      Model false_one;
      false_one.effects = {of.rival};
      return fit_model(both, false_one).chi2 - fit_model(both, true_one).chi2;
    };
    before += difference(pair) / kDraws;
    Recording second =
        simulate_plan(kMesh, drive.plan, {}, WheeledRobot(), seed + 1000, {{pair.truth}}).recording;
    second.survey = both.front().survey;
    second.name = "second";
    both.push_back(std::move(second));
    sum += difference(pair) / kDraws;
  }
  const auto tolerance = [](double lambda) {
    return 4.0 * std::sqrt(4.0 * lambda / kDraws) + 0.05 * lambda;
  };
  EXPECT_NEAR(before, pair.before, tolerance(std::max(1.0, pair.before)));
  EXPECT_NEAR(sum, pair.after, tolerance(pair.after));
}

TEST(PlanDrive, RefusesWhatMakesNoSense) {
  const Recording recording = recorded(tour(), {}, of_size("wheelbase", 0.02), 25);
  const Diagnosis diagnosis = diagnose(std::vector<Recording>{recording}, Model());
  const auto refused = [&diagnosis](const PlanOptions& options) {
    EXPECT_THROW(static_cast<void>(plan_drive(diagnosis, options)), std::invalid_argument);
  };
  PlanOptions options;
  options.rivals = {"wheelbase"};
  refused(options);
  options.rivals = {"wheelbase", "no such effect"};
  refused(options);
  options.rivals = {"wheelbase", "turn asymmetry"};
  options.start = "nowhere";
  refused(options);
  options.start = "";
  options.power = 1.0;
  refused(options);
}

/// Every shape of every effect that is promised, tested on noise-free recordings of the plan with
/// exactly the practical size: the chi^2 that the fit finds is lambda.
TEST(SlowPlanAcceptance, ShowsEachEffectAsClearlyAsItSays) {
  LandmarkGraph map;
  for (int k = 0; k < kMesh.landmarks(); ++k) {
    map.add_landmark(landmark_name(kMesh, k), kMesh.positions[static_cast<std::size_t>(k)]);
  }
  for (const MeshRoute& one : kMesh.routes) map.add_route(one.from, one.to);
  AcceptanceOptions options;
  options.size = 6.0;
  options.most_time = 400.0;
  const PlannedDrive drive = plan_acceptance(map, Model(), options);
  ASSERT_FALSE(drive.plan.waypoints.empty());
  EXPECT_GT(drive.effects.size(), 15U);
  int looked_at = 0;
  for (const PlannedEffect& one : drive.effects) {
    if (one.effect.shape.size() != 1) continue;
    const bool plain = one.effect.name == "travel scale" || one.effect.name == "wheelbase" ||
                       one.effect.name == "wheel diameter ratio";
    if (!plain) continue;
    ++looked_at;
    WheeledRobot robot;
    robot.noise = kNoiseFree;
    DrivingStyle style;
    style.standing = 0.0;
    const Recording recording =
        simulate_plan(kMesh, drive.plan, style, robot, 1, {{one.effect}}).recording;
    Model with;
    with.effects = {one.effect};
    const double chi2 = fit_model(std::vector<Recording>{recording}, Model()).chi2 -
                        fit_model(std::vector<Recording>{recording}, with).chi2;
    EXPECT_NEAR(chi2, one.lambda, 0.1 * one.lambda) << one.effect.name;
  }
  EXPECT_EQ(looked_at, 3);
}

}  // namespace
}  // namespace trussmap::plan_drive_test
