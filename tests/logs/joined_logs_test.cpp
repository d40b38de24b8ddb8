// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Several tables as one recording: the layouts of tests/logs/tables/joined_layouts.py, which shares
// nothing with the readers, against its single table; and first maps of exports as they are.
#include "logs/calendar.hpp"
#include "logs/log_map.hpp"
#include "scratch_folder.hpp"
#include "shared_data.hpp"
#include "trussmap/error.hpp"
#include "trussmap/log_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::joined_logs_test {
using namespace logs;
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

/// The folder with all layouts.
fs::path layouts(const ScratchFolder& scratch) {
  const std::string python = fs::exists("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
  const std::string script =
      std::string(TRUSSMAP_SOURCE_DIR) + "/tests/logs/tables/joined_layouts.py";
  EXPECT_EQ(std::system((python + " -B " + script + " " + scratch.path().string()).c_str()), 0);
  return scratch.path();
}

std::vector<fs::path> tables_in(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& one : fs::directory_iterator(folder)) {
    const bool log = one.path().extension() != ".toml" && one.path().filename() != "survey.csv";
    if (log) found.push_back(one.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

double turned_by_gyro(const Drive& drive) {
  double sum = 0.0;
  for (std::size_t k = 0; k < drive.rows(); ++k) sum += drive.yaw_rate[k] * drive.duration(k);
  return sum;
}

double sum_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double one : values) sum += one;
  return sum;
}

/// Rows, travels, times and sightings are those of the single table, but for the digits that the
/// layout writes.
void expect_same(const Recording& single, const Recording& joined, const std::string& layout) {
  SCOPED_TRACE(layout);
  const double start = single.drive.t.front() - joined.drive.t.front();
  ASSERT_EQ(joined.drive.rows(), single.drive.rows());
  for (std::size_t k = 0; k < single.drive.rows(); ++k) {
    ASSERT_NEAR(joined.drive.t[k] + start, single.drive.t[k], 1e-9) << k;
    ASSERT_NEAR(joined.drive.left[k], single.drive.left[k], 3e-9) << k;
    ASSERT_NEAR(joined.drive.right[k], single.drive.right[k], 3e-9) << k;
    ASSERT_NEAR(joined.drive.yaw_rate[k], single.drive.yaw_rate[k], 1e-5) << k;
  }
  EXPECT_NEAR(sum_of(joined.drive.left), sum_of(single.drive.left), 2e-8);
  EXPECT_NEAR(sum_of(joined.drive.right), sum_of(single.drive.right), 2e-8);
  EXPECT_NEAR(turned_by_gyro(joined.drive), turned_by_gyro(single.drive), 1e-6);
  ASSERT_EQ(joined.sightings.size(), single.sightings.size());
  const auto key = [](const Sighting& one) { return std::pair(one.t, one.landmark); };
  std::vector<Sighting> a = single.sightings;
  std::vector<Sighting> b = joined.sightings;
  const auto before = [&](const Sighting& one, const Sighting& other) {
    return key(one) < key(other);
  };
  std::sort(a.begin(), a.end(), before);
  std::sort(b.begin(), b.end(), before);
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_NEAR(b[k].t + start, a[k].t, 1e-6) << k;
    EXPECT_EQ(b[k].landmark, a[k].landmark) << k;
    EXPECT_NEAR(b[k].range, a[k].range, 1e-6) << k;
    EXPECT_NEAR(b[k].bearing, a[k].bearing, 1e-6) << k;
  }
}

