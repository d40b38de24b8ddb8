// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Maps by their files' endings; what is no map is refused by the file's name.
#include "trussmap/map_files.hpp"

#include "scratch_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <string>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

using testing::ScratchFolder;

TEST(MapFiles, TheEndingSaysTheFormat) {
  const ScratchFolder scratch;
  LandmarkGraph map;
  map.add_landmark("1", {0.5, 0.25});
  map.add_landmark("2", 0, {{3.0, 4.0}, 0.01 * Matrix2::Identity()});
  for (const char* name : {"m.graphml", "m.g2o"}) {
    const auto file = scratch.path() / name;
    EXPECT_TRUE(is_map_file(file));
    write_file(file, format_map(map, file, "made by a test"));
    const LandmarkGraph back = read_map(file);
    ASSERT_EQ(back.landmarks(), 2) << name;
    EXPECT_EQ(back.landmark(1).position, map.landmark(1).position) << name;
    EXPECT_LE((back.route(0).covariance - map.route(0).covariance).norm(), 1e-15) << name;
  }
  EXPECT_NE(format_map(map, "m.geojson").find("FeatureCollection"), std::string::npos);
  EXPECT_NE(format_map(map, "m.dot").find("graph"), std::string::npos);
  EXPECT_FALSE(is_map_file("m.txt"));
}

std::string message_of(const std::filesystem::path& file) {
  try {
    (void)read_map(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "read without complaint";
}

TEST(MapFiles, WhatIsNoMapIsRefusedByTheFilesName) {
  const ScratchFolder scratch;
  scratch.write("poses.g2o",
                "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n"
                "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n");
  const std::string poses = (scratch.path() / "poses.g2o").string();
  EXPECT_EQ(message_of(poses),
            poses +
                ": is a graph of poses, expected a map: points (VERTEX_XY) and displacements "
                "(EDGE_POINTXY) alone");
  scratch.write("flat.g2o", "VERTEX_XY 0 0 0\nVERTEX_XY 1 1 0\nEDGE_POINTXY 0 1 1 0 1 0 0\n");
  const std::string flat = (scratch.path() / "flat.g2o").string();
  EXPECT_EQ(message_of(flat).rfind(flat + ": the edge from vertex 0 to 1", 0), 0U)
      << message_of(flat);
  EXPECT_EQ(message_of("m.txt"), "m.txt: is named like no map, expected .graphml or .g2o");
  EXPECT_THROW((void)format_map(LandmarkGraph(), "m.txt"), InputError);
  LandmarkGraph never_driven;
  never_driven.add_landmark("A", {0.0, 0.0});
  never_driven.add_landmark("B", {1.0, 0.0});
  never_driven.add_route(0, 1);
  EXPECT_THROW((void)format_map(never_driven, "m.g2o"), InputError);
}

}  // namespace
}  // namespace trussmap
