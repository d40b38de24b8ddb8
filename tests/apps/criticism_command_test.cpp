// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// compare, add and fit as a user meets them.
#include "json_file.hpp"
#include "scratch_folder.hpp"
#include "shared_data.hpp"
#include "trussmap/write_files.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::criticism_command_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Ran;
using testing::read_json;
using testing::run_trussmap;
using testing::ScratchFolder;

const std::string kRiddleFolder = std::string(TRUSSMAP_SOURCE_DIR) + "/maps/riddle";
const std::string kNominal = kRiddleFolder + "/model.toml";

TEST(CriticismCommands, TheReadmesWalkThroughEndsWithAConsistentModel) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  Ran ran = run_trussmap("compare " + kRiddleFolder + " --model " + kNominal + " --json " + at +
                         "c.json");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_EQ(ran.output.rfind("misfit", 0), 0U) << ran.output;
  const json before = read_json(at + "c.json");
  EXPECT_EQ(before["verdict"], "misfit");
  EXPECT_EQ(before["trends"][0]["residual"], "compass");
  EXPECT_EQ(before["trends"][0]["against"], "heading");

  ran = run_trussmap("add " + kNominal + " \"hard iron\" --out " + at + "m2.toml");
  ASSERT_EQ(ran.status, 0) << ran.output;
  ran = run_trussmap("fit " + kRiddleFolder + " --model " + at + "m2.toml --out " + at +
                     "m3.toml --json " + at + "f.json");
  ASSERT_EQ(ran.status, 0) << ran.output;
  const json fitted = read_json(at + "f.json");
  const json& effect = fitted["effects"][0];
  EXPECT_EQ(effect["effect"], "hard iron");
  EXPECT_EQ(effect["channel"], "compass");
  // Simulated with 0.04 and -0.03 (maps/riddle/README.md).
  EXPECT_NEAR(effect["coefficients"][0].get<double>(), 0.04, 3.0 * effect["sd"][0].get<double>());
  EXPECT_NEAR(effect["coefficients"][1].get<double>(), -0.03, 3.0 * effect["sd"][1].get<double>());
  EXPECT_LT(effect["sd"][0].get<double>(), 0.001);
  const double fallen =
      fitted["without_effects"]["chi2"].get<double>() - fitted["chi2"].get<double>();
  EXPECT_NEAR(fitted["predicted_decrease"].get<double>() / fallen, 1.0, 0.02);

  ran = run_trussmap("compare " + kRiddleFolder + " --model " + at + "m3.toml --json " + at +
                     "d.json");
  ASSERT_EQ(ran.status, 0) << ran.output;
  const json after = read_json(at + "d.json");
  EXPECT_EQ(after["verdict"], "consistent");
  EXPECT_LT(after["heldout"]["arrival_rms_m"].get<double>(),
            0.2 * before["heldout"]["arrival_rms_m"].get<double>());
}

TEST(CriticismCommands, CompareHasTheKeysOfItsFormat) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  const Ran ran = run_trussmap("compare " + kRiddleFolder + " --model " + kNominal + " --json " +
                               at + "c.json");
  ASSERT_EQ(ran.status, 0) << ran.output;
  const json found = read_json(at + "c.json");
  for (const char* key : {"chi2", "dof", "p_value", "legs", "landmarks"}) {
    EXPECT_TRUE(found[key].is_number()) << key;
  }
  EXPECT_EQ(found["legs"], 28);
  EXPECT_EQ(found["landmarks"], 16);
  for (const char* key : {"legs", "arrival_rms_m", "stretch_error", "orientation_error_rad"}) {
    EXPECT_TRUE(found["heldout"][key].is_number()) << key;
  }
  EXPECT_EQ(found["worst"].size(), 28U);
  double before = INFINITY;
  for (const json& leg : found["worst"]) {
    for (const char* key : {"t", "chi2", "stretch_error", "orientation_error_rad"}) {
      EXPECT_TRUE(leg[key].is_number()) << key;
    }
    EXPECT_TRUE(leg["from"].is_string() && leg["to"].is_string());
    EXPECT_LE(leg["chi2"].get<double>(), before);
    before = leg["chi2"].get<double>();
  }
}

