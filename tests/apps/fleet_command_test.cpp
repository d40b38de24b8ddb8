// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap fleet, as a user meets it.
#include "json_file.hpp"
#include "scratch_folder.hpp"
#include "trussmap/write_files.hpp"

#include <future>
#include <string>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

using testing::run_trussmap;
using testing::ScratchFolder;

TEST(FleetCommand, AddsMergesAndReports) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  for (int k = 1; k <= 3; ++k) {
    const std::string n = std::to_string(k);
    ASSERT_EQ(run_trussmap("simulate --mesh 3x3 --tours 2 --effect wheelbase=0.03 --seed " + n +
                           " --out " + at + "s" + n)
                  .status,
              0);
    const testing::Ran ran =
        run_trussmap("fleet add " + at + (k < 3 ? "a.db" : "b.db") + " R" + n + " " + at + "s" + n +
                     " --model " + at + "s1/model.toml --date 2026-03-01 --meta tyre=A");
    ASSERT_EQ(ran.status, 0) << ran.output;
  }
  const testing::Ran again = run_trussmap("fleet add " + at + "a.db R1 " + at + "s1 --model " + at +
                                          "s1/model.toml --date 2026-03-01");
  EXPECT_EQ(again.status, 2);
  EXPECT_NE(again.output.find("--replace"), std::string::npos) << again.output;
  ASSERT_EQ(run_trussmap("fleet merge " + at + "c.db " + at + "b.db " + at + "a.db").status, 0);
  const testing::Ran report =
      run_trussmap("fleet report " + at + "c.db --json " + at + "c.json --html " + at + "c.html");
  ASSERT_EQ(report.status, 0) << report.output;
  EXPECT_NE(report.output.find("3 robots, 3 days"), std::string::npos) << report.output;
  EXPECT_NE(report.output.find("wheelbase"), std::string::npos) << report.output;
  const auto json = testing::read_json(at + "c.json");
  EXPECT_EQ(json["robots"], 3);
  ASSERT_FALSE(json["findings"].empty());
  EXPECT_NE(read_file(at + "c.html").find("R3"), std::string::npos);
  for (const std::string& wrong :
       {"fleet add " + at + "a.db R9 " + at + "s1 --model " + at + "s1/model.toml --date today",
        "fleet add " + at + "a.db R9 " + at + "s1 --model " + at + "s1/model.toml --meta tyre",
        "fleet report " + at + "none.db", "fleet report " + at + "s1/drive.csv"}) {
    EXPECT_EQ(run_trussmap(wrong).status, 2) << wrong;
  }
}

TEST(FleetCommand, TwoThatAddAtOnceLoseNothing) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  ASSERT_EQ(run_trussmap("simulate --mesh 3x3 --tours 1 --seed 1 --out " + at + "s").status, 0);
  constexpr int kDays = 4;
  const auto complaints_of = [&at](const std::string& robot) {
    std::string complaints;
    for (int day = 1; day <= kDays; ++day) {
      const testing::Ran ran =
          run_trussmap("fleet add " + at + "f.db " + robot + " " + at + "s --model " + at +
                       "s/model.toml --date 2026-03-0" + std::to_string(day));
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
}  // namespace trussmap
