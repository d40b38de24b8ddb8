// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// From a log to a diagnosis by the command.
#include "scratch_folder.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::convert_log_test {
namespace {

namespace fs = std::filesystem;
using testing::Ran;
using testing::run_trussmap;
using testing::ScratchFolder;

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

const fs::path kLogs = fs::path(TRUSSMAP_SOURCE_DIR) / "maps" / "logs";

TEST(ConvertLog, TheFirstMapOfTheExampleIsTheOneThatIsThere) {
  const ScratchFolder scratch;
  const fs::path map = scratch.path() / "map.toml";
  const Ran ran = run_trussmap("convert --inspect " + (kLogs / "warehouse.mcap").string() +
                               " --map " + map.string());
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("/joint_states"), std::string::npos) << ran.output;
  const auto body = [](const std::string& text) { return text.substr(text.find("[time]")); };
  EXPECT_EQ(body(text_of(map)), body(text_of(kLogs / "warehouse.toml")));
}

/// A bag of Humble: it says what its messages are called, not what is in them.
TEST(ConvertLog, TakesDefinitionsThatTheBagLacks) {
  const ScratchFolder scratch;
  const bool debian = fs::exists("/usr/bin/python3");
  const std::string write = std::string(debian ? "/usr/bin/python3" : "python3") + " -B '" +
                            TRUSSMAP_SOURCE_DIR + "/tests/logs/bags/write_test_bags.py' '" +
                            scratch.path().string() + "' db3_definitions_apart > /dev/null";
  ASSERT_EQ(std::system(write.c_str()), 0);
  const std::string bag = (scratch.path() / "bag.db3").string();
  const std::string given = " --definitions " + (scratch.path() / "src").string();
  const std::string first = (scratch.path() / "first.toml").string();
  const Ran without = run_trussmap("convert --inspect " + bag + " --map " + first);
  EXPECT_EQ(without.status, 0) << without.output;
  EXPECT_NE(without.output.find("/everything: the bag has no definition of my_msgs/Everything; "
                                "--definitions takes its .msg file\n"),
            std::string::npos)
      << without.output;
  const Ran with = run_trussmap("convert --inspect " + bag + " --map " + first + "2" + given);
  EXPECT_EQ(with.status, 0) << with.output;
  EXPECT_NE(with.output.find("/everything/steps[0]"), std::string::npos) << with.output;
  EXPECT_NE(with.output.find("OUT --map " + first + "2" + given), std::string::npos);
  const fs::path map = scratch.write("map.toml",
                                     "[robot]\nwheelbase = 0.3\n[odometry]\ntwist = \"/odom\"\n"
                                     "[covariates]\nload = \"/everything/u8\"\n"
                                     "[fixes]\ntopic = \"/gps\"\n");
  const std::string convert =
      "convert " + bag + " " + (scratch.path() / "rec").string() + " --map " + map.string();
  const Ran refused = run_trussmap(convert);
  EXPECT_EQ(refused.status, 2) << refused.output;
  EXPECT_NE(refused.output.find("map.toml:6: /everything/u8 cannot be read"), std::string::npos)
      << refused.output;
  EXPECT_EQ(run_trussmap(convert + given).status, 0);
  EXPECT_NE(text_of(scratch.path() / "rec" / "drive.csv").find(",load"), std::string::npos);
}

TEST(ConvertLog, MistakesAreOneLineWithWhatToDo) {
  const ScratchFolder scratch;
  const std::string log = (kLogs / "team.csv").string();
  const std::string map = (kLogs / "team.toml").string();
  const std::string out = (scratch.path() / "rec").string();
  const auto refused = [](const std::string& arguments, const std::string& part) {
    const Ran ran = run_trussmap(arguments);
    EXPECT_EQ(ran.status, 2) << arguments << "\n" << ran.output;
    EXPECT_NE(ran.output.find(part), std::string::npos) << arguments << "\n" << ran.output;
  };
  refused("convert " + log + " " + out, "--map");
  refused("convert " + log + " --map " + map, "OUT");
  refused("convert " + log + " " + out + " --map " + map + " --definitions " + out,
          "does not exist");
  refused("convert " + log + " " + out + " --definitions " + map, "is for logs");
  refused("convert " + log + " " + out + ".graphml --map " + map, "named like a map");
  refused("convert " + log + " " + out + " --map " + out + "/none.toml", "none.toml");
  refused("convert --inspect " + log + " --map " + map, "there already");
  refused("convert --inspect " + out + "/none.mcap", "does not exist");
  refused("convert " + out + "/none.mcap " + out + " --map " + map, "none.mcap");
  refused("convert " + log + " " + map + " " + out, "--map map.toml");
  refused("convert --inspect " + log + " " + log + " --map " + out + ".toml", "given twice");
  EXPECT_FALSE(fs::exists(out)) << "nothing is half-written";
}

