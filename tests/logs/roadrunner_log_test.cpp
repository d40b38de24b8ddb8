// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The logs are written by tests/logs/bags/roadrunner_writer.py, after the same source.
#include "log_messages.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::roadrunner_log_test {
using namespace logs;
namespace {

using testing::bytes_of;
using testing::LoggedMessages;
using testing::messages_of;
using testing::ScratchFolder;
using testing::written_by;
using Lines = std::vector<std::string>;

LoggedMessages logged(const std::string& script, std::size_t elements = 4096) {
  const ScratchFolder scratch;
  const auto file = written_by(scratch, "from roadrunner_writer import *\n" + script);
  EXPECT_TRUE(is_roadrunner_log(file));
  return messages_of(read_roadrunner_log, file, elements);
}

std::string all_types(int version) {
  return "with RoadRunnerLog(path, " + std::to_string(version) + R"() as log:
  POSE = struct_of(timestamp=LONG, x=DOUBLE, y=DOUBLE, heading=DOUBLE)
  MODE = enum_of('INIT', 'RUN', 'STOP')
  log.channel('POSE', POSE)
  log.channel('ALL', struct_of(b=BOOLEAN, i=INT, l=LONG, d=DOUBLE, s=STRING, mode=MODE, pose=POSE,
                               ints=array_of(INT), grid=array_of(array_of(DOUBLE)),
                               poses=array_of(POSE), texts=array_of(STRING)))
  log.channel('MODE', MODE)
  log.channel('PRE_INIT', LONG)
  pose = {'timestamp': 2**53 + 1, 'x': 0.1, 'y': -1e-300, 'heading': 3.0}
  for k in range(3):
    log.write('POSE', pose)
    log.write('MODE', k)
  log.write('PRE_INIT', -2**63)
  log.channel('LATE', STRING)
  log.write('LATE', 'größe')
  log.write('ALL', {'b': True, 'i': -2**31, 'l': 2**63 - 1, 'd': 0.1, 's': '', 'mode': 'RUN',
                    'pose': pose, 'ints': [1, 2, 3], 'grid': [[], [0.5]], 'poses': [pose],
                    'texts': ['a', 'bc']})
)";
}

TEST(RoadRunnerLog, EveryTypeGivesTheValueWritten) {
  const std::string pose =
      "{timestamp=9007199254740993i x=0.10000000000000001 y=-1e-300 heading=3}";
  // Version 0 pads channels that have arrays.
  for (const int version : {0, 1}) {
    const LoggedMessages found = logged(all_types(version));
    EXPECT_EQ(found.error, "");
    EXPECT_EQ(found.end.cut_off, "");
    EXPECT_EQ(found.lines,
              (Lines{"POSE " + pose, "MODE 'INIT'", "POSE " + pose, "MODE 'RUN'", "POSE " + pose,
                     "MODE 'STOP'", "PRE_INIT -9223372036854775808i", "LATE 'größe'",
                     "ALL {b=1i i=-2147483648i l=9223372036854775807i d=0.10000000000000001 s='' "
                     "mode='RUN' pose=" +
                         pose + " ints=[1i 2i 3i]/3 grid=[[]/0 [0.5]/1]/2 poses=[" + pose +
                         "]/1 texts=['a' 'bc']/2}"}));
    ASSERT_EQ(found.end.topics.size(), 5U);
    EXPECT_EQ(found.end.topics[0].messages, 3U);
    EXPECT_EQ(found.end.topics[3].type, "long");
  }
}

/// The bytes that the writer of road-runner-ftc gives for its own test (LogWriterTest.kt), of
/// version 0: {m=DOUBLE} within {n, s, w, x, y, z}.
TEST(RoadRunnerLog, ReadsWhatItsOwnTestWrites) {
  const std::string channel("\0\0\0\0\0\0\0\014TEST_CHANNEL", 20);
  const std::string members(
      "\0\0\0\0\0\0\0\6\0\0\0\1n\0\0\0\0\0\0\0\1\0\0\0\1m\0\0\0\6\0\0\0\5\0\0\0\3INT\0\0\0\4LONG"
      "\0\0\0\6DOUBLE\0\0\0\6STRING\0\0\0\7BOOLEAN\0\0\0\1s\0\0\0\4\0\0\0\1w\0\0\0\5\0\0\0\1x"
      "\0\0\0\1\0\0\0\1y\0\0\0\2\0\0\0\1z\0\0\0\3",
      125);
  const std::string message(
      "\0\0\0\1\0\0\0\0\0\0\0\2\0\0\0\5hello\1\0\0\0\1\0\0\0\0\0\0\0\2\x40\x08\0\0\0\0\0\0", 42);
  const ScratchFolder scratch;
  const auto file = scratch.write(
      "a.log", std::string("RR\0\0", 4) + channel + members + message + message + message);
  const LoggedMessages found = messages_of(read_roadrunner_log, file);
  EXPECT_EQ(found.error, "");
  const std::string line = "TEST_CHANNEL {n={m='DOUBLE'} s='hello' w=1i x=1i y=2i z=3}";
  EXPECT_EQ(found.lines, (Lines{line, line, line}));
}