/// The command line after "Next (...):", without its first word.
std::string next_line(const std::string& output) {
  const std::size_t next = output.find("\nNext (");
  if (next == std::string::npos) return "";
  const std::size_t line = output.find("\n  trussmap ", next) + 12;
  return output.substr(line, output.find('\n', line) - line);
}

TEST(CriticismCommands, SayWhichCommandHelpsOnAsALineToRun) {
  const ScratchFolder scratch;
  const std::string found = (scratch.path() / "found.toml").string();
  const Ran compared =
      run_trussmap("compare " + kRiddleFolder + " --model " + kNominal + " --gate 5 --holdout 0.2");
  const std::string diagnose = next_line(compared.output);
  EXPECT_EQ(diagnose,
            "diagnose " + kRiddleFolder + " --model " + kNominal + " --gate 5 --holdout 0.2");
  const Ran diagnosed = run_trussmap(diagnose);
  ASSERT_EQ(diagnosed.status, 0) << diagnosed.output;
  std::string discover = next_line(diagnosed.output);
  const std::size_t out = discover.find("found.toml");
  ASSERT_NE(out, std::string::npos) << diagnosed.output;
  discover.replace(out, 10, found);
  const Ran discovered = run_trussmap(discover);
  ASSERT_EQ(discovered.status, 0) << discovered.output;
  EXPECT_EQ(next_line(discovered.output),
            "build " + kRiddleFolder + " --model " + found + " --out map.graphml");
}

TEST(CriticismCommands, AToleranceIsPassedOrFailed) {
  const ScratchFolder scratch;
  const std::string page = (scratch.path() / "page.html").string();
  const std::string out = (scratch.path() / "c.json").string();
  const std::string given = kRiddleFolder + " --model " + kNominal;
  const Ran failed = run_trussmap("compare " + given + " --tolerance 1mm --json " + out);
  EXPECT_EQ(failed.status, 1) << failed.output;
  EXPECT_NE(failed.output.find("failed: legs end "), std::string::npos) << failed.output;
  const json judged = read_json(out).at("tolerance");
  EXPECT_FALSE(judged.at("passed").get<bool>());
  EXPECT_EQ(judged.at("arrival_rms_m"), read_json(out).at("heldout").at("arrival_rms_m"));
  const Ran passed = run_trussmap("compare " + given + " --tolerance \"90 cm\" --html " + page);
  EXPECT_EQ(passed.status, 0) << passed.output;
  const std::string html = read_file(page);
  EXPECT_NE(html.find("Passed: legs end "), std::string::npos);
  EXPECT_NE(html.find("trussmap compare "), std::string::npos);
  EXPECT_EQ(run_trussmap("compare " + given + " --tolerance 3km").status, 2);
  EXPECT_EQ(run_trussmap("compare " + given + " --tolerance 1mm --holdout 0").status, 2);
}

TEST(CriticismCommands, ALoneLandmarksOffsetIsNotFittedAndSaysWhy) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  ASSERT_EQ(run_trussmap("add " + kNominal + " \"compass offset\" --out " + at + "m.toml").status,
            0);
  const Ran ran = run_trussmap("fit " + kRiddleFolder + " --model " + at +
                               "m.toml --without survey --json " + at + "f.json");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("not fitted"), std::string::npos) << ran.output;
  const json fitted = read_json(at + "f.json");
  EXPECT_EQ(fitted["effects"][0]["coefficients"][0], 0.0);
  EXPECT_TRUE(fitted["effects"][0]["sd"][0].is_null());
}

