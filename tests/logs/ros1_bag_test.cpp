// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/bag_lines.hpp"
#include "logs/cdr.hpp"
#include "logs/message_log.hpp"
#include "scratch_folder.hpp"
#include "trussmap/log_files.hpp"
#include "trussmap/recording_files.hpp"

#include <cstring>
#include <set>

#include <gtest/gtest.h>

namespace trussmap::ros1_bag_test {
using namespace logs;
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;
using testing::ReadLog;
using testing::ScratchFolder;
using testing::TestBag;

class Ros1BagVariants : public ::testing::TestWithParam<const char*> {};

TEST_P(Ros1BagVariants, AreReadAsWritten) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), GetParam());
  ASSERT_FALSE(bag.path.empty());
  EXPECT_TRUE(is_rosbag2(bag.path));
  testing::expect_read_as_written(bag, 100000U);
}

INSTANTIATE_TEST_SUITE_P(Ros1Bag, Ros1BagVariants,
                         ::testing::Values("ros1_plain", "ros1_bz2", "ros1_lz4", "ros1_one_chunk",
                                           "ros1_of_any_name", "ros1_split"),
                         [](const auto& one) { return std::string(one.param); });

/// A recorder that lost its power: the last chunk has no size yet.
TEST(Ros1Bag, OneThatWasNotClosedIsReadToItsEnd) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), "ros1_not_closed");
  ASSERT_FALSE(bag.path.empty());
  const ReadLog log = testing::read_lines(bag.path);
  EXPECT_EQ(log.error, "");
  EXPECT_EQ(log.end.cut_off, "at byte " + std::to_string(fs::file_size(bag.path)) +
                                 ": all messages are read, but its end is missing");
  EXPECT_TRUE(log.lines == bag.expected);
}

TEST(Ros1Bag, AChunkThatWasBeingCompressedIsLost) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), "ros1_bz2_not_closed");
  ASSERT_FALSE(bag.path.empty());
  const ReadLog log = testing::read_lines(bag.path);
  EXPECT_EQ(log.error, "");
  EXPECT_NE(log.end.cut_off.find(": ends in the middle of a chunk"), std::string::npos);
  EXPECT_TRUE(bag.expected.starts_with(log.lines));
  EXPECT_GT(log.lines.size() + 20000, bag.expected.size());
}

class SmallRos1Bag : public ::testing::TestWithParam<const char*> {};

TEST_P(SmallRos1Bag, CutOffAnywhereGivesWhatWasComplete) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), GetParam());
  ASSERT_FALSE(bag.path.empty());
  const std::string whole = testing::content_of(bag.path);
  std::set<std::size_t> lengths;
  for (std::size_t size = 0; size < whole.size(); size += 10) {
    const auto file = scratch.write(std::to_string(size) + ".bag", whole.substr(0, size));
    const ReadLog log = testing::read_lines(file);
    EXPECT_TRUE(bag.expected.starts_with(log.lines)) << size;
    EXPECT_NE(log.error.empty(), log.end.cut_off.empty()) << size;
    EXPECT_NE((log.error + log.end.cut_off).find("at byte "), std::string::npos) << size;
    EXPECT_TRUE(log.error.empty() || size <= 13 || log.end.topics.empty()) << log.error;
    lengths.insert(log.lines.size());
  }
  EXPECT_GT(lengths.size(), 3U);
  EXPECT_EQ(*lengths.rbegin(), bag.expected.size());
}

/// A bag has no checksums of its own: what is noticed is one line, with the place.
TEST_P(SmallRos1Bag, AChangedByteGivesALineOrMessages) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), GetParam());
  ASSERT_FALSE(bag.path.empty());
  const std::string whole = testing::content_of(bag.path);
  const bool packed = std::string(GetParam()) == "ros1_small_bz2";  // bzip2 has checksums
  std::size_t noticed = 0;
  for (std::size_t at = 0; at < whole.size(); at += 7) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x15);
    const ReadLog log = testing::read_lines(scratch.write("changed.bag", changed));
    if (log.error.empty()) {
      const bool before = log.lines == bag.expected || !log.end.cut_off.empty();
      EXPECT_TRUE(before || !packed) << at;
      continue;
    }
    EXPECT_NE(log.error.find("changed.bag: at byte "), std::string::npos) << log.error;
    EXPECT_EQ(log.error.find('\n'), std::string::npos) << log.error;
    ++noticed;
  }
  EXPECT_GT(noticed, 100U);
}

INSTANTIATE_TEST_SUITE_P(Ros1Bag, SmallRos1Bag,
                         ::testing::Values("ros1_small", "ros1_small_bz2", "ros1_small_lz4"),
                         [](const auto& one) { return std::string(one.param); });

