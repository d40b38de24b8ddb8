// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap umbmark and trussmap noise as a user meets them.
#include "json_file.hpp"
#include "scratch_folder.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/umbmark.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::calibration_command_test {
namespace {

using nlohmann::json;
using testing::Ran;
using testing::read_json;
using testing::run_trussmap;
using testing::ScratchFolder;

const std::vector<std::string> kUmbmarkKeys = {
    "alpha_rad", "beta_rad",    "E_d",          "E_b",   "c_left",
    "c_right",   "wheelbase_m", "E_max_syst_m", "sem_m", "second_round_worthwhile"};

/// Chong & Kleeman's centres before calibration, as four runs each 10 mm off.
constexpr const char* kRuns =
    "# end errors, m\ndirection,x,y\ncw,0.042,0.031\ncw,0.022,0.031\ncw,0.032,0.041\n"
    "cw,0.032,0.021\nccw,0.107,-0.094\nccw,0.087,-0.094\nccw,0.097,-0.084\nccw,0.097,-0.104\n";

TEST(UmbmarkCommand, WritesWhatTheFormatsPromise) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  const std::string runs = scratch.write("runs.csv", kRuns).string();
  const Ran ran = run_trussmap("umbmark " + runs + " --side 4 --wheelbase 0.5 --out " + at +
                               "/m.toml --json " + at + "/u.json --plots " + at + "/plots");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_EQ(ran.output.rfind("worth correcting", 0), 0U) << ran.output;
  const json result = read_json(scratch.path() / "u.json");
  for (const std::string& key : kUmbmarkKeys) {
    EXPECT_TRUE(result.contains(key)) << key;
    EXPECT_TRUE(result["exact"].contains(key)) << key;
  }
  EXPECT_NEAR(result["alpha_rad"].get<double>(), -0.0079375, 1e-12);
  EXPECT_NEAR(result["beta_rad"].get<double>(), 0.004, 1e-12);
  EXPECT_NEAR(result["E_d"].get<double>(), 1.0005001246977578, 1e-12);
  EXPECT_NEAR(result["E_b"].get<double>(), 0.994972236696724, 1e-12);
  EXPECT_NEAR(result["wheelbase_m"].get<double>(), 0.5 * 0.994972236696724, 1e-12);
  EXPECT_NEAR(result["E_max_syst_m"].get<double>(), 0.13507405376311175, 1e-12);
  // Coordinates +10, -10, 0, 0 mm: variance 200/3 mm^2, over four runs.
  EXPECT_NEAR(result["sem_m"].get<double>(), 1e-3 * std::sqrt(200.0 / 3.0 / 4.0), 1e-12);
  EXPECT_TRUE(result["second_round_worthwhile"].get<bool>());

  // The wheelbase stands in [robot], once.
  const Model model = read_model(scratch.path() / "m.toml");
  const GeometryErrors written = geometry_errors(model);
  EXPECT_NEAR(written.diameter_ratio, result["exact"]["E_d"].get<double>(), 1e-14);
  EXPECT_EQ(written.wheelbase_ratio, 1.0);
  EXPECT_NEAR(model.robot.wheelbase, 0.5 * result["exact"]["E_b"].get<double>(), 1e-14);
  for (const json& one : result["constants"]) {
    const std::string name = one["name"];
    const char* key = name == "wheelbase"    ? "wheelbase_m"
                      : name == "left wheel" ? "c_left"
                                             : "c_right";
    EXPECT_NEAR(one["new"].get<double>(), result["exact"][key].get<double>(), 1e-12) << name;
    EXPECT_NEAR(one["sd"].get<double>(), result["exact"][std::string("sd_") + key].get<double>(),
                1e-6 * one["sd"].get<double>())
        << name;
  }
  EXPECT_EQ(result["constants"].size(), 3U);
  EXPECT_NE(scratch.contents().at("plots/umbmark.svg").find("</svg>"), std::string::npos);
}

