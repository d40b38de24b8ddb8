// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
// trussmap plan, and simulate --plan: from a recording that leaves something open to one that does
// not; hostile plans.
#include "json_file.hpp"
#include "scratch_folder.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::plan_command_test {
namespace {

using nlohmann::json;
using testing::Ran;
using testing::read_json;
using testing::run_trussmap;
using testing::ScratchFolder;

const char* const kWorld = "simulate --mesh 3x3 --seed 5 --effect 'travel scale=0.006' ";

/// Driven at one speed, a robot that travels 0.6 % too far looks as if that went with the speed.
TEST(SlowPlanCommand, DecidesWhatARecordingLeavesOpen) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  ASSERT_EQ(run_trussmap(kWorld + ("--tours 2 --speeds 0.5,0.5 --out " + at + "one")).status, 0);
  const std::string judged = " --model " + at + "one/model.toml --json ";
  const Ran planned =
      run_trussmap("plan " + at + "one" + judged + at + "plan.json --out " + at + "next.csv");
  ASSERT_EQ(planned.status, 0) << planned.output;
  const json plan = read_json(scratch.path() / "plan.json");
  EXPECT_EQ(plan["verdict"], "enough");
  EXPECT_GE(plan["power"].get<double>(), 0.95);
  EXPECT_LT(plan["length_m"].get<double>(), 100.0);
  EXPECT_GT(plan["waypoints"].size(), 2U);
  const json geo = read_json(scratch.path() / "next.geojson");
  EXPECT_EQ(geo["features"].size(), 2 * plan["waypoints"].size() - 1);

  ASSERT_EQ(run_trussmap(kWorld + ("--plan " + at + "next.csv --out " + at + "two")).status, 0);
  const Ran both = run_trussmap("diagnose " + at + "one " + at + "two" + judged + at + "both.json");
  ASSERT_EQ(both.status, 0) << both.output;
  EXPECT_EQ(read_json(scratch.path() / "both.json")["missing"], "travel scale");
}

TEST(PlanCommand, IsDrivenWaypointByWaypoint) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  scratch.write("p.csv",
                "landmark,number,x,y,heading,speed,bend,turn,turn_rate,stop_s\n"
                "dock,1,0,0,0,0,0,0,0,0\nshelf,2,3,0,1.5708,0.5,0,1.5708,0.5,2\n"
                "door,3,3,4,1.5708,0.8,0,0,0,0\n");
  const Ran ran = run_trussmap("simulate --noise-free --plan " + at + "p.csv --out " + at +
                               "a --json " + at + "a.json");
  ASSERT_EQ(ran.status, 0) << ran.output;
  const json report = read_json(scratch.path() / "a.json");
  EXPECT_NEAR(report["length_m"].get<double>(), 7.0, 1e-9);
  // 3 m at 0.5 m/s, 2 s, a quarter turn at 0.5 rad/s, 4 m at 0.8 m/s; whole rows of 0.1 s.
  EXPECT_NEAR(report["duration_s"].get<double>(), 6.0 + 2.0 + 3.1416 + 5.0, 0.2);
  const std::string sightings = scratch.contents().at("a/sightings.csv");
  EXPECT_LT(sightings.find("dock"), sightings.find("shelf"));
  EXPECT_LT(sightings.find("shelf"), sightings.find("door"));
}

struct Hostile {
  const char* rows;
  const char* complaint;
};

TEST(PlanCommand, HostilePlansGiveOneLineAndStatusTwo) {
  const std::string header = "number,landmark,x,y,heading,speed,bend,turn,turn_rate,stop_s";
  const std::string good = "\n1,a,0,0,0,0,0,0,0,0\n2,b,3,0,0,0.5,0,0,0,0\n";
  const std::vector<Hostile> all = {
      {"", "is empty"},
      {"number,landmark\n1,a\n", "x"},
      {"H\n1,a,0,0,0,0,0,0,0,0\n", "two or more"},
      {"H\n1,a,0,0,0,0,0,0,0,0\n3,b,3,0,0,0.5,0,0,0,0\n", "number is 3, expected 2"},
      {"H\n1,a,0,0,0,0,0,0,0,0\n2,a,3,0,0,0.5,0,0,0,0\n", "expected another"},
      {"H\n1,a,0,0,0,0,0,0,0,0\n2,,3,0,0,0.5,0,0,0,0\n", "landmark is empty"},
      {"H\n1,a,0,0,0,0,0,0,0,0\n2,b,3,0,0,0,0,0,0,0\n", "speed is 0"},
      {"H\n1,a,0,0,0,0,0,0,0,0\n2,b,3,0,0,-1,0,0,0,0\n", "speed is -1"},
      {"H\n1,a,0,0,0,0,0,0,0,0\n2,b,nan,0,0,1,0,0,0,0\n", "nan"},
      {"H\n1,a,0,0,0,0,0,0,0,0\n2,b,1e99,0,0,1,0,0,0,0\n", "1e99"},
      {"H\n1,a,0,0,0,0,0,0,0,0\n2,b,0,0,0,1,0,0,0,0\n", "another place"},
      {"H\n1,a,0,0,0,0,0,3,0,0\n2,b,3,0,0,1,0,0,0,0\n", "turn_rate is 0"},
      {"H\n1,a,0,0,0,0,0,0,0,-1\n2,b,3,0,0,1,0,0,0,0\n", "stop_s is -1"},
      {"H\n1,a,0,0,0,0,0,0,0,0\n2,b,3,0,0,1,45,0,0,0\n", "degrees"},
      {"H\n1,a,0,0,0,0,0,0,0,0\n2,b,3,0,0,1,0,0,0\n", "fields"},
      {"H,2 loads\n1,a,0,0,0,0,0,0,0,0,1\n2,b,3,0,0,1,0,0,0,0,1\n", "2 loads"}};
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  for (const Hostile& one : all) {
    std::string text = one.rows;
    if (const std::size_t place = text.find('H'); place == 0) text.replace(0, 1, header);
    scratch.write("p.csv", text);
    const Ran ran = run_trussmap("simulate --plan " + at + "p.csv --out " + at + "out");
    EXPECT_EQ(ran.status, 2) << text << ran.output;
    EXPECT_NE(ran.output.find("p.csv"), std::string::npos) << ran.output;
    EXPECT_NE(ran.output.find(one.complaint), std::string::npos) << text << ran.output;
    EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
    EXPECT_FALSE(std::filesystem::exists(scratch.path() / "out")) << text;
  }
  scratch.write("p.csv", header + good);
  EXPECT_EQ(run_trussmap("simulate --plan " + at + "p.csv --out " + at + "out").status, 0);
  const Ran other = run_trussmap("simulate --mesh 2x2 --plan " + at + "p.csv --out " + at + "x");
  EXPECT_EQ(other.status, 2);
  EXPECT_NE(other.output.find("none of the mesh"), std::string::npos) << other.output;
}

TEST(PlanCommand, AsksForARecordingOrAMap) {
  for (const char* call : {"plan", "plan --mesh 3x3 --map a.graphml", "plan a --mesh 3x3", "plan a",
                           "plan --mesh 3x3 --rivals 'wheelbase, turn scrub'"}) {
    const Ran ran = run_trussmap(call);
    EXPECT_EQ(ran.status, 2) << call;
    EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
  }
}

}  // namespace
}  // namespace trussmap::plan_command_test
