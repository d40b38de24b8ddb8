// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The example of docs/maps.md: compiled here, run, and the same to the letter.
#include "policy/source_files.hpp"
#include "scratch_folder.hpp"
#include "simulation/tours.hpp"
#include "simulation/wheeled_robot.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"

#include <filesystem>
#include <random>
#include <string>

#include <gtest/gtest.h>

#define main documented_example  // NOLINT
// page: begin
#include <trussmap/build_map.hpp>
#include <trussmap/model_file.hpp>
#include <trussmap/recording_files.hpp>

int main() {
  const trussmap::Model model = trussmap::read_model("rec/model.toml");
  const auto built = trussmap::build_map({trussmap::read_recording("rec")}, model,
                                         {.method = trussmap::Method::adjustment});
  return built.map.landmarks() > 0 ? 0 : 1;
}
// page: end
#undef main

namespace trussmap::documented_example_test {
namespace {

namespace fs = std::filesystem;

TEST(DocumentedExample, IsOnItsPage) {
  const std::string here = testing::text_of("tests/build_map/documented_example_test.cpp");
  const std::string begin = "// page: begin\n";
  const std::size_t from = here.find(begin) + begin.size();
  const std::string example = here.substr(from, here.find("// page: end\n") - from);
  EXPECT_NE(testing::text_of("docs/maps.md").find("```cpp\n" + example + "```\n"),
            std::string::npos);
}

/// In the folder where the test stands, which is put back.
TEST(DocumentedExample, MapsARecording) {
  const testing::ScratchFolder scratch;
  const Mesh mesh = even_mesh({3, 3}, 5.0);
  std::mt19937_64 random(1);
  const Tours tours = make_tours(mesh, WalkKind::euler, 2, random);
  const Recording driven = simulate_drive(mesh, tours.walk, {}, {}, 1).recording;
  write_recording(scratch.path() / "rec", driven, "", {{"model.toml", format_model(Model{})}});
  const fs::path before = fs::current_path();
  fs::current_path(scratch.path());
  const int status = documented_example();
  fs::current_path(before);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace trussmap::documented_example_test