TEST(UmbmarkCommand, RoundsMultiplyWhetherTogetherOrThroughAModel) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  const std::string rehearsal =
      "umbmark --simulate --true-E-d 1.004 --true-E-b 1.02 --scatter 0.005 --solution formulas ";
  ASSERT_EQ(run_trussmap(rehearsal + "--rounds 2 --seed 3 --write " + at + "/r.csv --json " + at +
                         "/both.json")
                .status,
            0);
  const std::string given = "--wheelbase 0.34 --solution formulas ";
  ASSERT_EQ(run_trussmap("umbmark " + at + "/r.csv " + at + "/r_2.csv " + given + "--json " + at +
                         "/again.json --out " + at + "/both.toml")
                .status,
            0);
  EXPECT_EQ(read_json(scratch.path() / "both.json"), read_json(scratch.path() / "again.json"));
  ASSERT_EQ(run_trussmap("umbmark " + at + "/r.csv " + given + "--out " + at + "/1.toml").status,
            0);
  ASSERT_EQ(run_trussmap("umbmark " + at + "/r_2.csv --solution formulas --model " + at +
                         "/1.toml --out " + at + "/2.toml")
                .status,
            0);
  const auto total = [&](const char* file) {
    return geometry_errors(read_model(scratch.path() / file));
  };
  EXPECT_NEAR(total("both.toml").diameter_ratio, total("2.toml").diameter_ratio, 1e-13);
  const auto wheelbase = [&](const char* file) {
    return read_model(scratch.path() / file).robot.wheelbase;
  };
  EXPECT_NEAR(wheelbase("both.toml"), wheelbase("2.toml"), 1e-13);
  EXPECT_NEAR(total("2.toml").diameter_ratio, 1.004, 2e-4);
  EXPECT_NEAR(wheelbase("2.toml"), 0.34 * 1.02, 4e-4);
  const json result = read_json(scratch.path() / "both.json");
  ASSERT_EQ(result["rounds"].size(), 2U);
  EXPECT_LT(result["E_max_syst_m"].get<double>(),
            0.1 * result["rounds"][0]["E_max_syst_m"].get<double>());
  EXPECT_NEAR(result["c_left"].get<double>() + result["c_right"].get<double>(), 2.0, 1e-12);
}

TEST(NoiseCommand, WritesWhatTheFormatsPromise) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  ASSERT_EQ(run_trussmap("noise --simulate --true-k-left 0.0004 --true-k-right 0.00058 --runs 400 "
                         "--wheelbase 0.5 --seed 2 --write " +
                         at + "/r.csv")
                .status,
            0);
  scratch.write("m.toml",
                "[robot]\nwheelbase = 0.5\n[[effect]]\nname = \"mine\"\nchannel = \"turn\"\n"
                "shape = [\"speed\"]\n");
  const Ran ran =
      run_trussmap("noise " + at + "/r.csv --path 10,-10 --model " + at + "/m.toml --out " + at +
                   "/n.toml --json " + at + "/n.json --plots " + at + "/plots --sensor-sd 0,0,0");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_EQ(ran.output.rfind("the wheels' noise explains", 0), 0U) << ran.output;
  const json result = read_json(scratch.path() / "n.json");
  EXPECT_EQ(result["runs"], 400);
  // Four standard errors of 400 runs, the bounds of 60 runs over sqrt(400/60).
  EXPECT_NEAR(result["k_left"].get<double>(), 0.0004, 4 * 1.37e-5);
  EXPECT_NEAR(result["k_right"].get<double>(), 0.00058, 4 * 1.73e-5);
  EXPECT_NEAR(result["sd_k_left"].get<double>(), 1.37e-5, 1e-6);
  EXPECT_NEAR(result["sd_k_right"].get<double>(), 1.73e-5, 1e-6);
  const Model model = read_model(scratch.path() / "n.toml");
  EXPECT_EQ(model.noise.left, result["k_left"].get<double>());
  EXPECT_EQ(model.noise.right, result["k_right"].get<double>());
  ASSERT_EQ(model.effects.size(), 1U);  // what the model said otherwise is kept
  EXPECT_EQ(model.effects[0].name, "mine");
  EXPECT_NE(scratch.contents().at("plots/noise.svg").find("</svg>"), std::string::npos);
}

