// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/bag_lines.hpp"
#include "logs/message_log.hpp"
#include "scratch_folder.hpp"
#include "trussmap/write_files.hpp"

#include <cstdlib>
#include <sqlite3.h>

#include <gtest/gtest.h>

namespace trussmap::rosbag2_test {
using namespace logs;
namespace {

namespace fs = std::filesystem;

using testing::ReadLog;
using testing::ScratchFolder;
using testing::TestBag;

class Rosbag2Variants : public ::testing::TestWithParam<const char*> {};

/// With nothing left in the folder of temporary files.
TEST_P(Rosbag2Variants, AreReadAsWritten) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), GetParam());
  ASSERT_FALSE(bag.path.empty());
  EXPECT_TRUE(is_rosbag2(bag.path));
  const fs::path temporary = scratch.path() / "temporary";
  fs::create_directories(temporary);
  ::setenv("TMPDIR", temporary.c_str(), 1);
  testing::expect_read_as_written(bag, 1000U);
  ::unsetenv("TMPDIR");
  EXPECT_TRUE(fs::is_empty(temporary));
}

INSTANTIATE_TEST_SUITE_P(Rosbag2, Rosbag2Variants,
                         ::testing::Values("db3_of_galactic", "db3_of_humble", "db3_of_iron",
                                           "folder_sqlite3", "folder_mcap", "folder_three_files",
                                           "folder_twelve_mcap_files", "folder_without_metadata",
                                           "folder_mcap_without_metadata",
                                           "folder_file_compression", "folder_message_compression",
                                           "folder_mcap_file_compression",
                                           "folder_mcap_message_compression",
                                           "folder_compressed_without_metadata"),
                         [](const auto& one) { return std::string(one.param); });

std::string complaint(const ScratchFolder& scratch, const fs::path& path) {
  const ReadLog log = testing::read_lines(path);
  EXPECT_EQ(log.error.find('\n'), std::string::npos);
  const std::string folder = scratch.path().string() + "/";
  return log.error.starts_with(folder) ? log.error.substr(folder.size())
                                       : log.error + "cut off " + log.end.cut_off;
}

TEST(Rosbag2, CutOffAnywhereIsRefusedInALineOrReadAsFarAsItGoes) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), "db3_of_iron");
  ASSERT_FALSE(bag.path.empty());
  const std::string whole = testing::content_of(bag.path);
  for (std::size_t size = 0; size < whole.size(); size += whole.size() / 97) {
    const ReadLog log =
        testing::read_lines(scratch.write(std::to_string(size) + ".db3", whole.substr(0, size)));
    EXPECT_EQ(log.lines, "") << size;
    EXPECT_NE(log.error.find(".db3: "), std::string::npos) << size;
    EXPECT_EQ(log.error.find('\n'), std::string::npos) << size;
  }
  EXPECT_EQ(
      complaint(scratch, scratch.write("cut.db3", whole.substr(0, 20 * 4096))),
      "cut.db3: cannot be read as a rosbag2 (database disk image is malformed), expected a whole "
      "database (copy it again, or sqlite3 FILE .recover)");
  EXPECT_EQ(
      complaint(scratch, scratch.write("cut.db3", whole.substr(0, whole.size() - 9))),
      "cut.db3: at byte " + std::to_string(whole.size() - 9) +
          ": the database is cut off, in the middle of a page of 4096 bytes, expected it whole "
          "(copy it again, or sqlite3 FILE .recover)");
  EXPECT_EQ(complaint(scratch, scratch.write("cut.db3", "")),
            "cut.db3: is empty, expected the SQLite file of a rosbag2");
  EXPECT_EQ(complaint(scratch, scratch.write("cut.db3", std::string(30840, 'x'))),
            "cut.db3: cannot be read as a rosbag2 (file is not a database)");
}

TEST(Rosbag2, ACompressedFileThatIsCutOffOrDamagedIsSaidToBe) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), "folder_mcap_file_compression");
  ASSERT_FALSE(bag.path.empty());
  const std::string whole = testing::content_of(bag.path / "drive_0.mcap.zstd");
  // A second frame that is cut off, after all of the bag.
  const ReadLog cut =
      testing::read_lines(scratch.write("cut.mcap.zstd", whole + whole.substr(0, 9)));
  EXPECT_EQ(cut.error, "");
  EXPECT_TRUE(cut.lines == bag.expected);
  EXPECT_EQ(cut.end.cut_off, "the zstd data end too soon");
  EXPECT_EQ(complaint(scratch, scratch.write("cut.mcap.zstd", whole.substr(0, 9))),
            "cut.mcap.zstd: the zstd data end too soon");
  EXPECT_EQ(complaint(scratch, scratch.write("cut.db3.zstd", whole.substr(0, whole.size() - 9))),
            "cut.db3.zstd: the zstd data end too soon");
  EXPECT_EQ(complaint(scratch, scratch.write("a.mcap.zstd", std::string(100, 'x'))),
            "a.mcap.zstd: at byte 0: the zstd data are damaged (Unknown frame descriptor)");
}

