// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Landmarks with an axis of their own: tags and floor codes whose yaw each sighting reads.
#include "fit/placed_drives.hpp"
#include "recording/floor_code.hpp"
#include "scratch_folder.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/error.hpp"
#include "trussmap/recording_files.hpp"

#include <fstream>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::landmark_yaw_test {
namespace {

using testing::add_fit;
using testing::expect_right;
using testing::FitStatistics;
using testing::path_error;
using testing::placed_drive;
using testing::PlacedDrive;
using testing::PlacedOptions;

PlacedOptions with_markers() {
  PlacedOptions options;
  options.markers = true;
  options.landmarks = true;
  options.sees = SensorParts::both;
  return options;
}

/// The same without what the yaws say.
Recording without_yaws(Recording recording) {
  for (Sighting& one : recording.sightings) one.yaw = kAbsent;
  for (SurveyPoint& one : recording.survey) one.heading = kAbsent;
  return recording;
}

TEST(LandmarkYaw, ExactOnesLeaveNoError) {
  PlacedOptions options = with_markers();
  options.noise = false;
  const PlacedDrive drive = placed_drive(options, 3);
  const ModelFit fit = fit_model({drive.recording}, drive.model);
  EXPECT_LT(fit.chi2, 1e-6);
  const ModelFit without = fit_model({without_yaws(drive.recording)}, drive.model);
  // Each yaw is a row; each orientation an unknown that the survey measures, too.
  EXPECT_EQ(fit.dof - without.dof, std::ssize(drive.recording.sightings));
}

TEST(LandmarkYaw, ItsOffsetIsFoundAgainstASurveyAndNotWithout) {
  PlacedOptions options = with_markers();
  options.noise = false;
  options.effects = {{"turned", Channel::sighting_yaw, {"1"}, {0.04}, false}};
  PlacedDrive drive = placed_drive(options, 5);
  EXPECT_GT(fit_model({drive.recording}, drive.model).chi2, 20.0);
  Model model = drive.model;
  model.effects = {{"turned", Channel::sighting_yaw, {"1"}, {}, false}};
  const ModelFit fit = fit_model({drive.recording}, model);
  EXPECT_LT(fit.chi2, 1e-6);
  EXPECT_NEAR(fit.effects[0].effect.coefficients[0], 0.04, 1e-6);
  for (SurveyPoint& one : drive.recording.survey) one.heading = kAbsent;
  EXPECT_LT(fit_model({drive.recording}, drive.model).chi2, 1e-6);
}

/// 60 drives, seeds 100 to 159, half of them with a compass: the noise of everything, and an offset
/// of the yaws that is found.
TEST(LandmarkYaw, ChiSquareAndIntervalsAreRight) {
  constexpr int kDrives = 60;
  FitStatistics found;
  for (int k = 0; k < kDrives; ++k) {
    PlacedOptions options = with_markers();
    options.compass = k % 2 == 0;
    options.effects = {{"turned", Channel::sighting_yaw, {"1"}, {0.01}, false},
                       {"wider", Channel::turn, {"1"}, {0.01}, false}};
    const PlacedDrive drive = placed_drive(options, 100 + static_cast<std::uint64_t>(k));
    Model model = drive.model;
    model.effects = options.effects;
    add_fit(found, drive.recording, model, kDrives);
  }
  expect_right(found, kDrives);
}

/// Seeds 20 to 29: without a compass a good yaw is what tells the heading at a landmark.
TEST(LandmarkYaw, TellsTheHeadingOfARobotWithoutCompass) {
  double with = 0.0;
  double without = 0.0;
  for (std::uint64_t seed = 20; seed < 30; ++seed) {
    PlacedOptions options = with_markers();
    options.sees = std::nullopt;
    options.yaw_sd = 0.002;
    const PlacedDrive drive = placed_drive(options, seed);
    const auto heading_error = [&](const Recording& recording) {
      const std::vector<TimedPose> poses = adjusted_poses(fit_model({recording}, drive.model));
      double sum = 0.0;
      for (const TrueStop& stop : drive.motion.stops) {
        sum += std::pow(wrap_angle(poses[stop.rows].estimate.pose.heading - stop.pose.heading), 2);
      }
      return sum;
    };
    with += heading_error(drive.recording);
    without += heading_error(without_yaws(drive.recording));
  }
  EXPECT_LT(with, 0.5 * without);
}

/// One surveyed tag ties a robot without compass to the map, wherever it looks as it starts: seeds
/// 30 to 35.
TEST(LandmarkYaw, OneSurveyedTagTellsPlaceAndHeading) {
  for (std::uint64_t seed = 30; seed < 36; ++seed) {
    PlacedOptions options = with_markers();
    options.sees = std::nullopt;
    PlacedDrive drive = placed_drive(options, seed);
    // The map turned by this much about the origin: the robot starts anywhere, looking anywhere.
    const double turn = static_cast<double>(seed);
    const Matrix2 R = rotation(turn);
    SurveyPoint tag = drive.recording.survey[seed % drive.recording.survey.size()];
    const Vector2 place = R * Vector2(tag.x, tag.y);
    tag = {tag.landmark, place.x(), place.y(), 0.01, wrap_angle(tag.heading + turn)};
    drive.recording.survey = {tag};
    const ModelFit fit = fit_model({drive.recording}, drive.model);
    EXPECT_LT(fit.chi2, 1.5 * fit.dof) << seed;
    // The yaw is good to 0.03 rad in all, the way 10 m long.
    EXPECT_LT(path_error(drive, fit, {0.0, 0.0, turn}), 1.0) << seed;
  }
}

/// Two sessions with a survey each: equal headings count once, different ones at the same place
/// twice.
TEST(LandmarkYaw, SeveralSurveyedHeadingsOfALandmarkCount) {
  const PlacedDrive drive = placed_drive(with_markers(), 9);
  Recording again = placed_drive(with_markers(), 10).recording;
  again.name = "again";
  again.survey = drive.recording.survey;
  const auto dof = [&](const std::vector<SurveyPoint>& survey) {
    Recording second = again;
    second.survey = survey;
    return fit_model({drive.recording, second}, drive.model).dof;
  };
  std::vector<SurveyPoint> other = again.survey;
  const int once = dof(again.survey);
  other.front().heading += 0.01;
  EXPECT_EQ(dof(other), once + 1);
  other.front().heading = kAbsent;
  EXPECT_EQ(dof(other), once);
  other.front() = again.survey.front();
  other.front().x += 0.01;
  EXPECT_EQ(dof(other), once + 3);
  // It may as well be the later session that has headings at all.
  std::vector<SurveyPoint> plain = again.survey;
  for (SurveyPoint& one : plain) one.heading = kAbsent;
  Recording first = drive.recording;
  first.survey = plain;
  EXPECT_EQ(fit_model({first, again}, drive.model).dof, once);
}

/// A wrong yaw is left out and named; the sighting that it came with stays.
TEST(LandmarkYaw, WrongOnesAreLeftOut) {
  PlacedDrive drive = placed_drive(with_markers(), 8);
  Sighting& wrong = drive.recording.sightings[drive.recording.sightings.size() / 2];
  wrong.yaw = wrap_angle(wrong.yaw + 1.5);
  FitOptions options;
  options.gate = 16.0;
  const ModelFit fit = fit_model({drive.recording}, drive.model, options);
  ASSERT_EQ(fit.left_out.size(), 1U);
  const std::string& named = fit.left_out.front();
  EXPECT_EQ(named.rfind("yaw of landmark " + wrong.landmark, 0), 0U) << named;
}

/// The robot stands 4 cm off its codes, which say where: as good as if it stood on them.
TEST(LandmarkYaw, FloorCodesSayWhereTheRobotStands) {
  PlacedOptions options = with_markers();
  options.noise = false;
  options.sees = std::nullopt;
  PlacedDrive drive = placed_drive(options, 4);
  const Recording plain = drive.recording;
  const Vector2 code(-0.03, 0.025);  // in the robot's axes: its camera sits askew
  for (std::size_t k = 0; k < drive.recording.sightings.size(); ++k) {
    Sighting& one = drive.recording.sightings[k];
    recording::place_by_code(code, one);
  }
  // All landmarks lie where the camera was: a lever takes exactly that up.
  Model model = drive.model;
  EXPECT_GT(fit_model({drive.recording}, model).chi2, 1.0);
  model.effects = {{"ahead", Channel::lever, {"1"}, {}, false},
                   {"left", Channel::lever_left, {"1"}, {}, false}};
  const ModelFit fit = fit_model({drive.recording}, model);
  EXPECT_LT(fit.chi2, 1e-6);
  EXPECT_NEAR(fit.effects[0].effect.coefficients[0], 0.03, 1e-6);
  EXPECT_NEAR(fit.effects[1].effect.coefficients[0], -0.025, 1e-6);
}

/// What a read of these sightings or this survey complains of.
std::string complaint(const std::string& sightings, const std::string& survey) {
  const testing::ScratchFolder folder;
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder.path() / name) << text;
  };
  write("drive.csv", "t,left,right\n1,0.1,0.1\n2,0.1,0.1\n");
  write("sightings.csv", sightings);
  if (!survey.empty()) write("survey.csv", survey);
  try {
    (void)read_recording(folder.path());
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(LandmarkYaw, BadColumnsAreToldWithTheirLine) {
  const auto says = [](const std::string& text, const char* what) {
    return text.find(what) != std::string::npos;
  };
  EXPECT_EQ(complaint("t,landmark,yaw,dx,dy\n1,A,0.1,0.01,0.02\n2,A,,,\n",
                      "landmark,x,y,heading\nA,0,0,0.1\n"),
            "");
  EXPECT_TRUE(says(complaint("t,landmark,yaw\n1,A,x\n", ""), "sightings.csv:2"));
  EXPECT_TRUE(says(complaint("t,landmark,yaw,dx\n1,A,0.1,0.2\n", ""), "dx or dy stands alone"));
  EXPECT_TRUE(says(complaint("t,landmark,dx,dy\n1,A,0.1,0.2\n", ""), "expected a yaw"));
  EXPECT_TRUE(
      says(complaint("t,landmark,range,bearing,yaw,dx,dy\n1,A,1,0,0.1,0.2,0\n", ""), "stands on"));
  EXPECT_TRUE(says(complaint("t,landmark,yaw\n1,A,0\n", "landmark,x,y,heading\nA,0,0,east\n"),
                   "survey.csv:2"));
}

TEST(LandmarkYaw, IsWrittenAsItIsRead) {
  PlacedDrive drive = placed_drive(with_markers(), 6);
  drive.recording.sightings.front().dx = 0.01;
  drive.recording.sightings.front().dy = -0.02;
  const testing::ScratchFolder folder;
  write_recording(folder.path() / "r", drive.recording);
  const Recording read = read_recording(folder.path() / "r");
  ASSERT_EQ(read.sightings.size(), drive.recording.sightings.size());
  for (std::size_t k = 0; k < read.sightings.size(); ++k) {
    EXPECT_EQ(read.sightings[k].yaw, drive.recording.sightings[k].yaw);
  }
  EXPECT_EQ(read.sightings.front().dx, 0.01);
  EXPECT_EQ(read.sightings.front().dy, -0.02);
  EXPECT_TRUE(std::isnan(read.sightings.back().dx));
  EXPECT_EQ(read.survey.front().heading, drive.recording.survey.front().heading);
}

}  // namespace
}  // namespace trussmap::landmark_yaw_test
