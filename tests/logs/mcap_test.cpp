// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/bag_lines.hpp"
#include "logs/message_log.hpp"
#include "scratch_folder.hpp"

#include <cstring>
#include <map>
#include <set>

#include <gtest/gtest.h>

namespace trussmap::mcap_test {
using namespace logs;
namespace {

using testing::ReadLog;
using testing::ScratchFolder;
using testing::TestBag;

/// From the specification: records, texts and numbers of MCAP.
template <typename T>
std::string number(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}
std::string text(const std::string& value) {
  return number<std::uint32_t>(static_cast<std::uint32_t>(value.size())) + value;
}
std::string record(int type, const std::string& content) {
  return static_cast<char>(type) + number<std::uint64_t>(content.size()) + content;
}
const std::string kMagic("\x89MCAP0\r\n", 8);
const std::string kBegin = kMagic + record(1, text("") + text(""));
const std::string kEnd =
    record(15, number<std::uint32_t>(0)) + record(2, std::string(20, '\0')) + kMagic;

std::string channel(int id, int schema, const std::string& topic, const std::string& encoding) {
  return record(4, number<std::uint16_t>(static_cast<std::uint16_t>(id)) +
                       number<std::uint16_t>(static_cast<std::uint16_t>(schema)) + text(topic) +
                       text(encoding) + text(""));
}
std::string schema(int id, const std::string& type, const std::string& encoding,
                   const std::string& definition) {
  return record(3, number<std::uint16_t>(static_cast<std::uint16_t>(id)) + text(type) +
                       text(encoding) + text(definition));
}
std::string message(int id, std::uint64_t time, const std::string& data) {
  return record(5, number<std::uint16_t>(static_cast<std::uint16_t>(id)) +
                       number<std::uint32_t>(0) + number(time) + number(time) + data);
}
std::string chunk(const std::string& compression, const std::string& records, std::uint64_t size,
                  std::uint32_t crc = 0) {
  return record(6, number<std::uint64_t>(0) + number<std::uint64_t>(0) + number(size) +
                       number(crc) + text(compression) + number<std::uint64_t>(records.size()) +
                       records);
}
const std::string kInt8 = std::string("\0\1\0\0", 4);
const std::string kByteTopic =
    schema(1, "std_msgs/msg/Int8", "ros2msg", "int8 data") + channel(1, 1, "/a", "cdr");

class McapVariants : public ::testing::TestWithParam<const char*> {};

TEST_P(McapVariants, AreReadAsWritten) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), GetParam());
  ASSERT_FALSE(bag.path.empty());
  EXPECT_TRUE(is_mcap(bag.path));
  testing::expect_read_as_written(bag, 1000U);
}

INSTANTIATE_TEST_SUITE_P(Mcap, McapVariants,
                         ::testing::Values("mcap_plain", "mcap_lz4", "mcap_zstd", "mcap_one_chunk",
                                           "mcap_unchunked", "mcap_without_summary",
                                           "mcap_without_checksums", "mcap_without_definitions",
                                           "mcap_idl", "mcap_as_rosbag2", "mcap_big_endian",
                                           "mcap_wide_characters", "mcap_with_others"),
                         [](const auto& one) { return std::string(one.param); });

/// Whether all of it is a beginning of `expected` that ends with a whole message.
bool is_beginning(const std::string& lines, const std::string& expected) {
  if (!expected.starts_with(lines)) return false;
  return lines.size() == expected.size() || expected[lines.size()] == '/';
}

class SmallMcap : public ::testing::TestWithParam<const char*> {};

TEST_P(SmallMcap, CutOffAnywhereGivesWhatWasComplete) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), GetParam());
  ASSERT_FALSE(bag.path.empty());
  const std::string whole = testing::content_of(bag.path);
  std::set<std::size_t> lengths;
  for (std::size_t size = 0; size < whole.size(); size += 10) {
    const auto file = scratch.write(std::to_string(size) + ".mcap", whole.substr(0, size));
    const ReadLog log = testing::read_lines(file);
    EXPECT_TRUE(is_beginning(log.lines, bag.expected)) << size;
    EXPECT_NE(log.error.empty(), log.end.cut_off.empty()) << size;
    EXPECT_NE((log.error + log.end.cut_off).find("at byte "), std::string::npos) << size;
    EXPECT_EQ(log.error.empty(), size > 8) << log.error;
    lengths.insert(log.lines.size());
  }
  EXPECT_GT(lengths.size(), 3U);
  EXPECT_EQ(*lengths.rbegin(), bag.expected.size());
}

TEST_P(SmallMcap, AChangedByteIsNoticedOrHarmless) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), GetParam());
  ASSERT_FALSE(bag.path.empty());
  const std::string whole = testing::content_of(bag.path);
  std::size_t noticed = 0;
  for (std::size_t at = 0; at < whole.size(); at += 7) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x15);
    const ReadLog log = testing::read_lines(scratch.write(std::to_string(at) + ".mcap", changed));
    if (log.error.empty()) {
      EXPECT_TRUE(log.lines == bag.expected) << at;
    } else {
      EXPECT_NE(log.error.find(".mcap: at byte "), std::string::npos) << log.error;
      EXPECT_EQ(log.error.find('\n'), std::string::npos) << log.error;
      ++noticed;
    }
    // Without chunks a checksum is there for all data alone, at their end.
    if (std::string(GetParam()) != "small_unchunked") {
      EXPECT_TRUE(is_beginning(log.lines, bag.expected) || !log.error.empty()) << at;
    }
  }
  EXPECT_GT(noticed, 100U);
}