TEST(CalibrationCommands, BadInputNamesFileAndLineAndWritesNothing) {
  const ScratchFolder scratch;
  struct Bad {
    const char* command;
    const char* content;
    const char* said;
  };
  const std::string square = "umbmark --wheelbase 0.34";
  const std::string noise = "noise --wheelbase 0.34";
  const Bad all[] = {
      {"umbmark", "", "bad.csv"},
      {"umbmark", "direction,x\ncw,1\n", "bad.csv:1"},
      {"umbmark", "direction,x,y\ncw,0.1,0.2\nleft,0.1,0.2\n", "bad.csv:3: direction is \"left\""},
      {"umbmark", "direction,x,y\ncw,0.1,abc\n", "bad.csv:2"},
      {"umbmark", "direction,x,y\ncw,0.1,nan\n", "bad.csv:2"},
      {"umbmark", "direction,x,y\ncw,0.1,0.1\ncw,0.2,0.1\n", "no run in direction ccw"},
      {"umbmark", "direction,x,y\ncw,0.1,0.1\ncw,0.2,0.1\nccw,0.1,0.1\n", "1 run in direction ccw"},
      {"umbmark", "direction,x,y\ncw,32,31\ncw,97,94\n", "bad.csv:2: x is 32 m"},
      {"noise", "x,y\n0.1,0.2\n", "bad.csv:1"},
      {"noise", "x,y,heading\n0.1,0.2,0.01\n", "1 run, expected two"},
      {"noise", "x,y,heading\n0.1,0.2,0.01\n0.1,45,0.01\n", "bad.csv:3: y is 45 m"}};
  for (const Bad& bad : all) {
    const std::string file = scratch.write("bad.csv", bad.content).string();
    const std::string command = bad.command == std::string("umbmark") ? square : noise;
    const Ran ran = run_trussmap(command + " " + file + " --out " + scratch.path().string() +
                                 "/m.toml --plots " + scratch.path().string() + "/plots");
    EXPECT_EQ(ran.status, 2) << bad.content << ran.output;
    EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
    EXPECT_NE(ran.output.find(bad.said), std::string::npos) << ran.output;
    EXPECT_EQ(scratch.contents().size(), 1U) << bad.content;
  }
}

TEST(CalibrationCommands, BadUsageEndsWithStatus2AndOneLine) {
  const ScratchFolder scratch;
  const std::string runs = scratch.write("runs.csv", kRuns).string();
  const std::vector<std::string> bad = {"umbmark",
                                        "umbmark " + runs,
                                        "umbmark --simulate " + runs,
                                        "umbmark --wheelbase 0.3 --runs 4 " + runs,
                                        "umbmark --wheelbase 0 " + runs,
                                        "umbmark --wheelbase 0.3 --side -1 " + runs,
                                        "umbmark --simulate --true-E-d 0",
                                        "noise --simulate --path 10,x",
                                        "noise --simulate --path 0",
                                        "noise --simulate --sensor-sd 1,2",
                                        "noise --simulate --sensor-sd 1,2,-3"};
  for (const std::string& arguments : bad) {
    const Ran ran = run_trussmap(arguments);
    EXPECT_EQ(ran.status, 2) << arguments << "\n" << ran.output;
    EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
  }
  // No scatter at all: a failed run, not bad usage.
  EXPECT_EQ(run_trussmap("noise --simulate").status, 1);
  for (const char* command : {"umbmark --help", "noise --help"}) {
    EXPECT_EQ(run_trussmap(command).status, 0);
  }
}

