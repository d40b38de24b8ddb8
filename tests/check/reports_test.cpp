// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recordings as people reported them, each with the mistake that it has; and drawn ones of the same
// kinds, of other sizes.
#include "scratch_folder.hpp"
#include "shared_data.hpp"
#include "trussmap/check.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/noise_fit.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording_files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::reports_test {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;
using Kinds = std::set<std::string>;

std::string words_of(const std::vector<CheckFinding>& findings) {
  std::string text;
  for (const CheckFinding& one : findings) text += in_words(one) + "\n";
  return text;
}

Kinds kinds_of(const std::vector<CheckFinding>& findings) {
  Kinds kinds;
  for (const CheckFinding& one : findings) kinds.insert(one.kind);
  return kinds;
}

struct Report {
  const char* folder;
  Kinds kinds;
  const char* words;  ///< that the findings have
};

TEST(Reports, EachIsNamed) {
  TRUSSMAP_NEEDS_SHARED("data/reports");
  const Report reports[] = {
      {"counter-glitch", {"counter glitch"}, "row 401 (t = 8.02 s)"},
      {"cut-by-a-byte", {"cut off"}, "\"L0_\""},
      {"dead-wheels", {}, ""},
      {"four-marks-scale", {}, ""},
      {"half-travel", {}, ""},
      {"half-turns", {}, ""},
      {"sightings-twice", {"rows twice"}, "every row stands twice"},
      {"survey-mirrored", {"turns opposite"}, "a survey with x and y exchanged"},
      {"ten-spins", {"nothing to test"}, ""},
      {"time-in-ntp", {"clock set"}, "row 51"},
      {"time-in-us", {"time unit"}, "microseconds"},
      {"turns-1.4", {}, ""},
      {"wheels-exchanged-ranges", {"turns opposite"}, "wheels exchanged"},
      {"wheels-that-never-travel", {"no travel"}, "the fixes"},
      {"wheels-that-never-turn", {"no turning"}, "the gyro and the fixes"},
  };
  for (const Report& one : reports) {
    const fs::path folder = testing::shared("data/reports") / one.folder;
    const Model model = read_model((folder / "model.toml").string());
    const auto findings = check_read_recordings({read_recording(folder)}, &model, "model.toml");
    EXPECT_EQ(kinds_of(findings), one.kinds) << one.folder << "\n" << words_of(findings);
    EXPECT_NE(words_of(findings).find(one.words), std::string::npos) << words_of(findings);
  }
}

TEST(SlowReports, HealthyRecordingsAreNotAccused) {
  TRUSSMAP_NEEDS_SHARED("data/hidden");
  TRUSSMAP_NEEDS_SHARED("data/rough");
  for (const char* set : {"data/hidden", "data/rough"}) {
    for (const auto& entry : fs::directory_iterator(testing::shared(set))) {
      if (!entry.is_directory()) continue;
      const Model model = read_model((entry.path() / "model.toml").string());
      const auto findings =
          check_read_recordings({read_recording(entry.path())}, &model, "model.toml");
      EXPECT_TRUE(findings.empty()) << words_of(findings);
    }
  }
}

/// A robot of two wheels, 0.4 m apart, on arcs to both sides for 200 s; six beacons about it are
/// ranged at 5 Hz, a receiver gives fixes at 1 Hz, a gyro turns.
struct Drawn {
  Recording recording;
  Model model;
};

Drawn drawn(std::uint64_t seed, bool ranges, bool fixes, bool gyro) {
  constexpr double kRow = 0.1;  // s
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Drawn world;
  world.recording.name = "drawn";
  world.model.robot.wheelbase = 0.4;
  world.model.robot.wheelbase_stated = true;
  Drive& drive = world.recording.drive;
  std::vector<SurveyPoint>& survey = world.recording.survey;
  for (int k = 0; k < 6 && ranges; ++k) {
    const double around = k * std::numbers::pi / 3.0;
    survey.push_back({"b" + std::to_string(k), 6.0 * std::cos(around), 5.0 * std::sin(around)});
  }
  Pose pose;
  const double phase = static_cast<double>(random() % 100);
  for (int row = 1; row <= 2000; ++row) {
    const double t = kRow * row;
    const double rate = 0.5 * std::sin(0.11 * t + phase) + 0.3 * std::sin(0.37 * t);
    const double turn = rate * kRow;
    const double path = 0.4 * kRow;
    pose = compose(pose, {path * std::cos(0.5 * turn), path * std::sin(0.5 * turn), turn});
    drive.t.push_back(t);
    drive.left.push_back(path - 0.2 * turn + 4e-4 * normal(random));
    drive.right.push_back(path + 0.2 * turn + 4e-4 * normal(random));
    if (gyro) drive.yaw_rate.push_back(rate + 0.005 * normal(random));
    if (fixes && row % 10 == 0) {
      world.recording.fixes.push_back(
          {t, pose.x + 0.03 * normal(random), pose.y + 0.03 * normal(random)});
    }
    if (ranges && row % 2 == 0) {
      const SurveyPoint& beacon = survey[static_cast<std::size_t>(row / 2 % 6)];
      const double range = std::hypot(beacon.x - pose.x, beacon.y - pose.y);
      world.recording.sightings.push_back(
          {t, beacon.landmark, std::abs(range + 0.05 * normal(random))});
    }
  }
  return world;
}