TEST(CriticismCommands, ExcludedTimesAreNotUsed) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  const std::string compare = "compare " + kRiddleFolder + " --model " + kNominal + " --json ";
  ASSERT_EQ(run_trussmap(compare + at + "all.json").status, 0);
  const Ran some = run_trussmap(compare + at + "some.json --exclude 20:50,1:60:70.5");
  ASSERT_EQ(some.status, 0) << some.output;
  EXPECT_LT(read_json(at + "some.json")["legs"].get<int>(),
            read_json(at + "all.json")["legs"].get<int>());
  struct {
    const char* stretch;
    const char* expected;
  } const cases[] = {{"50:20", "is no stretch of time"},
                     {"20", "is no stretch of time"},
                     {"0:20:50", "is no stretch of time"},
                     {"20:nan", "is no stretch of time"},
                     {"2:20:50", "there is no recording 2, expected 1 to 1"},
                     {"1e6:2e6", "expected a part of that"}};
  for (const auto& one : cases) {
    const Ran ran = run_trussmap(compare + at + "no.json --exclude " + one.stretch);
    EXPECT_EQ(ran.status, 2) << one.stretch;
    EXPECT_NE(ran.output.find(one.expected), std::string::npos) << ran.output;
  }
  const Ran two = run_trussmap("compare " + kRiddleFolder + " " + kRiddleFolder + " --model " +
                               kNominal + " --exclude 20:50");
  EXPECT_EQ(two.status, 2);
  EXPECT_NE(two.output.find("does not say of which of 2 recordings"), std::string::npos)
      << two.output;
  EXPECT_FALSE(std::filesystem::exists(at + "no.json"));
}

struct BadModel {
  const char* name;
  const char* effect;    ///< lines after the eight of the robot and its noise
  const char* expected;  ///< in the message, after the file's name
};

TEST(CriticismCommands, WrongEffectsAreNamedWithTheModelsLineAndWriteNothing) {
  const std::string robot = "[robot]\nwheelbase = 0.34\n\n";  // the effect begins on line 4
  const BadModel cases[] = {
      {"formula", "[[effect]]\nname = \"e\"\nchannel = \"turn\"\nshape = [\"sin(\"]\n",
       ":7: effect \"e\": shape \"sin(\" cannot be read"},
      {"variable", "[[effect]]\nname = \"e\"\nchannel = \"turn\"\nshape = [\"payload\"]\n",
       ":7: effect \"e\": shape \"payload\" names \"payload\", which is unknown, expected one of "},
      {"count",
       "[[effect]]\nname = \"e\"\nchannel = \"turn\"\nshape = [\"1\"]\ncoefficients = [1, 2]\n",
       ":8: effect \"e\" has 2 coefficients, expected 1"},
      {"division", "[[effect]]\nname = \"e\"\nchannel = \"turn\"\nshape = [\"1/starts\"]\n",
       ":7: effect \"e\": shape \"1/starts\" "},
      {"channel", "[[effect]]\nname = \"e\"\nchannel = \"spin\"\nshape = [\"1\"]\n",
       ":6: effect \"e\": channel \"spin\" is unknown, expected one of travel"},
      {"catalogue", "[[effect]]\nname = \"ghosts\"\n",
       ":4: effect \"ghosts\" is not in the catalogue"}};
  for (const BadModel& one : cases) {
    const ScratchFolder scratch;
    const fs::path model = scratch.write("m.toml", robot + one.effect);
    for (const char* command : {"fit", "compare", "build", "calibrate"}) {
      const bool fit = std::string(command) == "fit";
      const Ran ran = run_trussmap(std::string(command) + " " + kRiddleFolder + " --model " +
                                   model.string() + " --json " + (scratch.path() / "j").string() +
                                   (fit ? " --out " + (scratch.path() / "o").string() : ""));
      EXPECT_EQ(ran.status, 2) << one.name;
      EXPECT_NE(ran.output.find(model.string() + one.expected), std::string::npos)
          << one.name << ": " << ran.output;
      EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
    }
    EXPECT_EQ(scratch.contents().size(), 1U) << one.name;
  }
}