/// As a power cut leaves a bag: its last file without an end, and no metadata.
TEST(Rosbag2, ItsLastFileMayBeCutOff) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), "folder_mcap_without_metadata");
  ASSERT_FALSE(bag.path.empty());
  const fs::path last = bag.path / "drive_11.mcap";
  fs::resize_file(last, 40);
  const ReadLog log = testing::read_lines(bag.path);
  EXPECT_EQ(log.error, "");
  EXPECT_EQ(log.end.cut_off, "drive_11.mcap: at byte 8: ends in the middle of a header");
  EXPECT_GT(log.lines.size(), bag.expected.size() / 2);
  EXPECT_TRUE(bag.expected.starts_with(log.lines));
}

TEST(Rosbag2, WhatACompressedFileBecomesIsLimited) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), "folder_mcap_file_compression");
  ASSERT_FALSE(bag.path.empty());
  const fs::path temporary = scratch.path() / "temporary";
  fs::create_directories(temporary);
  ::setenv("TMPDIR", temporary.c_str(), 1);
  set_read_limits({1000});
  const std::string said = complaint(scratch, bag.path / "drive_0.mcap.zstd");
  set_read_limits({});
  ::unsetenv("TMPDIR");
  EXPECT_EQ(said,
            "drive/drive_0.mcap.zstd: the zstd data grow to more than 1000 bytes; allow more with "
            "--max-input-mib");
  EXPECT_TRUE(fs::is_empty(temporary));
}

/// Whatever it is called.
TEST(Rosbag2, ABagOfRos1IsReadAsOne) {
  const ScratchFolder scratch;
  for (const char* const name : {"a.bag", "a.db3"}) {
    EXPECT_EQ(complaint(scratch, scratch.write(name, "#ROSBAG V1.2\n....")),
              std::string(name) +
                  ": at byte 0: is a bag of ROS 1 of another version, expected #ROSBAG V2.0");
  }
}

std::string metadata(const std::string& paths, const std::string& more = "",
                     const std::string& storage = "sqlite3") {
  return "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: " + storage +
         "\n  relative_file_paths: " + paths + "\n" + more;
}

TEST(Rosbag2, MetadataAreNotTrusted) {
  const ScratchFolder scratch;
  scratch.write("outside.db3", "x");
  const fs::path folder = scratch.path() / "bag";
  const auto said = [&](const std::string& yaml) {
    scratch.write("bag/metadata.yaml", yaml);
    return complaint(scratch, folder);
  };
  const std::string name = "bag/metadata.yaml";
  const std::string outside = ", expected one within the folder";
  EXPECT_EQ(said(metadata("[../outside.db3]")),
            name + ": names the file \"../outside.db3\"" + outside);
  EXPECT_EQ(said(metadata("[a/../../outside.db3]")),
            name + ": names the file \"a/../../outside.db3\"" + outside);
  EXPECT_EQ(said(metadata("[/etc/passwd]")), name + ": names the file \"/etc/passwd\"" + outside);
  EXPECT_EQ(said(metadata("['']")), name + ": names the file \"\"" + outside);
  EXPECT_EQ(said(metadata("[gone.db3]")),
            name + ": names the file \"gone.db3\", which is not in the folder");
  EXPECT_EQ(said(metadata("[[a]]")), name + ": relative_file_paths has an entry that is no name");
  EXPECT_EQ(said(metadata("[]")), "bag: has no files of a rosbag2 (.db3, .mcap)");
  EXPECT_EQ(said(metadata("[a.db3]", "", "hdf5")),
            name + ": storage_identifier is \"hdf5\", expected sqlite3 or mcap");
  EXPECT_EQ(said(metadata("[a.db3]", "  compression_format: lz4\n")),
            name + ": compression_format is \"lz4\", expected zstd");
  EXPECT_EQ(said("a: b\n"),
            name + ": has no rosbag2_bagfile_information, expected the metadata of a rosbag2");
  EXPECT_EQ(said("- a\n- b: [\n"), name + ":3: end of sequence flow not found, expected YAML");
  EXPECT_EQ(said(std::string(100000, '[')).substr(0, 19), name + ":1");
}

