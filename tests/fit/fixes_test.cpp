// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Positions without heading: drives that nothing else ties to a place, and drives with landmarks.
#include "driven.hpp"
#include "estimation/kinds/kinds.hpp"
#include "fit/placed_drives.hpp"
#include "fit/replicated_recording.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/check.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/simulated_recording.hpp"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::fixes_test {
using namespace estimation;
namespace {

using testing::expect_right;
using testing::fit_statistics;
using testing::FitStatistics;
using testing::is_mean_of_right_ones;
using testing::path_error;
using testing::placed_drive;
using testing::PlacedDrive;
using testing::PlacedOptions;

std::vector<Effect> mounted(double ahead, double left, double late) {
  return {catalogue_effect("antenna ahead of the axle", {ahead}),
          catalogue_effect("antenna beside the axle", {left}),
          catalogue_effect("fix delay", {late})};
}

FitOptions gated() {
  FitOptions options;
  options.gate = 16.0;
  return options;
}

/// The simulator finds fixes by turning its physics round; model and recording agree exactly.
TEST(Fixes, ExactOnesLeaveNoErrorAndTellTheirAntenna) {
  for (const bool compass : {false, true}) {
    PlacedOptions options;
    options.compass = compass;
    options.noise = false;
    options.fix_rate = 1.3;  // within rows
    options.effects = mounted(0.35, -0.2, 0.15);
    const PlacedDrive drive = placed_drive(options, 5);
    Model model = drive.model;
    model.effects = options.effects;
    FitOptions held;
    held.fit_effects = false;
    EXPECT_LT(fit_model({drive.recording}, model, held).chi2, 1e-6);
    for (Effect& effect : model.effects) effect.coefficients = {0.0};
    const ModelFit fit = fit_model({drive.recording}, model);
    EXPECT_LT(fit.chi2, 1e-6);
    EXPECT_NEAR(fit.model.effects[0].coefficients[0], 0.35, 1e-5);
    EXPECT_NEAR(fit.model.effects[1].coefficients[0], -0.2, 1e-5);
    EXPECT_NEAR(fit.model.effects[2].coefficients[0], 0.15, 1e-5);
    EXPECT_LT(path_error(drive, fit), 1e-5);
  }
}

/// Drives of two minutes with fixes and what is unknown of their antenna, three effects each.
FitStatistics statistics(int drives, std::uint64_t first_seed) {
  PlacedOptions options;
  options.fix_rate = 1.0;
  options.effects = mounted(0.3, 0.1, 0.2);
  return fit_statistics(options, drives, first_seed);
}

/// 30 drives, seeds 100 to 129.
TEST(Fixes, ChiSquareAndIntervalsAreThoseOfTheNoise) {
  const FitStatistics found = statistics(30, 100);
  EXPECT_TRUE(is_mean_of_right_ones(found.mean, 30, found.dof)) << found.mean;
  // 90 intervals at 95 %: 85.5, sd 2.1; four of them.
  EXPECT_GE(found.inside, 77);
}

/// Every 17th fix is 3 to 9 m off, the first three among them.
TEST(Fixes, WrongOnesAreLeftOutAndNamed) {
  for (const bool compass : {false, true}) {
    PlacedOptions options;
    options.compass = compass;
    options.fix_rate = 1.0;
    PlacedDrive drive = placed_drive(options, 7);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::set<double> wrong;
    for (std::size_t k = 0; k < drive.recording.fixes.size(); ++k) {
      if (k % 17 != 5 && k > 2) continue;
      Fix& fix = drive.recording.fixes[k];
      const Vector2 off = (3.0 + 6.0 * uniform(random)) * rotation(6.3 * uniform(random)).col(0);
      fix.x += off.x();
      fix.y += off.y();
      fix.quality = 2.0;
      wrong.insert(fix.t);
    }
    const ModelFit fit = fit_model({drive.recording}, drive.model, gated());
    const fitting::FitState& state = *fit.state;
    std::set<double> left_out;
    for (const int k : state.adjustment.left_out) {
      const Measurement& one = state.problem.measurements[idx(k)];
      ASSERT_EQ(one.kind, &kinds::fix);
      left_out.insert(drive.recording.fixes[one.source].t);
    }
    for (const double t : wrong) EXPECT_TRUE(left_out.contains(t)) << t;
    EXPECT_LE(left_out.size(), wrong.size() + 2);  // one right one in 3000 goes, too
    ASSERT_FALSE(fit.left_out.empty());
    EXPECT_EQ(fit.left_out[0].rfind("fixes.csv: fix at t = 0.000 s, ", 0), 0U) << fit.left_out[0];
    EXPECT_NE(fit.left_out[0].find(" m off (quality 2)"), std::string::npos) << fit.left_out[0];
    EXPECT_LT(path_error(drive, fit), 0.1);
  }
}

/// A clock, an antenna or an axle that is off is named by a diagnosis without it.
TEST(Fixes, DiagnosisNamesTheAntenna) {
  PlacedOptions options;
  options.fix_rate = 2.0;
  options.tours = 2;
  options.effects = {catalogue_effect("antenna ahead of the axle", {0.4})};
  const PlacedDrive drive = placed_drive(options, 8);
  const Diagnosis found = diagnose({drive.recording}, drive.model, {});
  EXPECT_EQ(found.missing, "antenna ahead of the axle");
}

TEST(Fixes, BesideAKnownDriftInRestsLeaveTheFitWhereItIs) {
  // A drift turns the robot in rests, too, where its wheels stand still: it slips there as it does
  // anywhere, and is not turned round and round to bring it a millimetre sideways.
  SimulationSettings settings;
  settings.mesh = "4x4";
  settings.tours = 1;
  settings.seed = 7;
  settings.rests = true;
  settings.fix_rate = 0.5;
  const SimulatedRecording one = simulate(settings, {catalogue_effect("heading drift", {0.002})});
  Model known = one.model;
  known.effects = {catalogue_effect("heading drift", {0.002})};
  FitOptions as_given;
  as_given.fit_effects = false;
  const ModelFit fit = fit_model({one.drive.recording}, known, as_given);
  EXPECT_GT(fit.p_value, 1e-3);
  EXPECT_LT(fit.chi2, 1.2 * fit.dof);
}

/// Held-out legs end at fixes; the model that made them is consistent.
TEST(Fixes, EndLegsWhereNothingElseDoes) {
  PlacedOptions options;
  options.fix_rate = 2.0;
  options.compass = true;
  const PlacedDrive drive = placed_drive(options, 9);
  const Comparison result = compare({drive.recording}, drive.model);
  EXPECT_TRUE(result.consistent());
  EXPECT_GT(result.held_out.legs.size(), 10U);
  // The fix's own noise, twice 0.05 m, and what the wheels add in a metre.
  EXPECT_GT(result.held_out.arrival_rms, 0.05);
  EXPECT_LT(result.held_out.arrival_rms, 0.15);
}

TEST(Fixes, GiveTheMapTheirFrame) {
  for (const double rate : {0.05, 2.0}) {
    PlacedOptions options;
    options.fix_rate = rate;
    options.landmarks = true;
    PlacedDrive drive = placed_drive(options, 10);
    const Alignment elsewhere{1.0, 2.0, {100.0, -50.0}, 0.0};
    for (Fix& fix : drive.recording.fixes) {
      const Vector2 moved = elsewhere.apply({fix.x, fix.y});
      fix.x = moved.x();
      fix.y = moved.y();
    }
    const ModelFit fit = fit_model({drive.recording}, drive.model, gated());
    EXPECT_LT(fit.chi2, 1.5 * fit.dof);
    for (const FittedLandmark& one : fit.landmarks) {
      const auto at = std::find_if(drive.motion.stops.begin(), drive.motion.stops.end(),
                                   [&](const TrueStop& stop) {
                                     return "L" + std::to_string(stop.landmark / 3) + "_" +
                                                std::to_string(stop.landmark % 3) ==
                                            one.name;
                                   });
      ASSERT_NE(at, drive.motion.stops.end()) << one.name;
      const double off = (one.position - elsewhere.apply(at->pose.position())).norm();
      EXPECT_LT(off, 0.02 + 4.0 * std::sqrt(one.covariance.trace())) << one.name;
    }
    const BuiltMap built = build_map({drive.recording}, drive.model);
    EXPECT_EQ(built.map.landmarks(), 9);
  }
}

/// Latitude and longitude in degrees are no metres; metres are.
TEST(Fixes, InDegreesAreNoticed) {
  PlacedOptions options;
  options.fix_rate = 1.0;
  PlacedDrive drive = placed_drive(options, 14);
  EXPECT_TRUE(check_recordings({drive.recording}, &drive.model).empty());
  for (Fix& fix : drive.recording.fixes) {
    fix.x = 12.9 + fix.x / 70e3;
    fix.y = 50.8 + fix.y / 111e3;
  }
  const std::vector<CheckFinding> findings = check_recordings({drive.recording}, &drive.model);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].kind, "fix unit");
}