std::vector<CheckFinding> found_in(const Drawn& world) {
  return check_recordings({world.recording}, &world.model, "model.toml");
}

/// Seeds 1 to 6; the model's track right, half and twice as wide.
TEST(Reports, ExchangedWheelsAreNamedWhateverTheTrack) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    for (const double track : {1.0, 0.5, 2.0}) {
      for (const bool ranges : {true, false}) {
        Drawn world = drawn(seed, ranges, !ranges, false);
        world.model.robot.wheelbase *= track;
        EXPECT_TRUE(found_in(world).empty()) << seed << " " << track << words_of(found_in(world));
        std::swap(world.recording.drive.left, world.recording.drive.right);
        EXPECT_NE(words_of(found_in(world)).find("wheels exchanged"), std::string::npos)
            << seed << " " << track << " " << ranges << words_of(found_in(world));
      }
    }
  }
}

/// Seeds 1 to 6.
TEST(Reports, WheelsThatShowHalfOfTheMotionAreNamed) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    for (const bool ranges : {true, false}) {
      const Drawn healthy = drawn(seed, ranges, !ranges, seed % 2 == 0);
      Drawn world = healthy;
      Drive& drive = world.recording.drive;
      for (std::size_t row = 0; row < drive.rows(); ++row) {
        const double half = 0.5 * (drive.right[row] - drive.left[row]);
        drive.left[row] = -half;
        drive.right[row] = half;
      }
      EXPECT_EQ(kinds_of(found_in(world)), Kinds{"no travel"}) << words_of(found_in(world));
      world = healthy;
      drive.left = drive.right;
      EXPECT_EQ(kinds_of(found_in(world)), Kinds{"no turning"}) << words_of(found_in(world));
    }
  }
}

/// By 1 m to 12 km, for 1 to 20 samples, seeds 1 to 8: named with its rows, and put right.
TEST(Reports, ACounterThatWasWrongIsNamedWithItsRows) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Drawn healthy = drawn(seed, false, true, false);
    const std::size_t row = 100 * seed;
    const std::size_t back = row + (seed % 2 == 0 ? 1 : 2 * seed);
    const double by =
        (seed % 3 == 0 ? -1.0 : 1.0) * std::pow(12046.0, (static_cast<double>(seed) - 1.0) / 7.0);
    Drawn world = healthy;
    std::vector<double>& wheel =
        seed % 4 < 2 ? world.recording.drive.left : world.recording.drive.right;
    wheel[row] += by;
    wheel[back] -= by;
    const auto findings = found_in(world);
    ASSERT_EQ(kinds_of(findings), Kinds{"counter glitch"}) << words_of(findings);
    EXPECT_EQ(findings[0].column, seed % 4 < 2 ? "left" : "right");
    for (const std::size_t one : {row, back}) {
      EXPECT_NE(findings[0].evidence.find("row " + std::to_string(one + 1) + " "),
                std::string::npos);
    }
    const MendedRecording whole = mended(world.recording, &world.model);
    EXPECT_EQ(whole.notes.size(), 1U);
    const Drive& was = healthy.recording.drive;
    for (std::size_t k = 0; k < was.rows(); ++k) {
      EXPECT_NEAR(whole.recording.drive.left[k], was.left[k], 0.03);
      EXPECT_NEAR(whole.recording.drive.right[k], was.right[k], 0.03);
    }
    EXPECT_TRUE(check_recordings({whole.recording}, &world.model).empty());
  }
}

TEST(Reports, RowsThatStandTwiceMakeNoErrorSmaller) {
  Drawn world = drawn(3, true, false, false);
  world.recording.loops = {{20.0, 20.1, 0.04, 0.0, 0.0}, {30.0, 30.1, 0.04, 0.0, 0.0}};
  const ModelFit once = fit_model({world.recording}, world.model);
  Recording twice = world.recording;
  twice.sightings.clear();
  twice.loops.clear();
  for (const Sighting& one : world.recording.sightings)
    twice.sightings.insert(twice.sightings.end(), {one, one});
  for (const Loop& one : world.recording.loops) twice.loops.insert(twice.loops.end(), {one, one});
  const ModelFit fit = fit_model({twice}, world.model);
  EXPECT_EQ(fit.dof, once.dof);
  EXPECT_NEAR(fit.chi2, once.chi2, 1e-9 * once.chi2);
  const auto findings = check_recordings({twice}, &world.model);
  ASSERT_EQ(findings.size(), 2U) << words_of(findings);
  for (const CheckFinding& one : findings) EXPECT_EQ(one.kind, "rows twice");
  const MendedRecording whole = mended(twice);
  EXPECT_EQ(whole.recording.sightings.size(), world.recording.sightings.size());
  EXPECT_EQ(whole.recording.loops.size(), world.recording.loops.size());
}

