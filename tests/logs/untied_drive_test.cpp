// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/untied_drive.hpp"

#include "scratch_folder.hpp"
#include "trussmap/recording_files.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::untied_drive_test {
using namespace logs;
namespace {

namespace fs = std::filesystem;
using testing::Ran;
using testing::run_trussmap;
using testing::ScratchFolder;

constexpr double kRow = 0.05;   // s
constexpr double kTrack = 0.4;  // m

/// `rest` s, then `drive` s of curves, and again; a gyro with a bias and noise.
Drive stop_and_go(double rest, double drive, double bias, double sd) {
  std::mt19937 draw(20261129);
  std::normal_distribution<double> noise(0.0, sd);
  Drive made;
  double t = 0.0;
  for (int lap = 0; lap < 4; ++lap) {
    for (double left = rest + drive; left > 1e-9; left -= kRow) {
      const bool moves = left <= drive + 1e-9;
      const double turn = moves ? 0.8 * std::sin(0.7 * t) : 0.0;
      const double speed = moves ? 0.5 : 0.0;
      made.t.push_back(t += kRow);
      made.left.push_back((speed - 0.5 * kTrack * turn) * kRow);
      made.right.push_back((speed + 0.5 * kTrack * turn) * kRow);
      made.yaw_rate.push_back(turn + bias + noise(draw));
    }
  }
  return made;
}

TEST(UntiedDrive, AGyrosBiasIsWhatItReadsAtRest) {
  const Drive drive = stop_and_go(10.0, 20.0, 0.02, 0.01);
  const auto rest = gyro_at_rest(drive, Robot());
  ASSERT_TRUE(rest);
  // 200 rows a rest, less the first and the last of each.
  EXPECT_NEAR(rest->duration, 4 * 198 * kRow, 1e-6);
  EXPECT_NEAR(rest->sd, 0.01 / std::sqrt(4 * 198), 0.1 * 0.01 / std::sqrt(4 * 198));
  EXPECT_NEAR(rest->mean, 0.02, 4 * rest->sd);
  EXPECT_FALSE(gyro_at_rest(stop_and_go(1.5, 20.0, 0.02, 0.01), Robot()));
  Drive none = drive;
  none.yaw_rate.clear();
  EXPECT_FALSE(gyro_at_rest(none, Robot()));
  EXPECT_EQ(untied_warnings(none, Robot()).size(), 1U);
  for (double& one : none.left) one += 1e-4;  // never stands
  none.yaw_rate = drive.yaw_rate;
  EXPECT_FALSE(gyro_at_rest(none, Robot()));
}

TEST(UntiedDrive, RowsWithoutAReadingDoNotCount) {
  Drive drive = stop_and_go(10.0, 20.0, 0.02, 0.0);
  for (std::size_t k = 0; k < drive.rows(); k += 2) {
    drive.yaw_rate[k] = std::numeric_limits<double>::quiet_NaN();
  }
  const auto rest = gyro_at_rest(drive, Robot());
  ASSERT_TRUE(rest);
  EXPECT_NEAR(rest->mean, 0.02, 1e-12);
  EXPECT_NEAR(rest->duration, 4 * 99 * kRow, 1e-6);
}

/// Of another drive its own columns stand; what steers may turn meanwhile.
TEST(UntiedDrive, OtherWheelsStandByTheirColumns) {
  Drive drive = stop_and_go(10.0, 20.0, 0.02, 0.0);
  Robot robot;
  robot.drive = DriveKind::tricycle;
  robot.columns = {"wheel", "steer"};
  std::vector<double> steer;
  for (std::size_t k = 0; k < drive.rows(); ++k)
    steer.push_back(0.1 * std::sin(0.1 * static_cast<double>(k)));
  drive.covariates = {{"wheel", drive.left}, {"steer", steer}, {"load", steer}};
  drive.left.clear();
  drive.right.clear();
  const auto rest = gyro_at_rest(drive, robot);
  ASSERT_TRUE(rest);
  EXPECT_NEAR(rest->duration, 4 * 198 * kRow, 1e-6);
}

std::vector<double> last_row(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::string last;
  while (std::getline(stream, line)) last = line;
  std::vector<double> values;
  std::istringstream cells(last);
  while (std::getline(cells, line, ',')) values.push_back(std::stod(line));
  return values;
}

/// A table with sums of the travels and the gyro, and where the wheels end.
struct MadeTable {
  std::string text;
  double x = 0.0, y = 0.0, heading = 0.0;
};

MadeTable table_of(const Drive& drive) {
  MadeTable made;
  std::ostringstream table;
  table.precision(17);
  table << "t,left,right,gyro\n0,0,0,0.05\n";
  double left = 0.0;
  double right = 0.0;
  for (std::size_t k = 0; k < drive.rows(); ++k) {
    left += drive.left[k];
    right += drive.right[k];
    table << drive.t[k] << ',' << left << ',' << right << ',' << drive.yaw_rate[k] << '\n';
    const double turn = (drive.right[k] - drive.left[k]) / kTrack;
    const double way = 0.5 * (drive.left[k] + drive.right[k]);
    made.x += way * std::cos(made.heading + 0.5 * turn);
    made.y += way * std::sin(made.heading + 0.5 * turn);
    made.heading += turn;
  }
  made.text = table.str();
  return made;
}

constexpr const char* kMap = R"(time.field = "t"
[robot]
wheelbase = 0.4
[noise]
gyro = 0.0001
left = 0.01
right = 0.01
[wheels]
unit = "m"
left.field = "left"
right.field = "right"
[yaw_rate]
field = "gyro"
unit = "rad/s"
)";

