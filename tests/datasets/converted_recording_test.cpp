// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What readers of foreign files take is a recording that our own reader takes, or is refused before
// anything is written: small inputs, changed at random (seed) where numbers stand.
#include "datasets/formats.hpp"
#include "scratch_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::converted_recording_test {
using namespace datasets;
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

struct Read {
  Recording recording;
  Model model;
};

struct Format {
  std::string corpus;  ///< of the fuzzer, whose inputs are files between lines of "===="
  std::vector<std::string> names;
  std::function<Read(const fs::path& folder)> read;
};

template <typename Foreign>
Read taken(Foreign foreign) {
  return {std::move(foreign.recording), std::move(foreign.model)};
}

const std::vector<Format>& formats() {
  static const std::vector<Format> kFormats{
      {"mrclam",
       {"Robot1_Odometry.dat", "Robot1_Measurement.dat", "Barcodes.dat", "Landmark_Groundtruth.dat",
        "Robot1_Groundtruth.dat"},
       [](const fs::path& at) { return taken(read_mrclam(at / "Robot1")); }},
      {"optiodom",
       {"a_run-01.csv", "a_metadata.csv"},
       [](const fs::path& at) { return taken(read_optiodom(at / "a_run-01.csv")); }},
      {"ranges",
       {"a_DR.txt", "a_TD.txt", "a_GT.csv"},
       [](const fs::path& at) { return taken(read_radio_ranges(at / "a")); }},
      {"loops",
       {"a_Input.txt"},
       [](const fs::path& at) { return taken(read_place_loops(at / "a")); }},
      {"phil",
       {"kobuki_data.csv", "rio_data.csv", "mocap_robot.csv"},
       [](const fs::path& at) { return taken(read_phil(at)); }},
      {"line",
       {"dataset1.csv"},
       [](const fs::path& at) { return taken(read_line_robot(at / "dataset1.csv")); }},
      {"encoders",
       {"log.txt"},
       [](const fs::path& at) { return taken(read_encoder_log(at / "log.txt")); }},
      {"g2o", {"a.g2o"}, [](const fs::path& at) {
         return taken(read_graph_recording(at / "a.g2o"));
       }}};
  return kFormats;
}

