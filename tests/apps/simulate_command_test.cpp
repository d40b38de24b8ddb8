// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Effects in simulated recordings, from the command line: named, taken from a model, or hidden.
#include "json_file.hpp"
#include "scratch_folder.hpp"
#include "trussmap/recording_files.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::simulate_command_test {
namespace {

using nlohmann::json;
using testing::Ran;
using testing::read_json;
using testing::run_trussmap;
using testing::ScratchFolder;

/// How far build's map is from the survey under a model, m.
double map_error(const ScratchFolder& scratch, const std::string& folder,
                 const std::string& model) {
  const std::string at = scratch.path().string() + "/";
  const Ran built = run_trussmap("build " + at + folder + " --model " + at + model +
                                 " --method adjustment --json " + at + "m.json");
  EXPECT_EQ(built.status, 0) << built.output;
  return read_json(scratch.path() / "m.json")["survey"]["rms_m"].get<double>();
}

TEST(SimulateCommand, AModelWithTheSameEffectsExplainsTheRecording) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  const std::string effects =
      "[[effect]]\nname = \"one wheel under load\"\nchannel = \"left\"\n"
      "shape = [\"payload_kg\"]\ncoefficients = [0.0004]\n"
      "[[effect]]\nname = \"turn asymmetry\"\ncoefficients = [-0.03]\n";
  scratch.write("effects.toml", effects);
  const Ran ran = run_trussmap("simulate --mesh 4x4 --uneven --noise-free --no-compass --effects " +
                               at + "effects.toml --out " + at + "r");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("one wheel under load"), std::string::npos);
  // Two effects side by side, which build takes out one after the other: 1e-5 of a turn is left.
  EXPECT_LT(map_error(scratch, "r", "effects.toml"), 0.002);
  EXPECT_GT(map_error(scratch, "r", "r/model.toml"), 0.02);
}

/// The robot is that of --drive, whatever a file of effects says or leaves out.
TEST(SimulateCommand, EffectsOfAFileAreOfTheDriveThatIsSimulated) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  scratch.write("e.toml",
                "[[effect]]\nname = \"bent\"\nchannel = \"steer\"\nshape = [\"1\"]\n"
                "coefficients = [0.02]\n");
  const std::string command = "simulate --mesh 3x3 --effects " + at + "e.toml --out " + at;
  const Ran ran = run_trussmap(command + "r --drive tricycle");
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("bent"), std::string::npos) << ran.output;
  const Ran other = run_trussmap(command + "other");
  EXPECT_EQ(other.status, 2);
  EXPECT_NE(other.output.find("e.toml:4: effect \"bent\": channel \"steer\" is of another drive"),
            std::string::npos)
      << other.output;
}

TEST(SimulateCommand, ANamedEffectIsThatOfAModel) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  scratch.write("e.toml",
                "[[effect]]\nname = \"hard iron\"\ncoefficients = [0.2, -0.1]\n"
                "[[effect]]\nname = \"slippery patch (x=5, y=5, r=3)\"\ncoefficients = [-0.03]\n");
  ASSERT_EQ(
      run_trussmap("simulate --mesh 3x3 --seed 4 --effects " + at + "e.toml --out " + at + "a")
          .status,
      0);
  ASSERT_EQ(run_trussmap("simulate --mesh 3x3 --seed 4 --effect 'hard iron=0.2,-0.1' --effect "
                         "'slippery patch (x=5, y=5, r=3)=-0.03' --out " +
                         at + "b --json " + at + "b.json")
                .status,
            0);
  const auto files = scratch.contents();
  EXPECT_EQ(files.at("a/drive.csv"), files.at("b/drive.csv"));
  EXPECT_EQ(files.at("a/model.toml").find("[[effect]]"), std::string::npos);
  EXPECT_EQ(read_json(scratch.path() / "b.json")["effects"][1]["channel"], "wheels");
}