TEST(CriticismCommands, AddRefusesWhatItCannotAdd) {
  const ScratchFolder scratch;
  const std::string out = " --out " + (scratch.path() / "m.toml").string();
  const auto refused = [&](const std::string& what, const std::string& expected) {
    const Ran ran = run_trussmap("add " + kNominal + " " + what + out);
    EXPECT_EQ(ran.status, 2) << what;
    EXPECT_NE(ran.output.find(expected), std::string::npos) << ran.output;
  };
  refused("ghosts", "\"ghosts\" is not in the catalogue");
  refused("mine --channel turn", "--channel and --shape go together");
  refused("mine --channel turn --shape \"sin(\"", "cannot be read");
  refused("mine --channel round --shape 1", "effect \"mine\": channel \"round\" is unknown");
  EXPECT_TRUE(scratch.contents().empty());
}

TEST(CriticismCommands, AFormulaOfOnesOwnIsAsGoodAsTheCatalogues) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  ASSERT_EQ(
      run_trussmap("add " + kNominal + " \"tyre drift (temperature_C)\" --out " + at + "a.toml")
          .status,
      0);
  ASSERT_EQ(
      run_trussmap("add " + kNominal +
                   " mine --channel wheels --shape \"0+temperature_C*1\" --out " + at + "b.toml")
          .status,
      0);
  for (const char* name : {"a", "b"}) {
    const Ran ran = run_trussmap("fit " + kRiddleFolder + " --model " + at + name +
                                 ".toml --json " + at + name + ".json");
    ASSERT_EQ(ran.status, 0) << ran.output;
  }
  const json a = read_json(at + "a.json");
  const json b = read_json(at + "b.json");
  const double of_catalogue = a["effects"][0]["coefficients"][0].get<double>();
  EXPECT_NEAR(b["effects"][0]["coefficients"][0].get<double>(), of_catalogue,
              1e-12 * std::abs(of_catalogue));
  EXPECT_NEAR(b["chi2"].get<double>(), a["chi2"].get<double>(), 1e-12 * a["chi2"].get<double>());
}

struct Practice {
  const char* recording;
  const char* residual;
  const char* against;
};

TEST(CriticismCommands, TheStrongestTrendOfThePracticeRecordingsIsTheRightOne) {
  TRUSSMAP_NEEDS_SHARED("data/hidden");
  const ScratchFolder scratch;
  // What the answers of the recordings' README mean in compare's words.
  const Practice cases[] = {{"a", "turn", "all"},
                            {"b", "compass", "heading"},
                            {"c", "stretch", "payload_kg"},
                            {"d", "stretch", "place"},
                            {"e", "orientation", "heading"},
                            {"f", "compass", "lights"},
                            {"g", "turn", "turn rate"},
                            {"j", "compass", "signed turn rate"}};
  for (const Practice& one : cases) {
    const std::string folder =
        testing::shared(std::string("data/hidden/") + one.recording).string();
    const std::string out = (scratch.path() / one.recording).string();
    const Ran ran =
        run_trussmap("compare " + folder + " --model " + folder + "/model.toml --json " + out);
    ASSERT_EQ(ran.status, 0) << ran.output;
    const json found = read_json(out);
    EXPECT_EQ(found["verdict"], "misfit") << one.recording;
    EXPECT_EQ(found["trends"][0]["residual"], one.residual) << one.recording;
    EXPECT_EQ(found["trends"][0]["against"], one.against) << one.recording;
  }
  for (const char* null : {"h", "i"}) {
    const std::string folder = testing::shared(std::string("data/hidden/") + null).string();
    const Ran ran = run_trussmap("compare " + folder + " --model " + folder + "/model.toml");
    EXPECT_EQ(ran.output.rfind("consistent", 0), 0U) << ran.output;
    EXPECT_NE(ran.output.find("No residual has a trend"), std::string::npos) << ran.output;
  }
}

}  // namespace
}  // namespace trussmap::criticism_command_test