INSTANTIATE_TEST_SUITE_P(Mcap, SmallMcap,
                         ::testing::Values("small_plain", "small_lz4", "small_zstd",
                                           "small_unchunked"),
                         [](const auto& one) { return std::string(one.param); });

TEST(Mcap, UnwantedTopicsAreCountedAlone) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), "mcap_lz4");
  ASSERT_FALSE(bag.path.empty());
  std::map<std::string, int> asked;
  std::map<std::string, std::uint64_t> seen;
  LogVisit visit;
  visit.elements = 3;
  visit.wanted = [&asked](const LogTopic& topic) {
    ++asked[topic.name];
    EXPECT_EQ(topic.encoding, "cdr");
    EXPECT_EQ(topic.unread, "");
    EXPECT_EQ(topic.messages, 0U);
    return topic.name == "/odom" || topic.name == "/image";
  };
  visit.message = [&seen](const LogMessage& one) {
    ++seen[one.topic.name];
    EXPECT_EQ(one.topic.messages, seen[one.topic.name]);
    if (one.topic.name == "/odom") {
      EXPECT_EQ(one.topic.type, "nav_msgs/msg/Odometry");
      const FieldRef list = *one.fields.member("pose")->member("covariance");
      EXPECT_EQ(list.field().length, 36U);
      EXPECT_EQ(list.children().size(), 3U);
    } else {
      EXPECT_EQ(one.fields.member("data")->field().length, 10U);
      EXPECT_EQ(one.fields.member("data")->element(2)->number(), 2.0);
      EXPECT_FALSE(one.fields.member("data")->element(3));
    }
  };
  const LogEnd end = read_mcap(bag.path, visit);
  EXPECT_EQ(seen, (std::map<std::string, std::uint64_t>{{"/image", 6}, {"/odom", 60}}));
  for (const auto& [name, times] : asked) EXPECT_EQ(times, 1) << name;
  std::map<std::string, std::uint64_t> counted;
  for (const LogTopic& topic : end.topics) counted[topic.name] = topic.messages;
  EXPECT_EQ(counted.size(), 14U);
  EXPECT_EQ(counted["/imu"], 30U);
  EXPECT_EQ(counted["/everything"], 60U);
}

std::string complaint(const ScratchFolder& scratch, const std::string& bytes) {
  const ReadLog log = testing::read_lines(scratch.write("a.mcap", bytes));
  const std::string name = (scratch.path() / "a.mcap").string() + ": ";
  return log.error.starts_with(name) ? log.error.substr(name.size())
                                     : log.error + "cut off " + log.end.cut_off;
}

TEST(Mcap, SaysWhatIsWrong) {
  const ScratchFolder scratch;
  EXPECT_EQ(complaint(scratch, ""), "at byte 0: the file is empty, expected an MCAP file");
  EXPECT_EQ(complaint(scratch, "#ROSBAG V2.0\n"), "at byte 0: does not begin as an MCAP file does");
  EXPECT_EQ(complaint(scratch, "\x89MCAP1\r\n"),
            "at byte 5: is MCAP of another version, expected version 0");
  EXPECT_EQ(complaint(scratch, kMagic + kEnd),
            "at byte 8: a record of type 15, expected the header (type 1)");
  EXPECT_EQ(complaint(scratch, kBegin + message(3, 0, "") + kEnd),
            "at byte 34: a message of channel 3, expected one that a record before it describes");
  EXPECT_EQ(complaint(scratch, kBegin + record(0, "") + kEnd),
            "at byte 25: a record of type 0, expected 1 to 255");
  EXPECT_EQ(complaint(scratch, kBegin + channel(1, 7, "/a", "cdr") + kEnd),
            "at byte 51: channel 1 has schema 7, expected one that a record before it describes");
  EXPECT_EQ(complaint(scratch, kBegin + kByteTopic + channel(1, 1, "/b", "cdr") + kEnd),
            "at byte 122: channel 1 is described twice, expected the same again");
  const std::string a_message = kBegin + kByteTopic + message(1, 5, kInt8) + kEnd;
  EXPECT_EQ(complaint(scratch, a_message),
            "at byte 120: a message of /a needs 1 bytes for std_msgs/Int8, 0 are left");
  EXPECT_EQ(complaint(scratch, kBegin + kByteTopic + message(1, ~std::uint64_t{0}, "") + kEnd),
            "at byte 120: a message of /a is 18446744073709551615 ns after the epoch, expected "
            "9223372036854775807 at most");
}