TEST(Reports, TimesOfOtherClocksAreNamed) {
  const Drawn healthy = drawn(5, true, true, false);
  const auto scaled = [](Recording one, double drive, double others) {
    for (double& t : one.drive.t) t *= drive;
    for (Sighting& sighting : one.sightings) sighting.t *= drive;
    for (Fix& fix : one.fixes) fix.t *= others;
    return one;
  };
  const auto found = [&](const Recording& one) {
    return check_recordings({one}, &healthy.model, "model.toml");
  };
  for (const auto& [unit, name] : {std::pair{1e3, "milliseconds"}, std::pair{1e6, "microseconds"},
                                   std::pair{1e9, "nanoseconds"}}) {
    const auto all = found(scaled(healthy.recording, unit, unit));
    EXPECT_EQ(kinds_of(all), Kinds{"time unit"}) << words_of(all);
    EXPECT_NE(words_of(all).find(name), std::string::npos) << words_of(all);
    const auto fixes = found(scaled(healthy.recording, 1.0, unit));
    ASSERT_EQ(kinds_of(fixes), Kinds{"time unit"}) << words_of(fixes);
    EXPECT_EQ(fixes[0].file, "drawn/fixes.csv");
  }
  Recording elsewhere = healthy.recording;
  for (Fix& one : elsewhere.fixes) one.t += 1.7e9;
  EXPECT_EQ(kinds_of(found(elsewhere)), Kinds{"other clock"});
}

/// The clock is set by 55 years: named, put right, and no work for the years.
TEST(Reports, AClockThatWasSetCostsNothing) {
  Drawn world = drawn(6, false, true, false);
  const Recording healthy = world.recording;
  constexpr double kYears = 1.764e9;  // s
  for (double& t : world.recording.drive.t) t += t > 100.05 ? kYears : 0.0;
  for (Fix& one : world.recording.fixes) one.t += one.t > 100.05 ? kYears : 0.0;
  const auto findings = found_in(world);
  EXPECT_EQ(kinds_of(findings), Kinds{"clock set"}) << words_of(findings);
  const auto budgets = noise_budget({world.recording}, world.model, {1.0, 10.0});
  ASSERT_EQ(budgets.size(), 2U);
  for (const NoiseBudget& one : budgets) {
    EXPECT_GT(one.windows, 10);
    EXPECT_LE(one.windows, 800);
  }
  const MendedRecording whole = mended(world.recording);
  for (std::size_t row = 0; row < healthy.drive.rows(); ++row) {
    EXPECT_NEAR(whole.recording.drive.t[row], healthy.drive.t[row], 1e-5);
  }
}

TEST(Reports, AFileThatWasCutOffIsNamed) {
  const ScratchFolder scratch;
  const Drawn world = drawn(7, true, true, false);
  const fs::path folder = scratch.path() / "cut";
  write_recording(folder, world.recording);
  const auto found = [&] {
    return check_read_recordings({read_recording(folder)}, &world.model, "model.toml");
  };
  EXPECT_TRUE(found().empty()) << words_of(found());
  std::ifstream in(folder / "sightings.csv");
  std::string names((std::istreambuf_iterator<char>(in)), {});
  names.pop_back();  // a last line without its end alone is no mistake
  std::ofstream(folder / "sightings.csv") << names;
  EXPECT_TRUE(found().empty()) << words_of(found());
  std::ofstream(folder / "drive.csv", std::ios::app) << "200.1,0.0412345678,0.04";
  const auto findings = found();
  ASSERT_EQ(kinds_of(findings), Kinds{"cut off"}) << words_of(findings);
  EXPECT_EQ(findings[0].column, "right");
}

TEST(Reports, NamesThatDifferInCaseAlone) {
  Drawn world = drawn(8, true, false, false);
  EXPECT_TRUE(found_in(world).empty()) << words_of(found_in(world));
  world.recording.survey[2].landmark = "B2";
  EXPECT_TRUE(kinds_of(found_in(world)).contains("names differ in case"));
}

TEST(Reports, ColumnsThatHang) {
  Drawn world = drawn(9, false, true, true);
  std::fill(world.recording.drive.yaw_rate.begin(), world.recording.drive.yaw_rate.end(), 0.0);
  auto findings = found_in(world);
  ASSERT_EQ(kinds_of(findings), Kinds{"constant column"}) << words_of(findings);
  EXPECT_EQ(findings[0].column, "yaw_rate");
  world.recording.drive.yaw_rate.clear();
  for (Fix& one : world.recording.fixes) one.y = 2.0;
  findings = found_in(world);
  ASSERT_EQ(kinds_of(findings), Kinds{"constant column"}) << words_of(findings);
  EXPECT_EQ(findings[0].column, "y");
}

}  // namespace
}  // namespace trussmap::reports_test