/// From the specification, by hand.
std::string u32(std::uint32_t value) {
  std::string bytes(4, '\0');
  std::memcpy(bytes.data(), &value, 4);
  return bytes;
}
std::string field(const std::string& name, const std::string& value) {
  const std::string text = name + "=" + value;
  return u32(static_cast<std::uint32_t>(text.size())) + text;
}
std::string record(int op, const std::string& header, const std::string& data) {
  const std::string whole = field("op", std::string(1, static_cast<char>(op))) + header;
  return u32(static_cast<std::uint32_t>(whole.size())) + whole +
         u32(static_cast<std::uint32_t>(data.size())) + data;
}
std::string bag_header(std::uint32_t index = 0, std::uint32_t chunks = 0) {
  return "#ROSBAG V2.0\n" +
         record(3,
                field("index_pos", u32(index) + u32(0)) + field("conn_count", u32(0)) +
                    field("chunk_count", u32(chunks)),
                "");
}
std::string connection(std::uint32_t id, const std::string& topic, const std::string& type,
                       const std::string& definition) {
  return record(7, field("conn", u32(id)) + field("topic", topic),
                field("type", type) + field("message_definition", definition));
}
std::string message(std::uint32_t id, std::uint32_t sec, std::uint32_t nsec,
                    const std::string& data) {
  return record(2, field("conn", u32(id)) + field("time", u32(sec) + u32(nsec)), data);
}
std::string chunk(const std::string& compression, std::uint32_t size, const std::string& data) {
  return record(5, field("compression", compression) + field("size", u32(size)), data);
}

std::string complaint(const ScratchFolder& scratch, const std::string& bytes) {
  const ReadLog log = testing::read_lines(scratch.write("a.bag", bytes));
  const std::string name = (scratch.path() / "a.bag").string() + ": ";
  return log.error.starts_with(name) ? log.error.substr(name.size())
                                     : log.error + "cut off " + log.end.cut_off;
}

TEST(Ros1Bag, SaysWhatIsWrong) {
  const ScratchFolder scratch;
  const std::string begin = bag_header();
  const std::string at = "at byte " + std::to_string(begin.size()) + ": ";
  EXPECT_EQ(complaint(scratch, "nothing of a bag"),
            "at byte 0: does not begin as a bag of ROS 1 does, expected #ROSBAG V2.0");
  EXPECT_EQ(complaint(scratch, "#ROSBAG V1.2\n...."),
            "at byte 0: is a bag of ROS 1 of another version, expected #ROSBAG V2.0");
  EXPECT_EQ(complaint(scratch, "#ROSBAG V2.0\n" + chunk("none", 0, "")),
            "at byte 13: a record of op 5, expected the header of the bag (op 3)");
  EXPECT_EQ(complaint(scratch, begin + message(4, 1, 2, "")),
            at + "a message of connection 4, expected one that a record before it describes");
  EXPECT_EQ(complaint(scratch, begin + chunk("zip", 4, "abcd")),
            at + "a chunk is compressed by \"zip\", expected none, bz2 or lz4");
  EXPECT_EQ(complaint(scratch, begin + chunk("none", 5, "abcd")),
            at + "a chunk is damaged: its records have 4 bytes, expected 5");
  EXPECT_EQ(complaint(scratch, begin + chunk("bz2", 5, "abcd")),
            at + "a chunk is damaged: its bzip2 data are damaged");
  EXPECT_EQ(complaint(scratch, begin + chunk("bz2", 0xFFFFFFFFU, "abcd")),
            at + "a chunk of 4294967295 bytes, expected 268435456 at most");
  const std::string known = begin + connection(1, "/a", "a/A", "int32 x\n");
  const std::string later = "at byte " + std::to_string(known.size()) + ": ";
  EXPECT_EQ(complaint(scratch, known + connection(1, "/b", "a/A", "int32 x\n")),
            later + "connection 1 is described twice, expected the same again");
  EXPECT_EQ(complaint(scratch, known + message(1, 1, 2, "abcde")),
            later +
                "a message of /a has 1 bytes after its last field, expected the fields of a/A "
                "alone");
  EXPECT_EQ(complaint(scratch, known + message(1, 1, 2, "abc")),
            later + "a message of /a needs 4 bytes for a/A, 3 are left");
}

