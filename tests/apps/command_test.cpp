// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The command line as a user meets it: status, one line for what is wrong, nothing half-written.
#include "json_file.hpp"
#include "scratch_folder.hpp"
#include "trussmap/gate.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::command_test {
namespace {

using nlohmann::json;
using testing::Ran;
using testing::read_json;
using testing::run_trussmap;
using testing::ScratchFolder;

const std::vector<std::string> kCommands = {
    "add",      "adjust",   "build",   "calibrate", "compare", "contrast", "convert",
    "diagnose", "discover", "effects", "fit",       "merge",   "noise",    "plan",
    "reveal",   "simulate", "tape",    "tour",      "umbmark", "watch"};

TEST(Command, HelpIsThereForEveryCommand) {
  const std::string all = run_trussmap("--help").output;
  for (const std::string& name : kCommands) {
    const Ran ran = run_trussmap(name + " --help");
    EXPECT_EQ(ran.status, 0) << name;
    EXPECT_NE(ran.output.find("Usage: trussmap " + name), std::string::npos) << ran.output;
    EXPECT_NE(ran.output.find("--help"), std::string::npos) << name;
    EXPECT_NE(all.find("\n  " + name + " "), std::string::npos) << name;
  }
}

TEST(Command, HelpSpellsTypesInOneWay) {
  // CLI11's own spellings, and a path that is not called one.
  const std::regex other(R"(\b(TEXT|FLOAT|INT|UINT|PATH\.\.\.|RECORDING\.\.\. RECORDING)\b)");
  const std::regex no_file(R"(\n  --(json|svg|html|model|write) (?!FILE))");
  for (const std::string& name : kCommands) {
    const std::string help = run_trussmap(name + " --help").output;
    EXPECT_FALSE(std::regex_search(help, other)) << help;
    EXPECT_FALSE(std::regex_search(help, no_file)) << help;
  }
}

/// Help as one line, so that line breaks do not matter.
std::string help_in_one_line(const std::string& command) {
  static const std::regex kBlanks(R"(\s+)");
  return std::regex_replace(run_trussmap(command + " --help").output, kBlanks, " ");
}

TEST(Command, HelpStatesTheDefaultOfEveryGate) {
  const std::string build = help_in_one_line("build");
  EXPECT_NE(
      build.find(fmt::format("by default {:g}, and more where too many would go", kAdjustmentGate)),
      std::string::npos)
      << build;
  for (const std::string command : {"compare", "diagnose", "discover", "fit"}) {
    const std::string help = help_in_one_line(command);
    EXPECT_NE(help.find(fmt::format("--gate X={:g} ", kModelGate)), std::string::npos) << help;
  }
  const std::string adjust = help_in_one_line("adjust");
  EXPECT_NE(adjust.find(fmt::format("--gate X={:g} ", kPoseGraphGate)), std::string::npos);
}

TEST(Command, HelpSaysWhatARecordingIs) {
  for (const std::string name : {"build", "calibrate", "compare", "diagnose", "discover", "fit"}) {
    const std::string help = run_trussmap(name + " --help").output;
    for (const char* line : {"drive.csv      t,left,right", "sightings.csv  t,landmark",
                             "survey.csv     landmark,x,y", "truth.csv      t,x,y,heading"}) {
      EXPECT_NE(help.find(line), std::string::npos) << name << ": " << line;
    }
  }
}

/// What the documentation's table of the catalogue has: names without brackets, each with its
/// channel.
std::map<std::string, std::string> documented_effects() {
  std::ifstream page(TRUSSMAP_SOURCE_DIR "/docs/effects.md");
  static const std::regex kRow(R"(\| `([a-z0-9 -]+)[^`]*` \| [^|]* \| `([a-z_0-9]+)` × .*)");
  std::map<std::string, std::string> effects;
  for (std::string line; std::getline(page, line);) {
    std::smatch row;
    if (!std::regex_match(line, row, kRow)) continue;
    std::string name = row[1];
    name.erase(name.find_last_not_of(' ') + 1);
    effects[name] = row[2];
  }
  return effects;
}

TEST(EffectsCommand, DrawsWhatItTellsOf) {
  const ScratchFolder scratch;
  const std::string file = (scratch.path() / "e.svg").string();
  const Ran ran = run_trussmap("effects \"turn scrub\" --drawing " + file);
  ASSERT_EQ(ran.status, 0) << ran.output;
  std::ifstream stream(file);
  std::string first;
  std::getline(stream, first);
  EXPECT_EQ(first.rfind("<svg", 0), 0U) << first;
  EXPECT_EQ(run_trussmap("effects --drawing " + file).status, 2);  // of which?
}

TEST(EffectsCommand, ListsWhatTheDocumentationHas) {
  const ScratchFolder scratch;
  const std::string file = (scratch.path() / "e.json").string();
  const Ran ran = run_trussmap("effects --json " + file);
  ASSERT_EQ(ran.status, 0) << ran.output;
  std::map<std::string, std::string> listed;
  const json written = read_json(file);
  for (const json& one : written["effects"]) {
    const std::string in_full = one["in_full"];
    EXPECT_NE(ran.output.find("  " + in_full + " "), std::string::npos) << in_full;
    EXPECT_FALSE(one["cause"].get<std::string>().empty()) << in_full;
    listed[one["name"]] = one["channel"];
  }
  EXPECT_GT(listed.size(), 50U);
  EXPECT_EQ(listed, documented_effects());
}

TEST(EffectsCommand, TellsOfOneAndRefusesWhatItDoesNotKnow) {
  const Ran one = run_trussmap("effects 'tyre drift (temperature_C)'");
  EXPECT_EQ(one.status, 0);
  EXPECT_EQ(one.output.rfind("tyre drift (COLUMN)\n", 0), 0U) << one.output;
  EXPECT_NE(one.output.find("calibrate again from time to time"), std::string::npos);
  const Ran none = run_trussmap("effects gremlins");
  EXPECT_EQ(none.status, 2);
  EXPECT_EQ(none.output,
            "trussmap: \"gremlins\" is not in the catalogue, whose names trussmap effects lists\n");
}

TEST(Command, AGraphWithPosesIsNoMapAndIsNamed) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  const std::string graph = scratch.write("poses.g2o", "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n").string();
  const Ran ran = run_trussmap("convert " + graph + " " + at + "/x.geojson");
  EXPECT_EQ(ran.status, 2) << ran.output;
  EXPECT_EQ(ran.output.rfind("trussmap: " + graph + ": is a graph of poses, expected a map", 0), 0U)
      << ran.output;
  EXPECT_EQ(scratch.contents().size(), 1U);
}

