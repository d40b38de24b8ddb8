// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Words of 10 000 characters wherever one can stand: what is wrong is said in one line that can be
// read. And the limits of what is read.
#include "scratch_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::long_words_test {
namespace {

using testing::Ran;
using testing::run_trussmap;
using testing::ScratchFolder;

const std::string kLong(10000, 'w');
const std::string kDrive = "t,left,right\n1,1,1\n2,1,1\n";
const std::string kSightings = "t,landmark\n1,A\n2,B\n";
const std::string kModel = "[robot]\nwheelbase = 0.3\n";

void expect_short(const std::string& arguments, const std::string& expected) {
  const Ran ran = run_trussmap(arguments);
  EXPECT_EQ(ran.status, 2) << ran.output.substr(0, 2000);
  EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1)
      << ran.output.substr(0, 2000);
  EXPECT_LT(ran.output.size(), 1000U) << ran.output.substr(0, 2000);
  EXPECT_NE(ran.output.find(expected), std::string::npos) << ran.output.substr(0, 2000);
}

void expect_short_recording(const std::string& drive, const std::string& sightings,
                            const std::string& model, const std::string& expected) {
  const ScratchFolder scratch;
  scratch.write("r/drive.csv", drive);
  scratch.write("r/sightings.csv", sightings);
  scratch.write("m.toml", model);
  const std::string folder = scratch.path().string();
  expect_short("compare " + folder + "/r --model " + folder + "/m.toml", expected);
}

TEST(LongWords, InRecordings) {
  expect_short_recording("t,left,right\n1," + kLong + ",1\n", kSightings, kModel, "drive.csv:2");
  expect_short_recording("t,left," + kLong + "\n1,1,1\n", kSightings, kModel, "drive.csv:1");
  expect_short_recording("t,left,right,a" + kLong + ",a" + kLong + "\n", kSightings, kModel,
                         "twice");
  expect_short_recording("t,left,right,a" + kLong + "\n1,1,1,x\n", kSightings, kModel,
                         "drive.csv:2");
  expect_short_recording("t,left,right,-" + kLong + "\n1,1,1,1\n", kSightings, kModel,
                         "drive.csv:1");
  expect_short_recording(kDrive, "t,landmark\n1,\x1B" + kLong + "\n", kModel, "sightings.csv:2");
  expect_short_recording(kDrive, "t,landmark\n9," + kLong + "\n", kModel, "sightings.csv:2");
}

TEST(LongWords, InModels) {
  const std::string effect = kModel + "[[effect]]\nname = ";
  expect_short_recording(kDrive, kSightings, kLong + " = 1\n", "m.toml:1");
  expect_short_recording(kDrive, kSightings, "[robot]\n" + kLong + " = 1\n", "m.toml:2");
  expect_short_recording(kDrive, kSightings, "[noise]\n" + kLong + " = 1\n", "m.toml:2");
  expect_short_recording(kDrive, kSightings, kModel + "[" + kLong + "\n", "m.toml:3");
  expect_short_recording(kDrive, kSightings, effect + "\"" + kLong + "\"\n", "m.toml:");
  const std::string own = effect + "\"own\"\nchannel = \"turn\"\nshape = [\"";
  expect_short_recording(kDrive, kSightings, own + kLong + "\"]\n", "m.toml:");
  expect_short_recording(kDrive, kSightings, own + "sin(" + kLong + "\"]\n", "m.toml:");
  std::string sum = "1";
  for (int k = 0; k < 2500; ++k) sum += " + u";
  expect_short_recording(kDrive, kSightings, own + sum + "\"]\n", "m.toml:");
  expect_short_recording(kDrive, kSightings, effect + "\"own\"\nchannel = \"" + kLong + "\"\n",
                         "m.toml:");
}