std::string content(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::vector<std::string> parts_of(std::string text) {
  const std::string between = "====\n";
  std::vector<std::string> parts;
  for (std::size_t at = 0; (at = text.find(between)) != std::string::npos;) {
    parts.push_back(text.substr(0, at));
    text.erase(0, at + between.size());
  }
  parts.push_back(text);
  return parts;
}

/// With one of its numbers another one.
std::string changed(const std::string& text, std::mt19937_64& random) {
  static const std::regex kNumber(R"([-+]?\d+\.?\d*(e[-+]?\d+)?)");
  static const std::array<const char*, 16> kHostile{
      "1e300", "-1e300", "1e-320", "1e308",   "1e13", "-1e13",  "1000001", "1e9",
      "2e9",   "1e17",   "1e155",  "1700000", "0",    "-1e155", "1e50",    "-3"};
  std::vector<std::pair<std::size_t, std::size_t>> places;
  for (auto one = std::sregex_iterator(text.begin(), text.end(), kNumber);
       one != std::sregex_iterator(); ++one) {
    places.emplace_back(one->position(), one->length());
  }
  if (places.empty()) return text;
  const auto [at, length] = places[random() % places.size()];
  std::string result = text;
  return result.replace(at, length, kHostile[random() % kHostile.size()]);
}

TEST(ConvertedRecording, CanBeReadAgainOrIsNotWritten) {
  const ScratchFolder scratch;
  std::mt19937_64 random(27);
  int written = 0;
  int refused = 0;
  for (const Format& format : formats()) {
    const fs::path corpus = fs::path(TRUSSMAP_SOURCE_DIR) / "tests/fuzz/corpus" / format.corpus;
    for (const auto& entry : fs::directory_iterator(corpus)) {
      const std::vector<std::string> parts = parts_of(content(entry.path()));
      for (int round = 0; round < 40; ++round) {
        const fs::path in = scratch.path() / "in";
        const fs::path out = scratch.path() / "out";
        fs::remove_all(in);
        fs::remove_all(out);
        const std::size_t which = random() % std::min(parts.size(), format.names.size());
        for (std::size_t k = 0; k < std::min(parts.size(), format.names.size()); ++k) {
          if (parts[k].empty()) continue;
          const bool change = round > 0 && k == which;
          scratch.write("in/" + format.names[k], change ? changed(parts[k], random) : parts[k]);
        }
        try {
          const Read read = format.read(in);
          write_recording(out, read.recording, "", {{"model.toml", format_model(read.model)}});
        } catch (const InputError& error) {
          ++refused;
          EXPECT_FALSE(fs::exists(out));
          EXPECT_NE(std::string(error.what()).find(in.string()), std::string::npos) << error.what();
          continue;
        }
        ++written;
        EXPECT_NO_THROW(static_cast<void>(read_recording(out))) << entry.path() << " " << round;
        EXPECT_NO_THROW(static_cast<void>(read_model(out / "model.toml"))) << entry.path();
      }
    }
  }
  EXPECT_GT(written, 100);
  EXPECT_GT(refused, 100);
}

TEST(ConvertedRecording, TheLineAtFaultIsNamed) {
  const ScratchFolder scratch;
  const auto said = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing";
  };
  scratch.write("a_DR.txt", "100.5 0.10 0.02\n101.0 2e6 0\n101.5 0.30 -0.02\n");
  scratch.write("a_TD.txt", "101.2 2 7 3.5\n");
  const std::string travel =
      said([&] { static_cast<void>(read_radio_ranges(scratch.path() / "a")); });
  EXPECT_NE(travel.find("a_DR.txt:2: the left wheel's travel is 2e+06"), std::string::npos)
      << travel;
  scratch.write("a_DR.txt", "100.5 0.10 0.02\n101.0 0.2 0\n101.5 0.30 -0.02\n");
  scratch.write("a_TD.txt", "# ranges\n101.2 2 7 1e7\n");
  const std::string range =
      said([&] { static_cast<void>(read_radio_ranges(scratch.path() / "a")); });
  EXPECT_NE(range.find("a_TD.txt:2: the range is 1e+07, expected a number of at most"),
            std::string::npos)
      << range;
  scratch.write("dataset1.csv", "0,0,1,3\n1,1,1,2\n2,1e10,1,1\n");
  const std::string truth =
      said([&] { static_cast<void>(read_line_robot(scratch.path() / "dataset1.csv")); });
  EXPECT_NE(truth.find("dataset1.csv:3: x is 1e+10"), std::string::npos) << truth;
}

/// What no reader of a foreign file has seen: the recording itself cannot be one.
TEST(ConvertedRecording, WhatCouldNotBeReadAgainIsNotWritten) {
  const ScratchFolder scratch;
  Recording recording;
  recording.name = "mine";
  recording.drive.t = {1.0, 2.0, 3.0};
  recording.drive.left = recording.drive.right = {0.1, 0.1, 0.1};
  recording.sightings = {{1.0, "a"}, {3.0, "b"}};
  const fs::path out = scratch.path() / "out";
  EXPECT_NO_THROW(write_recording(out, recording));
  const auto before = scratch.contents();
  recording.sightings[1].t = 30.0;
  try {
    write_recording(out, recording);
    FAIL() << "a sighting outside the drive was written";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("mine: makes a recording that could not be read again"
                        ": sightings.csv:3: time 30 is outside the drive"),
              std::string::npos)
        << error.what();
  }
  EXPECT_EQ(scratch.contents(), before);
}

}  // namespace
}  // namespace trussmap::converted_recording_test
