// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap build of a recording without landmarks.
#include "scratch_folder.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::path_command_test {
namespace {

namespace fs = std::filesystem;
using testing::Ran;
using testing::run_trussmap;
using testing::ScratchFolder;

std::string text_in(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A mower on a winding way with a fix a second, of which one, at t = 30, lies 5 m beside it.
std::string mower(const ScratchFolder& scratch) {
  std::ostringstream drive, fixes;
  drive << "t,left,right\n";
  fixes << "t,x,y,sd\n";
  double x = 0.0, y = 0.0, heading = 0.0;
  for (int k = 1; k <= 600; ++k) {
    const double turn = 0.06 * std::sin(0.02 * k);
    drive << 0.1 * k << "," << 0.03 - 0.17 * turn << "," << 0.03 + 0.17 * turn << "\n";
    x += 0.03 * std::cos(heading + 0.5 * turn);
    y += 0.03 * std::sin(heading + 0.5 * turn);
    heading += turn;
    if (k % 10 != 0) continue;
    fixes << 0.1 * k << "," << x + 0.02 * std::sin(3.1 * k) + (k == 300 ? 5.0 : 0.0) << ","
          << y + 0.02 * std::cos(2.9 * k) << ",0.02\n";
  }
  scratch.write("mower/drive.csv", drive.str());
  scratch.write("mower/fixes.csv", fixes.str());
  const fs::path model = scratch.write("mower/model.toml", "[robot]\nwheelbase = 0.34\n");
  return (scratch.path() / "mower").string() + " --model " + model.string();
}

TEST(PathCommand, BuildSaysThatThereIsAPathAndNamesTheFixLeftOut) {
  const ScratchFolder scratch;
  const std::string out = (scratch.path() / "path").string();
  const Ran ran = run_trussmap("build " + mower(scratch) + " --json " + out + ".json --svg " + out +
                               ".svg --html " + out + ".html");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("no landmark was sighted: the path of 18."), std::string::npos)
      << ran.output;
  EXPECT_NE(ran.output.find("good: nothing speaks against this path, certain to 0.0"),
            std::string::npos)
      << ran.output;
  EXPECT_NE(ran.output.find("    t = 30.000 s: 5.0"), std::string::npos) << ran.output;

  const nlohmann::json json = nlohmann::json::parse(text_in(out + ".json"));
  EXPECT_EQ(json["verdict"], "good");
  EXPECT_EQ(json["landmarks"], 0);
  EXPECT_EQ(json["positions"], nlohmann::json::object());
  EXPECT_EQ(json["paths"][0]["fixes"], 60);
  ASSERT_EQ(json["paths"][0]["left_out"].size(), 1U);
  EXPECT_EQ(json["paths"][0]["left_out"][0]["kind"], "fix");
  EXPECT_NEAR(json["paths"][0]["left_out"][0]["misfit_m"].get<double>(), 5.0, 0.1);
  const std::string svg = text_in(out + ".svg");
  EXPECT_NE(svg.find("<polyline class=\"after\""), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_NE(text_in(out + ".html").find("The path, before and after"), std::string::npos);
}

TEST(PathCommand, BuildWritesNoMapWithoutLandmarks) {
  const ScratchFolder scratch;
  const fs::path map = scratch.path() / "map.graphml";
  for (const std::string option : {"--out", "--csv"}) {
    const Ran ran = run_trussmap("build " + mower(scratch) + " " + option + " " + map.string());
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.output, "trussmap: no landmark was sighted, so that there is no map for " +
                              option +
                              ", expected apply --adjusted --out, which writes the path\n");
    EXPECT_FALSE(fs::exists(map));
  }
}

}  // namespace
}  // namespace trussmap::path_command_test
