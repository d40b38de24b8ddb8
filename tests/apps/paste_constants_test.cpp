// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Constants to paste do what they are for: a robot whose wheels and track are other than its
// software believes is driven (drawn_drive.hpp, none of the library's formulas), a command finds
// constants, and with these in its software, by arithmetic of this file alone, other drives of it
// are reckoned as well as with the true ones.
#include "estimation/drawn_drive.hpp"
#include "json_file.hpp"
#include "scratch_folder.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::paste_constants_test {
namespace {

using nlohmann::json;
using testing::DrawnPose;
using testing::DrawnRobot;
using testing::Ran;
using testing::read_json;
using testing::run_trussmap;
using testing::ScratchFolder;

constexpr double kNominal = 0.34;  // m

/// What the robot's software multiplies travels by, and divides their difference by.
struct Software {
  double left = 1.0;
  double right = 1.0;
  double wheelbase = kNominal;  // m
};

Software truth_of(const DrawnRobot& robot) {
  return {robot.E_s * 2.0 / (1.0 + robot.E_d), robot.E_s * 2.0 * robot.E_d / (1.0 + robot.E_d),
          robot.E_b * kNominal};
}

/// Left wheel 2 % too large, right one 1 % too small, track 3 % too narrow.
DrawnRobot worn() {
  DrawnRobot robot;
  robot.E_d = 0.99 / 1.02;
  robot.E_b = 0.97;
  robot.E_s = 0.5 * (1.02 + 0.99);
  robot.k_left = robot.k_right = 0.0005;
  robot.truth_sd = 0.001;
  robot.truth_heading_sd = 0.002;
  return robot;
}

/// How far off the end of a drive is reckoned, m.
double end_error(const Recording& recording, const Software& software) {
  DrawnPose pose;
  for (std::size_t row = 0; row < recording.drive.rows(); ++row) {
    const double left = software.left * recording.drive.left[row];
    const double right = software.right * recording.drive.right[row];
    pose =
        testing::after(pose, {1.0, 0.5 * (left + right), (right - left) / software.wheelbase}, 1.0);
  }
  const DrawnPose end = testing::pose_at(testing::figure(), 1e9);
  return std::hypot(pose.x - end.x, pose.y - end.y);
}

/// Root mean square over thirty drives of the robot, seeds 100 to 129.
double rms_of(const DrawnRobot& robot, const Software& software) {
  constexpr int kDrives = 30;
  double sum = 0.0;
  for (int drive = 0; drive < kDrives; ++drive) {
    const auto seed = static_cast<std::uint64_t>(100 + drive);
    sum += std::pow(end_error(testing::draw(testing::figure(), robot, seed), software), 2);
  }
  return std::sqrt(sum / kDrives);
}

Software pasted(const json& report) {
  Software software;
  for (const json& one : report["constants"]) {
    if (one["new"].is_null()) continue;
    if (one["name"] == "left wheel") software.left *= one["new"].get<double>();
    if (one["name"] == "right wheel") software.right *= one["new"].get<double>();
    if (one["name"] == "wheelbase") software.wheelbase = one["new"];
  }
  return software;
}

/// By diff_drive_controller's parameters alone.
Software multiplied(const json& report) {
  Software software;
  for (const json& one : report["stacks"]) {
    if (one["key"] == "left_wheel_radius_multiplier") software.left = one["value"];
    if (one["key"] == "right_wheel_radius_multiplier") software.right = one["value"];
    if (one["key"] == "wheel_separation_multiplier") {
      software.wheelbase = kNominal * one["value"].get<double>();
    }
  }
  return software;
}

class PasteConstants : public ::testing::Test {
 protected:
  /// `effects`: names, fitted by the command.
  void start(const DrawnRobot& robot, const std::string& effects = "") {
    std::filesystem::remove_all(drive_);
    write_recording(drive_, testing::draw(testing::figure(), robot, 7));
    std::filesystem::remove(drive_ / "sightings.csv");
    scratch_.write("m.toml",
                   "[robot]\nwheelbase = 0.34\n[noise]\nleft = 0.0005\nright = 0.0005\n"
                   "truth = 0.001\ntruth_heading = 0.002\n" +
                       effects);
  }
  json found_by(const std::string& command, const std::string& model = "m.toml") {
    ran_ = run_trussmap(fmt::format("{} {} --model {}/{} --json {}", command, drive_.string(),
                                    scratch_.path().string(), model,
                                    (scratch_.path() / "found.json").string()));
    EXPECT_EQ(ran_.status, 0) << ran_.output;
    return read_json(scratch_.path() / "found.json");
  }
  [[nodiscard]] std::string out() const {
    return " --out " + (scratch_.path() / "out.toml").string() + " ";
  }

