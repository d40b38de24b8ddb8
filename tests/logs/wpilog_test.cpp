// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The logs are written by tests/logs/bags/wpilog_writer.py, after the same specification.
#include "log_messages.hpp"
#include "trussmap/error.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::wpilog_test {
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
  const auto file = written_by(scratch, "from wpilog_writer import *\n" + script);
  EXPECT_TRUE(is_wpilog(file));
  return messages_of(read_wpilog, file, elements);
}

std::string with_log(const std::string& body) {
  return "with WpiLog(path, extra='a robot') as log:\n" + body;
}

/// A value of each type.
const std::string kPlain = with_log(R"(
  def one(name, kind, time, value, wide=False):
    log.write(log.start(name, kind, '{"source": "NT"}'), time, value, wide)
  one('/b', 'boolean', 1, True)
  one('/i', 'int64', 255, -2**63)
  one('/j', 'int64', 256, 2**63 - 1, True)
  one('/f', 'float', 2**40 + 1, 0.1)
  one('/d', 'double', 9_000_000_000_000_001, 0.1)
  one('/s', 'string', 3, 'größe')
  one('/json', 'json', 4, '{"a": 1}')
  one('/bs', 'boolean[]', 5, [True, False, True])
  one('/is', 'int64[]', 6, [-1, 2**53 + 1])
  one('/fs', 'float[]', 7, [0.5, 0.1])
  one('/ds', 'double[]', 8, [1e-300, 0.1])
  one('/ss', 'string[]', 9, ['', 'two', 'ö'])
  one('/none', 'double[]', 10, [])
)");

TEST(Wpilog, EveryTypeGivesTheValueWritten) {
  const LoggedMessages found = logged(kPlain);
  EXPECT_EQ(found.error, "");
  EXPECT_EQ(found.end.cut_off, "");
  EXPECT_EQ(found.lines,
            (Lines{"/b 1000 1i", "/i 255000 -9223372036854775808i",
                   "/j 256000 9223372036854775807i", "/f 1099511627777000 0.10000000149011612",
                   "/d 9000000000000001000 0.10000000000000001", "/s 3000 'größe'",
                   "/json 4000 '{\"a\": 1}'", "/bs 5000 [1i 0i 1i]/3",
                   "/is 6000 [-1i 9007199254740993i]/2", "/fs 7000 [0.5 0.10000000149011612]/2",
                   "/ds 8000 [1e-300 0.10000000000000001]/2", "/ss 9000 ['' 'two' 'ö']/3",
                   "/none 10000 []/0"}));
  ASSERT_EQ(found.end.topics.size(), 13U);
  EXPECT_EQ(found.end.topics[0].type, "boolean");
  EXPECT_EQ(found.end.topics[12].messages, 1U);
}

TEST(Wpilog, OfLongListsTheFirstElementsAreKept) {
  const LoggedMessages found = logged(with_log(R"(
  log.schema('P', 'int8 n[5]')
  log.write(log.start('/ds', 'double[]'), 1, [0.5] * 1000)
  log.write(log.start('/p', 'struct:P'), 2, {'n': [1, 2, 3, 4, 5]})
)"),
                                      2);
  EXPECT_EQ(found.lines, (Lines{"/ds 1000 [0.5 0.5]/1000", "/p 2000 {n=[1i 2i]/5}"}));
}

const std::string kStructs = with_log(R"(
  log.schema('Inner', ' int16 i ;; double x[2];')
  log.schema('All', '''bool b; char c; int8 s; uint8 u; int32 w; uint64 l; float f; float64 d;
                       char tag[4]; Inner one; Inner two[2]; enum {off=0, on=1} int8 mode;
                       {a=1,} uint16 kind; bool flags[3]''')
  all = log.start('/all', 'struct:All')
  value = {'b': True, 'c': 'x', 's': -1, 'u': 255, 'w': -2**31, 'l': 2**63 - 1, 'f': 0.1, 'd': 0.1,
           'tag': 'A7', 'one': {'i': -5, 'x': [0.5, 1.5]},
           'two': [{'i': 1, 'x': [1, 2]}, {'i': 2, 'x': [3, 4]}], 'mode': 1, 'kind': 65535,
           'flags': [True, False, True]}
  log.write(all, 7, value)
  log.write(log.start('/pairs', 'struct:Inner[]'), 8, value['two'])
)");