/// From a table with wheels and a gyro alone to poses, by the commands that are told; with the bias
/// that is told the heading is that of the wheels.
TEST(UntiedDrive, ATableOfWheelsAndGyroLeadsToPoses) {
  const ScratchFolder scratch;
  const Drive drive = stop_and_go(10.0, 20.0, 0.05, 0.0);
  const MadeTable table = table_of(drive);
  const std::string log = scratch.write("a.csv", table.text).string();
  const std::string map = scratch.write("map.toml", kMap).string();
  const fs::path rec = scratch.path() / "rec";
  const Ran made = run_trussmap("convert " + log + " " + rec.string() + " --map " + map);
  ASSERT_EQ(made.status, 0) << made.output;
  EXPECT_NE(made.output.find("nothing ties the drive to a place"), std::string::npos)
      << made.output;
  EXPECT_NE(made.output.find("coefficients = [0.05]"), std::string::npos) << made.output;
  EXPECT_NE(made.output.find("trussmap apply " + rec.string() + " --model " + rec.string() +
                             "/model.toml --out poses.csv"),
            std::string::npos)
      << made.output;
  EXPECT_FALSE(fs::exists(rec / "sightings.csv"));
  EXPECT_EQ(read_recording(rec, true).drive.rows(), drive.rows());
  const fs::path out = scratch.path() / "poses.csv";
  const std::string apply = "apply " + rec.string() + " --out " + out.string() + " --model ";
  const Ran plain = run_trussmap(apply + (rec / "model.toml").string());
  ASSERT_EQ(plain.status, 0) << plain.output;
  EXPECT_EQ(plain.output.find("nothing to test"), std::string::npos) << plain.output;
  const double biased = last_row(out)[3];
  std::ostringstream model;
  model << std::ifstream(rec / "model.toml").rdbuf();
  const std::string mended =
      model.str() + "\n[[effect]]\nname = \"gyro bias\"\ncoefficients = [0.05]\n";
  const Ran ran = run_trussmap(apply + scratch.write("mended.toml", mended).string());
  ASSERT_EQ(ran.status, 0) << ran.output;
  const std::vector<double> last = last_row(out);
  EXPECT_NEAR(std::remainder(last[3] - table.heading, 6.283185307179586), 0.0, 1e-3);
  EXPECT_NEAR(last[1], table.x, 0.01);
  EXPECT_NEAR(last[2], table.y, 0.01);
  EXPECT_GT(std::abs(std::remainder(biased - table.heading, 6.283185307179586)), 0.1);
}

/// What needs a place says so in one line.
TEST(UntiedDrive, WhatNeedsAPlaceRefusesADriveAlone) {
  const ScratchFolder scratch;
  const fs::path rec = scratch.path() / "rec";
  const std::string log =
      scratch.write("a.csv", table_of(stop_and_go(10.0, 20.0, 0.05, 0.0)).text).string();
  const std::string map = scratch.write("map.toml", kMap).string();
  ASSERT_EQ(run_trussmap("convert " + log + " " + rec.string() + " --map " + map).status, 0);
  const std::string apply =
      "apply " + rec.string() + " --out " + (scratch.path() / "poses.csv").string() + " --model ";
  for (const char* const command : {"fit", "compare", "diagnose"}) {
    const Ran refused = run_trussmap(std::string(command) + " " + rec.string() + " --model " +
                                     (rec / "model.toml").string());
    EXPECT_EQ(refused.status, 2) << command << refused.output;
    EXPECT_NE(refused.output.find("sightings.csv: is missing"), std::string::npos)
        << command << refused.output;
  }
  const Ran adjusted = run_trussmap(apply + (rec / "model.toml").string() + " --adjusted");
  EXPECT_EQ(adjusted.status, 2) << adjusted.output;
  EXPECT_NE(adjusted.output.find("expected some to adjust to"), std::string::npos)
      << adjusted.output;
  const Ran checked =
      run_trussmap("check " + rec.string() + " --model " + (rec / "model.toml").string());
  EXPECT_EQ(checked.status, 1) << checked.output;
  EXPECT_NE(checked.output.find("drive.csv, all: nothing to test"), std::string::npos)
      << checked.output;
}

}  // namespace
}  // namespace trussmap::untied_drive_test