TEST(Command, AnMrclamRobotWithoutItsOdometryIsNamed) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  scratch.write("set/Barcodes.dat", "# subject barcode\n6 72\n");
  scratch.write("set/Robot1_Measurement.dat", "1.0 72 1.0 0.1\n");
  for (const std::string robot : {"Robot1", "Robot2"}) {
    const Ran ran = run_trussmap("convert " + at + "/set/" + robot + " " + at + "/out");
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.output,
              "trussmap: " + at + "/set/" + robot + "_Odometry.dat: is missing, plain or as .xz\n");
  }
}

TEST(Command, BadUsageEndsWithStatus2AndOneLine) {
  for (const char* arguments : {"",
                                "bild",
                                "build",
                                "build r --model m --method magic",
                                "tour --eta 1",
                                "tour --tours 0",
                                "tour --mesh 6",
                                "tour --x-lines 0,1",
                                "tour --eta 99999999999",
                                "tour --eta all --no-groups",
                                "tour --maps-after 1",
                                "tour --tours 3 --maps x --maps-after 4",
                                "tour --polygon 2",
                                "tour --polygon 5 --mesh 3x3",
                                "tour --wheelbase 0.5",
                                "tour --wheels 0.003 --odometry-error 0.1",
                                "tour --wheels 0.003 --no-compass --compass-error 0.1",
                                "build r --model m --relax",
                                "build r --model m --eta 9",
                                "build r --model m --store s.db --relax",
                                "build r --model m --method gauss-markov --eta 9",
                                "build r --model m --method elastic-printed --law variance",
                                "simulate --out /dev/null/x",
                                "build r --model m --gate -1",
                                "convert a.txt b.txt"}) {
    const Ran ran = run_trussmap(arguments);
    EXPECT_EQ(ran.status, 2) << arguments << "\n" << ran.output;
    EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
    EXPECT_EQ(ran.output.rfind("trussmap: ", 0), 0U) << ran.output;
  }
}