TEST(Wpilog, StructsAreDecodedByTheirSchemas) {
  const LoggedMessages found = logged(kStructs);
  EXPECT_EQ(found.error, "");
  EXPECT_EQ(found.lines,
            (Lines{"/all 7000 {b=1i c='x' s=-1i u=255i w=-2147483648i l=9223372036854775807i "
                   "f=0.10000000149011612 d=0.10000000000000001 tag='A7' one={i=-5i x=[0.5 1.5]/2} "
                   "two=[{i=1i x=[1 2]/2} {i=2i x=[3 4]/2}]/2 mode=1i kind=65535i "
                   "flags=[1i 0i 1i]/3}",
                   "/pairs 8000 [{i=1i x=[1 2]/2} {i=2i x=[3 4]/2}]/2"}));
  EXPECT_EQ(found.end.topics.size(), 2U) << "schemas are no topics";
}

/// The layouts that the specification spells out, byte by byte.
TEST(Wpilog, BitFieldsLieAsInTheSpecification) {
  const LoggedMessages found = logged(with_log(R"(
  def one(name, schema, data):
    log.schema(name, schema)
    log.record(log.start(name, 'struct:' + name), 1, bytes(data))
  one('A', 'int8 a:4; int16 b:4', [0b00000101, 0b00000110, 0])
  one('B', 'int16 a:4; uint16 b:5; bool c:1; int16 d:7',
      [0b10010011, 0b00000011, 0b00101010, 0])
  one('C', 'uint8 a:4; int8 b:2; bool c:1; int16 d:1', [0b01011001, 1, 0])
  one('D', 'bool a:1; bool b:1; int8 c:2', [0b00000110])
  one('E', 'bool a:1; bool b:1; int16 c:2', [0b10, 0b01, 0])
  one('F', 'uint64 a:63; int8 b', [255] * 8 + [254])
  one('G', 'uint8 a:6; uint8 b:6; uint8 c', [63, 21, 7])
)"));
  EXPECT_EQ(found.error, "");
  EXPECT_EQ(found.lines, (Lines{"A 1000 {a=5i b=6i}", "B 1000 {a=3i b=25i c=1i d=42i}",
                                "C 1000 {a=9i b=1i c=1i d=-1i}", "D 1000 {a=0i b=1i c=1i}",
                                "E 1000 {a=0i b=1i c=1i}", "F 1000 {a=9223372036854775807i b=-2i}",
                                "G 1000 {a=63i b=21i c=7i}"}));
}

/// Packed by the script's own rules.
TEST(Wpilog, BitFieldsGiveTheValuesWritten) {
  const LoggedMessages found = logged(with_log(R"(
  log.schema('Bits', 'uint32 a:20; int32 b:12; bool c:1; uint8 d:7; bool e:1; int16 f:3; double x')
  bits = log.start('bits', 'struct:Bits')
  log.write(bits, 1, dict(a=1000000, b=-2048, c=1, d=100, e=1, f=-4, x=0.25))
)"));
  EXPECT_EQ(found.lines, (Lines{"bits 1000 {a=1000000i b=-2048i c=1i d=100i e=1i f=-4i x=0.25}"}));
}

TEST(Wpilog, WpilibsOwnStructsNeedNoSchema) {
  const std::string poses = R"(
  turn = {'value': 0.25}
  place = {'x': 1.5, 'y': -2.5}
  space = {'translation': {'x': 1, 'y': 2, 'z': 3}, 'rotation': {'q': dict(w=1, x=0, y=0, z=0.5)}}
  values = {'Rotation2d': turn, 'Translation2d': place,
            'Pose2d': {'translation': place, 'rotation': turn},
            'Transform2d': {'translation': place, 'rotation': turn},
            'Twist2d': dict(dx=1, dy=2, dtheta=3), 'Quaternion': dict(w=1, x=2, y=3, z=4),
            'Rotation3d': space['rotation'], 'Translation3d': space['translation'],
            'Pose3d': space, 'ChassisSpeeds': dict(vx=1, vy=2, omega=3),
            'DifferentialDriveWheelPositions': dict(left=1, right=2),
            'DifferentialDriveWheelSpeeds': dict(left=1, right=2),
            'SwerveModulePosition': {'distance': 4, 'angle': turn},
            'SwerveModuleState': {'speed': 4, 'angle': turn}}
  for name, value in values.items():
    log.write(log.start(name, 'struct:' + name), 1, value)
)";
  const LoggedMessages alone = logged(with_log(poses));
  EXPECT_EQ(alone.error, "");
  ASSERT_EQ(alone.lines.size(), 14U);
  EXPECT_EQ(alone.lines[2], "Pose2d 1000 {translation={x=1.5 y=-2.5} rotation={value=0.25}}");
  EXPECT_EQ(alone.lines[8],
            "Pose3d 1000 {translation={x=1 y=2 z=3} rotation={q={w=1 x=0 y=0 z=0.5}}}");
  const LoggedMessages stated = logged(with_log("\n  log.wpilib_schemas(*WPILIB)" + poses));
  EXPECT_EQ(stated.lines, alone.lines);
}

TEST(Wpilog, SchemasMayComeLateOrByNetworkTables) {
  const LoggedMessages found = logged(with_log(R"(
  log.schemas.add('Point', 'double x; double y')
  log.schemas.add('Line', 'Point a; Point b')
  line = log.start('line', 'struct:Line')
  one = {'a': {'x': 1, 'y': 2}, 'b': {'x': 3, 'y': 4}}
  log.write(line, 1, one)
  log.schema('Line', 'Point a; Point b', 'NT:')
  log.write(line, 2, one)
  log.schema('Point', 'double x; double y', 'NT:')
  log.write(line, 3, one)
)"));
  EXPECT_EQ(found.lines,
            (Lines{"line 1000 {a={x=1 y=2} b={x=3 y=4}}", "line 2000 {a={x=1 y=2} b={x=3 y=4}}",
                   "line 3000 {a={x=1 y=2} b={x=3 y=4}}"}));
}

/// A log that goes on after new code was put on the robot.
TEST(Wpilog, ASchemaHoldsUntilTheNextOfItsName) {
  const LoggedMessages found = logged(with_log(R"(
  log.schema('P', 'int8 x')
  p = log.start('p', 'struct:P')
  log.write(p, 1, {'x': 1})
  log.schema('P', 'int16 y')
  log.write(p, 2, {'y': 2})
)"));
  EXPECT_EQ(found.lines, (Lines{"p 1000 {x=1i}", "p 2000 {y=2i}"}));
}

TEST(Wpilog, WhatCannotBeReadSaysWhy) {
  const LoggedMessages found = logged(with_log(R"(
  def one(name, kind, data=b'12345678'):
    log.record(log.start(name, kind), 1, data)
  def state(name, text):
    log.record(log.start('/.schema/struct:' + name, 'structschema'), 0, text.encode())
  one('raw', 'raw')
  one('proto', 'proto:wpi.proto.ProtobufPose2d')
  one('missing', 'struct:Mine')
  state('Outer', 'int8 a; Inner b')
  one('nested', 'struct:Outer[]')
  state('Wrong', 'double x; float')
  one('wrong', 'struct:Wrong')
  state('Loop', 'Loop a')
  one('loop', 'struct:Loop')
  state('Bits', 'double a:3')
  one('bits', 'struct:Bits')
  state('Huge', 'double a[4000000000]')
  one('huge', 'struct:Huge')
  state('Empty', ' ; ')
  one('empty', 'struct:Empty[]')
)"));
  EXPECT_EQ(found.error, "");
  EXPECT_EQ(found.lines, Lines{});
  Lines why;
  for (const LogTopic& one : found.end.topics) {
    EXPECT_EQ(one.messages, 1U) << one.name;
    why.push_back(one.name + ": " + one.unread);
  }
  EXPECT_EQ(
      why, (Lines{"raw: its type \"raw\" is none that can be read", "proto: protobuf",
                  "missing: its schema struct:Mine is not in the log",
                  "nested: its schema struct:Inner is not in the log",
                  "wrong: its schema struct:Wrong has the member \"float\", expected TYPE NAME, "
                  "NAME[SIZE] or NAME:BITS",
                  "loop: its structs are nested too deeply",
                  "bits: its schema struct:Bits has the member \"double a:3\", expected an integer "
                  "and no more bits than it has",
                  "huge: its schema struct:Huge is larger than 16 MiB or a million fields",
                  "empty: its schema struct:Empty has no members"}));
}

TEST(Wpilog, EntriesAreFinishedAndUsedAgain) {
  const LoggedMessages found = logged(with_log(R"(
  a = log.start('a', 'double')
  log.write(a, 1, 0.5)
  log.set_metadata(a, 'new')
  log.finish(a)
  log.write(a, 2, 1.5)                    # after its end: no longer of any entry
  log.start('b', 'int64', entry=a)
  log.write(a, 3, 7)
  log.finish(a)
  log.start('a', 'double', entry=a)
  log.write(a, 4, 2.5)
  log.start('a', 'string', entry=a + 7)
  log.write(a + 7, 5, 'x')
)"));
  EXPECT_EQ(found.error, "");
  EXPECT_EQ(found.lines, (Lines{"a 1000 0.5", "b 3000 7i", "a 4000 2.5", "a 5000 'x'"}));
  ASSERT_EQ(found.end.topics.size(), 3U);
  EXPECT_EQ(found.end.topics[0].messages, 2U);
  EXPECT_EQ(found.end.topics[2].type, "string");
}

/// As where a log's beginning is lost: what is known is read, the rest is told once.
TEST(Wpilog, DataOfNoEntryArePassedOverAndCounted) {
  const LoggedMessages found = logged(with_log(R"(
  a = log.start('a', 'double')
  log.record(a + 7, 1, b'12345678')
  log.write(a, 1, 0.5)
  log.record(0, 1, b'\x01' + (a + 9).to_bytes(4, 'little'))     # finishes what was never started
  log.record(a + 7, 2, b'')
  log.finish(a)
  log.write(a, 2, 1.5)
  log.start('a', 'double', entry=a + 7)
  log.write(a + 7, 3, 2.5)
)"));
  EXPECT_EQ(found.error, "");
  EXPECT_EQ(found.end.cut_off, "");
  EXPECT_EQ(found.lines, (Lines{"a 1000 0.5", "a 3000 2.5"}));
  ASSERT_EQ(found.end.topics.size(), 1U);
  EXPECT_EQ(found.end.topics[0].messages, 2U);
  ASSERT_EQ(found.end.passed_over.size(), 1U);
  EXPECT_EQ(found.end.passed_over[0].number, 3U);
  EXPECT_EQ(found.end.passed_over[0].what,
            "records of entries that were not started, or had been finished");
  EXPECT_EQ(logged(kPlain).end.passed_over.size(), 0U);
}

TEST(Wpilog, WhatIsNotWantedIsCounted) {
  const ScratchFolder scratch;
  const auto file = written_by(scratch, "from wpilog_writer import *\n" + kPlain);
  LogVisit visit;
  Lines asked;
  visit.wanted = [&asked](const LogTopic& topic) {
    asked.push_back(topic.name);
    return topic.name == "/d";
  };
  Lines got;
  visit.message = [&got](const LogMessage& one) {
    got.push_back(one.topic.name + std::to_string(one.number));
  };
  const LogEnd end = read_wpilog(file, visit);
  EXPECT_EQ(asked.size(), 13U);
  EXPECT_EQ(got, Lines{"/d4"});
  for (const LogTopic& one : end.topics) EXPECT_EQ(one.messages, 1U);
}

std::string complaint(const std::string& body, const std::string& header = "") {
  const std::string script = header.empty() ? with_log(body) : header + body;
  const LoggedMessages found = logged(script);
  return found.error.empty() ? "cut off " + found.end.cut_off : found.error;
}

TEST(Wpilog, SaysWhatIsWrongAndWhere) {
  // The header is of 19 bytes, a start of "a", "double" of 28.
  const std::string start = "\n  a = log.start('a', 'double')\n";
  EXPECT_EQ(complaint(start + "  log.record(a, 1, b'1234')"),
            ": at byte 51: double of 4 bytes, expected 8");
  EXPECT_EQ(complaint("\n  log.record(0, 1, b'\\x07\\0\\0\\0\\0')"),
            ": at byte 24: a control record of kind 7, expected 0, 1 or 2");
  EXPECT_EQ(complaint("\n  log.record(0, 1, b'\\0\\1\\0\\0\\0\\xff\\0\\0\\0ab')"),
            ": at byte 32: needs 255 more bytes, 2 are left");
  EXPECT_EQ(complaint(start + "  log.file.write(b'\\x80' + bytes(20))"),
            ": at byte 47: is no record, expected a first byte below 128");
  EXPECT_EQ(complaint(start + "  log.file.write(b'\\x0c\\1\\xff\\xff\\xff\\x7f\\0')"),
            ": at byte 47: a record of 2147483647 bytes, expected at most 256 MiB");
  EXPECT_EQ(complaint(start + "  log.file.write(b'\\x0c\\1\\xff\\0\\0\\0\\0' + bytes(100))"),
            "cut off at byte 47: ends in the middle of a record");
  EXPECT_EQ(complaint(start + "  log.file.write(bytes(1000000))"),
            "cut off at byte 47: ends with bytes 0");
  EXPECT_EQ(complaint(start + "  log.file.write(bytes(1000000) + b'1')"),
            ": at byte 47: a control record without content");
  EXPECT_EQ(complaint(start + "  log.write(a, 2**62, 1.0)"),
            ": at byte 47: a time of 4611686018427387904 µs, expected less than 292 years");
  EXPECT_EQ(complaint("  pass", "with WpiLog(path, version=0x0200) as log:\n"),
            ": at byte 6: version 2.0 of the format, expected 1.0");
}

TEST(Wpilog, ALogThatIsCutOffIsReadUpToThere) {
  for (const std::string& script : {kPlain, kStructs}) {
    const ScratchFolder scratch;
    const std::string log = bytes_of(written_by(scratch, "from wpilog_writer import *\n" + script));
    testing::expect_prefixes(read_wpilog, log, 6);
  }
}

TEST(Wpilog, DamagedBytesAreSurvived) {
  for (const std::string& script : {kPlain, kStructs}) {
    const ScratchFolder scratch;
    const std::string log = bytes_of(written_by(scratch, "from wpilog_writer import *\n" + script));
    testing::expect_damage_is_survived(read_wpilog, log);
  }
}

/// Records lie across the blocks in which a file is read, at every place.
TEST(Wpilog, LongLogsAreReadInBlocks) {
  const LoggedMessages found = logged(with_log(R"(
  n = log.start('n', 'int64')
  s = log.start('s', 'string')
  for k in range(20000):
    log.write(n, k, k)
    if k % 100 == 0: log.write(s, k, 'x' * (k * 7))
)"));
  EXPECT_EQ(found.error, "");
  EXPECT_EQ(found.longest, 19900U * 7);
  std::size_t next = 0;
  for (const std::string& line : found.lines) {
    if (line[0] == 's') continue;
    const std::string number = std::to_string(next);
    ASSERT_EQ(line, "n " + std::to_string(next * 1000) + " " + number + "i");
    ++next;
  }
  EXPECT_EQ(next, 20000U);
}

}  // namespace
}  // namespace trussmap::wpilog_test