TEST(SimulateCommand, WhatIsHiddenIsSealedAndRevealed) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  const std::string simulate = "simulate --mesh 4x4 --tours 1 --seed 11 --hide --out " + at;
  const Ran ran = run_trussmap(simulate + "a --json " + at + "a.json");
  ASSERT_EQ(ran.status, 0) << ran.output;
  ASSERT_EQ(run_trussmap(simulate + "b").status, 0);
  auto files = scratch.contents();
  EXPECT_EQ(files.at("a/drive.csv"), files.at("b/drive.csv"));
  EXPECT_EQ(files.at("a/truth.json"), files.at("b/truth.json"));

  const Ran revealed = run_trussmap("reveal " + at + "a --json " + at + "answer.json");
  ASSERT_EQ(revealed.status, 0) << revealed.output;
  const json answer = read_json(scratch.path() / "answer.json");
  ASSERT_GE(answer["effects"].size(), 1U);
  for (const json& effect : answer["effects"]) {
    const std::string name = effect["name"];
    EXPECT_NE(revealed.output.find(name), std::string::npos) << revealed.output;
    for (const char* file : {"a/truth.json", "a/model.toml", "a.json"}) {
      EXPECT_EQ(files.at(file).find(name), std::string::npos) << file;
    }
    EXPECT_EQ(ran.output.find(name), std::string::npos) << ran.output;
  }

  // The answer is the recording's: the same effects, given openly, make the same drive.
  std::string open = "simulate --mesh 4x4 --tours 1 --seed 11 --out " + at + "c";
  for (const json& effect : answer["effects"]) {
    std::string values;
    for (const json& value : effect["coefficients"]) {
      values += (values.empty() ? "" : ",") + value.dump();
    }
    open += " --effect '" + effect["name"].get<std::string>() + "=" + values + "'";
  }
  ASSERT_EQ(run_trussmap(open).status, 0);
  files = scratch.contents();
  EXPECT_EQ(files.at("a/drive.csv"), files.at("c/drive.csv"));
}

TEST(SimulateCommand, HidingWithoutASeedDrawsOneAndSaysWhich) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  const std::string simulate = "simulate --mesh 3x3 --tours 1 --hide --out " + at;
  const Ran a = run_trussmap(simulate + "a --json " + at + "a.json");
  const Ran b = run_trussmap(simulate + "b --json " + at + "b.json");
  ASSERT_EQ(a.status + b.status, 0) << a.output;
  // Two draws of 32 bits are equal once in four billion runs of this test.
  const json seed = read_json(scratch.path() / "a.json")["seed"];
  EXPECT_NE(seed, read_json(scratch.path() / "b.json")["seed"]);
  EXPECT_NE(a.output.find("--seed " + seed.dump() + ","), std::string::npos) << a.output;
  const Ran again = run_trussmap(simulate + "c --seed " + seed.dump());
  ASSERT_EQ(again.status, 0);
  EXPECT_EQ(again.output.find("They were drawn"), std::string::npos) << again.output;
  auto files = scratch.contents();
  EXPECT_EQ(files.at("a/drive.csv"), files.at("c/drive.csv"));
  EXPECT_EQ(files.at("a/truth.json"), files.at("c/truth.json"));
  EXPECT_NE(files.at("a/drive.csv"), files.at("b/drive.csv"));
}

TEST(SimulateCommand, WhatWasFoundOfTheHiddenIsScored) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  const Ran made = run_trussmap("simulate --mesh 4x4 --seed 11 --hide --out=" + at + "r-2");
  ASSERT_EQ(made.status, 0) << made.output;
  EXPECT_NE(made.output.find("  Try another: trussmap simulate --mesh 4x4 --hide --seed 12 --out " +
                             at + "r-3\n"),
            std::string::npos)
      << made.output;
  ASSERT_EQ(run_trussmap("reveal " + at + "r-2 --json " + at + "a.json").status, 0);
  const json truth = read_json(scratch.path() / "a.json")["effects"];
  // The true model, once fitted, and one effect too many.
  std::string model = scratch.contents().at("r-2/model.toml");
  for (const json& one : truth) {
    model += "\n[[effect]]\nname = " + one["name"].dump() + "\nchannel = " + one["channel"].dump() +
             "\nshape = " + one["shape"].dump() + "\n";
  }
  model += "\n[[effect]]\nname = \"mine\"\nchannel = \"wheels\"\nshape = [\"t\"]\n";
  scratch.write("m.toml", model);
  const std::string folder = at + "r-2 ";
  ASSERT_EQ(run_trussmap("fit " + folder + "--model " + at + "m.toml --out " + at +
                         "f.toml --json " + at + "f.json")
                .status,
            0);
  const Ran scored =
      run_trussmap("reveal " + folder + "--model " + at + "f.toml --json " + at + "s.json");
  ASSERT_EQ(scored.status, 0) << scored.output;
  const json score = read_json(scratch.path() / "s.json")["score"];
  EXPECT_EQ(score["found"], truth.size());
  EXPECT_EQ(score["missed"], 0);
  EXPECT_EQ(score["false"], 1);
  const json fitted = read_json(scratch.path() / "f.json")["effects"];
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const json& row = score["effects"][k];
    EXPECT_EQ(row["outcome"], "found");
    const double sd = row["sd"][0].get<double>();
    EXPECT_NEAR(sd, fitted[k]["sd"][0].get<double>(), 1e-3 * sd);
    EXPECT_NEAR(row["z"][0].get<double>(),
                (row["estimate"][0].get<double>() - row["truth"][0].get<double>()) / sd, 1e-9);
    EXPECT_LT(std::abs(row["z"][0].get<double>()), 4.0) << scored.output;
  }
  EXPECT_EQ(score["effects"].back()["outcome"], "false");
  // The nominal model has nothing of it.
  const Ran none = run_trussmap("reveal " + folder + "--model " + at + "r-2/model.toml");
  EXPECT_EQ(
      none.output.rfind("score: 0 found, " + std::to_string(truth.size()) + " missed, 0 false", 0),
      0U)
      << none.output;
}