  const ScratchFolder scratch_;
  const std::filesystem::path drive_ = scratch_.path() / "drive";
  Ran ran_;
};

/// As good as the true ones, and much better than what the robot believed.
void expect_right(const json& report, const DrawnRobot& robot) {
  const double by_truth = rms_of(robot, truth_of(robot));
  EXPECT_GT(rms_of(robot, {}), 20.0 * by_truth);
  EXPECT_LT(rms_of(robot, pasted(report)), 1.5 * by_truth);
  EXPECT_LT(rms_of(robot, multiplied(report)), 1.5 * by_truth);
  const Software known = truth_of(robot);
  for (const json& one : report["constants"]) {
    const double right = one["name"] == "left wheel"    ? known.left
                         : one["name"] == "right wheel" ? known.right
                         : one["name"] == "wheelbase"   ? known.wheelbase
                                                        : 0.0;
    if (right == 0.0) continue;
    EXPECT_NEAR(one["new"].get<double>(), right, 4.0 * one["sd"].get<double>()) << one["name"];
  }
}

TEST_F(PasteConstants, OfCalibrateAreRight) {
  start(worn());
  expect_right(found_by("calibrate" + out()), worn());
  EXPECT_NE(ran_.output.find("left_wheel_radius_multiplier: 1.0"), std::string::npos)
      << ran_.output;

  // The model written has the wheelbase once: a fit of its effects finds none of it left.
  const Model written = read_model(scratch_.path() / "out.toml");
  EXPECT_NEAR(written.robot.wheelbase, 0.97 * kNominal, 2e-4 * kNominal);
  const json again = found_by("fit", "out.toml");
  bool fitted = false;
  for (const json& one : again["effects"]) {
    if (one["effect"] != "wheelbase") continue;
    fitted = true;
    EXPECT_NEAR(one["coefficients"][0].get<double>(), 0.0, 1.5 * one["sd"][0].get<double>());
  }
  EXPECT_TRUE(fitted);
  EXPECT_LT(rms_of(worn(), pasted(again)), 1.5 * rms_of(worn(), truth_of(worn())));
  for (const json& one : again["constants"]) {  // what was in force is what calibrate found
    const double found = one["new"].get<double>();
    EXPECT_NEAR(one["old"].get<double>(), found, 2.0 * one["sd"].get<double>()) << one["name"];
  }
}

TEST_F(PasteConstants, OfFitAreRightByAnyEffects) {
  start(worn(),
        "[[effect]]\nname = \"travel scale\"\n[[effect]]\nname = \"wheelbase\"\n"
        "[[effect]]\nname = \"wheel diameter ratio\"\n");
  expect_right(found_by("fit"), worn());
  start(worn(),
        "[[effect]]\nname = \"l\"\nchannel = \"left\"\nshape = [\"1\"]\n"
        "[[effect]]\nname = \"r\"\nchannel = \"right\"\nshape = [\"1\"]\n"
        "[[effect]]\nname = \"wheelbase\"\n");
  expect_right(found_by("fit"), worn());
}

TEST_F(PasteConstants, OneWheelIsSaidToBeOne) {
  DrawnRobot robot = worn();
  robot.E_d = 1.0 / 1.0096;
  robot.E_s = 0.5 * (1.0096 + 1.0);
  robot.E_b = 1.0;
  start(robot);
  found_by("calibrate");
  EXPECT_NE(ran_.output.find("the left wheel is 0.9"), std::string::npos) << ran_.output;
  EXPECT_NE(ran_.output.find("% larger than nominal; the right one and the wheelbase are"),
            std::string::npos)
      << ran_.output;
  start(worn());
  found_by("calibrate");
  EXPECT_EQ(ran_.output.find("than nominal; the"), std::string::npos) << ran_.output;
}

class SlowPasteConstants : public PasteConstants {};

TEST_F(SlowPasteConstants, OfDiscoverAndDiagnoseAreRight) {
  start(worn());
  expect_right(found_by("discover"), worn());
  const json predicted = found_by("diagnose");
  EXPECT_LT(rms_of(worn(), pasted(predicted)), 0.25 * rms_of(worn(), {}));
}

TEST_F(PasteConstants, OfSquaresAreInTheModelOnce) {
  const std::string at = scratch_.path().string();
  const Ran ran = run_trussmap(
      "umbmark --simulate --true-E-d 1.006 --true-E-b 0.96 --true-E-s 1.01 --scatter 0.002 "
      "--wheelbase 0.34 --out " +
      at + "/out.toml --json " + at + "/u.json");
  ASSERT_EQ(ran.status, 0) << ran.output;
  DrawnRobot robot = worn();
  robot.E_d = 1.006;
  robot.E_b = 0.96;
  robot.E_s = 1.01;
  const Software software = pasted(read_json(scratch_.path() / "u.json"));
  EXPECT_LT(rms_of(robot, software), 0.1 * rms_of(robot, {}));
  EXPECT_NEAR(read_model(scratch_.path() / "out.toml").robot.wheelbase, 0.96 * kNominal,
              1e-3 * kNominal);
  start(robot);
  for (const json& one : found_by("fit", "out.toml")["effects"]) {
    if (one["effect"] != "wheelbase") continue;
    EXPECT_NEAR(one["coefficients"][0].get<double>(), 0.0, 1.5e-3);
  }
}

/// Straight on alone: no wheelbase, and no figure for it.
TEST_F(PasteConstants, WhatWasNotDeterminedIsNoFigure) {
  const DrawnRobot robot = worn();
  write_recording(drive_, testing::draw({{20.0, 0.5, 0.0}}, robot, 7));
  std::filesystem::remove(drive_ / "sightings.csv");
  scratch_.write("m.toml", "[robot]\nwheelbase = 0.34\n");
  const json found = found_by("calibrate");
  for (const json& one : found["constants"]) {
    EXPECT_EQ(one["new"].is_null(), one["name"] == "wheelbase") << one;
  }
  for (const json& one : found["stacks"]) EXPECT_NE(one["key"], "wheel_separation_multiplier");
  EXPECT_NE(ran_.output.find("# wheelbase: not determined"), std::string::npos) << ran_.output;
}

}  // namespace
}  // namespace trussmap::paste_constants_test