TEST(RoadRunnerLog, OfLongListsTheFirstElementsAreKept) {
  const LoggedMessages found = logged(R"(
with RoadRunnerLog(path) as log:
  log.channel('A', array_of(DOUBLE))
  log.channel('B', array_of(BOOLEAN))
  log.write('A', [0.5] * 100000)
  log.write('B', [True] * 5)
  log.write('A', [1, 2])
)",
                                      2);
  EXPECT_EQ(found.error, "");
  EXPECT_EQ(found.lines, (Lines{"A [0.5 0.5]/100000", "B [1i 1i]/5", "A [1 2]/2"}));
}

std::string complaint(const std::string& body) {
  const LoggedMessages found = logged(
      "with RoadRunnerLog(path) as log:\n  log.channel('A', INT)\n  def raw(*numbers):\n"
      "    log.file.write(struct.pack('>%di' % len(numbers), *numbers))\n" +
      body);
  return found.error.empty() ? "cut off " + found.end.cut_off : found.error;
}

TEST(RoadRunnerLog, SaysWhatIsWrongAndWhere) {
  // The header and the channel take 17 bytes.
  EXPECT_EQ(complaint("  raw(7)"), ": at byte 17: an entry of kind 7, expected 0 or 1");
  EXPECT_EQ(complaint("  raw(1, 4, 0)"),
            ": at byte 17: a message of channel 4, of which there are 1");
  EXPECT_EQ(complaint("  raw(0, 0, 9)"), ": at byte 29: a schema of kind 9, expected 0 to 7");
  EXPECT_EQ(complaint("  raw(0, -1)"), ": at byte 25: -1 bytes of text, expected 0 to 256 million");
  EXPECT_EQ(complaint("  log.channel('B', struct_of())"),
            ": at byte 34: a schema without members, expected some");
  EXPECT_EQ(complaint("  raw(0, 0, *[7] * 100)"), ": at byte 161: a schema beyond all measure");
  EXPECT_EQ(complaint("  log.channel('E', enum_of('X'))\n  log.write('E', 1)"),
            ": at byte 51: constant 1 of an enum, expected 0 to 0");
  EXPECT_EQ(complaint("  raw(0, 1000)"), "cut off at byte 17: ends in the middle of an entry");
  EXPECT_EQ(complaint("  raw(*[0] * 100000)"), "cut off at byte 17: ends with bytes 0");
  EXPECT_EQ(complaint("  raw(*[0] * 100000, 1)"), ": at byte 17: bytes 0, expected an entry");
  const ScratchFolder scratch;
  const auto newer = scratch.write("a.log", std::string("RR\0\2", 4));
  EXPECT_EQ(messages_of(read_roadrunner_log, newer).error,
            ": at byte 2: version 2 of the format, expected 0 or 1");
}

TEST(RoadRunnerLog, ALogThatIsCutOffIsReadUpToThere) {
  const ScratchFolder scratch;
  const std::string log =
      bytes_of(written_by(scratch, "from roadrunner_writer import *\n" + all_types(0)));
  testing::expect_prefixes(read_roadrunner_log, log, 2);
}

TEST(RoadRunnerLog, DamagedBytesAreSurvived) {
  const ScratchFolder scratch;
  const std::string log =
      bytes_of(written_by(scratch, "from roadrunner_writer import *\n" + all_types(1)));
  testing::expect_damage_is_survived(read_roadrunner_log, log);
}

TEST(RoadRunnerLog, LongLogsAreReadInBlocks) {
  const LoggedMessages found = logged(R"(
with RoadRunnerLog(path) as log:
  log.channel('A', struct_of(n=INT, s=STRING))
  for k in range(3000):
    log.write('A', {'n': k, 's': 'x' * (k * 37 % 500)})
  log.write('A', {'n': 3000, 's': 'x' * 1000000})
)");
  EXPECT_EQ(found.error, "");
  ASSERT_EQ(found.lines.size(), 3001U);
  for (std::size_t k = 0; k < 3000; ++k) {
    ASSERT_EQ(found.lines[k],
              "A {n=" + std::to_string(k) + "i s='" + std::string(k * 37 % 500, 'x') + "'}");
  }
}

}  // namespace
}  // namespace trussmap::roadrunner_log_test