/// A folder that was renamed, of a version whose paths began with its name.
TEST(Rosbag2, PathsMayBeginWithTheFoldersName) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), "folder_sqlite3");
  ASSERT_FALSE(bag.path.empty());
  scratch.write("drive/metadata.yaml", metadata("[old/drive_0.db3]"));
  EXPECT_TRUE(testing::read_lines(bag.path).lines == bag.expected);
}

/// Runs statements on a database.
void run(const fs::path& file, const std::string& sql) {
  sqlite3* base = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &base), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(base, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(base);
  sqlite3_close(base);
}

const std::string kTopics =
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name, type, serialization_format);";
const std::string kMessages =
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data);";

TEST(Rosbag2, TablesAreNotTrusted) {
  const ScratchFolder scratch;
  const auto said = [&scratch](const std::string& sql) {
    const fs::path file = scratch.path() / "a.db3";
    fs::remove(file);
    run(file, sql);
    return complaint(scratch, file);
  };
  EXPECT_EQ(said("CREATE TABLE a(b)"),
            "a.db3: has no table topics, expected a rosbag2 with topics and messages");
  // A view that never ends.
  EXPECT_EQ(said(kTopics + "CREATE VIEW messages AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL "
                           "SELECT x+1 FROM c) SELECT x, x AS timestamp, x AS data FROM c"),
            "a.db3: has no table messages, expected a rosbag2 with topics and messages");
  EXPECT_EQ(said(kMessages + "CREATE TABLE topics(id)"),
            "a.db3: cannot be read as a rosbag2 (no such column: name)");
  const std::string topic = kTopics + kMessages +
                            "INSERT INTO topics VALUES (1, '/a', 'std_msgs/msg/Int8', 'cdr');"
                            "INSERT INTO topics VALUES (2, '/b', 'my_msgs/msg/A', 'cdr');"
                            "INSERT INTO topics VALUES (3, '/c', 'std_msgs/msg/Int8', 'xcdr');";
  EXPECT_EQ(said(topic + "INSERT INTO messages VALUES (7, 4, 5, x'0001000003')"),
            "a.db3: message 7 is of topic 4, which it has not");
  EXPECT_EQ(said(topic + "INSERT INTO messages VALUES (7, 1, 'now', x'0001000003')"),
            "a.db3: has a row without a number in column timestamp, expected a rosbag2");
  EXPECT_EQ(said(topic + "INSERT INTO messages VALUES (7, 1, 5, NULL)"),
            "a.db3: message 7: a message of /a has 0 bytes, expected 4 or more");
  EXPECT_EQ(said(topic + "INSERT INTO messages VALUES (7, 1, -5, x'0001000003')"),
            "a.db3: message 7: a message of /a is 18446744073709551611 ns after the epoch, "
            "expected 9223372036854775807 at most");
  EXPECT_EQ(said(topic + "INSERT INTO messages VALUES (7, 1, 5, x'28b52ffd00')").substr(0, 50),
            std::string("a.db3: message 7: a message of /a cannot be decompressed").substr(0, 50));
  EXPECT_EQ(said(topic + "INSERT INTO messages VALUES (7, 2, 5, x'00')"), "cut off ");
  const ReadLog log = testing::read_lines(scratch.path() / "a.db3");
  ASSERT_EQ(log.end.topics.size(), 3U);
  EXPECT_EQ(log.end.topics[1].unread,
            "the bag has no definition of my_msgs/A; --definitions takes its .msg file");
  EXPECT_EQ(log.end.topics[1].messages, 1U);
  EXPECT_EQ(log.end.topics[2].unread, "xcdr");
}

TEST(Rosbag2, WhatARecorderLeftBesideIsSaidToBeLeftOut) {
  const ScratchFolder scratch;
  const TestBag bag = testing::write_test_bag(scratch.path(), "db3_of_iron");
  ASSERT_FALSE(bag.path.empty());
  scratch.write("bag.db3-wal", "something");
  const ReadLog log = testing::read_lines(bag.path);
  EXPECT_TRUE(log.lines == bag.expected);
  EXPECT_EQ(log.end.cut_off,
            "what its recorder left in bag.db3-wal is not read; it comes in when sqlite3 opens "
            "the bag");
  EXPECT_EQ(testing::content_of(scratch.path() / "bag.db3-wal"), "something");
}

TEST(Rosbag2, AFolderOfARecordingIsNone) {
  const ScratchFolder scratch;
  scratch.write("drive.csv", "t,left,right\n");
  EXPECT_FALSE(is_rosbag2(scratch.path()));
  EXPECT_FALSE(is_rosbag2(scratch.path() / "none.db3"));
  EXPECT_FALSE(is_mcap(scratch.path() / "none.mcap"));
}

}  // namespace
}  // namespace trussmap::rosbag2_test