/// As files were sealed before they were encrypted: {"seed":1,"effects":[]}.
TEST(SimulateCommand, AnEarlierAnswerStillOpens) {
  const ScratchFolder scratch;
  scratch.write("r/truth.json",
                "{\"note\": \"\", \"sealed\": \"eyJzZWVkIjoxLCJlZmZlY3RzIjpbXX0=\", \"checksum\": "
                "\"05ce92d4ad82e80f\"}");
  const std::string at = scratch.path().string();
  const Ran ran = run_trussmap("reveal " + at + "/r --json " + at + "/a.json");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_EQ(read_json(scratch.path() / "a.json")["seed"], 1);
}

TEST(SimulateCommand, AnAnswerGoesWithItsRecordingAndAgainstTampering) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  ASSERT_EQ(run_trussmap("simulate --mesh 3x3 --hide --out " + at + "r").status, 0);
  std::string text = scratch.contents().at("r/truth.json");
  const std::size_t middle = text.find("\"sealed\": \"") + 30;
  text[middle] = text[middle] == 'A' ? 'B' : 'A';
  scratch.write("r/truth.json", text);
  Ran ran = run_trussmap("reveal " + at + "r");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.output.find("truth.json: is broken"), std::string::npos) << ran.output;
  ASSERT_EQ(run_trussmap("simulate --mesh 3x3 --out " + at + "r").status, 0);
  ran = run_trussmap("reveal " + at + "r");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.output.find("truth.json: there is none"), std::string::npos) << ran.output;
}

TEST(SimulateCommand, BadEffectsEndWithOneLineAndWriteNothing) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  scratch.write("fitless.toml", "[[effect]]\nname = \"wheelbase\"\n");
  scratch.write("channel.toml",
                "[[effect]]\nname = \"x\"\nchannel = \"lift\"\nshape = [\"1\"]\n"
                "coefficients = [1]\n");
  const auto before = scratch.contents();
  struct Bad {
    std::string arguments;
    const char* says;
  };
  for (const Bad& bad :
       std::vector<Bad>{{"--effect gremlins=1", "\"gremlins\" is not in the catalogue"},
                        {"--effect wheelbase", "expected NAME=VALUE"},
                        {"--effect wheelbase=", "is no number"},
                        {"--effect wheelbase=0.1x", "\"0.1x\" is no number"},
                        {"--effect wheelbase=nan", "\"nan\" is no number"},
                        {"--effect wheelbase=0.1,", "\"\" is no number"},
                        {"--effect wheelbase=0.1,0.2", "has 2 coefficients, expected 1"},
                        {"--effect slope=0.1", "has 1 coefficients, expected 2"},
                        {"--effect 'slippery patch=0.1'", "lacks a place or threshold"},
                        {"--effect 'tyre drift=0.1'", "needs a covariate"},
                        {"--effect 'tyre drift (fuel)=0.1'", "names \"fuel\", which is unknown"},
                        {"--effect 'travel scale=-1'", "leave no wheel travels"},
                        {"--effects " + at + "none.toml", "cannot be opened"},
                        {"--effects " + at + "fitless.toml", "has no coefficients"},
                        {"--effects " + at + "channel.toml", "channel \"lift\" is unknown"},
                        {"--effect 'yaw offset=0.1'", "acts on yaws of landmarks, expected mark"},
                        {"--hide --effect wheelbase=0.1", "excludes"},
                        {"--rough fog", "half, memory, haze, tails, floor"},
                        {"--rough half,", "unknown rough noise ''"},
                        {"--rough ''", "unknown rough noise ''"},
                        {"--rough haze --no-compass", "haze is noise of a compass"},
                        {"--rough half --noise-free", "--noise-free excludes --rough"},
                        {"--covariate speed", "\"speed\", which is taken"},
                        {"--covariate 2b", "expected a letter"},
                        {"--speeds 0.9,0.2", "slowest first"},
                        {"--ramp -1", "not a number of 0 or more"}}) {
    const Ran ran = run_trussmap("simulate --mesh 3x3 --out " + at + "r " + bad.arguments);
    EXPECT_EQ(ran.status, 2) << bad.arguments << "\n" << ran.output;
    EXPECT_NE(ran.output.find(bad.says), std::string::npos) << ran.output;
    EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
    EXPECT_EQ(ran.output.rfind("trussmap: ", 0), 0U) << ran.output;
  }
  EXPECT_EQ(scratch.contents(), before);
}

