// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recordings without landmarks: what build_map makes of fixes and loops alone.
#include "datasets/formats.hpp"
#include "fit/placed_drives.hpp"
#include "shared_data.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/error.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::built_path_test {
namespace {

using testing::placed_drive;
using testing::PlacedDrive;
using testing::PlacedOptions;

/// Where the robot truly was at the end of every row, m.
std::vector<TruthRow> truth_of(const PlacedDrive& drive) {
  std::vector<TruthRow> truth;
  for (std::size_t row = 0; row < drive.motion.rows.size(); ++row) {
    const Pose& pose = drive.motion.rows[row].pose;
    truth.push_back({drive.recording.drive.t[row], pose.x, pose.y, pose.heading});
  }
  return truth;
}

std::size_t left_out(const BuiltPath& path) {
  return static_cast<std::size_t>(std::count_if(path.ties.begin(), path.ties.end(),
                                                [](const PathTie& one) { return one.left_out; }));
}

/// Without noise the path is the true one: of fixes in their frame, of loops in that of the start.
TEST(BuiltPath, OfExactFixesOrLoopsIsTheTrueOne) {
  for (const bool loops : {false, true}) {
    PlacedOptions options;
    options.noise = false;
    options.fix_rate = loops ? 0.0 : 1.3;
    options.loops = loops;
    PlacedDrive drive = placed_drive(options, 3);
    drive.recording.truth = truth_of(drive);
    const BuiltMap built = build_map({drive.recording}, drive.model);
    EXPECT_TRUE(built.good()) << built.warnings.front();
    EXPECT_EQ(built.map.landmarks(), 0);
    ASSERT_EQ(built.paths.size(), 1U);
    const BuiltPath& path = built.paths[0];
    ASSERT_EQ(path.adjusted.size(), drive.motion.rows.size() + 1);
    ASSERT_FALSE(path.ties.empty());
    EXPECT_EQ(path.ties[0].loop, loops);
    EXPECT_EQ(left_out(path), 0U);
    const Pose first = loops ? inverse(drive.motion.start) : Pose{};
    for (std::size_t row = 0; row < drive.motion.rows.size(); ++row) {
      const Vector2 truth = compose(first, drive.motion.rows[row].pose).position();
      ASSERT_LT((path.adjusted[row + 1] - truth).norm(), 1e-4) << row;
    }
    ASSERT_TRUE(path.on_truth.has_value());
    EXPECT_LT(path.on_truth->rms, 1e-4);
    EXPECT_LT(path.on_truth->rms_dead_reckoning, 1e-4);
    EXPECT_LT(path.rms_dead_reckoning, 1e-4);
  }
}

/// 40 drives with fixes of 5 cm (seeds 100 to 139): squared errors over their variances are 1 on
/// average. Errors hang together over a fifth of a drive at most, so that the mean of squares in
/// the plane is good to 1 / sqrt(40 * 5).
TEST(BuiltPath, IsAsCertainAsItSays) {
  constexpr int kDrives = 40;
  double ratio = 0.0;
  for (int k = 0; k < kDrives; ++k) {
    PlacedOptions options;
    options.fix_rate = 0.5;
    const PlacedDrive drive = placed_drive(options, 100 + static_cast<std::uint64_t>(k));
    const BuiltMap built = build_map({drive.recording}, drive.model);
    const BuiltPath& path = built.paths[0];
    std::vector<double> errors;
    for (std::size_t row = 0; row < drive.motion.rows.size(); ++row) {
      errors.push_back((path.adjusted[row + 1] - drive.motion.rows[row].pose.position()).norm());
    }
    double sum = 0.0;
    for (const double one : errors) sum += one * one / static_cast<double>(errors.size());
    ratio += sum / (path.median_sd * path.median_sd) / kDrives;
    EXPECT_GE(path.worst_sd, path.median_sd);
    EXPECT_NEAR(built.quality.median_sd, path.median_sd, 1e-15);
  }
  // Between fixes errors are larger than at them, where standard errors are stated.
  EXPECT_GT(ratio, 1.0 - 4.0 / std::sqrt(kDrives * 5.0));
  EXPECT_LT(ratio, 1.5);
}

/// One of them wrong does not speak against the rest.
TEST(BuiltPath, NamesTheWrongFixAndStaysGood) {
  PlacedOptions options;
  options.fix_rate = 1.0;
  PlacedDrive drive = placed_drive(options, 7);
  Fix& wrong = drive.recording.fixes[20];
  wrong.x += 3.0;
  const BuiltMap built = build_map({drive.recording}, drive.model);
  EXPECT_EQ(verdict_of(built), "good") << built.warnings.front();
  EXPECT_NE(verdict_in_words(built).find("nothing speaks against this path"), std::string::npos);
  const BuiltPath& path = built.paths[0];
  ASSERT_GE(left_out(path), 1U);
  EXPECT_LE(left_out(path), 2U);  // one right one in 3000 goes, too
  const auto found = std::find_if(path.ties.begin(), path.ties.end(), [&wrong](const PathTie& one) {
    return one.left_out && one.t == wrong.t;
  });
  ASSERT_NE(found, path.ties.end());
  EXPECT_NEAR(found->misfit, 3.0, 0.2);
  EXPECT_NEAR((found->from - Vector2(wrong.x, wrong.y)).norm(), 0.0, 1e-12);
  EXPECT_NE(map_picture(built, "a path").find("fix wrong\" cx"), std::string::npos);
}

/// Two drives in the frame of the fixes; each has its path.
TEST(BuiltPath, SeveralSessionsHaveEachTheirOwn) {
  PlacedOptions options;
  options.fix_rate = 1.0;
  PlacedDrive first = placed_drive(options, 11);
  PlacedDrive second = placed_drive(options, 12);
  first.recording.name = "first";
  second.recording.name = "second";
  const BuiltMap built = build_map({first.recording, second.recording}, first.model);
  ASSERT_EQ(built.paths.size(), 2U);
  EXPECT_EQ(built.paths[1].recording, "second");
  EXPECT_EQ(built.paths[1].adjusted.size(), second.motion.rows.size() + 1);
  const Vector2 end = second.motion.rows.back().pose.position();
  EXPECT_LT((built.paths[1].adjusted.back() - end).norm(), 0.3);
}

std::string complaint(const std::vector<Recording>& recordings, const Model& model,
                      Method method = Method::adjustment) {
  try {
    static_cast<void>(build_map(recordings, model, {.method = method}));
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(BuiltPath, NeedsSomethingToTieItAndTheAdjustment) {
  PlacedOptions options;
  options.fix_rate = 1.0;
  PlacedDrive drive = placed_drive(options, 13);
  drive.recording.name = "mower";
  EXPECT_NE(complaint({drive.recording}, drive.model, Method::elastic)
                .find("mower: has no landmarks, between which legs go, expected the method "
                      "adjustment"),
            std::string::npos);
  Recording bare = drive.recording;
  bare.fixes.clear();
  EXPECT_NE(complaint({bare}, drive.model).find("mower: no landmark was sighted"),
            std::string::npos);
  options.landmarks = true;
  PlacedDrive sighted = placed_drive(options, 14);
  EXPECT_NE(complaint({sighted.recording, drive.recording}, drive.model)
                .find("mower: no landmark was sighted"),
            std::string::npos);
}

/// A lecture hall by places that look alike, many of them wrong, beside its truth of positions.
TEST(SlowBuiltPath, OfTheLectureHallIsNearItsTruth) {
  TRUSSMAP_NEEDS_SHARED("data/tuc-slam");
  Dataset read = datasets::read_place_loops(testing::shared("data/tuc-slam/Lecture_Hall"));
  std::istringstream text(read_file(testing::shared("data/tuc-slam/Lecture_Hall_GT.txt.xz")));
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string tag;
    TruthRow row;
    if (words >> tag >> row.t >> row.x >> row.y && tag == "point2") {
      read.recording.truth.push_back(row);
    }
  }
  const BuiltMap built = build_map({read.recording}, read.model);
  EXPECT_FALSE(built.good());  // three loops of ten are wrong
  ASSERT_TRUE(built.paths[0].on_truth.has_value());
  const PathOnTruth& truth = *built.paths[0].on_truth;
  EXPECT_GT(truth.rms_dead_reckoning, 10.0);
  EXPECT_LT(truth.rms, 0.2 * truth.rms_dead_reckoning);
}

}  // namespace
}  // namespace trussmap::built_path_test
