// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap fleet, as a user meets it.
#include "json_file.hpp"
#include "scratch_folder.hpp"
#include "trussmap/write_files.hpp"

#include <future>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace trussmap::fleet_command_test {
namespace {

using testing::run_trussmap;
using testing::ScratchFolder;

TEST(ContrastCommand, NamesWhatARepairChanged) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  for (const int k : {1, 2}) {
    const std::string draw =
        fmt::format("simulate --mesh 4x4 --tours 3 --effect wheelbase={1} --seed {2} --out {0}s{2}",
                    at, k == 1 ? "0.03" : "0", k);
    ASSERT_EQ(run_trussmap(draw).status, 0);
    const testing::Ran ran = run_trussmap(
        fmt::format("calibrate {0}s{1} --model {0}s1/model.toml --json {0}{1}.json", at, k));
    ASSERT_EQ(ran.status, 0) << ran.output;
  }
  const testing::Ran ran = run_trussmap(
      fmt::format("contrast {0}1.json {0}2.json --json {0}c.json --html {0}c.html", at));
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_EQ(ran.output.rfind("changed: wheelbase (+0.0", 0), 0U) << ran.output;
  const auto figures = testing::read_json(at + "c.json").at("figures");
  for (const auto& one : figures) {
    EXPECT_EQ(one.at("changed").get<bool>(), one.at("name") == "wheelbase") << one;
  }
  EXPECT_NE(read_file(at + "c.html").find("changed: wheelbase"), std::string::npos);
  const testing::Ran same = run_trussmap(fmt::format("contrast {0}1.json {0}1.json", at));
  EXPECT_EQ(same.output.rfind("nothing changed beyond chance", 0), 0U) << same.output;
  EXPECT_EQ(run_trussmap(fmt::format("contrast {0}1.json {0}c.json", at)).status, 2);
}

TEST(FleetCommand, AddsMergesAndReports) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  for (int k = 1; k <= 3; ++k) {
    const std::string draw = fmt::format(
        "simulate --mesh 3x3 --tours 2 --effect wheelbase=0.03 --seed {1} --out {0}s{1}", at, k);
    ASSERT_EQ(run_trussmap(draw).status, 0);
    const testing::Ran ran = run_trussmap(fmt::format(
        "fleet add {0}{2} R{1} {0}s{1} --model {0}s1/model.toml --date 2026-03-01 --meta tyre=A",
        at, k, k < 3 ? "a.db" : "b.db"));
    ASSERT_EQ(ran.status, 0) << ran.output;
  }
  const testing::Ran again = run_trussmap(
      fmt::format("fleet add {0}a.db R1 {0}s1 --model {0}s1/model.toml --date 2026-03-01", at));
  EXPECT_EQ(again.status, 2);
  EXPECT_NE(again.output.find("--replace"), std::string::npos) << again.output;
  ASSERT_EQ(run_trussmap(fmt::format("fleet merge {0}c.db {0}b.db {0}a.db", at)).status, 0);
  const testing::Ran report =
      run_trussmap(fmt::format("fleet report {0}c.db --json {0}c.json --html {0}c.html", at));
  ASSERT_EQ(report.status, 0) << report.output;
  EXPECT_NE(report.output.find("3 robots, 3 days"), std::string::npos) << report.output;
  EXPECT_NE(report.output.find("wheelbase"), std::string::npos) << report.output;
  const auto json = testing::read_json(at + "c.json");
  EXPECT_EQ(json["robots"], 3);
  ASSERT_FALSE(json["findings"].empty());
  EXPECT_NE(read_file(at + "c.html").find("R3"), std::string::npos);
  for (const char* wrong : {"fleet add {0}a.db R9 {0}s1 --model {0}s1/model.toml --date today",
                            "fleet add {0}a.db R9 {0}s1 --model {0}s1/model.toml --meta tyre",
                            "fleet report {0}none.db", "fleet report {0}s1/drive.csv"}) {
    EXPECT_EQ(run_trussmap(fmt::format(fmt::runtime(wrong), at)).status, 2) << wrong;
  }
}

TEST(FleetCommand, TwoThatAddAtOnceLoseNothing) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  ASSERT_EQ(
      run_trussmap(fmt::format("simulate --mesh 3x3 --tours 1 --seed 1 --out {}s", at)).status, 0);
  constexpr int kDays = 4;
  const auto complaints_of = [&at](const std::string& robot) {
    std::string complaints;
    for (int day = 1; day <= kDays; ++day) {
      const testing::Ran ran = run_trussmap(
          fmt::format("fleet add {0}f.db {1} {0}s --model {0}s/model.toml --date 2026-03-0{2}", at,
                      robot, day));
      if (ran.status != 0) complaints += ran.output;
    }
    return complaints;
  };
  // Each call is a process of its own.
  auto other = std::async(std::launch::async, complaints_of, "R2");
  EXPECT_EQ(complaints_of("R1"), "");
  EXPECT_EQ(other.get(), "");
  const testing::Ran report = run_trussmap("fleet report " + at + "f.db");
  EXPECT_NE(report.output.find("2 robots, 8 days"), std::string::npos) << report.output;
}

}  // namespace
}  // namespace trussmap::fleet_command_test
