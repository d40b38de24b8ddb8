// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Whatever a command is given, it ends by itself, in its own words, on one line, and writes over
// nothing that it reads.
#include "scratch_folder.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::hostile_words_test {
namespace {

namespace fs = std::filesystem;
using testing::Ran;
using testing::run_trussmap;
using testing::ScratchFolder;

/// Of libraries: what they say is of their insides.
const std::vector<std::string> kPhrases{"json.exception",
                                        "parse error",
                                        "Error while parsing",
                                        "basic_string",
                                        "vector::",
                                        "map::at",
                                        "stoi",
                                        "stod",
                                        "std::",
                                        "bad_alloc",
                                        "what():",
                                        "terminate",
                                        "sqlite",
                                        "SQL ",
                                        "unable to open",
                                        "filesystem error",
                                        "malformed",
                                        "iostream",
                                        "CLI::",
                                        "unordered_map"};

/// Lines but warnings of what is suspicious all the same.
int complaints_in(const std::string& output) {
  int count = 0;
  for (std::size_t at = 0; at < output.size();) {
    const std::size_t end = std::min(output.find('\n', at), output.size());
    count += output.compare(at, 9, "warning: ") == 0 ? 0 : 1;
    at = end + 1;
  }
  return count;
}

class HostileWords : public ::testing::Test {
 protected:
  void SetUp() override {
    scratch_.write("rec/drive.csv", "t,left,right\n1,0.1,0.1\n2,0.1,0.12\n3,0.1,0.1\n4,0.1,0.1\n");
    scratch_.write("rec/sightings.csv", "t,landmark\n1,a\n2,b\n4,a\n");
    scratch_.write("model.toml", "[robot]\nwheelbase = 0.3\n");
    scratch_.write("graph.g2o", "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n");
  }
  [[nodiscard]] std::string at(const std::string& name) const {
    return (scratch_.path() / name).string();
  }
  /// Runs it: status 2, one line, in words of this project, with `said` in it.
  void refused(const std::string& arguments, const std::string& said) const {
    const auto before = scratch_.contents();
    const Ran ran = run_trussmap(arguments);
    EXPECT_EQ(ran.status, 2) << arguments << "\n" << ran.output;
    EXPECT_EQ(complaints_in(ran.output), 1) << ran.output;
    EXPECT_NE(ran.output.find(said), std::string::npos) << arguments << "\n" << ran.output;
    for (const std::string& phrase : kPhrases) {
      EXPECT_EQ(ran.output.find(phrase), std::string::npos) << phrase << " in " << ran.output;
    }
    EXPECT_EQ(scratch_.contents(), before) << arguments;
  }
  void refused_model(const std::string& text, const std::string& said) const {
    scratch_.write("bad.toml", text);
    refused("compare " + at("rec") + " --model " + at("bad.toml"), said);
  }

