// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Tables of runs as people write them: units, decimal commas, signs.
#include "scratch_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/recording_files.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::taped_runs_test {
namespace {

using testing::ScratchFolder;

std::string refusal_of(const std::string& table, bool degrees = false) {
  const ScratchFolder scratch;
  try {
    static_cast<void>(read_taped_runs(scratch.write("r.csv", table), degrees));
  } catch (const InputError& error) {
    const std::string said = error.what();
    return said.substr(said.find("r.csv"));
  }
  return "read";
}

TEST(TapedRuns, ComeBackAsWritten) {
  const ScratchFolder scratch;
  const std::string table =
      "kind,expected,odometry,heading,gyro,seconds\nstraight,10.031,10,0.01,,\n"
      "spin,-62.9,-62.5,,-62,60\nrest,0,0,,0.6,60\n";
  const auto runs = read_taped_runs(scratch.write("r.csv", table));
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[1].kind, TapedKind::spin);
  EXPECT_EQ(runs[1].line, 3U);
  EXPECT_TRUE(std::isnan(runs[0].gyro) && std::isnan(runs[0].sd));
  EXPECT_EQ(format_taped_runs(runs), table);
}

TEST(TapedRuns, DecimalCommasSemicolonsTabsAndBlanksAreRead) {
  const ScratchFolder scratch;
  for (const std::string& table :
       {std::string(
            "kind;expected;odometry;sd\nstraight; 10,031 ;10;0,002\nspin;-6,3;-6,25;\n;;;\n"),
        std::string("kind,expected,odometry,sd\nstraight,\"10,031\",10,\"0,002\"\n"
                    "spin,\"-6,3\",-6.25,\n"),
        std::string("kind\texpected\todometry\tsd\nstraight\t10.031\t10\t0,002\n"
                    "spin\t-6,3\t-6,25\t\n")}) {
    const auto runs = read_taped_runs(scratch.write("r.csv", table));
    ASSERT_EQ(runs.size(), 2U) << table;
    EXPECT_EQ(runs[0].expected, 10.031);
    EXPECT_EQ(runs[0].sd, 0.002);
    EXPECT_EQ(runs[1].odometry, -6.25);
    EXPECT_TRUE(std::isnan(runs[1].sd));
  }
  const std::string square = "direction;x;y\ncw;0,01;-0,02\ncw;0,02;0\nccw;0;0,5\nccw;1,5;0\n";
  const SquareRuns runs = read_square_runs(scratch.write("s.csv", square), 16.0);
  EXPECT_EQ(runs.cw[0], Eigen::Vector2d(0.01, -0.02));
  EXPECT_EQ(runs.ccw[1], Eigen::Vector2d(1.5, 0.0));
}

TEST(TapedRuns, DegreesAndRatesBecomeRadians) {
  const ScratchFolder scratch;
  const auto runs =
      read_taped_runs(scratch.write("r.csv",
                                    "kind,expected,odometry,yaw_rate,seconds,sd,sd_gyro\n"
                                    "spin,3600,3578.1,60,60,2,0.1\nrest,,,0.5,,,0.01\n"
                                    "straight,5,5,,,0.002,\n"),
                      true);
  const double degree = std::numbers::pi / 180.0;
  EXPECT_NEAR(runs[0].expected, 20.0 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(runs[0].gyro, 3600.0 * degree, 1e-12);
  EXPECT_NEAR(runs[0].sd, 2.0 * degree, 1e-15);
  EXPECT_NEAR(runs[0].sd_gyro, 6.0 * degree, 1e-12);  // of a mean rate over 60 s
  EXPECT_EQ(runs[1].seconds, 1.0);
  EXPECT_NEAR(runs[1].gyro, 0.5 * degree, 1e-15);
  EXPECT_EQ(runs[2].sd, 0.002);
}

TEST(TapedRuns, AnotherUnitIsNamed) {
  const std::string head = "kind,expected,odometry,heading\n";
  const std::pair<std::string, std::string> all[] = {
      {"straight,1003.1,10,",
       "r.csv:2: expected is 1003.1 and odometry 10, expected metres for both "
       "(is expected in centimetres, 100 times too long?)"},
      {"straight,10031,10,", "millimetres, 1000 times too long"},
      {"straight,10.03,1000,", "(is odometry in centimetres, 100 times too long?)"},
      {"straight,502,500,",
       "longer than any tape, expected metres (are these centimetres, 100 "
       "times too long?)"},
      {"straight,5020,5000,", "(are these millimetres, 1000 times too long?)"},
      {"straight,0,5,", "expected metres above 0"},
      {"straight,5,5,2.3", "are these degrees? --degrees"},
      {"spin,3600,3578,", "573 full turns, expected radians (are these degrees?"},
      {"spin,3600,62.4,", "are these degrees?"},
      {"spin,62.8,3578,", "expected radians for both (is one in turns, or in degrees?)"},
      {"spin,10,62.4,", "is one in turns"},
      {"spin,62.8,-62.4,", "opposite signs"},
      {"turn,1,1,", "kind is \"turn\", expected straight, spin or rest"},
      {"rest,,,0.5", "a rest without seconds"},
      {"spin,1,a,", "column odometry is \"a\", expected a number"}};
  for (const auto& [row, said] : all) {
    const std::string refusal = refusal_of(head + row + "\n");
    EXPECT_NE(refusal.find(said), std::string::npos) << row << ": " << refusal;
    EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
  }
  EXPECT_EQ(refusal_of(head), "r.csv: no run, expected one or more");
  EXPECT_NE(refusal_of(head + "straight,10,03,10,\n").find("decimal commas?"), std::string::npos);
  EXPECT_EQ(refusal_of(head + "spin,3600,3578,\n", true), "read");
  EXPECT_EQ(refusal_of(head + "straight,20,10,\n"), "read");  // a radius for a diameter
}

}  // namespace
}  // namespace trussmap::taped_runs_test