/// Without them a drive of fixes alone has nothing to go by.
TEST(Fixes, CanBeLeftOut) {
  PlacedOptions options;
  options.fix_rate = 1.0;
  const PlacedDrive drive = placed_drive(options, 11);
  FitOptions without;
  without.use_fixes = false;
  EXPECT_THROW(static_cast<void>(fit_model({drive.recording}, drive.model, without)), InputError);
}

/// One in a tenth of a second, or a quarter of a metre; those of all outside the drive not at all.
TEST(Fixes, ThatFollowTooFastArePassedOver) {
  PlacedOptions options;
  options.fix_rate = 100.0;
  PlacedDrive drive = placed_drive(options, 12);
  const double end = drive.recording.drive.t.back();
  drive.recording.fixes.push_back({end + 1.0, 0.0, 0.0});
  const RecordingProblem problem = make_problem({testing::driven(drive.recording)}, drive.model);
  const auto fixes = std::count_if(problem.measurements.begin(), problem.measurements.end(),
                                   [](const Measurement& one) { return one.kind == &kinds::fix; });
  EXPECT_NEAR(static_cast<double>(fixes), 10.0 * end, 3.0);
}

/// Errors that last 5 s, 8 cm beside white ones of 3 cm: with the process stated the adjustment's
/// chi^2 is right, without it far too large. Seeds 200 to 219.
TEST(Fixes, NoiseThatLastsCanBeStated) {
  constexpr int kDrives = 20;
  double with = 0.0;
  double without = 0.0;
  int dof = 0;
  for (int k = 0; k < kDrives; ++k) {
    PlacedOptions options;
    options.fix_rate = 2.0;
    options.fix_sd = 0.03;
    PlacedDrive drive = placed_drive(options, 200 + static_cast<std::uint64_t>(k));
    std::mt19937_64 random(300 + static_cast<std::uint64_t>(k));
    std::normal_distribution<double> normal;
    Vector2 lasting(0.08 * normal(random), 0.08 * normal(random));
    double before = 0.0;
    for (Fix& fix : drive.recording.fixes) {
      const double keep = std::exp(-(fix.t - before) / 5.0);
      const double fresh = 0.08 * std::sqrt(1.0 - keep * keep);
      lasting = keep * lasting + fresh * Vector2(normal(random), normal(random));
      fix.x += lasting.x();
      fix.y += lasting.y();
      before = fix.t;
    }
    const ModelFit white = fit_model({drive.recording}, drive.model);
    without += white.chi2 / white.dof / kDrives;
    Model model = drive.model;
    model.noise.processes = {{Channel::fix_x, ProcessKind::correlated_in_t, 0.08, 5.0},
                             {Channel::fix_y, ProcessKind::correlated_in_t, 0.08, 5.0}};
    const ModelFit fit = fit_model({drive.recording}, model);
    with += fit.chi2 / fit.dof / kDrives;
    dof = fit.dof;
  }
  EXPECT_TRUE(is_mean_of_right_ones(with, kDrives, dof)) << with;
  EXPECT_GT(without, 1.5);
}

/// What is drawn anew from a fit has the fit's own noise.
TEST(Fixes, AreReplicatedWithTheRest) {
  PlacedOptions options;
  options.fix_rate = 2.0;
  options.effects = mounted(0.3, 0.1, 0.2);
  const PlacedDrive drive = placed_drive(options, 13);
  Model model = drive.model;
  model.effects = mounted(0.0, 0.0, 0.0);
  const ModelFit fit = fit_model({drive.recording}, model);
  const std::vector<DrivenRecording> again =
      fitting::replicated({testing::driven(drive.recording)}, *fit.state, 4);
  const ModelFit second = fit_model(again, fit.model);
  EXPECT_LT(std::abs(second.chi2 - second.dof), 5.0 * std::sqrt(2.0 * second.dof));
  for (std::size_t e = 0; e < 3; ++e) {
    EXPECT_NEAR(second.effects[e].effect.coefficients[0], fit.effects[e].effect.coefficients[0],
                5.0 * second.effects[e].sd[0]);
  }
}

/// 500 drives, seeds 1000 to 1499.
TEST(SlowFixes, ChiSquareAndIntervalsAreThoseOfTheNoise) {
  expect_right(statistics(500, 1000), 500);
}

}  // namespace
}  // namespace trussmap::fixes_test
