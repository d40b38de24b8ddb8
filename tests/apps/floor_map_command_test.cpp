// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// diagnose --floor-map as a user meets it.
#include "json_file.hpp"
#include "scratch_folder.hpp"
#include "trussmap/write_files.hpp"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::floor_map_command_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Ran;
using testing::read_json;
using testing::run_trussmap;
using testing::ScratchFolder;

/// Four bytes from `at` on, the highest first, as PNG has its numbers.
unsigned number_at(const std::string& bytes, std::size_t at) {
  unsigned value = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    value = value << 8U | static_cast<unsigned char>(bytes.at(at + k));
  }
  return value;
}

TEST(SlowFloorMapCommand, WritesAMapAndAPictureOfAMagneticField) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  write_file(at + "e.toml",
             "[[effect]]\nname = \"iron here and there\"\nchannel = \"compass\"\n"
             "shape = [\"sin(0.5*x+0.2*y)\", \"cos(0.4*y-0.3*x)\", \"sin(0.6*y+0.1*x)\"]\n"
             "coefficients = [0.05, 0.05, 0.05]\n");
  Ran ran = run_trussmap("simulate --seed 31 --effects " + at + "e.toml --out " + at + "rec");
  ASSERT_EQ(ran.status, 0) << ran.output;
  const std::string folder = at + "floor";
  fs::create_directory(folder);
  write_file(folder + "/floor-turn.png", "of a run before");
  write_file(folder + "/mine.txt", "somebody's");
  ran = run_trussmap("diagnose " + at + "rec --model " + at + "rec/model.toml --json " + at +
                     "d.json --html " + at + "d.html --floor-map " + folder);
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("the compass's heading differs from place to place: sd "),
            std::string::npos)
      << ran.output;
  EXPECT_NE(ran.output.find("map of compass in "), std::string::npos) << ran.output;
  EXPECT_FALSE(fs::exists(folder + "/floor-turn.png"));
  EXPECT_TRUE(fs::exists(folder + "/mine.txt"));

  const json places = read_json(at + "d.json")["places"];
  ASSERT_FALSE(places.empty());
  const json& field = places[0];
  EXPECT_EQ(field["channel"], "compass");
  EXPECT_EQ(field["mean"].size(),
            field["columns"].get<std::size_t>() * field["rows"].get<std::size_t>());
  std::size_t driven = 0;
  for (const json& one : field["mean"]) driven += one.is_null() ? 0U : 1U;
  EXPECT_EQ(read_json(folder + "/floor-compass.geojson")["features"].size(), driven);

  const std::string png = fs::exists(folder + "/floor-compass.png")
                              ? read_file(folder + "/floor-compass.png")
                              : std::string();
  if (png.empty()) GTEST_SKIP() << "built without libpng";
  EXPECT_EQ(png.substr(0, 8), std::string("\x89PNG\r\n\x1a\n"));
  EXPECT_EQ(png.substr(12, 4), "IHDR");
  const unsigned columns = field["columns"].get<unsigned>();
  const unsigned rows = field["rows"].get<unsigned>();
  EXPECT_GE(number_at(png, 16), 2U * columns);
  EXPECT_GE(number_at(png, 20), 2U * rows);
  EXPECT_LT(number_at(png, 16), 900U);
  EXPECT_NE(png.find("IEND"), std::string::npos);

  EXPECT_NE(read_file(at + "d.html").find("What differs from place to place"), std::string::npos);
}

TEST(FloorMapCommand, SaysThatThereIsNone) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  const std::string riddle = std::string(TRUSSMAP_SOURCE_DIR) + "/maps/riddle";
  const Ran ran = run_trussmap("diagnose " + riddle + " --model " + riddle +
                               "/model.toml --floor-map " + at + "floor");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("Nothing differs from place to place: no floor map"), std::string::npos)
      << ran.output;
  EXPECT_FALSE(fs::exists(at + "floor"));
}

}  // namespace
}  // namespace trussmap::floor_map_command_test