TEST(SimulateCommand, RoughNoiseIsNotWhatTheModelStates) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  const std::string simulate = "simulate --mesh 3x3 --tours 1 --seed 5 ";
  struct Pair {
    const char* without;
    const char* rough;
  };
  for (const Pair& pair : std::vector<Pair>{
           {"", "--rough all"},
           {"--hide", "--hide --rough half,haze"},
           {"--no-compass", "--no-compass --rough tails"},
           {"--effect 'hard iron=0.2,-0.1'", "--effect 'hard iron=0.2,-0.1' --rough floor"}}) {
    ASSERT_EQ(run_trussmap(simulate + pair.without + " --out " + at + "a").status, 0);
    const Ran ran = run_trussmap(simulate + pair.rough + " --out " + at + "b");
    ASSERT_EQ(ran.status, 0) << ran.output;
    EXPECT_NE(ran.output.find("not what model.toml states"), std::string::npos) << ran.output;
    const auto files = scratch.contents();
    EXPECT_NE(files.at("a/drive.csv"), files.at("b/drive.csv")) << pair.rough;
    for (const char* file : {"model.toml", "sightings.csv", "survey.csv"}) {
      EXPECT_EQ(files.at(std::string("a/") + file), files.at(std::string("b/") + file)) << file;
    }
    EXPECT_EQ(files.contains("a/truth.json"), files.contains("b/truth.json"));
    if (files.contains("a/truth.json")) {
      EXPECT_EQ(files.at("a/truth.json"), files.at("b/truth.json"));
    }
  }
  ASSERT_EQ(run_trussmap(simulate + "--rough floor,haze --out " + at + "c --json " + at + "c.json")
                .status,
            0);
  EXPECT_EQ(read_json(scratch.path() / "c.json")["rough"], json({"haze", "floor"}));
}

/// A walk of 0.001 rad/s per s^1/2 is 0.014 rad/s off after 200 s; at the start it is nothing.
TEST(SimulateCommand, ABiasWalksAndNothingElse) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  const std::string simulate = "simulate --mesh 4x4 --tours 1 --gyro --gyro-noise 1e-9 --seed 5 ";
  ASSERT_EQ(run_trussmap(simulate + "--out " + at + "a").status, 0);
  ASSERT_EQ(run_trussmap(simulate + "--gyro-walk 0.001 --out " + at + "b").status, 0);
  const auto files = scratch.contents();
  for (const char* file : {"model.toml", "sightings.csv", "survey.csv"}) {
    EXPECT_EQ(files.at(std::string("a/") + file), files.at(std::string("b/") + file)) << file;
  }
  const Drive still = read_recording(scratch.path() / "a").drive;
  const Drive walking = read_recording(scratch.path() / "b").drive;
  EXPECT_EQ(still.left, walking.left);
  EXPECT_EQ(still.heading, walking.heading);
  double squares = 0.0;  // of the steps, rad/s
  for (std::size_t k = 1; k < still.rows(); ++k) {
    const double step = (walking.yaw_rate[k] - still.yaw_rate[k]) -
                        (walking.yaw_rate[k - 1] - still.yaw_rate[k - 1]);
    squares += step * step;
  }
  // Means over rows: half of one step and half of the next.
  const double rows = static_cast<double>(still.rows());
  const double expected = 0.5 * 1e-6 * (still.t.back() - still.start());
  EXPECT_NEAR(squares / expected, 1.0, 4.0 * std::sqrt(3.0 / rows));
}

