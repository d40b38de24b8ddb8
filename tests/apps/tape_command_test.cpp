// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap tape as a user meets it, and what people write into tables by hand.
#include "json_file.hpp"
#include "scratch_folder.hpp"
#include "shared_data.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/umbmark.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::tape_command_test {
namespace {

using nlohmann::json;
using testing::Ran;
using testing::read_json;
using testing::run_trussmap;
using testing::ScratchFolder;

TEST(TapeCommand, FindsTheFaultsOfARehearsedRobot) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string();
  const Ran ran = run_trussmap(
      "tape --simulate --true-E-d 1.004 --true-E-b 0.98 --true-E-s 1.01 --true-gyro-scale 0.02 "
      "--true-gyro-bias 0.01 --scatter 0.003 --scatter-heading 0.003 --write " +
      at + "/r.csv --out " + at + "/m.toml --json " + at + "/t.json");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_EQ(ran.output.rfind("worth correcting: ", 0), 0U) << ran.output;
  EXPECT_EQ(ran.output.find("warning"), std::string::npos) << ran.output;
  const json found = read_json(scratch.path() / "t.json");
  const std::pair<const char*, double> truth[] = {{"E_s", 1.01},
                                                  {"E_b", 0.98},
                                                  {"E_d", 1.004},
                                                  {"gyro_scale", 0.02},
                                                  {"gyro_bias_rad_per_s", 0.01}};
  for (const auto& [name, value] : truth) {
    EXPECT_NEAR(found[name].get<double>(), value,
                5.0 * found[std::string("sd_") + name].get<double>())
        << name;
  }
  EXPECT_EQ(found["class"], "wheelbase");
  EXPECT_EQ(found["looks_the_same"], json::array());  // both ways, slowly and fast, with a tape
  ASSERT_EQ(found["constants"].size(), 5U);
  EXPECT_EQ(found["constants"][0]["name"], "wheelbase");
  EXPECT_NEAR(found["constants"][0]["new"].get<double>(), 0.34 * found["E_b"].get<double>(), 1e-12);
  const Model model = read_model(scratch.path() / "m.toml");
  EXPECT_NEAR(geometry_errors(model).scale, found["E_s"].get<double>(), 1e-12);
  EXPECT_EQ(model.effects.back().name, "gyro bias");
  // The same by the table.
  const Ran again = run_trussmap("tape " + at + "/r.csv --wheelbase 0.34");
  EXPECT_EQ(again.output, ran.output);
  // With all of it in force nothing is left, and the model keeps what it had.
  ASSERT_EQ(run_trussmap("tape " +
                         scratch
                             .write("s.csv",
                                    "kind,expected,odometry\nstraight,10,10\n"
                                    "straight,10.001,10\n")
                             .string() +
                         " --model " + at + "/m.toml --out " + at + "/n.toml")
                .status,
            0);
  const GeometryErrors kept = geometry_errors(read_model(scratch.path() / "n.toml"));
  EXPECT_NEAR(kept.diameter_ratio, geometry_errors(model).diameter_ratio, 1e-12);
}

TEST(TapeCommand, DegreesOfTenTurnsAreAskedAboutThenRead) {
  const ScratchFolder scratch;
  const std::string file =
      scratch.write("r.csv", "kind;expected;odometry;sd\nspin;3600;3578,1;2\n").string();
  const Ran asked = run_trussmap("tape --wheelbase 0.23 " + file);
  EXPECT_EQ(asked.status, 2);
  EXPECT_EQ(std::count(asked.output.begin(), asked.output.end(), '\n'), 1) << asked.output;
  EXPECT_NE(asked.output.find("are these degrees?"), std::string::npos) << asked.output;
  const Ran ran = run_trussmap("tape --degrees --wheelbase 0.23 " + file);
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.output.rfind("worth correcting: the wheelbase is 0.608 +- 0.055 % smaller", 0), 0U)
      << ran.output;
  EXPECT_NE(ran.output.find("wheel scale, turn asymmetry, turn scrub look the same"),
            std::string::npos)
      << ran.output;
}