TEST(Command, SimulateBuildAndConvertGoTogether) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  ASSERT_EQ(
      run_trussmap("simulate --mesh 4x4 --tours 2 --no-compass --seed 5 --out " + at + "/r").status,
      0);
  const Ran built = run_trussmap("build " + at + "/r --model " + at + "/r/model.toml --out " + at +
                                 "/m.graphml --json " + at + "/m.json --svg " + at +
                                 "/m.svg --csv " + at + "/p.csv");
  ASSERT_EQ(built.status, 0) << built.output;
  const json result = read_json(scratch.path() / "m.json");
  EXPECT_EQ(result["method"], "adjustment");
  EXPECT_EQ(result["verdict"], "good") << result["warnings"];
  EXPECT_EQ(result["warnings"], json::array());
  EXPECT_EQ(result["positions"].size(), 16U);
  EXPECT_TRUE(result["positions"]["L3_3"].contains("c_xy"));
  EXPECT_EQ(built.output.find("doubtful"), std::string::npos);
  const auto places = scratch.contents().at("p.csv");
  EXPECT_EQ(places.substr(0, places.find('\n')), "landmark,x,y,c_xx,c_xy,c_yy");
  EXPECT_EQ(std::count(places.begin(), places.end(), '\n'), 17);
  for (const char* file : {"m.graphml", "m.json", "m.svg", "p.csv"}) {
    EXPECT_NE(built.output.find(at + "/" + file, built.output.find("written:")), std::string::npos)
        << built.output;
  }
  EXPECT_EQ(result["landmarks"], 16);
  EXPECT_EQ(result["routes"], 24);
  EXPECT_LT(result["survey"]["rms_m"].get<double>(),
            0.5 * result["survey"]["rms_dead_reckoning_m"].get<double>());
  for (const char* format : {"geojson", "dot", "g2o", "graphml"}) {
    EXPECT_EQ(run_trussmap("convert " + at + "/m.graphml " + at + "/c." + format).status, 0);
  }
  const auto files = scratch.contents();
  const auto graph_of = [](const std::string& text) { return text.substr(text.find("<graphml")); };
  EXPECT_EQ(graph_of(files.at("m.graphml")), graph_of(files.at("c.graphml")));
  EXPECT_NE(files.at("m.graphml").find("method adjustment"), std::string::npos);
  EXPECT_NE(files.at("m.svg").find("</svg>"), std::string::npos);
}

TEST(Command, BuildShowsHowLandmarksAreTurned) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  ASSERT_EQ(run_trussmap("simulate --mesh 3x3 --markers --seed 6 --out " + at + "/r").status, 0);
  const Ran built = run_trussmap("build " + at + "/r --model " + at + "/r/model.toml --out " + at +
                                 "/m.graphml --json " + at + "/m.json --csv " + at + "/p.csv");
  ASSERT_EQ(built.status, 0) << built.output;
  EXPECT_NE(built.output.find("landmarks with orientation          9  of 9, their axes good to 0."),
            std::string::npos)
      << built.output;
  const json result = read_json(scratch.path() / "m.json");
  EXPECT_EQ(result["quality"]["oriented"], 9);
  EXPECT_LT(result["quality"]["median_sd_heading_rad"].get<double>(), 0.02);
  const json& one = result["positions"]["L1_1"];
  EXPECT_LE(std::abs(one["heading"].get<double>()), 3.1416);
  EXPECT_GT(one["sd_heading"].get<double>(), 0.0);
  const auto files = scratch.contents();
  EXPECT_EQ(files.at("p.csv").rfind("landmark,x,y,c_xx,c_xy,c_yy,heading,sd_heading\n", 0), 0U);
  EXPECT_NE(files.at("m.graphml").find("<data key=\"n_sd_heading\">"), std::string::npos);
}

