// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Maps as YAML, read back by yaml-cpp.
#include "trussmap/error.hpp"
#include "trussmap/map_files.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>
#include <yaml-cpp/yaml.h>

#include <gtest/gtest.h>

namespace trussmap::map_yaml_test {
namespace {

LandmarkGraph tags() {
  LandmarkGraph map;
  map.add_landmark("tag36h11:5", {1.0 / 3.0, 1e-7});
  map.set_heading(0, 2.0, 0.01);
  Matrix2 C;
  C << 0.04, 0.01, 0.01, 0.09;
  map.set_covariance(0, C);
  map.add_landmark("tag_007", {-2.0, 1e21});
  map.set_heading(1, -3.0);
  map.add_landmark("12", {4.0, 5.0});
  map.add_landmark("pole \"B\"\\", {6.0, 7.0});
  map.add_landmark("a9", {0.0, 0.0});
  map.add_landmark("b9", {0.0, 1.0});
  return map;
}

TEST(MapYaml, MarkersHoldPosesAndCovariances) {
  const LandmarkGraph map = tags();
  YamlMapOptions options;
  options.comment = "by a test\nid: 3";
  const YamlMap yaml = format_map_yaml(map, options);
  const YAML::Node file = YAML::Load(yaml.text);
  EXPECT_EQ(file["frame_id"].as<std::string>(), "map");
  EXPECT_FALSE(file["id"]);
  const YAML::Node markers = file["markers"];
  ASSERT_EQ(markers.size(), 6U);
  for (int k = 0; k < map.landmarks(); ++k) {
    const YAML::Node one = markers[k];
    const Landmark& landmark = map.landmark(k);
    EXPECT_EQ(one["name"].as<std::string>(), landmark.name);
    EXPECT_EQ(one["pose"]["position"]["x"].as<double>(), landmark.position.x());
    EXPECT_EQ(one["pose"]["position"]["y"].as<double>(), landmark.position.y());
    EXPECT_EQ(one["pose"]["position"]["z"].as<double>(), 0.0);
    const YAML::Node turn = one["pose"]["orientation"];
    EXPECT_EQ(turn["x"].as<double>(), 0.0);
    EXPECT_EQ(turn["y"].as<double>(), 0.0);
    EXPECT_NEAR(2.0 * std::atan2(turn["z"].as<double>(), turn["w"].as<double>()),
                landmark.heading.value_or(0.0), 1e-15);
    EXPECT_EQ(one["covariance"].IsDefined(), k == 0);
    EXPECT_FALSE(one["size"]);
  }
  EXPECT_EQ(markers[0]["id"].as<int>(), 5);
  EXPECT_EQ(markers[1]["id"].as<int>(), 7);
  EXPECT_EQ(markers[2]["id"].as<int>(), 12);
  for (const int k : {3, 4, 5}) EXPECT_FALSE(markers[k]["id"]) << k;
  const auto C = markers[0]["covariance"].as<std::vector<double>>();
  ASSERT_EQ(C.size(), 36U);
  EXPECT_EQ(C[0], 0.04);
  EXPECT_EQ(C[1], 0.01);
  EXPECT_EQ(C[6], 0.01);
  EXPECT_EQ(C[7], 0.09);
  EXPECT_EQ(C[14], 1e6);
  EXPECT_EQ(C[35], 0.01 * 0.01);
  EXPECT_EQ(yaml.without_id, (std::vector<std::string>{"pole \"B\"\\", "a9", "b9"}));
  EXPECT_EQ(yaml.without_heading.size(), 4U);
}

TEST(MapYaml, BundlesHoldTheTags) {
  YamlMapOptions options;
  options.layout = YamlLayout::apriltag;
  options.tag_size = 0.16;
  const YamlMap yaml = format_map_yaml(tags(), options);
  const YAML::Node file = YAML::Load(yaml.text);
  EXPECT_TRUE(file["standalone_tags"].IsSequence());
  EXPECT_EQ(file["standalone_tags"].size(), 0U);
  ASSERT_EQ(file["tag_bundles"].size(), 1U);
  EXPECT_EQ(file["tag_bundles"][0]["name"].as<std::string>(), "map");
  const YAML::Node layout = file["tag_bundles"][0]["layout"];
  ASSERT_EQ(layout.size(), 3U);
  EXPECT_EQ(layout[1]["id"].as<int>(), 7);
  EXPECT_EQ(layout[1]["size"].as<double>(), 0.16);
  EXPECT_EQ(layout[1]["x"].as<double>(), -2.0);
  EXPECT_EQ(layout[1]["y"].as<double>(), 1e21);
  EXPECT_EQ(layout[1]["z"].as<double>(), 0.0);
  EXPECT_EQ(layout[1]["qw"].as<double>(), std::cos(-1.5));
  EXPECT_EQ(layout[1]["qx"].as<double>(), 0.0);
  EXPECT_EQ(layout[1]["qy"].as<double>(), 0.0);
  EXPECT_EQ(layout[1]["qz"].as<double>(), std::sin(-1.5));
  EXPECT_EQ(yaml.without_id.size(), 3U);
}

/// YAML 1.1 (PyYAML) takes 1e-07 for a text.
TEST(MapYaml, EveryNumberHasAPoint) {
  const std::string text = format_map_yaml(tags()).text;
  EXPECT_NE(text.find("y: 1.0e-07"), std::string::npos) << text;
  EXPECT_NE(text.find("y: 1.0e+21"), std::string::npos) << text;
  EXPECT_NE(text.find("x: -2.0"), std::string::npos) << text;
}

TEST(MapYaml, WhatCannotBeWrittenIsRefused) {
  YamlMapOptions options;
  options.layout = YamlLayout::apriltag;
  EXPECT_THROW(static_cast<void>(format_map_yaml(tags(), options)), std::invalid_argument);
  options.tag_size = -1.0;
  EXPECT_THROW(static_cast<void>(format_map_yaml(tags(), options)), std::invalid_argument);
  options.tag_size = 0.1;
  LandmarkGraph map;
  map.add_landmark("door", {0.0, 0.0});
  map.add_landmark("99999999999999999999", {1.0, 0.0});
  EXPECT_THROW(static_cast<void>(format_map_yaml(map, options)), InputError);
  options.layout = YamlLayout::markers;
  EXPECT_EQ(YAML::Load(format_map_yaml(LandmarkGraph(), options).text)["markers"].size(), 0U);
}

TEST(MapYaml, NamesOfAllKindsAreQuoted) {
  LandmarkGraph map;
  const std::vector<std::string> names = {
      "no", "1e3 ", "- a: b", "#x", "\xc3\xa4\xe2\x82\xac", "a\tb\x01", "{c}, [d]", "~", "''"};
  for (const std::string& one : names) map.add_landmark(one, {0.0, 0.0});
  const YAML::Node markers = YAML::Load(format_map_yaml(map).text)["markers"];
  ASSERT_EQ(markers.size(), names.size());
  for (std::size_t k = 0; k < names.size(); ++k) {
    EXPECT_EQ(markers[k]["name"].as<std::string>(), names[k]);
  }
}

}  // namespace
}  // namespace trussmap::map_yaml_test