TEST(TapeCommand, AWheelbaseInMillimetresIsAskedAbout) {
  const ScratchFolder scratch;
  const std::string tape =
      scratch.write("r.csv", "kind,expected,odometry\nspin,6.3,6.25\n").string();
  const std::string squares = TRUSSMAP_SOURCE_DIR "/maps/square_runs.csv";
  for (const std::string& call : {"tape " + tape, "umbmark " + squares}) {
    const Ran ran = run_trussmap(call + " --wheelbase 340");
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.output,
              "trussmap: --wheelbase is 340 m, wider than any robot, expected metres (0.34 for 340 "
              "mm?)\n");
    EXPECT_EQ(run_trussmap(call + " --wheelbase 3.4").status, 0);
  }
}

std::string with_commas(std::string text) {
  std::replace(text.begin(), text.end(), ',', ';');
  std::replace(text.begin(), text.end(), '.', ',');
  return text;
}

constexpr const char* kSquares =
    "direction,x,y\ncw,0.042,0.031\ncw,0.022,0.031\ncw,0.032,0.041\ncw,0.032,0.021\n"
    "ccw,0.107,-0.094\nccw,0.087,-0.094\nccw,0.097,-0.084\nccw,0.097,-0.104\n";

TEST(UmbmarkByHand, DecimalCommasAreRead) {
  const ScratchFolder scratch;
  const std::string call = "umbmark --wheelbase 0.5 ";
  EXPECT_EQ(run_trussmap(call + scratch.write("a.csv", kSquares).string()).output,
            run_trussmap(call + scratch.write("b.csv", with_commas(kSquares)).string()).output);
}

TEST(UmbmarkByHand, CentimetresAreNamed) {
  const ScratchFolder scratch;
  std::string large = "direction,x,y\n";
  std::string small = large;
  for (const char* one : {"cw,4.2,3.1\n", "cw,2.2,3.1\n", "ccw,10.7,-9.4\n", "ccw,8.7,-9.4\n"}) {
    small += one;
  }
  for (const char* one : {"cw,21.7,7.6\n", "cw,2.2,3.1\n", "ccw,10.7,-9.4\n", "ccw,8.7,-9.4\n"}) {
    large += one;
  }
  for (const std::string& table : {small, large}) {
    const Ran ran =
        run_trussmap("umbmark --wheelbase 0.5 " + scratch.write("c.csv", table).string());
    EXPECT_NE(ran.output.find("centimetres, 100 times too long"), std::string::npos) << ran.output;
  }
  const Ran straight = run_trussmap("umbmark --wheelbase 0.5 --straight 1003.1:10 " +
                                    scratch.write("a.csv", kSquares).string());
  EXPECT_EQ(straight.status, 2);
  EXPECT_NE(straight.output.find("centimetres, 100 times too long"), std::string::npos);
}

TEST(UmbmarkByHand, RunsThatContradictThemselvesAreDoubtfulWithWiderErrors) {
  const ScratchFolder scratch;
  const auto judged = [&](const std::string& table) {
    const std::string out = (scratch.path() / "u.json").string();
    const Ran ran = run_trussmap("umbmark --wheelbase 0.5 --json " + out + " " +
                                 scratch.write("u.csv", table).string());
    EXPECT_EQ(ran.status, 0) << ran.output;
    json result = read_json(out);
    result["said"] = ran.output;
    return result;
  };
  const json good = judged(kSquares);
  EXPECT_EQ(good["verdict"], "worth correcting");
  std::string exchanged = kSquares;  // every label the other
  for (std::size_t at = 14; at < exchanged.size(); at = exchanged.find('\n', at) + 1) {
    if (exchanged.compare(at, 3, "cw,") == 0) {
      exchanged.insert(at, "c");
    } else {
      exchanged.erase(at, 1);
    }
  }
  const json bad = judged(exchanged);
  EXPECT_EQ(bad["verdict"], "doubtful");
  EXPECT_EQ(bad["said"].get<std::string>().rfind("doubtful: ", 0), 0U) << bad["said"];
  // The centres have the same scatter; what two constants leave of them, 60 mm and more, is added.
  for (const char* sd : {"sd_E_d", "sd_E_b", "sd_wheelbase_m", "sd_c_left"}) {
    EXPECT_GT(bad["exact"][sd].get<double>(), 5.0 * good["exact"][sd].get<double>()) << sd;
    EXPECT_GT(bad[sd].get<double>(), 5.0 * good[sd].get<double>()) << sd;
  }
}