TEST(CalibrationCommands, ExchangedLabelsAreAWarningAboutTheRunsGiven) {
  const ScratchFolder scratch;
  std::string text = kRuns;
  for (std::size_t at = text.find("\ncw,"); at != std::string::npos; at = text.find("\ncw,", at)) {
    text.replace(at, 4, "\nCCW,");
  }
  for (std::size_t at = text.find("\nccw,"); at != std::string::npos;
       at = text.find("\nccw,", at)) {
    text.replace(at, 5, "\ncw,");
  }
  for (std::size_t at = text.find("CCW"); at != std::string::npos; at = text.find("CCW", at)) {
    text.replace(at, 3, "ccw");
  }
  const std::string runs = scratch.write("runs.csv", text).string();
  const Ran ran = run_trussmap("umbmark --wheelbase 0.5 " + runs);
  EXPECT_EQ(ran.status, 0);
  EXPECT_NE(ran.output.find("warning: x and y contradict"), std::string::npos) << ran.output;
}

const std::string kMaps = TRUSSMAP_SOURCE_DIR "/maps/";

TEST(UmbmarkCommand, TakesDistancesToWallsForTheEnds) {
  // The robot of maps/make_wall_runs.py, which shares nothing with this program.
  const ScratchFolder scratch;
  const std::string out = (scratch.path() / "w.json").string();
  const Ran ran = run_trussmap("umbmark " + kMaps + "wall_runs.csv --wall-sensors " + kMaps +
                               "wall_sensors.csv --wheelbase 0.34 --json " + out);
  ASSERT_EQ(ran.status, 0) << ran.output;
  const json result = read_json(out);
  const json& exact = result["exact"];
  EXPECT_NEAR(exact["E_d"].get<double>(), 1.0008, 4.0 * exact["sd_E_d"].get<double>());
  EXPECT_NEAR(exact["E_b"].get<double>(), 0.989, 4.0 * exact["sd_E_b"].get<double>());
  const json& headings = result["headings"];
  EXPECT_NEAR(headings["E_d"].get<double>(), 1.0008, 4.0 * headings["sd_E_d"].get<double>());
  EXPECT_NEAR(headings["E_b"].get<double>(), 0.989, 4.0 * headings["sd_E_b"].get<double>());
  EXPECT_GT(headings["p_value"].get<double>(), 0.01);
  EXPECT_NE(ran.output.find("headings"), std::string::npos) << ran.output;
}

TEST(UmbmarkCommand, HeadingsThatContradictPositionsAreAWarning) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  ASSERT_EQ(run_trussmap("umbmark --simulate --true-E-d 1.002 --true-E-b 0.98 --scatter 0.005 "
                         "--scatter-heading 0.002 --seed 2 --write " +
                         at + "/r.csv")
                .status,
            0);
  const Ran good = run_trussmap("umbmark --wheelbase 0.34 " + at + "/r.csv");
  EXPECT_EQ(good.output.find("warning"), std::string::npos) << good.output;
  std::string text = scratch.contents().at("r.csv");
  ASSERT_EQ(text.rfind("direction,x,y,heading\n", 0), 0U) << text;
  text.replace(0, text.find('\n'), "direction,y,x,heading");  // and so both axes are exchanged
  const Ran bad = run_trussmap("umbmark --wheelbase 0.34 " + scratch.write("b.csv", text).string());
  EXPECT_NE(bad.output.find("warning: headings and positions contradict"), std::string::npos)
      << bad.output;
}

