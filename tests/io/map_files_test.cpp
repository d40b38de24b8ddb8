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

namespace trussmap::map_files_test {
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

/// Landmarks with an axis and its error, with an axis alone, and with none.
LandmarkGraph oriented_map() {
  LandmarkGraph map;
  map.add_landmark("tag", {0.5, 0.25});
  map.set_heading(0, 1.0 / 3.0, 0.1 / 7.0);
  map.add_landmark("code", {1.0, 2.0});
  map.set_heading(1, -3.0);
  map.add_landmark("pole", {4.0, 2.0});
  return map;
}

TEST(MapFiles, OrientationsAreReadBackWithoutLoss) {
  const ScratchFolder scratch;
  const LandmarkGraph map = oriented_map();
  const auto file = scratch.path() / "m.graphml";
  write_file(file, format_map(map, file));
  const LandmarkGraph back = read_map(file);
  ASSERT_EQ(back.landmarks(), 3);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(back.landmark(k).heading, map.landmark(k).heading) << k;
    EXPECT_EQ(back.landmark(k).sd_heading, map.landmark(k).sd_heading) << k;
  }
  EXPECT_EQ(format_map_graphml(back), format_map_graphml(map));
  const std::string geojson = format_geojson(map);
  EXPECT_NE(geojson.find("\"heading\": -3.0"), std::string::npos) << geojson;
  EXPECT_NE(geojson.find("\"sd_heading\": 0.0142857"), std::string::npos) << geojson;
  EXPECT_EQ(format_positions(map),
            "landmark,x,y,heading,sd_heading\n"
            "tag,0.5,0.25,0.3333333333333333,0.014285714285714287\n"
            "code,1,2,-3,\n"
            "pole,4,2,,\n");
}

std::string message_of(const std::filesystem::path& file) {
  try {
    (void)read_map(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "read without complaint";
}

TEST(MapFiles, AnOrientationThatIsNoneIsRefused) {
  const ScratchFolder scratch;
  const auto refused = [&](const std::string& data) {
    scratch.write("m.graphml",
                  "<graphml><graph edgedefault=\"undirected\">\n<node id=\"A\">"
                  "<data key=\"x\">0</data><data key=\"y\">0</data>" +
                      data + "</node></graph></graphml>");
    return message_of(scratch.path() / "m.graphml");
  };
  const auto says = [](const std::string& text, const char* what) {
    return text.find(what) != std::string::npos;
  };
  EXPECT_TRUE(says(refused("<data key=\"heading\">north</data>"),
                   ":2: landmark A: heading is \"north\", expected a finite number"));
  EXPECT_TRUE(says(refused("<data key=\"heading\">1</data><data key=\"sd_heading\">-1</data>"),
                   "sd_heading is negative, expected 0 or more"));
  EXPECT_EQ(refused("<data key=\"heading\">1</data>"), "read without complaint");
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
}  // namespace trussmap::map_files_test