bool tells_of_noise(const json& diagnosis) {
  return std::any_of(diagnosis["noise"].begin(), diagnosis["noise"].end(),
                     [](const json& law) { return law["p_adjusted"].get<double>() < 0.05; });
}

TEST(ReportedRecordings, TenSpinsAreAWheelbaseToEveryCommand) {
  TRUSSMAP_NEEDS_SHARED("data/reports/ten-spins");
  const ScratchFolder scratch;
  const std::string out = (scratch.path() / "j.json").string();
  const std::string spins = testing::shared("data/reports/ten-spins").string();
  const std::string given = fmt::format("{0} --model {0}/model.toml --json {1}", spins, out);
  const Ran diagnosed = run_trussmap("diagnose " + given);
  ASSERT_EQ(diagnosed.status, 0) << diagnosed.output;
  const json diagnosis = read_json(out);
  EXPECT_EQ(diagnosis["missing"], "wheelbase");
  EXPECT_FALSE(tells_of_noise(diagnosis)) << diagnosis["noise"];
  EXPECT_EQ(diagnosed.output.find("heavy tails"), std::string::npos) << diagnosed.output;
  const Ran calibrated = run_trussmap("calibrate " + given);
  ASSERT_EQ(calibrated.status, 0) << calibrated.output;
  EXPECT_NEAR(read_json(out)["E_b"].get<double>(), 0.9939, 2e-4);
  EXPECT_EQ(calibrated.output.find("stated too large"), std::string::npos) << calibrated.output;
}

TEST(ReportedRecordings, FiveMetresTellNoWheelsApart) {
  TRUSSMAP_NEEDS_SHARED("data/reports/five-metres");
  const ScratchFolder scratch;
  const std::string out = (scratch.path() / "j.json").string();
  const std::string runs = testing::shared("data/reports/five-metres").string();
  const Ran ran = run_trussmap(fmt::format(
      "calibrate {0}/run1 {0}/run2 {0}/run3 --model {0}/model.toml --json {1}", runs, out));
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_TRUE(read_json(out)["E_d"].is_null());
}

/// 60 s at rest with a gyro that reads 0.011 rad/s.
TEST(ReportedRecordings, AGyroAtRestHasABiasAndNoLoudNoise) {
  const ScratchFolder scratch;
  std::string drive = "t,left,right,yaw_rate\n";
  for (int k = 1; k <= 3000; ++k) {
    drive += fmt::format("{:.2f},0,0,{:.6f}\n", 0.02 * k, 0.011 + 0.002 * std::sin(1.7 * k * k));
  }
  scratch.write("rest/drive.csv", drive);
  scratch.write("rest/truth.csv", "t,x,y,heading\n0.02,0,0,0\n60,0,0,0\n");
  const std::string model = scratch.write("m.toml", "[robot]\nwheelbase = 0.3\n").string();
  const std::string out = (scratch.path() / "j.json").string();
  const Ran ran = run_trussmap("diagnose " + (scratch.path() / "rest").string() + " --model " +
                               model + " --json " + out);
  ASSERT_EQ(ran.status, 0) << ran.output;
  const json diagnosis = read_json(out);
  EXPECT_EQ(diagnosis["missing"], "gyro bias");
  EXPECT_NEAR(diagnosis["candidates"][0]["coefficients"][0].get<double>(), 0.011, 3e-4);
  EXPECT_FALSE(tells_of_noise(diagnosis)) << diagnosis["noise"];
  const Ran calibrated =
      run_trussmap("calibrate " + (scratch.path() / "rest").string() + " --model " + model);
  EXPECT_NE(calibrated.output.find("nothing determined: "), std::string::npos) << calibrated.output;
}

}  // namespace
}  // namespace trussmap::tape_command_test