TEST(UmbmarkCommand, StraightRunsMakeTheScalePartOfTheResult) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  const std::string truth = "--true-E-d 1.003 --true-E-b 0.98 --true-E-s 1.02 ";
  ASSERT_EQ(run_trussmap("umbmark --simulate " + truth + "--scatter 0.002 --rounds 2 --json " + at +
                         "/s.json --write " + at + "/r.csv --out " + at + "/m.toml")
                .status,
            0);
  const json result = read_json(scratch.path() / "s.json");
  const json& first = result["rounds"][0];
  EXPECT_NEAR(first["E_s"].get<double>(), 1.02, 6.0 * first["sd_E_s"].get<double>());
  EXPECT_NEAR(first["exact"]["E_b"].get<double>(), 0.98, 1e-3);
  EXPECT_EQ(result["E_s"], 1.0);  // corrected by then
  EXPECT_NEAR(result["sd_E_s"].get<double>(), first["sd_E_s"].get<double>() / 1.02, 1e-5);
  const GeometryErrors written = geometry_errors(read_model(scratch.path() / "m.toml"));
  EXPECT_NEAR(written.scale, first["E_s"].get<double>(), 1e-12);
  EXPECT_NEAR(written.diameter_ratio, 1.003, 3e-4);

  const Ran ran = run_trussmap("umbmark " + at +
                               "/r.csv --wheelbase 0.34 --straight "
                               "10.2:10,5.1:5 --json " +
                               at + "/g.json");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("E_s = 1.02"), std::string::npos) << ran.output;
  // What the squares say of E_d and of E_b / E_s is theirs.
  const Ran bare =
      run_trussmap("umbmark " + at + "/r.csv --wheelbase 0.34 --json " + at + "/b.json");
  EXPECT_EQ(bare.output.find("E_s"), std::string::npos) << bare.output;
  const json with = read_json(scratch.path() / "g.json")["exact"];
  const json without = read_json(scratch.path() / "b.json")["exact"];
  EXPECT_NEAR(with["E_b"].get<double>() / 1.02, without["E_b"].get<double>(), 2e-3);
  EXPECT_NEAR(with["c_left"].get<double>() + with["c_right"].get<double>(), 2.04, 1e-3);
}

TEST(UmbmarkCommand, SaysWhatAnotherPathAloneWouldHide) {
  const ScratchFolder scratch;
  const std::string out = (scratch.path() / "a.json").string();
  const Ran ran = run_trussmap("umbmark " + kMaps +
                               "square_runs.csv --wheelbase 0.34 --alone eight@1.5 --alone "
                               "\"4,a90,4,a90,4,a90,4,a90\" --json " +
                               out);
  ASSERT_EQ(ran.status, 0) << ran.output;
  const json alone = read_json(out)["alone"];
  ASSERT_EQ(alone.size(), 2U);
  EXPECT_EQ(alone[0]["path"], "eight@1.5");
  EXPECT_LT(alone[0]["end_tuned_m"].get<double>(), 0.01);
  EXPECT_GT(alone[0]["square_cw_tuned_m"].get<double>(), 0.08);  // 2 sqrt(2) L beta, 0.11 m
  // The square turning left is what the text has always told of: 0.304 m to 0.000 m, cw 0.224 m.
  EXPECT_NE(ran.output.find("until 0.304 m became 0.000 m; cw, 0.224"), std::string::npos);
  EXPECT_NEAR(alone[1]["end_m"].get<double>(), 0.304, 5e-4);
  EXPECT_NEAR(alone[1]["square_cw_tuned_m"].get<double>(), 0.224, 5e-4);
}

TEST(NoiseCommand, JudgesAKThatIsStated) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  ASSERT_EQ(run_trussmap("noise --simulate --true-k-left 0.0004 --true-k-right 0.00058 "
                         "--wheelbase 0.5 --seed 3 --write " +
                         at + "/r.csv")
                .status,
            0);
  const auto judge = [&](const std::string& k, const std::string& further = "") {
    return run_trussmap("noise " + at + "/r.csv --wheelbase 0.5 --k " + k + " --json " + at +
                        "/k.json " + further);
  };
  const Ran ran = judge("0.0004,0.00058", "--plots " + at + "/plots --html " + at + "/k.html");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("the runs allow it"), std::string::npos) << ran.output;
  const json stated = read_json(scratch.path() / "k.json")["stated"];
  EXPECT_GT(stated["p_value"].get<double>(), 0.01);
  ASSERT_EQ(stated["within"].size(), 4U);
  EXPECT_EQ(stated["within"][0]["coordinates"], "x-y");
  const std::string picture = scratch.contents().at("plots/noise.svg");
  EXPECT_NE(picture.find("1, 2, 3 sigma"), std::string::npos);
  EXPECT_NE(scratch.contents().at("k.html").find("By the k stated"), std::string::npos);
  const Ran wrong = judge("0.0012,0.00058");
  EXPECT_NE(wrong.output.find("the runs contradict it"), std::string::npos) << wrong.output;
  EXPECT_EQ(judge("0,0.1").status, 2);
  EXPECT_EQ(judge("0.1").status, 2);
}

