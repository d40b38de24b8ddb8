// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/message_log.hpp"
#include "scratch_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/log_files.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::csv_log_test {
using namespace logs;
namespace {

using testing::ScratchFolder;
using Lines = std::vector<std::string>;

/// name=12 of an integer, name=0.5d of a number, name='a' of a text, name of what is absent.
std::string shown(FieldRef row) {
  std::string line;
  for (const FieldRef& one : row.children()) {
    line += (line.empty() ? "" : " ") + std::string(one.name());
    if (one.kind() == FieldKind::text) line += "='" + std::string(one.field().text) + "'";
    if (one.kind() == FieldKind::integer) line += "=" + std::to_string(one.field().integer);
    if (one.kind() == FieldKind::number && !std::isnan(one.number())) {
      char text[40];
      std::snprintf(text, sizeof text, "=%.17gd", one.number());
      line += text;
    }
  }
  return line;
}

struct Read {
  Lines rows;
  LogEnd end;
};

Read read(const std::filesystem::path& file) {
  Read result;
  LogVisit visit;
  visit.wanted = [](const LogTopic& topic) { return topic.table && topic.name.empty(); };
  visit.message = [&result](const LogMessage& message) {
    EXPECT_FALSE(message.has_time);
    EXPECT_EQ(message.topic.encoding, "csv");
    result.rows.push_back(shown(message.fields));
  };
  result.end = read_csv_log(file, visit);
  EXPECT_EQ(result.end.topics.size(), 1U);
  EXPECT_EQ(result.end.topics.at(0).messages, result.rows.size());
  return result;
}

Lines rows_of(const std::string& text) {
  const ScratchFolder scratch;
  const Read found = read(scratch.write("a.csv", text));
  EXPECT_EQ(found.end.cut_off, "");
  return found.rows;
}

std::string complaint(const std::string& text) {
  const ScratchFolder scratch;
  try {
    static_cast<void>(read(scratch.write("a.csv", text)));
  } catch (const InputError& error) {
    return std::string(error.what()).substr(scratch.path().string().size() + 1);
  }
  return "none";
}

TEST(CsvLog, NumbersAreExactAndTextsAreAsWritten) {
  EXPECT_EQ(rows_of("t,n,tag\n0.1,+12,A 1\n1e3,-7,true\n.5,9007199254740993,FALSE\n"),
            (Lines{"t=0.10000000000000001d n=12 tag='A 1'", "t=1000d n=-7 tag=1",
                   "t=0.5d n=9007199254740993 tag=0"}));
}

TEST(CsvLog, WhatIsNoNumberIsText) {
  EXPECT_EQ(
      rows_of("a,b,c,d,e\n1,0x1F,1.2.3,1e999,12e\n--1,+-1,.,1 2,\"1,5\"\n"),
      (Lines{"a=1 b='0x1F' c='1.2.3' d='1e999' e='12e'", "a='--1' b='+-1' c='.' d='1 2' e='1,5'"}));
}

TEST(CsvLog, EmptyFieldsAndNansAreAbsent) {
  EXPECT_EQ(rows_of("a,b,c,d\n1,,NaN,-inf\n2,\"\",nan,Infinity\n3,None,null,N/A\n"),
            (Lines{"a=1 b c d", "a=2 b c d", "a=3 b c d"}));
}

TEST(CsvLog, SeparatorsAreFound) {
  const Lines expected = {"t=0.5d x=1", "t=1 x=2"};
  EXPECT_EQ(rows_of("t,x\n0.5,1\n1,2\n"), expected);
  EXPECT_EQ(rows_of("t, x\r\n0.5, 1\r\n1 ,\t2\r\n"), expected);
  EXPECT_EQ(rows_of("t;x\n0.5;1\n1;2\n"), expected);
  EXPECT_EQ(rows_of("t;x\n0,5;1\n1;2\n"), expected);
  EXPECT_EQ(rows_of("t\tx\n0.5\t1\n1\t2\n"), expected);
  EXPECT_EQ(rows_of("t x\n 0.5   1\n1 \t 2 \n"), expected);
  EXPECT_EQ(rows_of("sep=;\r\nt;x\r\n0,5;1\r\n1;2\r\n"), expected);
  EXPECT_EQ(rows_of("\xEF\xBB\xBFt,x\n0.5,1\n1,2"), expected);
  EXPECT_EQ(rows_of("0,5;1,25\n"), (Lines{"column 1=0.5d column 2=1.25d"}));
  EXPECT_EQ(rows_of("1\n2\n"), (Lines{"column 1=1", "column 1=2"}));
  EXPECT_EQ(rows_of("Time (ms)\n2\n"), (Lines{"Time (ms)=2"}));
  EXPECT_EQ(rows_of("t\ttag\n1\t\n2\tb\n"), (Lines{"t=1 tag", "t=2 tag='b'"}));
  EXPECT_EQ(rows_of("when,x\n2024-01-01 12:00:00,1\n2024-01-01 12:00:01,2\n"),
            (Lines{"when='2024-01-01 12:00:00' x=1", "when='2024-01-01 12:00:01' x=2"}));
}

/// What the first number with a mark has decides: the other one may part thousands.
TEST(CsvLog, OneDecimalMarkHoldsForTheFile) {
  EXPECT_EQ(rows_of("a;b\n1;0,5\n1.000;2\n"), (Lines{"a=1 b=0.5d", "a='1.000' b=2"}));
  EXPECT_EQ(rows_of("a;b\n1;0.5\n1,000;2\n"), (Lines{"a=1 b=0.5d", "a='1,000' b=2"}));
}

TEST(CsvLog, QuotesAreThoseOfRfc4180) {
  EXPECT_EQ(rows_of("\"a,1\",b\n\"x\"\"y\",\"two\nlines\"\n\"1.5\" , 2\n"),
            (Lines{"a,1='x\"y' b='two\nlines'", "a,1=1.5d b=2"}));
}

TEST(CsvLog, HeadersMayBeMissing) {
  EXPECT_EQ(rows_of("0,1.5\n1,2.5\n"),
            (Lines{"column 1=0 column 2=1.5d", "column 1=1 column 2=2.5d"}));
  EXPECT_EQ(rows_of("0,red\n1,green\n"),
            (Lines{"column 1=0 column 2='red'", "column 1=1 column 2='green'"}));
  EXPECT_EQ(rows_of("t,1,2\n0,5,6\n"), (Lines{"t=0 1=5 2=6"}));
  // As rostopic echo -p and numpy.savetxt write them.
  EXPECT_EQ(rows_of("%time,field.x\n100,0.5\n200,1.5\n"),
            (Lines{"time=100 field.x=0.5d", "time=200 field.x=1.5d"}));
  EXPECT_EQ(rows_of("# t x\n0 1\n1 2\n"), (Lines{"t=0 x=1", "t=1 x=2"}));
  EXPECT_EQ(rows_of("# two columns of numbers\n0,1\n"), (Lines{"column 1=0 column 2=1"}));
}

TEST(CsvLog, CommentsAndBlankLinesAreSkipped) {
  EXPECT_EQ(rows_of("# robot \"7\n\nt,x\n% now\n0,1\n  \n1,2\n#end"),
            (Lines{"t=0 x=1", "t=1 x=2"}));
}

TEST(CsvLog, UnitsJoinTheNames) {
  EXPECT_EQ(rows_of("t,x [mm],n,a\n[s],[mm],,(deg)\n0,1,2,3\n"),
            (Lines{"t [s]=0 x [mm]=1 n=2 a [deg]=3"}));
  EXPECT_EQ(rows_of("t,x (mm)\ns,mm\n0,1\n"), (Lines{"t [s]=0 x (mm)=1"}));
  EXPECT_EQ(rows_of("t,x\nnone,null\n0,1\n"), (Lines{"t x", "t=0 x=1"}));
  // Texts before texts are no units.
  EXPECT_EQ(rows_of("name,colour\na,red\nb,green\n"),
            (Lines{"name='a' colour='red'", "name='b' colour='green'"}));
}

TEST(CsvLog, NamesAreMadeUnique) {
  EXPECT_EQ(rows_of("x,x,x (2),,x\n1,2,3,4,5\n"),
            (Lines{"x=1 x (2)=2 x (2) (2)=3 column 4=4 x (3)=5"}));
}

/// Loggers that print a separator behind every value.
TEST(CsvLog, AnEmptyFieldMayHangOn) {
  EXPECT_EQ(rows_of("a,b\n1,2,\n3,4,\n"), (Lines{"a=1 b=2", "a=3 b=4"}));
  EXPECT_EQ(rows_of("a,b,\n1,2,\n3,4\n"), (Lines{"a=1 b=2 column 3", "a=3 b=4 column 3"}));
}

TEST(CsvLog, SaysWhatIsWrongAndInWhichLine) {
  EXPECT_EQ(complaint(""), "a.csv:1: the file is empty, expected the rows of a table");
  EXPECT_EQ(complaint("# c\n\n"), "a.csv:1: the file is empty, expected the rows of a table");
  EXPECT_EQ(complaint("a,b\n1,2\n\"3\n3\",4\n1,2,3\n"),
            "a.csv:5: 3 fields, expected 2 as in the header");
  EXPECT_EQ(complaint("1,2\n1,2\n3\n1,2\n"), "a.csv:3: 1 field, expected 2 as in the first row");
  EXPECT_EQ(complaint("a,b\n1,2\n1,\xE9\n1,2\n"),
            "a.csv:3: a byte that is no UTF-8 text, expected UTF-8");
  EXPECT_EQ(complaint("a,b\n1,2\n1,5\"\n\"1\",2\n"),
            "a.csv:3: a quote within an unquoted field, expected \"...\" around it");
  EXPECT_EQ(complaint("a,b\n1,2\n1,\"5\n1,2\n"),
            "a.csv:3: a quoted field is not closed, expected a second \"");
  EXPECT_EQ(complaint(std::string("a,b\n1,\0002\n1,2\n", 13)), "a.csv:2: a byte 0, expected text");
  EXPECT_EQ(complaint("a,b\n" + std::string(2000000, '7') + "\n"),
            "a.csv:2: a line of more than 1 MiB, expected the rows of a table");
}

TEST(CsvLog, ATableThatIsCutOffIsReadUpToThere) {
  const ScratchFolder scratch;
  const auto cut = [&scratch](const std::string& text) {
    const Read found = read(scratch.write("a.csv", text));
    return std::to_string(found.rows.size()) + " " + found.end.cut_off;
  };
  EXPECT_EQ(cut("a,b\n1,2\n3"), "1 at byte 8: ends in the middle of line 3");
  EXPECT_EQ(cut("a,b\n1,2\n3,\"4"), "1 at byte 8: ends in the middle of line 3");
  EXPECT_EQ(cut("a,b\n1,2\n3,\xC3"), "1 at byte 10: ends within a character");
  EXPECT_EQ(cut(std::string("a,b\n1,2\n\0\0\0\0", 12)), "1 at byte 8: ends with bytes 0");
  EXPECT_EQ(cut("a,b\n1,2\n3,4"), "2 ");
}

/// More than is in memory at a time, by any way: fields begin and end at every place of a block.
TEST(CsvLog, LongTablesAreReadInBlocks) {
  const ScratchFolder scratch;
  std::string text = "n,tag\n";
  constexpr int kRows = 60000;
  for (int k = 0; k < kRows; ++k) {
    text += std::to_string(k) + (k % 7 == 0 ? ",\"a\r\n\"\"b\"\r\n" : ",c\r\n");
  }
  const Read found = read(scratch.write("b.TXT", text));
  ASSERT_EQ(found.rows.size(), std::size_t{kRows});
  for (int k = 0; k < kRows; ++k) {
    const std::string tag = k % 7 == 0 ? "'a\r\n\"b'" : "'c'";
    ASSERT_EQ(found.rows[static_cast<std::size_t>(k)], "n=" + std::to_string(k) + " tag=" + tag);
  }
}

TEST(CsvLog, ItsNameTellsATable) {
  for (const char* name : {"a.csv", "a.CSV", "a.tsv.xz", "a.txt", "a.csv.xz"}) {
    EXPECT_TRUE(is_csv_log(name)) << name;
  }
  for (const char* name : {"a.log", "a.xz", "csv", "a.csv.gz"})
    EXPECT_FALSE(is_csv_log(name)) << name;
  const ScratchFolder scratch;
  std::filesystem::create_directory(scratch.path() / "a.csv");
  EXPECT_FALSE(is_csv_log(scratch.path() / "a.csv"));
}

/// What is not wanted is counted alone.
TEST(CsvLog, ATableThatNobodyWantsIsCounted) {
  const ScratchFolder scratch;
  LogVisit visit;
  visit.wanted = [](const LogTopic&) { return false; };
  visit.message = [](const LogMessage&) { FAIL(); };
  const LogEnd end = read_csv_log(scratch.write("a.csv", "a,b\n1,2\n3,4\n"), visit);
  EXPECT_EQ(end.topics.at(0).messages, 2U);
}

/// Times, two wheels' ticks, a gyro, x, y, without a header: by blanks, tabs and commas the same
/// map, which converts once it says what is left, how large wheels are, and what x and y are.
TEST(CsvLog, OneWithoutAHeaderLeadsToAFirstMap) {
  const ScratchFolder scratch;
  std::string first;
  for (const char* const between : {"  ", "\t", ",", ", "}) {
    std::string text;
    double x = 0.0, y = 0.0, heading = 0.0, left = 0.0, right = 0.0;
    for (int k = 0; k < 400; ++k) {
      const double turn = 0.4 * std::sin(k / 40.0);  // rad/s
      char row[200];
      std::snprintf(row, sizeof row, "%.7e|%d|%d|%.7e|%.7e|%.7e\n", 0.05 * k,
                    static_cast<int>(left * 3000), static_cast<int>(right * 3000), turn, x, y);
      for (const char* c = row; *c != '\0'; ++c) text += *c == '|' ? between : std::string(1, *c);
      left += (0.4 - 0.15 * turn) * 0.05;
      right += (0.4 + 0.15 * turn) * 0.05;
      heading += turn * 0.05;
      x += 0.4 * 0.05 * std::cos(heading);
      y += 0.4 * 0.05 * std::sin(heading);
    }
    const auto file = scratch.write("a.txt", text);
    const std::string map = inspect_log(file).map;
    if (first.empty()) first = map;
    EXPECT_EQ(map, first);
  }
  EXPECT_NE(first.find("[time]\nfield = \"column 1\""), std::string::npos) << first;
  EXPECT_NE(first.find("[wheels.left]\nfield = \"column 2\""), std::string::npos) << first;
  EXPECT_NE(first.find("[wheels.right]\nfield = \"column 3\""), std::string::npos) << first;
  EXPECT_NE(first.find("#   column 4: -0.399"), std::string::npos) << first;
  EXPECT_NE(first.find("#   column 6: "), std::string::npos) << first;
  const auto mended = scratch.write("map.toml", first +
                                                    "[fixes]\nx = \"column 5\"\ny = \"column 6\"\n"
                                                    "[yaw_rate]\nfield = \"column 4\"\n"
                                                    "unit = \"rad/s\"\n");
  const LogRecording read = read_log_recording(scratch.path() / "a.txt", mended);
  EXPECT_EQ(read.recording.drive.rows(), 399U);
  EXPECT_EQ(read.recording.fixes.size(), 400U);
}

/// Poses that go to and fro are no wheels.
TEST(CsvLog, WhatGoesToAndFroIsNoWheel) {
  const ScratchFolder scratch;
  std::string text;
  for (int k = 0; k < 400; ++k) {
    text += std::to_string(k) + " " + std::to_string(std::sin(k / 30.0)) + " " +
            std::to_string(std::cos(k / 30.0)) + " ab\n";
  }
  const std::string map = inspect_log(scratch.write("a.txt", text)).map;
  EXPECT_EQ(map.find("\n[wheels"), std::string::npos) << map;
  EXPECT_NE(map.find("NOTHING LOOKS LIKE WHEELS"), std::string::npos);
  EXPECT_NE(map.find("#   column 2: -0.999"), std::string::npos) << map;
}

}  // namespace
}  // namespace trussmap::csv_log_test