TEST(Command, TheSameSeedGivesTheSameFiles) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  const std::string simulate = "simulate --mesh 3x3 --tours 1 --no-compass --range-sensor --seed 9";
  run_trussmap(simulate + " --out " + at + "/a");
  run_trussmap(simulate + " --out " + at + "/b");
  for (const char* run : {"a", "b"}) {
    const Ran built = run_trussmap("build " + at + "/" + run + " --model " + at + "/" + run +
                                   "/model.toml --out " + at + "/" + run + "/m.graphml");
    EXPECT_EQ(built.status, 0) << built.output;
  }
  const auto files = scratch.contents();
  for (const char* file : {"drive.csv", "sightings.csv", "survey.csv", "m.graphml"}) {
    EXPECT_EQ(files.at(std::string("a/") + file), files.at(std::string("b/") + file)) << file;
  }
}

TEST(Command, BadInputNamesFileAndLineAndWritesNothing) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  scratch.write("r/drive.csv", "t,left,right\n0.1,0,0\n0.2,0,zero\n");
  scratch.write("r/sightings.csv", "t,landmark\n0,A\n");
  scratch.write("m.toml", "[robot]\nwheelbase = 0.3\n");
  const auto before = scratch.contents();
  const Ran ran = run_trussmap("build " + at + "/r --model " + at + "/m.toml --out " + at +
                               "/m.graphml --json " + at + "/m.json");
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.output,
            "trussmap: " + at + "/r/drive.csv:3: column right is \"zero\", expected a number\n");
  EXPECT_EQ(scratch.contents(), before);
}

TEST(Command, AnOutputThatCannotBeWrittenLeavesTheOthersAlone) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  run_trussmap("simulate --mesh 3x3 --tours 1 --out " + at + "/r");
  scratch.write("m.graphml", "the map of before");
  const auto before = scratch.contents();
  const Ran ran = run_trussmap("build " + at + "/r --model " + at + "/r/model.toml --out " + at +
                               "/m.graphml --json " + at + "/no/such/folder.json");
  EXPECT_EQ(ran.status, 2) << ran.output;
  EXPECT_EQ(scratch.contents(), before);
}

TEST(Command, ASessionThatMeetsNoLandmarkOfTheOthersIsNamed) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  for (const char* session : {"one", "two"}) {
    const std::string name = std::string(session) == "one" ? "A" : "X";
    scratch.write(std::string(session) + "/drive.csv",
                  "t,left,right\n1,1,1\n2,1,1\n3,0.5,1\n4,1,1\n");
    scratch.write(std::string(session) + "/sightings.csv",
                  "t,landmark\n0," + name + "\n2," + name + "2\n4," + name + "3\n");
  }
  scratch.write("m.toml", "");
  const Ran ran = run_trussmap("build " + at + "/one " + at + "/two --model " + at + "/m.toml");
  EXPECT_EQ(ran.status, 1) << ran.output;
  EXPECT_TRUE(ran.output.ends_with("trussmap: " + at +
                                   "/two stands apart: no landmark ties it to " + at + "/one\n"))
      << ran.output;
}

TEST(Command, AWordThatIsNoCommandIsNamed) {
  const Ran ran = run_trussmap("polish x");
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(
      ran.output,
      "trussmap: \"polish\" is no command, expected one of add, adjust, apply, build, "
      "calibrate, check, "
      "compare, completion, contrast, convert, diagnose, discover, effects, explore, fit, fleet, "
      "manual, merge, "
      "noise, plan, "
      "reveal, schema, serve, simulate, tape, tour, umbmark, watch\n");
}

TEST(Command, ASessionGivenTwiceIsRefused) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  run_trussmap("simulate --mesh 3x3 --tours 1 --out " + at + "/r");
  const Ran ran =
      run_trussmap("build " + at + "/r " + at + "/../" + scratch.path().filename().string() +
                   "/r/ --model " + at + "/r/model.toml");
  EXPECT_EQ(ran.status, 2) << ran.output;
  EXPECT_NE(ran.output.find("is given twice"), std::string::npos) << ran.output;
}