TEST(LongWords, InGraphsAndMaps) {
  const ScratchFolder scratch;
  const std::string out = " " + (scratch.path() / "out.graphml").string();
  const auto g2o = [&](const std::string& text, const std::string& expected) {
    expect_short("adjust " + scratch.write("g.g2o", text).string(), expected);
  };
  g2o(kLong + " 1 2 3\n", "g.g2o:1");
  g2o("VERTEX_XY " + kLong + " 1 2\n", "g.g2o:1");
  g2o("VERTEX_XY 1 1 " + kLong + "\n", "g.g2o:1");
  g2o("VERTEX_XY 1 1 2 " + kLong + "\n", "g.g2o:1");
  const auto graphml = [&](const std::string& graph, const std::string& expected) {
    const auto file =
        scratch.write("m.graphml",
                      "<graphml><key id=\"x\" for=\"node\" attr.name=\"x\" attr.type=\"double\"/>"
                      "<key id=\"y\" for=\"node\" attr.name=\"y\" attr.type=\"double\"/>"
                      "<graph edgedefault=\"undirected\">" +
                          graph + "</graph></graphml>\n");
    expect_short("convert " + file.string() + out, expected);
  };
  const std::string place = "<data key=\"x\">0</data><data key=\"y\">0</data></node>";
  graphml("<node id=\"" + kLong + "\"/>", "m.graphml:1");
  graphml("<node id=\"A\">" + place + "<edge source=\"A\" target=\"" + kLong + "\"/>",
          "m.graphml:1");
  graphml("<node id=\"A\"><data key=\"x\">" + kLong + "</data><data key=\"y\">0</data></node>",
          "m.graphml:1");
  graphml("<" + kLong + ">", "m.graphml:");
  expect_short("umbmark " + scratch.write("r.csv", "direction,x,y\n" + kLong + ",0,0\n").string() +
                   " --side 4 --wheelbase 0.3",
               "r.csv:2");
}

/// maps/riddle, one of whose landmarks has a long name.
TEST(LongWords, InResults) {
  const ScratchFolder scratch;
  const std::string riddle = std::string(TRUSSMAP_SOURCE_DIR) + "/maps/riddle/";
  for (const char* file : {"drive.csv", "sightings.csv", "survey.csv"}) {
    std::ostringstream text;
    text << std::ifstream(riddle + file).rdbuf();
    scratch.write(std::string("r/") + file,
                  std::regex_replace(text.str(), std::regex("L0_1\\b"), kLong));
  }
  const std::string rest =
      " " + (scratch.path() / "r").string() + " --model " + riddle + "model.toml";
  for (const std::string command : {"compare", "build"}) {
    const Ran ran = run_trussmap(command + rest);
    EXPECT_EQ(ran.status, 0) << ran.output.substr(0, 2000);
    EXPECT_TRUE(command == "build" || ran.output.find("w...w") != std::string::npos);
    std::istringstream lines(ran.output);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LT(line.size(), 400U) << command << ": " << line.substr(0, 500);
    }
  }
}

TEST(LongWords, InArguments) {
  expect_short(kLong, "no command");
  expect_short("--" + kLong, "required");
  expect_short("build r --model m.toml --" + kLong, "w...w");
  expect_short("build " + kLong + " --model m.toml", "w...w");
  expect_short("simulate --mesh " + kLong + " --out r", "w...w");
  expect_short("simulate --tours " + kLong + " --out r", "w...w");
  expect_short("simulate --walk " + kLong + " --out r", "w...w");
  expect_short("simulate --effect " + kLong + "=1 --out r", "w...w");
  expect_short("noise --simulate --path " + kLong, "w...w");
  expect_short("convert " + kLong + " r", "w...w");
}

TEST(ReadingLimits, AreOptionsOfTheCommands) {
  const ScratchFolder scratch;
  const std::string maps = std::string(TRUSSMAP_SOURCE_DIR) + "/maps/";
  std::string drive = "t,left,right\n";
  for (int k = 1; k < 100000; ++k) drive += std::to_string(k) + ",1.000,1.000\n";
  scratch.write("r/drive.csv", drive);
  scratch.write("r/sightings.csv", kSightings);
  const std::string check = "check " + (scratch.path() / "r").string();
  expect_short(check + " --max-input-mib 1",
               "drive.csv: is more than 1 MiB; allow more with --max-input-mib");
  EXPECT_EQ(run_trussmap(check + " --max-input-mib 2").output.find("allow more"),
            std::string::npos);
  expect_short(check + " --max-input-mib 0", "--max-input-mib");
  const Ran help = run_trussmap("build --help");
  EXPECT_NE(help.output.find("--max-input-mib N"), std::string::npos) << help.output;
  EXPECT_NE(help.output.find("--max-nesting N"), std::string::npos) << help.output;
}

}  // namespace
}  // namespace trussmap::long_words_test