TEST(Mcap, SizesAreBelievedOnceTheBytesAreThere) {
  const ScratchFolder scratch;
  const std::string long_record = std::string("\5") + number(~std::uint64_t{0} >> 1U);
  EXPECT_EQ(complaint(scratch, kBegin + long_record + kEnd),
            "at byte 25: a message of 9223372036854775807 bytes, expected to end before the file "
            "does");
  EXPECT_EQ(complaint(scratch, kBegin + long_record + "abc"),
            "cut off at byte 25: ends in the middle of a message");
  EXPECT_EQ(complaint(scratch, kBegin + chunk("lz4", "x", std::uint64_t{1} << 40U) + kEnd),
            "at byte 34: a chunk of 1099511627776 bytes, expected 268435456 at most");
  EXPECT_TRUE(complaint(scratch, kBegin + chunk("zstd", "x", 1U << 28U) + kEnd)
                  .starts_with("at byte 34: a chunk is damaged: its "));
  EXPECT_EQ(complaint(scratch, kBegin + chunk("", "abc", 4) + kEnd),
            "at byte 34: a chunk is damaged: its records have 3 bytes, expected 4");
  EXPECT_EQ(complaint(scratch, kBegin + chunk("bz2", "abc", 4) + kEnd),
            "at byte 34: a chunk is compressed by \"bz2\", expected lz4, zstd or nothing");
  EXPECT_EQ(complaint(scratch, kBegin + chunk("", "abc", 3, 7) + kEnd),
            "at byte 34: a chunk is damaged: its checksum (CRC-32) is 891568578, expected 7");
  EXPECT_EQ(complaint(scratch, kBegin + chunk("", "abc", 3) + kEnd),
            "at byte 75: needs 8 more bytes, 2 are left");
}

TEST(Mcap, AFileOfAPowerCutIsReadAsFarAsItGoes) {
  const ScratchFolder scratch;
  const std::string whole = kBegin + kByteTopic + message(1, 5, kInt8 + '\x7F');
  for (const auto& [rest, said] : std::map<std::string, std::string>{
           {"", "at byte 147: ends before the record that ends its data"},
           {std::string(5000, '\0'), "at byte 147: has nothing but zeros from here on"},
           {"\5", "at byte 147: ends in the middle of a record"},
           {record(15, number<std::uint32_t>(0)),
            "at byte 160: all messages are read, but its end is missing"}}) {
    const ReadLog log = testing::read_lines(scratch.write("a.mcap", whole + rest));
    EXPECT_EQ(log.error, "");
    EXPECT_EQ(log.end.cut_off, said);
    EXPECT_EQ(log.lines, "/a 5 5\n data integer 127\n");
  }
}

TEST(Mcap, TopicsThatCannotBeReadSayWhy) {
  const ScratchFolder scratch;
  const auto unread = [&scratch](const std::string& type, const std::string& encoding,
                                 const std::string& definition, const std::string& of_messages) {
    const std::string bytes = kBegin + schema(1, type, encoding, definition) +
                              channel(1, 1, "/a", of_messages) + message(1, 5, "") + kEnd;
    const ReadLog log = testing::read_lines(scratch.write("a.mcap", bytes));
    EXPECT_EQ(log.error, "");
    EXPECT_EQ(log.lines, "");
    EXPECT_EQ(log.end.topics.at(0).messages, 1U);
    return log.end.topics.at(0).unread;
  };
  EXPECT_EQ(unread("foxglove.Pose", "protobuf", "..", "protobuf"), "protobuf");
  EXPECT_EQ(unread("Pose", "jsonschema", "{}", "json"), "json");
  EXPECT_EQ(unread("my_msgs/msg/A", "ros2idl", "..", "cdr"), "ros2idl");
  EXPECT_EQ(unread("my_msgs/msg/A", "", "", "cdr"),
            "the bag has no definition of my_msgs/A; --definitions takes its .msg file");
  EXPECT_EQ(unread("my_msgs/msg/A", "ros2msg", "int8 a\nint9 b\n", "cdr"),
            "line 2 of its definition: type int9 is not defined");
  EXPECT_EQ(unread("a/msg/A", "ros2msg", "string a\n", "ros1"), "ros1");
}

/// Two channels of one topic, as of two senders, and one with another type.
TEST(Mcap, TopicsAreToldByTheirNames) {
  const ScratchFolder scratch;
  const std::string bytes = kBegin + kByteTopic + channel(2, 1, "/a", "cdr") +
                            schema(2, "std_msgs/msg/UInt8", "ros2msg", "uint8 data") +
                            channel(3, 2, "/a", "cdr") + message(1, 1, kInt8 + '\xFF') +
                            message(2, 2, kInt8 + '\xFE') + message(3, 3, kInt8 + '\xFD') + kEnd;
  const ReadLog log = testing::read_lines(scratch.write("a.mcap", bytes));
  EXPECT_EQ(log.lines,
            "/a 1 1\n data integer -1\n/a 2 2\n data integer -2\n/a 3 3\n data integer 253\n");
  ASSERT_EQ(log.end.topics.size(), 1U);
  EXPECT_EQ(log.end.topics[0].messages, 3U);
}

}  // namespace
}  // namespace trussmap::mcap_test