/// On a mesh of uneven routes, without a compass, the printed refinement diverges: build says so,
/// and says nothing of the kind of the methods that do not.
TEST(Command, AMapThatContradictsItsRoutesIsDoubted) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  run_trussmap("simulate --mesh 6x6 --uneven --tours 3 --seed 1 --no-compass --out " + at + "/r");
  const std::string build = "build " + at + "/r --model " + at + "/r/model.toml --method ";
  EXPECT_NE(run_trussmap(build + "elastic-printed").output.find("contradicts its own routes"),
            std::string::npos);
  for (const char* method : {"elastic", "gauss-markov", "adjustment"}) {
    EXPECT_EQ(run_trussmap(build + method).output.find("warning"), std::string::npos) << method;
  }
}

/// Positions with covariances, what was kept out by name, and how well all fits.
TEST(Command, TheAdjustmentKeepsAMisreadLabelOutAndSaysSo) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  run_trussmap("simulate --mesh 4x4 --tours 2 --no-compass --range-sensor --seed 5 --out " + at +
               "/r");
  const auto files = scratch.contents();
  std::string sightings = files.at("r/sightings.csv");
  const std::size_t row = sightings.rfind('\n', sightings.size() - 2) + 1;
  const std::size_t name = sightings.find(',', row) + 1;
  const std::size_t end = sightings.find(',', name);
  const std::string time = sightings.substr(row, name - 1 - row);
  const std::string wrong = sightings.substr(name, end - name) == "L0_0" ? "L3_3" : "L0_0";
  sightings.replace(name, end - name, wrong);
  scratch.write("r/sightings.csv", sightings);
  const std::string build = "build " + at + "/r --model " + at + "/r/model.toml --out " + at +
                            "/m.graphml --json " + at + "/m.json --method adjustment";
  const Ran ran = run_trussmap(build);
  ASSERT_EQ(ran.status, 0) << ran.output;
  const json result = read_json(scratch.path() / "m.json");
  EXPECT_EQ(result["method"], "adjustment");
  bool named = false;
  for (const json& one : result["rejected"]) named = named || one["landmark"] == wrong;
  EXPECT_TRUE(named) << result["rejected"].dump() << " at t = " << time;
  EXPECT_LE(result["rejected"].size(), 5U);
  EXPECT_TRUE(result["converged"].get<bool>());
  EXPECT_GT(result["p_value"].get<double>(), 1e-4);
  EXPECT_NE(scratch.contents().at("m.graphml").find("c_xx"), std::string::npos);
  EXPECT_LT(result["survey"]["rms_m"].get<double>(), 0.1);
  for (const char* key : {"rms_similarity_m", "scale"}) {
    EXPECT_TRUE(result["survey"].contains(key)) << key;
  }
}

TEST(Command, UnitsThatNoRobotHasAreDoubted) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  run_trussmap("simulate --mesh 3x3 --tours 1 --out " + at + "/r");
  scratch.write("m.toml", "[robot]\nwheelbase = 340\n");
  const Ran ran = run_trussmap("build " + at + "/r --model " + at + "/m.toml");
  EXPECT_NE(ran.output.find("a wheelbase of 340 m; is it in metres?"), std::string::npos)
      << ran.output;
}

TEST(Command, BuildTakesAModelsEffectsOutAndRefusesWhatItCannot) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  run_trussmap("simulate --mesh 3x3 --tours 1 --out " + at + "/r");
  scratch.write("good.toml", "[[effect]]\nname = \"wheelbase\"\ncoefficients = [0.0]\n");
  scratch.write("bad.toml",
                "[[effect]]\nname = \"x\"\nchannel = \"turn\"\nshape = [\"fuel\"]\n"
                "coefficients = [0.1]\n");
  EXPECT_EQ(run_trussmap("build " + at + "/r --model " + at + "/good.toml").status, 0);
  const Ran ran = run_trussmap("build " + at + "/r --model " + at + "/bad.toml");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.output.find("effect \"x\": shape \"fuel\" names \"fuel\", which is unknown"),
            std::string::npos)
      << ran.output;
}

}  // namespace
}  // namespace trussmap::command_test