/// Coefficients of the effects in a fitted model, and their names.
std::pair<std::vector<std::string>, std::vector<double>> effects_of(const fs::path& model) {
  const std::string text = text_of(model);
  std::pair<std::vector<std::string>, std::vector<double>> found;
  static const std::regex kName(R"re(\[\[effect\]\]\nname = "([^"]*)")re");
  static const std::regex kCoefficients(R"(coefficients = \[([^\]]*)\])");
  for (auto at = std::sregex_iterator(text.begin(), text.end(), kName);
       at != std::sregex_iterator(); ++at) {
    found.first.push_back((*at)[1].str());
  }
  for (auto at = std::sregex_iterator(text.begin(), text.end(), kCoefficients);
       at != std::sregex_iterator(); ++at) {
    std::istringstream numbers((*at)[1].str());
    for (std::string one; std::getline(numbers, one, ',');) found.second.push_back(std::stod(one));
  }
  return found;
}

/// The same drive, its wheels in whole ticks, through every kind of log.
TEST(SlowConvertLog, EveryFormatLeadsToTheSameDiagnosis) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path();
  ASSERT_EQ(run_trussmap("simulate --mesh 3x3 --tours 3 --seed 5 --effect 'hard iron=0.05,0.02' "
                         "--out " +
                         (folder / "sim").string())
                .status,
            0);
  const std::string writer =
      std::string(TRUSSMAP_SOURCE_DIR) + "/tests/logs/bags/recording_as_logs.py";
  const std::string python = fs::exists("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
  ASSERT_EQ(std::system(
                (python + " -B " + writer + " " + (folder / "sim").string() + " " + folder.string())
                    .c_str()),
            0);
  std::vector<double> first;
  for (const char* log : {"drive.mcap", "bag", "drive.wpilog", "drive.log", "drive.csv"}) {
    const std::string in = (folder / log).string();
    const std::string name = in + ".converted";
    ASSERT_EQ(run_trussmap("convert --inspect " + in + " --map " + name + ".toml").status, 0);
    std::string map = text_of(name + ".toml");
    const std::string guess = "ticks_per_turn = 1000";
    if (const std::size_t at = map.find(guess); at != std::string::npos) {
      map.replace(at, guess.size(), "ticks_per_turn = 65536");
    }
    std::ofstream(name + ".toml") << map;
    const Ran converted = run_trussmap("convert " + in + " " + name + " --map " + name + ".toml");
    ASSERT_EQ(converted.status, 0) << converted.output;
    const Ran found = run_trussmap("discover " + name + " --model " + name + "/model.toml --out " +
                                   name + "_fitted.toml");
    ASSERT_EQ(found.status, 0) << found.output;
    const auto [names, coefficients] = effects_of(name + "_fitted.toml");
    EXPECT_EQ(names, std::vector<std::string>{"hard iron"}) << log;
    ASSERT_EQ(coefficients.size(), 2U) << log;
    if (first.empty()) first = coefficients;
    EXPECT_NEAR(coefficients[0], first[0], 1e-6 * std::abs(first[0])) << log;
    EXPECT_NEAR(coefficients[1], first[1], 1e-6 * std::abs(first[1])) << log;
  }
}

/// Five layouts of joined tables, and the single table of the same drive.
TEST(SlowConvertLog, JoinedTablesLeadToTheDiagnosisOfTheSingleTable) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path();
  const std::string python = fs::exists("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
  const std::string writer =
      std::string(TRUSSMAP_SOURCE_DIR) + "/tests/logs/tables/joined_layouts.py";
  ASSERT_EQ(std::system((python + " -B " + writer + " " + folder.string() + " 30").c_str()), 0);
  std::vector<double> first;
  for (const char* layout : {"single", "one", "two", "three", "four", "five"}) {
    const fs::path in = folder / layout;
    const std::string map = (in / "map.toml").string();
    const std::string out = in.string() + ".converted";
    const std::string logs = in.string() + (std::string(layout) == "single" ? "/all.csv" : "");
    const Ran converted = run_trussmap("convert " + logs + " " + out + " --map " + map);
    ASSERT_EQ(converted.status, 0) << converted.output;
    const Ran found = run_trussmap("discover " + out + " --model " + out + "/model.toml --out " +
                                   out + "_fitted.toml");
    ASSERT_EQ(found.status, 0) << found.output;
    const auto [names, coefficients] = effects_of(out + "_fitted.toml");
    EXPECT_EQ(names, std::vector<std::string>{"gyro scale"}) << layout << found.output;
    ASSERT_EQ(coefficients.size(), 1U) << layout;
    if (first.empty()) first = coefficients;
    EXPECT_NEAR(coefficients[0], 1.0 / 1.03 - 1.0, 0.005) << "3 % too much by the gyro";
    EXPECT_NEAR(coefficients[0], first[0], 1e-4 * std::abs(first[0])) << layout;
  }
}

}  // namespace
}  // namespace trussmap::convert_log_test
