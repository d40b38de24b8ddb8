// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/ros2_definition.hpp"

#include "logs/ros2_standard.hpp"

#include <gtest/gtest.h>

namespace trussmap::ros2_definition_test {
using namespace logs;
namespace {

const std::string kLine(80, '=');

TEST(Ros2Definition, HasFieldsInTheirOrderWithoutConstants) {
  const Ros2Layout layout = parse_ros2_definition("my_msgs/msg/A",
                                                  "# a comment\r\n"
                                                  "uint8 ON=1  # on\r\n"
                                                  "int32 LEAST = -5\n"
                                                  "string WORDS=a # b\n"
                                                  "\n"
                                                  "\tbool flag   true\n"
                                                  "float64[36]  covariance#none\n"
                                                  "string<=20[<=5] names\n"
                                                  "string words \"a = b # c\"\n"
                                                  "byte[] raw");
  ASSERT_EQ(layout.groups.size(), 1U);
  const std::vector<Ros2Field>& fields = layout.groups[0].fields;
  ASSERT_EQ(fields.size(), 5U);
  EXPECT_EQ(fields[0].name, "flag");
  EXPECT_EQ(fields[0].type, Ros2Type::boolean);
  EXPECT_EQ(fields[0].list, Ros2List::none);
  EXPECT_EQ(fields[1].name, "covariance");
  EXPECT_EQ(fields[1].list, Ros2List::fixed);
  EXPECT_EQ(fields[1].count, 36U);
  EXPECT_EQ(fields[2].type, Ros2Type::text);
  EXPECT_EQ(fields[2].longest, 20U);
  EXPECT_EQ(fields[2].list, Ros2List::sequence);
  EXPECT_EQ(fields[2].count, 5U);
  EXPECT_EQ(fields[3].name, "words");
  EXPECT_EQ(fields[4].type, Ros2Type::uint8);
  EXPECT_EQ(layout.groups[0].least, 1U + 36U * 8U + 4U + 4U + 4U);
}

TEST(Ros2Definition, FindsTypesWhereverTheyStand) {
  const Ros2Layout layout = parse_ros2_definition(
      "my_msgs/msg/A", "B near\nother_msgs/msg/B far\nother_msgs/C third\nHeader header\n" + kLine +
                           "\nMSG: other_msgs/C\nB of_c\n" + kLine +
                           "\nMSG: my_msgs/B\nint8 here\n" + kLine +
                           "\nMSG: other_msgs/msg/B\nint16 there\n");
  ASSERT_EQ(layout.groups.size(), 6U);  // those of Header and Time, which the text lacks, too
  const auto group = [&layout](std::size_t k) { return layout.groups.at(k); };
  const Ros2Group& message = group(0);
  ASSERT_EQ(message.fields.size(), 4U);
  EXPECT_EQ(group(message.fields[0].group).fields[0].name, "here");
  EXPECT_EQ(group(message.fields[1].group).fields[0].name, "there");
  EXPECT_EQ(group(message.fields[2].group).fields[0].name, "of_c");
  EXPECT_EQ(group(message.fields[2].group).fields[0].group, message.fields[1].group);
  EXPECT_EQ(group(message.fields[3].group).type, "std_msgs/Header");
  EXPECT_EQ(group(message.fields[3].group).fields[1].name, "frame_id");
  EXPECT_EQ(message.least, 1U + 2U + 2U + 4U + 4U + 4U);
}

std::string complaint(const std::string& text) {
  try {
    static_cast<void>(parse_ros2_definition("my_msgs/A", text));
  } catch (const DefinitionError& error) {
    return error.what();
  }
  return "none";
}

TEST(Ros2Definition, SaysWhatIsWrong) {
  const std::string at = " of its definition: ";
  EXPECT_EQ(complaint(""),
            "the bag has no definition of my_msgs/A; --definitions takes its .msg file");
  EXPECT_EQ(complaint("# nothing\n"), "none");
  EXPECT_EQ(complaint("int8 a\nint9 b\n"), "line 2" + at + "type int9 is not defined");
  EXPECT_EQ(complaint("int8 a\n---\nint8 b\n"),
            "line 2" + at + "\"---\", expected a type and a name");
  EXPECT_EQ(complaint("int8[ a\n"), "line 1" + at + "\"int8[\", expected ] at its end");
  EXPECT_EQ(complaint("int8[0] a\n"), "line 1" + at + "\"0\", expected a number of elements");
  EXPECT_EQ(complaint("int8[-1] a\n"), "line 1" + at + "\"-1\", expected a number of elements");
  EXPECT_EQ(complaint("int8[5000000000] a\n"),
            "line 1" + at + "\"5000000000\", expected a number of elements");
  EXPECT_EQ(complaint("int8<=5 a\n"), "line 1" + at + "<= is expected of string and wstring alone");
  EXPECT_EQ(complaint("int8 a\nint8 a\n"), "line 2" + at + "two fields have the name a");
  EXPECT_EQ(complaint("$ a\n"), "line 1" + at + "\"$\", expected a type");
  EXPECT_EQ(complaint("int8 a\n" + kLine + "\nIDL: b/B\n"),
            "line 3" + at + "\"MSG: TYPE\" is expected after a line of =");
}

TEST(Ros2Definition, TypesThatContainThemselvesAreRefused) {
  EXPECT_EQ(complaint("A a\n"), "line 1 of its definition: type my_msgs/A contains itself");
  EXPECT_EQ(complaint("B[] b\n" + kLine + "\nMSG: my_msgs/B\nint8 c\nA a\n"),
            "line 5 of its definition: type my_msgs/A contains itself");
}

/// Types T0 to Tn, each with `fields` of the next.
std::string chain(int count, const std::string& fields) {
  std::string text;
  for (int k = 0; k < count; ++k) {
    text += kLine + "\nMSG: my_msgs/T" + std::to_string(k) + "\n";
    for (const char name : fields) {
      const std::string type = k + 1 < count ? "T" + std::to_string(k + 1) : "int8";
      text += type + " " + name + "\n";
    }
  }
  return "T0 first\n" + text;
}

TEST(Ros2Definition, WhatGrowsBeyondAnyTrueMessageIsRefused) {
  EXPECT_EQ(complaint(chain(20, "a")), "none");
  EXPECT_NE(complaint(chain(40, "a")).find("its types are nested too deep"), std::string::npos);
  // 2^20 fields out of 20 lines.
  EXPECT_NE(complaint(chain(20, "ab")).find("more than 100000 fields"), std::string::npos);
  EXPECT_EQ(complaint(std::string(2000000, '\n') + "int8 a"),
            "its definition has more than 1048576 bytes");
}

TEST(Ros2Definition, StandardMessagesAreKnown) {
  for (const char* const type : {"std_msgs/msg/Bool",
                                 "std_msgs/msg/Int64MultiArray",
                                 "std_msgs/msg/Empty",
                                 "std_msgs/msg/ColorRGBA",
                                 "geometry_msgs/msg/TwistWithCovarianceStamped",
                                 "geometry_msgs/msg/AccelWithCovarianceStamped",
                                 "geometry_msgs/msg/WrenchStamped",
                                 "geometry_msgs/msg/PolygonStamped",
                                 "geometry_msgs/msg/PoseArray",
                                 "geometry_msgs/msg/Pose2D",
                                 "nav_msgs/msg/Path",
                                 "nav_msgs/msg/OccupancyGrid",
                                 "sensor_msgs/msg/CameraInfo",
                                 "sensor_msgs/msg/BatteryState",
                                 "sensor_msgs/msg/LaserScan",
                                 "sensor_msgs/msg/Joy",
                                 "sensor_msgs/msg/TimeReference",
                                 "sensor_msgs/msg/Illuminance",
                                 "sensor_msgs/msg/CompressedImage",
                                 "sensor_msgs/msg/PointCloud2",
                                 "tf2_msgs/msg/TF2Error",
                                 "tf2_msgs/msg/TFMessage",
                                 "diagnostic_msgs/msg/DiagnosticArray",
                                 "rosgraph_msgs/msg/Clock",
                                 "aruco_msgs/msg/MarkerArray",
                                 "ros2_aruco_interfaces/msg/ArucoMarkers",
                                 "apriltag_msgs/msg/AprilTagDetectionArray"}) {
    EXPECT_EQ(parse_ros2_definition(type, "").groups[0].type, ros2_type_name(type));
  }
  // header, child_frame_id, 7 + 36 and 6 + 36 numbers of 8 bytes
  EXPECT_EQ(parse_ros2_definition("nav_msgs/msg/Odometry", "").groups[0].least,
            8U + 4U + 4U + 85U * 8U);
  EXPECT_EQ(standard_ros2_definition("std_msgs/Nothing").data(), nullptr);
  EXPECT_EQ(standard_ros2_definition("zzz/Nothing").data(), nullptr);
}

}  // namespace
}  // namespace trussmap::ros2_definition_test