  ScratchFolder scratch_;
};

TEST_F(HostileWords, FilesOfNoSense) {
  refused_model("[robot\n", "no TOML: a table header cannot be read");
  refused_model("[robot]\nwheelbase = \"\n", "bad.toml:2: no TOML");
  refused_model("[[effect]]\nname = \"a\\u0000b\"\n", "holds a byte 0");
  refused_model("[[effect]]\nname = \"a\"\nchannel = \"turn\"\nshape = [\"x\\u0000\"]\n", "byte 0");
  scratch_.write("bad.db", std::string(4096, 'x'));
  refused("convert " + at("bad.db") + " " + at("m.graphml"), "is no map store");
  refused("fleet report " + at("bad.db"), "is no fleet store");
  scratch_.write("bad.json", "{\"shard\": ");
  refused("merge " + at("bad.json"), "is no shard");
  scratch_.write("work/steps.json", "{\"format\": 3}");
  refused(
      "serve " + at("rec") + " --no-browser --model " + at("model.toml") + " --work " + at("work"),
      "no log of a workbench");
  scratch_.write("work/steps.json", "[");
  refused(
      "serve " + at("rec") + " --no-browser --model " + at("model.toml") + " --work " + at("work"),
      "no log of a workbench");
  scratch_.write("nul.g2o", std::string("EDGE_SE2 0 1 1 0 0\0 1 0 0 1 0 1\n", 32));
  refused("adjust " + at("nul.g2o"), ", expected a number");
  scratch_.write("nul/drive.csv", std::string("t,left,ri\0ght\n1,0,0\n2,0,0\n", 27));
  scratch_.write("nul/sightings.csv", "t,landmark\n1,a\n");
  refused("check " + at("nul"), "is missing, found");
}

// Comparisons with what is no number are all false.
TEST_F(HostileWords, AValueOfTwoLinesIsToldInOne) {
  const std::string riddle = std::string(TRUSSMAP_SOURCE_DIR) + "/maps/riddle";
  ASSERT_EQ(run_trussmap("build " + riddle + " --model " + riddle + "/model.toml --out " +
                         at("m.graphml"))
                .status,
            0);
  std::string map = read_file(at("m.graphml"));
  const std::string key = "<data key=\"n_c_xx\">";
  const std::size_t value = map.find(key);
  ASSERT_NE(value, std::string::npos) << map;
  map.insert(value + key.size(), "1\n");
  scratch_.write("split.graphml", map);
  refused("convert " + at("split.graphml") + " " + at("m.yaml"), "expected a finite number");
}

TEST_F(HostileWords, OptionsThatAreNoNumbers) {
  const std::string compare = "compare " + at("rec") + " --model " + at("model.toml");
  for (const char* value : {"nan", "inf", "-inf", "-nan"}) {
    const std::string given = std::string("=") + value;
    refused(compare + " --level" + given, "--level: '" + std::string(value) + "' is not a finite");
    refused(compare + " --holdout" + given, "--holdout");
    refused("explore --air-loss" + given, "--air-loss");
    refused("simulate --out " + at("sim") + " --sensor " + value + ",0,0", "--sensor");
  }
  refused("simulate --out " + at("sim") + " --speeds 1e-12,1e-12", "speeds, turn rates and rests");
  refused("explore --mesh 2x2 --tours 1e6", "--tours 1e+06");
  refused("explore --mesh 2x2 --spacing 1e9", "--spacing");
}

TEST_F(HostileWords, FiguresBeyondAllThatRobotsHave) {
  for (const char* length : {"1e-12", "1e300", "1e-320", "0"}) {
    refused_model(std::string("[robot]\nwheelbase = ") + length + "\n",
                  "bad.toml:2: wheelbase is ");
  }
  refused_model("[robot]\nwheelbase = 0.3\n[noise]\ncompass = 1e-320\n", "bad.toml:4: compass is ");
  const std::string simulate = "simulate --mesh 3x3 --tours 1 --seed 1 --out " + at("sim");
  refused(simulate + " --overrun 1e308", "overrun");
  refused(simulate + " --wheelbase 1e-12", "--wheelbase");
  refused(simulate + " --wheelbase 1e300", "--wheelbase");
  refused(simulate + " --compass-noise 1e-320", "--compass-noise");
  scratch_.write("far.g2o", "EDGE_SE2 0 1 1e200 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n");
  refused("adjust " + at("far.g2o"),
          "far.g2o:1: dx is \"1e200\", expected a number of at most 1e30");
}

TEST_F(HostileWords, NothingIsWrittenOverWhatIsRead) {
  const std::string model = at("model.toml");
  const std::string fit = "fit " + at("rec") + " --model " + model + " --out ";
  refused(fit + model, "is what --model reads");
  refused(fit + at("rec/../model.toml"), "is what --model reads");
  fs::create_symlink(model, at("link.toml"));
  refused(fit + at("link.toml"), "is what --model reads");
  refused(fit + at("rec/drive.csv"), "is a file of the recording that RECORDING reads");
  refused("add " + model + " wheelbase --out " + model, "is what MODEL reads");
  refused("adjust " + at("graph.g2o") + " --out " + at("graph.g2o"), "is what GRAPH reads");
  refused("convert " + at("graph.g2o") + " " + at("graph.g2o"), "is what IN reads");
  refused(fit + "''", "--out is empty, expected a path");
  refused("compare " + at("rec") + " --model ''", "--model is empty, expected a path");
  refused("check ''", "RECORDING is empty, expected a path");
}

TEST_F(HostileWords, InputsWithoutAnEnd) {
  refused("compare " + at("rec") + " --model /dev/zero --max-input-mib 1",
          "/dev/zero: is more than 1 MiB");
  ASSERT_EQ(std::system(("ln -s /dev/zero " + at("endless.csv")).c_str()), 0);
  scratch_.write("map.toml", "[wheels.left]\nfield = \"left\"\nunit = \"m\"\n");
  refused("convert --inspect " + at("endless.csv") + " --max-input-mib 1", "endless.csv: ");
}

TEST_F(HostileWords, WhatCannotBeLookedAtIsNotCalledMissing) {
  ASSERT_EQ(::symlink("around.toml", at("around.toml").c_str()), 0);  // leads to itself
  fs::create_directory(at("circle"));
  ASSERT_EQ(::symlink("drive.csv", at("circle/drive.csv").c_str()), 0);
  const auto said = [](const std::string& arguments) {
    const Ran ran = run_trussmap(arguments);
    EXPECT_EQ(ran.status, 2) << ran.output;
    return ran.output;
  };
  EXPECT_NE(said("check " + at("circle")).find("circle/drive.csv: cannot be looked at: Too many"),
            std::string::npos);
  EXPECT_NE(said("compare " + at("rec") + " --model " + at("around.toml"))
                .find("around.toml: cannot be opened: Too many"),
            std::string::npos);
}

}  // namespace
}  // namespace trussmap::hostile_words_test
