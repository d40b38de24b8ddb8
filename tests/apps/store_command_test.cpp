// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// build --store and convert with a store, as a user meets them.
#include "child_process.hpp"
#include "command_path.hpp"
#include "json_file.hpp"
#include "scratch_folder.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/map_store.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::store_command_test {
namespace {

namespace fs = std::filesystem;
using testing::run_trussmap;
using testing::ScratchFolder;

/// Folders s0, s1, ... of sessions on one mesh.
void simulate(const ScratchFolder& scratch, int sessions) {
  for (int k = 0; k < sessions; ++k) {
    const std::string folder = (scratch.path() / ("s" + std::to_string(k))).string();
    ASSERT_EQ(run_trussmap("simulate --mesh 3x3 --tours 1 --seed " + std::to_string(k + 1) +
                           " --out " + folder)
                  .status,
              0);
  }
}

TEST(StoreCommand, AddsSessionsOnceAndKeepsThem) {
  const ScratchFolder scratch;
  simulate(scratch, 3);
  const std::string at = scratch.path().string() + "/";
  const std::string model = " --model " + at + "s0/model.toml";
  const std::string store = " --store " + at + "map.db";
  ASSERT_EQ(run_trussmap("build " + at + "s0 " + at + "s1" + model + store).status, 0);
  const testing::Ran again =
      run_trussmap("build " + at + "s1 " + at + "s2" + model + store + " --out " + at +
                   "map.graphml --json " + at + "map.json --csv " + at + "map.csv");
  ASSERT_EQ(again.status, 0) << again.output;
  EXPECT_NE(again.output.find("s1: is in the store already, nothing added\n"), std::string::npos)
      << again.output;

  const StoredMap stored = read_map_store(at + "map.db");
  ASSERT_EQ(stored.sessions.size(), 3U);
  EXPECT_EQ(stored.sessions[2].name, at + "s2");
  EXPECT_EQ(stored.method, Method::gauss_markov);
  EXPECT_EQ(format_map_graphml(read_map_graphml(at + "map.graphml")),
            format_map_graphml(stored.map));
  const auto json = testing::read_json(at + "map.json");
  EXPECT_EQ(json["sessions"], 3);
  EXPECT_EQ(json["legs"], stored.legs);
  ASSERT_EQ(json["added"].size(), 1U);
  EXPECT_EQ(json["added"][0]["recording"], at + "s2");

  for (const std::string& wrong :
       {std::string(" --method elastic"), std::string(" --method adjustment"),
        std::string(" --svg map.svg"), " --json " + at + "map.db"}) {
    const testing::Ran ran = run_trussmap("build " + at + "s0" + model + store + wrong);
    EXPECT_EQ(ran.status, 2) << wrong << ran.output;
  }
  EXPECT_EQ(run_trussmap("build " + at + "s0" + model + " --store " + at + "s0/drive.csv").status,
            2);
  EXPECT_EQ(read_map_store(at + "map.db").legs, stored.legs);
}

TEST(StoreCommand, ConvertsInAndOut) {
  const ScratchFolder scratch;
  simulate(scratch, 1);
  const std::string at = scratch.path().string() + "/";
  ASSERT_EQ(run_trussmap("build " + at + "s0 --model " + at +
                         "s0/model.toml --method elastic --out " + at + "a.graphml")
                .status,
            0);
  ASSERT_EQ(run_trussmap("convert " + at + "a.graphml " + at + "a.db").status, 0);
  ASSERT_EQ(run_trussmap("convert " + at + "a.db " + at + "b.graphml").status, 0);
  EXPECT_EQ(format_map_graphml(read_map_graphml(at + "a.graphml")),
            format_map_graphml(read_map_graphml(at + "b.graphml")));
  const testing::Ran twice = run_trussmap("convert " + at + "a.graphml " + at + "a.db");
  EXPECT_EQ(twice.status, 2);
  EXPECT_NE(twice.output.find("a.db: is there already, expected a new file"), std::string::npos)
      << twice.output;
  EXPECT_EQ(run_trussmap("convert " + at + "none.db " + at + "c.graphml").status, 2);
  EXPECT_FALSE(fs::exists(at + "none.db"));
}

std::string content_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// The command, its output going to a file, killed so long after it has said so many lines.
std::string output_until_killed(const std::vector<std::string>& arguments, const fs::path& output,
                                int lines, int microseconds) {
  std::vector<char*> argv;
  std::string command = testing::command_path();
  argv.push_back(command.data());
  std::vector<std::string> copies = arguments;
  for (std::string& one : copies) argv.push_back(one.data());
  argv.push_back(nullptr);
  const testing::ChildProcess child([&] {
    const int file = ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    ::execv(command.c_str(), argv.data());
  });
  const auto said = [&] {
    const std::string text = content_of(output);
    return std::count(text.begin(), text.end(), '\n');
  };
  for (int ms = 0; ms < 2000 && said() < lines; ++ms) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
  child.kill();
  return content_of(output);
}

/// What the command has said is kept, whole sessions alone are, and the next run goes on.
TEST(SlowStoreCommand, KillLosesNothingThatWasAcknowledged) {
  const ScratchFolder scratch;
  constexpr int kSessions = 8;
  constexpr int kKills = 60;
  simulate(scratch, kSessions);
  const fs::path store = scratch.path() / "map.db";
  std::vector<std::string> arguments{"build"};
  for (int k = 0; k < kSessions; ++k) {
    arguments.push_back((scratch.path() / ("s" + std::to_string(k))).string());
  }
  arguments.insert(arguments.end(), {"--model", (scratch.path() / "s0" / "model.toml").string(),
                                     "--store", store.string()});
  std::mt19937 random(14);
  std::size_t acknowledged = 0;
  int partly = 0;
  for (int kill = 0; kill < kKills; ++kill) {
    if (acknowledged == kSessions) {
      for (const char* ending : {"", "-wal", "-shm"}) fs::remove(store.string() + ending);
      acknowledged = 0;
    }
    fs::remove(scratch.path() / "output");
    const int lines = std::uniform_int_distribution<int>(0, 8)(random);
    const int moment = std::uniform_int_distribution<int>(0, 20000)(random);
    const std::string said =
        output_until_killed(arguments, scratch.path() / "output", lines, moment);
    for (std::size_t at = 0; (at = said.find(" legs, ", at)) != std::string::npos; ++at) {
      ++acknowledged;
    }
    if (!fs::exists(store)) {
      ASSERT_EQ(acknowledged, 0U);
      continue;
    }
    const MapStore opened(store);
    const std::vector<StoredSession> sessions = opened.sessions();
    ASSERT_GE(sessions.size(), acknowledged) << said;
    ASSERT_LE(sessions.size(), acknowledged + 1) << said;
    acknowledged = sessions.size();
    std::int64_t legs = 0;
    for (const StoredSession& one : sessions) {
      ASSERT_EQ(one.first_leg, legs);
      ASSERT_GT(one.legs, 10);
      legs += one.legs;
    }
    ASSERT_EQ(opened.legs(), legs);
    if (acknowledged > 0 && acknowledged < kSessions) ++partly;
  }
  EXPECT_GT(partly, kKills / 6) << "killed too early or too late to prove anything";
}

}  // namespace
}  // namespace trussmap::store_command_test