TEST(Ros1Bag, ATopicWhoseDefinitionIsWrongIsListedAsUnread) {
  const ScratchFolder scratch;
  const auto unread = [&scratch](const std::string& definition) {
    const std::string bytes =
        bag_header() + connection(1, "/a", "a/A", definition) + message(1, 1, 2, "");
    const ReadLog log = testing::read_lines(scratch.write("a.bag", bytes));
    EXPECT_EQ(log.error, "");
    EXPECT_EQ(log.end.topics.at(0).messages, 1U);
    return log.end.topics.at(0).unread;
  };
  EXPECT_EQ(unread("int32 x\nwide y\n"), "line 2 of its definition: type wide is not defined");
  // A type of the standard packages is what the bag says, or nothing: ROS 2 has others.
  EXPECT_EQ(unread("std_msgs/Float64 x\n"),
            "line 1 of its definition: type std_msgs/Float64 is not defined");
  EXPECT_EQ(unread("a/A x\n"), "line 1 of its definition: type a/A contains itself");
}

/// Bytes by hand: no gaps, texts without a closing zero, nothing for what is empty.
TEST(Ros1Bag, MessagesStandWithoutGaps) {
  const Ros2Layout layout = parse_ros1_definition(
      "a/A", "byte a\nfloat64 b\nstring c\nE nothing\nE[] none\ntime t\nduration[1] d\n"s +
                 std::string(80, '=') + "\nMSG: a/E\n");
  FieldTree tree;
  const std::string message =
      "\xFE\0\0\0\0\0\0\xF8\x3F\3\0\0\0hi\0\2\0\0\0\1\0\0\x80\5\0\0\0\xFF\xFF\xFF\xFF\6\0\0\0"s;
  decode_ros1(message, layout, 10, tree);
  std::string lines;
  testing::add_lines(lines, tree.root(), "");
  EXPECT_EQ(lines,
            " a integer -2\n b number 3ff8000000000000\n c text 686900\n none list 2\n"
            " t.sec integer 2147483649\n t.nanosec integer 5\n d list 1\n d[0].sec integer -1\n"
            " d[0].nanosec integer 6\n");
}

/// Lists without end of what has no bytes.
TEST(Ros1Bag, WhatIsEmptyCostsNothing) {
  const std::string line(80, '=');
  const Ros2Layout layout =
      parse_ros1_definition("a/A", "E[4000000000] a\nF[4000000000] b\nE[] c\n" + line +
                                       "\nMSG: a/E\n" + line + "\nMSG: a/F\nE[4000000000] d\n");
  FieldTree tree;
  const std::string message = u32(0xFFFFFFFFU);
  decode_ros1(message, layout, 10, tree);
  EXPECT_LE(tree.size(), kMostMessageFields + 4);
  EXPECT_EQ(tree.root().member("c")->field().length, 0xFFFFFFFFU);
}

/// The same drive by ROS 1 and by ROS 2: the same first map, the same recording.
TEST(Ros1Bag, IsTheRecordingThatRos2Has) {
  const ScratchFolder one;
  const ScratchFolder two;
  const TestBag old = testing::write_test_bag(one.path(), "drive_of_ros1");
  const TestBag now = testing::write_test_bag(two.path(), "drive_of_ros2");
  ASSERT_FALSE(old.path.empty() || now.path.empty());
  const std::string map_of_old = inspect_log(old.path).map;
  const std::string map_of_now = inspect_log(now.path).map;
  const auto body = [](const std::string& map) { return map.substr(map.find("[time]")); };
  EXPECT_EQ(body(map_of_old), body(map_of_now));
  EXPECT_NE(map_of_old.find("left.field"), std::string::npos) << map_of_old;
  EXPECT_NE(map_of_old.find("[fixes]"), std::string::npos) << map_of_old;
  const LogRecording of_old = read_log_recording(old.path, one.write("map.toml", map_of_old));
  const LogRecording of_now = read_log_recording(now.path, two.write("map.toml", map_of_now));
  EXPECT_EQ(of_old.epoch, of_now.epoch);
  const Recording& a = of_old.recording;
  const auto texts = [](const ScratchFolder& scratch, const LogRecording& read) {
    write_recording(scratch.path() / "rec", read.recording, "", {});
    std::string all;
    for (const char* const name : {"drive.csv", "sightings.csv", "fixes.csv"}) {
      all += testing::content_of(scratch.path() / "rec" / name);
    }
    return all;
  };
  EXPECT_EQ(a.drive.rows(), 1199U);
  EXPECT_EQ(a.sightings.size(), 11U);  // of those at the very begin and end one is not within
  EXPECT_EQ(a.fixes.size(), 11U);
  EXPECT_EQ(texts(one, of_old), texts(two, of_now));
}

}  // namespace
}  // namespace trussmap::ros1_bag_test
