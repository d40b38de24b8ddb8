// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// check, and the warnings of the other commands, as a user meets them.
#include "json_file.hpp"
#include "scratch_folder.hpp"
#include "shared_data.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::check_command_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Ran;
using testing::read_json;
using testing::run_trussmap;
using testing::ScratchFolder;

const std::string kRiddleFolder = std::string(TRUSSMAP_SOURCE_DIR) + "/maps/riddle";
const std::string kNominal = kRiddleFolder + "/model.toml";

/// The riddle with the columns left and right exchanged.
std::string with_wheels_exchanged(const ScratchFolder& scratch) {
  const fs::path folder = scratch.path() / "exchanged";
  fs::copy(kRiddleFolder, folder);
  std::ifstream in(kRiddleFolder + "/drive.csv");
  std::ostringstream text;
  text << in.rdbuf();
  std::string drive = text.str();
  const std::size_t at = drive.find("left,right");
  EXPECT_NE(at, std::string::npos);
  drive.replace(at, 10, "right,left");
  std::ofstream(folder / "drive.csv") << drive;
  return folder.string();
}

TEST(CheckCommand, FindsNothingInTheRiddle) {
  const ScratchFolder scratch;
  const std::string file = scratch.path().string() + "/found.json";
  const Ran ran =
      run_trussmap("check " + kRiddleFolder + " --model " + kNominal + " --json " + file);
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("nothing found"), std::string::npos) << ran.output;
  EXPECT_TRUE(read_json(file)["findings"].is_array());
  EXPECT_TRUE(read_json(file)["findings"].empty());
}

TEST(CheckCommand, SaysByItsStatusThatSomethingIsFound) {
  const ScratchFolder scratch;
  const std::string folder = with_wheels_exchanged(scratch);
  const std::string file = scratch.path().string() + "/found.json";
  const Ran ran = run_trussmap("check " + folder + " --model " + kNominal + " --json " + file);
  EXPECT_EQ(ran.status, 1) << ran.output;
  const json findings = read_json(file)["findings"];
  ASSERT_EQ(findings.size(), 1U) << ran.output;
  EXPECT_EQ(findings[0]["file"], folder + "/drive.csv");
  EXPECT_EQ(findings[0]["column"], "left,right");
  EXPECT_EQ(findings[0]["kind"], "wheels exchanged");
  EXPECT_NE(ran.output.find(findings[0]["evidence"].get<std::string>()), std::string::npos);
  EXPECT_NE(ran.output.find(findings[0]["remedy"].get<std::string>()), std::string::npos);
  EXPECT_EQ(ran.output.find("trussmap:"), std::string::npos) << ran.output;  // no complaint
}

/// Angles in degrees lead a car nowhere: check says so, where the other commands cannot begin.
TEST(CheckCommand, ReadsTheDriveFromTheModel) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "car";
  fs::create_directory(folder);
  std::ofstream drive(folder / "drive.csv");
  std::ofstream fixes(folder / "fixes.csv");
  drive << "t,wheel,steer\n";
  fixes << "t,x,y\n";
  for (int k = 1; k <= 100; ++k) {
    drive << 0.1 * k << ",0.5," << (k % 20 < 10 ? 12.0 : -17.0) << "\n";
    fixes << 0.1 * k << "," << 0.5 * k << ",0\n";
  }
  drive.close();
  fixes.close();
  const std::string model = (scratch.path() / "model.toml").string();
  std::ofstream(model) << "[robot]\ndrive = \"ackermann\"\nlength = 2.5\n";
  const Ran ran = run_trussmap("check " + folder.string() + " --model " + model);
  EXPECT_EQ(ran.status, 1) << ran.output;
  EXPECT_NE(ran.output.find("drive.csv, steer: angle unit"), std::string::npos) << ran.output;
  const Ran other = run_trussmap("apply " + folder.string() + " --model " + model + " --out " +
                                 (scratch.path() / "path.csv").string());
  EXPECT_EQ(other.status, 2) << other.output;
  EXPECT_NE(other.output.find("no way ahead"), std::string::npos) << other.output;
}

TEST(SlowCheckCommand, OtherCommandsWarn) {
  const ScratchFolder scratch;
  const std::string folder = with_wheels_exchanged(scratch);
  for (const std::string command : {"compare", "fit", "build", "calibrate"}) {
    const Ran ran = run_trussmap(command + " " + folder + " --model " + kNominal);
    EXPECT_NE(ran.output.find("warning: " + folder + "/drive.csv, left,right: wheels exchanged"),
              std::string::npos)
        << command << "\n"
        << ran.output;
    const Ran healthy = run_trussmap(command + " " + kRiddleFolder + " --model " + kNominal);
    EXPECT_EQ(healthy.output.find("remedy"), std::string::npos) << command << healthy.output;
  }
}

TEST(CheckCommand, AnswersThatCannotBeWrittenAreAFailure) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  for (const std::string& command :
       {"check " + kRiddleFolder, std::string("--help"), std::string("--version")}) {
    EXPECT_EQ(run_trussmap(command + " >/dev/full").status, 1) << command;
    EXPECT_EQ(run_trussmap(command + " >/dev/null").status, 0) << command;
  }
}

TEST(CheckCommand, AModelWithoutAWheelbaseIsNamed) {
  const ScratchFolder scratch;
  const std::string model = scratch.path().string() + "/model.toml";
  std::ofstream(model) << "[noise]\nleft = 0.003\n";
  const Ran ran = run_trussmap("check " + kRiddleFolder + " --model " + model);
  EXPECT_EQ(ran.status, 1) << ran.output;
  EXPECT_NE(ran.output.find(model + ", wheelbase: no wheelbase: "), std::string::npos)
      << ran.output;
}

}  // namespace
}  // namespace trussmap::check_command_test
