// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/message_definitions.hpp"

#include "logs/bag_lines.hpp"
#include "logs/ros2_definition.hpp"
#include "scratch_folder.hpp"

#include <gtest/gtest.h>

namespace trussmap::message_definitions_test {
using namespace logs;
namespace {

namespace fs = std::filesystem;
using testing::ReadLog;
using testing::ScratchFolder;
using testing::TestBag;

ReadLog read_with(const fs::path& log, const MessageDefinitions* given) {
  return testing::read_lines([&](LogVisit visit) {
    visit.definitions = given;
    return read_message_log(log, visit);
  });
}

class DefinitionsApart : public ::testing::TestWithParam<const char*> {};

/// With the workspace every message of the bag, to the bit; without it all but those of its types.
TEST_P(DefinitionsApart, AreThoseThatTheBagLacks) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), GetParam());
  ASSERT_FALSE(bag.path.empty());
  const MessageDefinitions given({scratch.path() / "src"});
  const ReadLog with = read_with(bag.path, &given);
  EXPECT_EQ(with.error, "");
  EXPECT_TRUE(with.lines == bag.expected);
  EXPECT_NE(with.lines.find("/everything "), std::string::npos);
  const ReadLog without = read_with(bag.path, nullptr);
  EXPECT_EQ(without.lines.find("/everything "), std::string::npos);
  EXPECT_LT(without.lines.size(), with.lines.size());
  for (const LogTopic& topic : without.end.topics) {
    const bool own = topic.name == "/everything" || topic.name == "/wide";
    EXPECT_EQ(topic.unread.empty(), !own) << topic.name;
  }
}

INSTANTIATE_TEST_SUITE_P(MessageDefinitions, DefinitionsApart,
                         ::testing::Values("mcap_definitions_apart", "db3_definitions_apart"),
                         [](const auto& one) { return std::string(one.param); });

TEST(MessageDefinitions, APackageIsTheFolderOrTheOneAboveMsg) {
  const ScratchFolder scratch;
  scratch.write("ws/install/a_msgs/share/a_msgs/msg/One.msg", "int8 x\n");
  scratch.write("ws/src/b_msgs/Two.msg", "a_msgs/One one\r\nint16 y\r\n");
  const fs::path alone = scratch.write("c_msgs/msg/Three.msg", "int32 z\n");
  scratch.write("ws/src/b_msgs/README", "text");
  const MessageDefinitions given({scratch.path() / "ws", alone});
  EXPECT_EQ(given.find("a_msgs/One")->text, "int8 x\n");
  EXPECT_EQ(given.find("c_msgs/Three")->text, "int32 z\n");
  EXPECT_EQ(given.find("msg/One"), nullptr);
  EXPECT_EQ(given.find("c_msgs/One"), nullptr);
  const Ros2Layout layout = parse_ros2_definition("b_msgs/msg/Two", "", &given);
  ASSERT_EQ(layout.groups.size(), 2U);
  EXPECT_EQ(layout.groups[0].least, 3U);
}

/// What the bag says of its own messages counts: a workspace may have moved on.
TEST(MessageDefinitions, ABagsOwnCountsFirst) {
  const ScratchFolder scratch;
  scratch.write("a_msgs/A.msg", "int64 x\n");
  scratch.write("std_msgs/Bool.msg", "int32 data\n");
  const MessageDefinitions given({scratch.path()});
  EXPECT_EQ(parse_ros2_definition("a_msgs/A", "int8 y\n", &given).groups[0].fields[0].name, "y");
  EXPECT_EQ(parse_ros2_definition("a_msgs/A", "", &given).groups[0].fields[0].name, "x");
  // That of a standard package is the workspace's before ours.
  EXPECT_EQ(parse_ros2_definition("std_msgs/Bool", "", &given).groups[0].least, 4U);
}

std::string complaint(const ScratchFolder& scratch, const std::vector<fs::path>& paths) {
  try {
    const MessageDefinitions given(paths);
    return "none";
  } catch (const InputError& error) {
    const std::string text = error.what();
    const std::string folder = scratch.path().string() + "/";
    return text.starts_with(folder) ? text.substr(folder.size()) : text;
  }
}

TEST(MessageDefinitions, SayWhatIsWrong) {
  const ScratchFolder scratch;
  EXPECT_EQ(complaint(scratch, {scratch.path() / "gone"}),
            "gone: does not exist, expected a .msg file or a folder of them");
  EXPECT_EQ(complaint(scratch, {scratch.write("a.txt", "")}),
            "a.txt: is no .msg file, expected PACKAGE/NAME.msg or a folder");
  scratch.write("empty/a.txt", "");
  EXPECT_EQ(complaint(scratch, {scratch.path() / "empty"}),
            "empty: is a folder without .msg files, expected PACKAGE/NAME.msg or "
            "PACKAGE/msg/NAME.msg in it");
  scratch.write("w/one/p/A.msg", "int8 a\n");
  const fs::path two = scratch.write("w/two/p/msg/A.msg", "int8 a\r\n");
  EXPECT_EQ(complaint(scratch, {scratch.path() / "w"}), "none");
  scratch.write("w/two/p/msg/A.msg", "int8 b\n");
  EXPECT_EQ(complaint(scratch, {scratch.path() / "w"}),
            "w/two/p/msg/A.msg: defines p/A otherwise than " +
                (scratch.path() / "w/one/p/A.msg").string() + ", expected one of the two");
  scratch.write("w/two/p/msg/A.msg", std::string((1U << 20U) + 1, '#'));
  EXPECT_EQ(complaint(scratch, {two}),
            "w/two/p/msg/A.msg: has more than 1048576 bytes, expected the definition of a message");
}

TEST(MessageDefinitions, AMistakeInOneIsSaidWithItsFile) {
  const ScratchFolder scratch;
  scratch.write("p/A.msg", "int8 a\nB b\n");
  scratch.write("p/B.msg", "int8 a\nint9 b\n");
  const MessageDefinitions given({scratch.path() / "p"});
  try {
    static_cast<void>(parse_ros2_definition("p/msg/A", "", &given));
    ADD_FAILURE();
  } catch (const DefinitionError& error) {
    EXPECT_EQ(std::string(error.what()),
              "line 2 of " + (scratch.path() / "p/B.msg").string() + ": type int9 is not defined");
  }
}

}  // namespace
}  // namespace trussmap::message_definitions_test