TEST(CalibrationCommands, BadWallDistancesAndStraightRunsNameWhatIsWrong) {
  const ScratchFolder scratch;
  const std::string columns =
      "start1,start2,start3,end1,end2,end3,odometry_x,odometry_y,odometry_heading\n";
  const std::string good = "1,1,1,1,1,1,0,0,0\n";
  const std::string sensors = "faces,x,y\nleft,0.2,0\nleft,-0.2,0\nahead,0,0\n";
  struct Bad {
    std::string runs;
    std::string sensors;
    const char* said;
  };
  const Bad all[] = {
      {columns + good + "1,1,1,1,1.6,1,0,0,0\n", sensors, "runs.csv:3: the distances of the two"},
      {columns + good + "1,1,1,1,1.35,1,0,0,0\n", sensors, "runs.csv:3: the distances say that"},
      {columns + good + "1,-1,1,1,1,1,0,0,0\n", sensors, "runs.csv:3: start2 is -1"},
      {columns + good + "1,1,1,1,1,900,0,0,0\n", sensors, "runs.csv:3: x of the end error is"},
      {columns + good, sensors, "1 run, expected two"},
      {"x,y,heading\n0,0,0\n", sensors, "odometry_x"},
      {columns + good, "faces,x,y\nleft,0.2,0\nup,-0.2,0\n", "sensors.csv:3: faces is \"up\""},
      {columns + good, "faces,x,y\nleft,0.2,0\nleft,-0.2,0\n", "2 sensors, expected three"},
      {columns + good, "faces,x,y\nleft,0.2,0\nahead,0,0\nright,0,0\n", "no two sensors face"}};
  for (const Bad& bad : all) {
    const std::string runs = scratch.write("runs.csv", bad.runs).string();
    const std::string where = scratch.write("sensors.csv", bad.sensors).string();
    const Ran ran = run_trussmap("noise --wheelbase 0.34 " + runs + " --wall-sensors " + where);
    EXPECT_EQ(ran.status, 2) << bad.runs << ran.output;
    EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
    EXPECT_NE(ran.output.find(bad.said), std::string::npos) << ran.output;
  }
  const std::string walls = scratch.write("walls.csv", columns + good).string();
  const std::string where = scratch.write("sensors.csv", sensors).string();
  const std::string squares = scratch.write("squares.csv", kRuns).string();
  const std::string turned =
      scratch.write("turned.csv", "direction,x,y,heading\ncw,0.1,0.1,4.6\n").string();
  const std::vector<std::pair<std::string, std::string>> usage = {
      {"noise --wheelbase 0.34 " + walls, "--wall-sensors"},
      {"noise --simulate --wall-sensors " + where, "--wall-sensors is given"},
      {"umbmark --wheelbase 0.34 " + turned, "turned.csv:2: heading is off by"},
      {"umbmark --wheelbase 0.34 --straight 10 " + squares, "--straight"},
      {"umbmark --wheelbase 0.34 --straight 10:x " + squares, "\"x\" is no length"},
      {"umbmark --wheelbase 0.34 --straight 10:10, " + squares, "--straight"},
      {"umbmark --wheelbase 0.34 --straight 10032:10 " + squares, "differ by half"},
      {"umbmark --simulate --straight 10:10", "--true-E-s"},
      {"umbmark --wheelbase 0.34 --alone eight " + squares, "\"eight\""}};
  for (const auto& [arguments, said] : usage) {
    const Ran ran = run_trussmap(arguments);
    EXPECT_EQ(ran.status, 2) << arguments << ran.output;
    EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
    EXPECT_NE(ran.output.find(said), std::string::npos) << arguments << "\n" << ran.output;
  }
}

}  // namespace
}  // namespace trussmap::calibration_command_test