/// The model that comes with a recording names its columns: with the effect it fits, and its page
/// draws the wheels.
TEST(SimulateCommand, DrawsEveryDrive) {
  const std::vector<std::pair<std::string, std::string>> drives = {
      {"skid-steer --wheelbase 0.5", "radius of wheel 4"},
      {"tricycle --length 0.8 --steer-noise 0.002", "steering offset by direction"},
      {"ackermann --wheel-left 0.2", "steering offset"},
      {"omni3 --length 0.25", "radius of wheel 2"},
      {"mecanum", "roller slip"},
      {"wheels", "radius of wheel 3"}};
  for (const auto& [drive, effect] : drives) {
    const ScratchFolder scratch;
    const std::string at = scratch.path().string() + "/";
    const Ran ran =
        run_trussmap("simulate --mesh 3x3 --noise-free --drive " + drive + " --effect '" + effect +
                     "=0.02' --out " + at + "r --json " + at + "r.json");
    ASSERT_EQ(ran.status, 0) << ran.output;
    EXPECT_EQ(read_json(scratch.path() / "r.json")["drive"], drive.substr(0, drive.find(' ')));
    const Ran added =
        run_trussmap("add " + at + "r/model.toml '" + effect + "' --out " + at + "m.toml");
    ASSERT_EQ(added.status, 0) << added.output;
    const Ran fitted = run_trussmap("fit " + at + "r --model " + at + "m.toml --out " + at +
                                    "f.toml --json " + at + "f.json --html " + at + "f.html");
    ASSERT_EQ(fitted.status, 0) << fitted.output;
    const json fit = read_json(scratch.path() / "f.json");
    EXPECT_LT(fit["chi2"].get<double>(), 1e-6) << drive;
    EXPECT_NEAR(fit["effects"][0]["coefficients"][0].get<double>(), 0.02, 1e-6) << drive;
    EXPECT_NE(scratch.contents().at("f.html").find("The robot's wheels"), std::string::npos);
  }
}

TEST(SimulateCommand, HidesEffectsOfTheDrive) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  const Ran ran = run_trussmap(
      "simulate --mesh 4x4 --tours 1 --drive mecanum --seed 3 --hide --out " + at + "r");
  ASSERT_EQ(ran.status, 0) << ran.output;
  const Ran revealed = run_trussmap("reveal " + at + "r");
  EXPECT_EQ(revealed.status, 0) << revealed.output;
}

TEST(SimulateCommand, OptionsAndEffectsOfAnotherDriveEndWithOneLine) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"--length 0.5", "--length is not of drive differential"},
      {"--drive tricycle --wheelbase 0.5", "--wheelbase is not of drive tricycle"},
      {"--drive mecanum --steer-noise 0.01", "--steer-noise is not of drive mecanum"},
      {"--drive hovercraft", "hovercraft"},
      {"--effect 'roller slip=0.1'", "is of another drive than differential"},
      {"--drive omni3 --effect 'steering offset=0.1'", "is of another drive than omni3"},
      {"--drive ackermann --spacing 1", "at least 1.46"},
      {"--drive omni3 --covariate wheel2", "taken by a wheel"}};
  for (const auto& [options, what] : wrong) {
    const Ran ran = run_trussmap("simulate --mesh 3x3 " + options + " --out " + at + "r");
    EXPECT_EQ(ran.status, 2) << options;
    EXPECT_NE(ran.output.find(what), std::string::npos) << ran.output;
    EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
  }
  EXPECT_TRUE(scratch.contents().empty());
}

TEST(SimulateCommand, HelpListsTheCatalogue) {
  const Ran ran = run_trussmap("simulate --help");
  for (const char* name : {"wheel diameter ratio", "tyre drift (COLUMN)", "slippery patch (x=.."}) {
    EXPECT_NE(ran.output.find(name), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace trussmap::simulate_command_test