TEST(JoinedLogs, EveryLayoutIsTheRecordingOfTheSingleTable) {
  const ScratchFolder scratch;
  const fs::path all = layouts(scratch);
  const LogRecording single =
      read_log_recording(all / "single" / "all.csv", all / "single" / "map.toml");
  ASSERT_GT(single.recording.sightings.size(), 20U);
  for (const char* layout : {"one", "two", "three", "four", "five"}) {
    const fs::path folder = all / layout;
    const LogRecording joined = read_log_recording(tables_in(folder), folder / "map.toml");
    EXPECT_EQ(joined.warnings, std::vector<std::string>()) << layout;
    expect_same(single.recording, joined.recording, layout);
  }
  // A folder is all that is in it; files in any order.
  std::vector<fs::path> files = tables_in(all / "one");
  std::reverse(files.begin(), files.end());
  const LogRecording back = read_log_recording(files, all / "one" / "map.toml");
  const LogRecording folder =
      read_log_recording(std::vector<fs::path>{all / "one"}, all / "one" / "map.toml");
  expect_same(single.recording, back.recording, "reversed");
  expect_same(single.recording, folder.recording, "folder");
}

const LogClockFacts& clock_of(const LogInspection& inspection, const std::string& file) {
  const auto found = std::find_if(inspection.clocks.begin(), inspection.clocks.end(),
                                  [&](const LogClockFacts& one) { return one.file == file; });
  EXPECT_NE(found, inspection.clocks.end()) << file;
  return *found;
}

void expect_parts(const std::string& map, const std::vector<std::string>& parts) {
  for (const std::string& one : parts)
    EXPECT_NE(map.find(one), std::string::npos) << one << "\n" << map;
}

TEST(JoinedLogs, InspectionTellsWhichClockIsWhich) {
  const ScratchFolder scratch;
  const fs::path all = layouts(scratch);
  const LogInspection two = inspect_logs(tables_in(all / "two"));
  const LogClockFacts& imu = clock_of(two, "imu.csv");
  EXPECT_NEAR(imu.clock, 1748457053.0 - 17.35, 0.01) << imu.why;
  EXPECT_GT(imu.likeness, 0.9);
  EXPECT_LT(imu.sd, 0.03) << "half a step of the gyro";
  EXPECT_EQ(clock_of(two, "tags.csv").clock, 0.0);
  EXPECT_TRUE(clock_of(two, "tags.csv").certain);
  expect_parts(two.map, {"fraction = \"nanosec\"", "file = \"wheels.csv\"\nfield = \"l_mm\"",
                         "[yaw_rate]\nfile = \"imu.csv\"\nfield = \"gz_dps\"\nunit = \"deg/s\"",
                         "file = \"tags.csv\"\nlandmark = \"name\"", "range_unit = \"cm\""});

  const LogInspection one = inspect_logs({all / "one"});
  for (const char* file : {"encoders.csv", "imu.csv", "tags.csv"}) {
    EXPECT_EQ(clock_of(one, file).clock, 0.0) << clock_of(one, file).why;
    EXPECT_TRUE(clock_of(one, file).certain);
  }
  expect_parts(one.map, {"\nsurvey.file = ", "field = \"gyro_z\""});

  const LogInspection three = inspect_logs(tables_in(all / "three"));
  EXPECT_FALSE(clock_of(three, "detections.csv").certain) << "times of no other clock";
  expect_parts(three.map, {"clock = 0   # s, added to its times; STATE IT"});

  const LogInspection five = inspect_logs(tables_in(all / "five"));
  EXPECT_EQ(clock_of(five, "odometry.csv").clock, 0.0);
}

/// The first map is right but for the wheelbase, and a clock that nothing tells.
TEST(JoinedLogs, FirstMapsOfLayoutsConvert) {
  const ScratchFolder scratch;
  const fs::path all = layouts(scratch);
  const LogRecording single =
      read_log_recording(all / "single" / "all.csv", all / "single" / "map.toml");
  for (const char* layout : {"one", "two", "four"}) {
    const std::vector<fs::path> files = tables_in(all / layout);
    const LogInspection inspection = inspect_logs(files);
    const LogRecording joined =
        read_log_recording(files, scratch.write("first.toml", inspection.map));
    EXPECT_EQ(joined.recording.drive.rows(), single.recording.drive.rows()) << inspection.map;
    EXPECT_NEAR(sum_of(joined.recording.drive.left), sum_of(single.recording.drive.left), 1e-6);
    EXPECT_EQ(joined.recording.sightings.size(), single.recording.sightings.size());
    EXPECT_NEAR(turned_by_gyro(joined.recording.drive), turned_by_gyro(single.recording.drive),
                0.05)
        << layout;
  }
}

TEST(JoinedLogs, PosesThatNeverMoveAreNoOdometry) {
  const ScratchFolder scratch;
  const fs::path all = layouts(scratch);
  const std::string moving = inspect_log(all / "three" / "odom.csv").map;
  expect_parts(moving,
               {"field = \"field.header.stamp\"\nunit = \"ns\"",
                "x = \"field.pose.pose.position.x\"", "# speed = \"field.twist.twist.linear.x\""});
  const std::string still = inspect_log(all / "still" / "odom.csv").map;
  expect_parts(still, {"\nspeed = \"field.twist.twist.linear.x\"",
                       "\nturn_rate = \"field.twist.twist.angular.z\"", "never move"});
  for (const std::string& map : {moving, still}) {
    EXPECT_EQ(map.find("angular.x"), std::string::npos) << map;
    EXPECT_EQ(map.find("[[sightings]]\n"), std::string::npos) << map;
    EXPECT_EQ(map.find("[yaw_rate]"), std::string::npos) << map;
  }
}

TEST(JoinedLogs, HeadsOfRealExports) {
  TRUSSMAP_NEEDS_SHARED("data/reports/tables");
  const fs::path folder = testing::shared("data/reports/tables");
  const std::string one = inspect_log(folder / "rostopic_echo_p.csv").map;
  expect_parts(one, {"field = \"field.header.stamp\"", "x = \"field.pose.pose.position.x\"",
                     "# turn_rate = \"field.twist.twist.angular.z\""});
  const LogInspection two = inspect_log(folder / "ros2_topic_echo.csv");
  expect_parts(two.map, {"field = \"header.stamp.sec\"", "fraction = \"header.stamp.nanosec\"",
                         "x = \"pose.pose.position.x\"", "# speed = \"twist.twist.linear.x\""});
  // Both are of one drive: their odometries go as far.
  const ScratchFolder scratch;
  const std::string place = "[truth]\nx = \"X\"\ny = \"Y\"\nheading = \"Y\"\n";
  const auto length = [&](const char* file, std::string map, const std::string& before) {
    std::string truth = place;
    truth.replace(truth.find('X'), 1, before + "pose.pose.position.x");
    while (truth.find("\"Y\"") != std::string::npos) {
      truth.replace(truth.find("\"Y\""), 3, "\"" + before + "pose.pose.position.y\"");
    }
    const LogRecording read =
        read_log_recording(folder / file, scratch.write("map.toml", map + truth));
    return 0.5 * (sum_of(read.recording.drive.left) + sum_of(read.recording.drive.right));
  };
  EXPECT_NEAR(length("rostopic_echo_p.csv", one, "field."),
              length("ros2_topic_echo.csv", two.map, ""), 0.02);
  EXPECT_GT(length("ros2_topic_echo.csv", two.map, ""), 2.0);
}

/// What the error says; empty: there was none.
std::string error_of(const std::vector<fs::path>& logs, const fs::path& map) {
  try {
    static_cast<void>(read_log_recording(logs, map));
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text;
  }
  return "";
}

TEST(JoinedLogs, MistakesAreOneLineWithFileLineAndColumn) {
  const ScratchFolder scratch;
  const fs::path wheels = scratch.write("wheels.csv", "t,l,r\n0,0,0\n1,1,1\n2,2,2\n3,3,3\n");
  const fs::path tags = scratch.write("tags.csv", "s,tag\n1,A\n2,B\n");
  const std::string map =
      "[[time]]\nfile = \"wheels.csv\"\nfield = \"t\"\n[[time]]\nfile = \"tags.csv\"\n"
      "field = \"s\"\n[robot]\nwheelbase = 0.3\n[wheels]\nfile = \"wheels.csv\"\n"
      "left.field = \"l\"\nright.field = \"r\"\n[[sightings]]\nfile = \"tags.csv\"\n"
      "landmark = \"tag\"\n";
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = map;
    const std::size_t at = changed.rfind(from);
    EXPECT_NE(at, std::string::npos) << from;
    return error_of({wheels, tags},
                    scratch.write("map.toml", changed.replace(at, from.size(), to)));
  };
  EXPECT_EQ(with("\"tag\"", "\"tag\""), "");
  const auto expect = [](const std::string& error, const std::string& part) {
    EXPECT_NE(error.find(part), std::string::npos) << error;
  };
  expect(with("file = \"tags.csv\"", "file = \"tag.csv\""),
         "map.toml:13: file = \"tag.csv\" is none of the files that are read, expected one of "
         "wheels.csv, tags.csv");
  expect(with("file = \"tags.csv\"\nlandmark", "landmark"),
         "map.toml:13: the table has no file, expected file = one of wheels.csv, tags.csv");
  expect(with("\"tag\"", "\"l\""), "tags.csv has the field l, expected one of s, tag");
  expect(with("\"r\"", "\"tag\""), "wheels.csv has no field tag, expected one of t, l, r");
  expect(with("field = \"s\"", "field = \"t\""), "field t is not in a message of ");
  expect(with("[[time]]\nfile = \"tags.csv\"\nfield = \"s\"\n", ""),
         "the messages of tags.csv have no times, expected a [[time]] of this file");
  expect(with("file = \"tags.csv\"\nfield = \"s\"", "file = \"wheels.csv\"\nfield = \"s\""),
         "map.toml:4: a second [[time]] of wheels.csv");
  expect(error_of({wheels, wheels}, scratch.write("map.toml", map)), "given twice");
  const fs::path bad = scratch.write("tags.csv", "s,tag\n1,A\nx,B\n");
  expect(error_of({wheels, bad}, scratch.write("map.toml", map)),
         "tags.csv:3: [time]: field s is no time (\"x\"), expected a number");
  // What is left out is named by its place, too.
  const fs::path text = scratch.write("wheels.csv", "t,l,r\n0,0,0\n1,1,1\n2,?,2\n3,3,3\n");
  const fs::path good = scratch.write("tags.csv", "s,tag\n1,A\n2,B\n");
  const LogRecording read = read_log_recording({text, good}, scratch.path() / "map.toml");
  const bool named = std::any_of(read.counts.begin(), read.counts.end(), [](const LogCount& one) {
    return one.what.find("wheels.csv:4, l: \"?\"") != std::string::npos;
  });
  EXPECT_TRUE(named);
}

/// A table's text keeps what a double has lost.
TEST(DecimalTime, IsExactToTheNanosecond) {
  EXPECT_EQ(decimal_time("1748457053.946277034", 1000000000), 1748457053946277034);
  EXPECT_EQ(decimal_time("1.748457053946277034e+09", 1000000000), 1748457053946277034);
  EXPECT_EQ(decimal_time("-0,25", 1000000000), -250000000);
  EXPECT_EQ(decimal_time("1748457053946.25", 1000000), 1748457053946250000);
  EXPECT_EQ(decimal_time("12e-3", 1000000000), 12000000);
  EXPECT_EQ(decimal_time(".5", 1000), 500);
  EXPECT_EQ(decimal_time("7", 1), 7);
  for (const char* none : {"", "x", "1.2.3", "--1", "1e", "1e99", "99999999999999999999", "."}) {
    EXPECT_EQ(decimal_time(none, 1000000000), std::nullopt) << none;
  }
}

}  // namespace
}  // namespace trussmap::joined_logs_test
