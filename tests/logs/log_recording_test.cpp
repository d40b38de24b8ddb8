// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Logs to recordings: tables written here, and bags written by tests/logs/bags.
#include "logs/log_messages.hpp"
#include "scratch_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/log_files.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording_files.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::log_recording_test {
namespace {

using testing::ScratchFolder;
using testing::written_by;

constexpr const char* kTable =
    "Time (ms),Left (mm),Right (mm),Heading (deg),Gyro (deg),Load,Tag,Range (mm),Bearing (deg)\n"
    "1000,0,0,10,0,1,,,\n"
    "1100,10,12,20,1,1,A,,\n"
    "1200,20,24,30,3,2,7,2000,90\n"
    "1300,30,36,-170,6,2,,,\n"
    "1400,50,58,170,10,2,-1,,\n";

constexpr const char* kMap = R"toml(time.field = "Time (ms)"
time.unit = "ms"
[robot]
wheelbase = 0.3
[wheels]
unit = "mm"
left.field = "Left (mm)"
right = { field = "Right (mm)", sign = -1 }
[heading]
field = "Heading (deg)"
unit = "deg"
[yaw_rate]
field = "Gyro (deg)"
unit = "deg"
[covariates]
load_kg = { field = "Load", scale = 2.0 }
[[sightings]]
landmark = "Tag"
range = "Range (mm)"
range_unit = "mm"
bearing = "Bearing (deg)"
bearing_unit = "deg"
bearing_sign = -1
none = ["-1"]
prefix = "tag"
)toml";

LogRecording converted(const std::string& table, const std::string& map) {
  const ScratchFolder scratch;
  return read_log_recording(scratch.write("a.csv", table), scratch.write("map.toml", map));
}

/// What the error says behind "map.toml:"; empty: there was none.
std::string error_of(const std::string& map, const std::string& table = kTable) {
  try {
    static_cast<void>(converted(table, map));
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    const std::size_t at = text.find("map.toml:");
    return at == std::string::npos ? text : text.substr(at + 9);
  }
  return "";
}

TEST(LogRecording, ATableBecomesARecording) {
  const LogRecording log = converted(kTable, kMap);
  const Drive& drive = log.recording.drive;
  EXPECT_EQ(drive.t, (std::vector<double>{1.1, 1.2, 1.3, 1.4}));
  const double left[] = {0.01, 0.01, 0.01, 0.02};
  const double right[] = {-0.012, -0.012, -0.012, -0.022};
  const double heading[] = {20, 30, -170, 170};
  const double rate[] = {10, 20, 30, 40};  // deg/s
  const double load[] = {2, 4, 4, 4};
  constexpr double kDegree = std::numbers::pi / 180.0;
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(drive.left[k], left[k], 1e-15);
    EXPECT_NEAR(drive.right[k], right[k], 1e-15);
    EXPECT_NEAR(wrap_angle(drive.heading[k] - heading[k] * kDegree), 0.0, 1e-12);
    EXPECT_NEAR(drive.yaw_rate[k], rate[k] * kDegree, 1e-12);
    EXPECT_EQ(drive.covariates.front().values[k], load[k]);
  }
  ASSERT_EQ(log.recording.sightings.size(), 1U) << "a name without range and bearing is none here";
  const Sighting& one = log.recording.sightings.front();
  EXPECT_EQ(one.landmark, "tag7");
  EXPECT_EQ(one.t, 1.2);
  EXPECT_EQ(one.range, 2.0);
  EXPECT_NEAR(one.bearing, -0.5 * std::numbers::pi, 1e-15);
  EXPECT_EQ(log.model.robot.wheelbase, 0.3);
}

TEST(LogRecording, EveryMistakeOfAMapIsNamedWithItsLine) {
  const std::string map = kMap;
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = map;
    const std::size_t at = changed.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return error_of(changed.replace(at, from.size(), to));
  };
  EXPECT_EQ(error_of(map), "");
  EXPECT_TRUE(with("unit = \"mm\"\nleft", "unit = \"kg\"\nleft").find("is no unit") !=
              std::string::npos);
  EXPECT_TRUE(with("unit = \"mm\"\nleft", "unit = \"deg\"\nleft").find("radius") !=
              std::string::npos);
  EXPECT_TRUE(with("unit = \"mm\"\nleft", "unit = \"tick\"\nleft").find("ticks_per_turn") !=
              std::string::npos);
  EXPECT_TRUE(with("sign = -1", "sign = 2").starts_with("8: [wheels.right]: sign is neither"));
  EXPECT_TRUE(with("sign = -1", "sgin = -1").starts_with("8: key \"sgin\" in [wheels.right]"));
  EXPECT_TRUE(with("[heading]", "[headings]").find("[headings] is unknown") != std::string::npos);
  EXPECT_TRUE(with("[wheels]", "[odometry]\ntwist = \"x\"\n[wheels]").find("either [odometry]") !=
              std::string::npos);
  EXPECT_TRUE(with("wheelbase = 0.3", "wheelbase = -1").starts_with("4: "));
  EXPECT_TRUE(with("\"Left (mm)\"", "\"Links\"").find("expected one of Time (ms), Left (mm)") !=
              std::string::npos);
  const std::string texts =
      "Time (ms),Left (mm),Right (mm),Heading (deg),Gyro (deg),Load,Tag,Range (mm),Bearing (deg)\n"
      "0,x,0,0,0,0,0,0,0\n1,y,0,0,0,0,0,0,0\n";
  EXPECT_TRUE(error_of(map, texts).find("Left (mm) of") < 5U) << error_of(map, texts);
  EXPECT_NE(error_of(map, texts).find("holds nothing that can be used so"), std::string::npos);
  EXPECT_TRUE(with("time.field = \"Time (ms)\"", "time.field = \"Zeit\"").find("Zeit") !=
              std::string::npos);
  EXPECT_TRUE(with("[robot]", "[robot").find("no TOML") != std::string::npos);
}

/// It is the drive that it is with sightings, and it is said what it is good for.
TEST(LogRecording, ADriveThatIsTiedToNoPlaceIsConvertedWithAWarning) {
  const std::string map = kMap;
  const std::string without = map.substr(0, map.find("[[sightings]]"));
  const LogRecording alone = converted(kTable, without);
  const LogRecording tied = converted(kTable, map);
  EXPECT_EQ(alone.recording.drive.left, tied.recording.drive.left);
  EXPECT_EQ(alone.recording.drive.yaw_rate, tied.recording.drive.yaw_rate);
  ASSERT_EQ(alone.warnings.size(), tied.warnings.size() + 2);
  EXPECT_TRUE(alone.warnings[alone.warnings.size() - 2].starts_with(
      "nothing ties the drive to a place: no sighting, fix or truth is within it. apply "));
  EXPECT_EQ(
      alone.warnings.back(),
      "the gyro's bias is not known: the wheels never stand for 2 s and more, expected a rest");
}

TEST(LogRecording, ColumnsWithoutATimeAreRefused) {
  std::string map = kMap;
  map = map.substr(map.find("[robot]"));
  EXPECT_NE(error_of(map).find("have no times"), std::string::npos) << error_of(map);
}

/// Wheels on topics of their own, at 50 and 20 Hz, not in order; truth along frames.
TEST(LogRecording, WheelsOfDifferentRatesGetOntoTheSameRows) {
  const ScratchFolder scratch;
  const auto log = written_by(scratch, R"(
import math
from bag_writer import BagWriter
from messages import *
bag = BagWriter()
bag.topic("/left", "my_msgs/msg/Ticks", "builtin_interfaces/Time stamp\nint64 ticks\n" + "="*80 +
          "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n")
bag.topic("/right", "my_msgs/msg/Ticks", "builtin_interfaces/Time stamp\nint64 ticks\n" + "="*80 +
          "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n")
bag.topic("/tf", "tf2_msgs/msg/TFMessage")
T0 = 1700000000 * 10**9
left = [(T0 + k * 20000000, k) for k in range(501)]
right = [(T0 + k * 50000000 + 7, 3 * k * k) for k in range(200)]
left[10], left[11] = left[11], left[10]
for t, n in left:
    bag.write("/left", t + 5, {"stamp": stamp(t), "ticks": n})
for t, n in right:
    bag.write("/right", t + 5, {"stamp": stamp(t), "ticks": n})
for k in range(0, 400):
    t = T0 + k * 25000000
    bag.write("/tf", t, tf(transform(t, "odom", "base_link", 0.1 * k, 0.0, 0.5)))
for k in range(0, 30):
    t = T0 + k * 350000000
    bag.write("/tf", t, tf(transform(t, "map", "odom", 1.0, 2.0, math.pi / 2)))
bag.write_mcap(path, compression="lz4")
)");
  const LogRecording read = read_log_recording(log, scratch.write("map.toml", R"(
[robot]
wheelbase = 0.5
[wheels]
unit = "tick"
metres_per_tick = 0.001
left.field = "/left/ticks"
right.field = "/right/ticks"
[truth]
pose = "/tf:map.base_link"
)"));
  const Drive& drive = read.recording.drive;
  ASSERT_EQ(drive.rows(), 199U);
  double left = 0.0;
  for (std::size_t k = 0; k < drive.rows(); ++k) {
    const double from = 0.05 * static_cast<double>(k) + 7e-9;
    EXPECT_EQ(drive.t[k], (50000000.0 * static_cast<double>(k + 1) + 7.0) / 1e9);
    // 50 ticks a second, evenly: 2.5 a row.
    EXPECT_NEAR(drive.left[k], 2.5e-3, 1e-12) << from;
    const double n = static_cast<double>(k);
    EXPECT_NEAR(drive.right[k], 3e-3 * (2.0 * n + 1.0), 1e-12);
    left += drive.left[k];
  }
  EXPECT_NEAR(left, 1e-3 * 50.0 * 199.0 * 0.05, 1e-12);
  ASSERT_GT(read.recording.truth.size(), 390U);
  const TruthRow& truth = read.recording.truth[100];
  EXPECT_EQ(truth.t, 2.5);
  EXPECT_NEAR(truth.x, 1.0, 1e-12);
  EXPECT_NEAR(truth.y, 2.0 + 10.0, 1e-12);
  EXPECT_NEAR(truth.heading, 0.5 * std::numbers::pi + 0.5, 1e-12);
  ASSERT_FALSE(read.counts.empty());
}

/// As what is printed says: a misspelt path is no absent reading, and a guess no figure.
TEST(LogRecording, SuspiciousMapsAreWarnedOf) {
  std::string table = "t,l,r,g,c,tag,range\n";
  double heading = 0.0;
  for (int k = 0; k < 100; ++k) {
    table += std::to_string(0.1 * k) + "," + std::to_string(-0.01 * k) + "," +
             std::to_string(0.01 * k) + "," + std::to_string(heading) + ",0,A,2\n";
    heading += 0.04 * 180.0 / std::numbers::pi;
  }
  const std::string map =
      "time.field = \"t\"\n[robot]\nwheelbase = 0.5   # m; STATE IT\n[wheels]\n"
      "left.field = \"l\"\nright.field = \"r\"\n[yaw_rate]\nfield = \"g\"\nunit = \"deg\"\n"
      "[[sightings]]\nlandmark = \"tag\"\nrange = \"range\"\n";
  const auto warnings = [&](const std::string& from, const std::string& to) {
    std::string changed = map;
    if (!from.empty()) changed.replace(changed.find(from), from.size(), to);
    std::string all;
    for (const std::string& one : converted(table, changed).warnings) all += one + "\n";
    return all;
  };
  EXPECT_NE(warnings("", "").find("map.toml:3: the figure is a guess still"), std::string::npos);
  EXPECT_EQ(warnings("   # m; STATE IT", ""), "");
  EXPECT_NE(warnings("unit = \"deg\"", "unit = \"rad\"").find("gyro turns 57.3 times"),
            std::string::npos)
      << warnings("unit = \"deg\"", "unit = \"rad\"");
  EXPECT_NE(warnings("unit = \"deg\"", "unit = \"deg\"\nsign = -1").find("gyro turns -1 times"),
            std::string::npos);
  std::string misspelt = map;
  misspelt.replace(misspelt.find("range = \"range\""), 15, "range = \"rnage\"");
  EXPECT_NE(error_of(misspelt, table).find("no message of"), std::string::npos)
      << error_of(misspelt, table);
}

/// Latitudes, markers in lists beside each other, ranges.
TEST(LogRecording, FixesMarkersAndRangesOfABag) {
  const ScratchFolder scratch;
  const auto log = written_by(scratch, R"(
import math
from bag_writer import BagWriter
from messages import *
bag = BagWriter()
bag.topic("/odom", "nav_msgs/msg/Odometry")
bag.topic("/gps", "sensor_msgs/msg/NavSatFix")
bag.topic("/aruco", "ros2_aruco_interfaces/msg/ArucoMarkers")
bag.topic("/range/post", "sensor_msgs/msg/Range")
bag.topic("/tf_static", "tf2_msgs/msg/TFMessage")
T0 = 1700000000 * 10**9
bag.write("/tf_static", T0, tf(transform(T0, "base_link", "camera", 0.2, 0.0, math.pi / 2)))
for k in range(21):
    t = T0 + k * 100000000
    bag.write("/odom", t, odometry(t, 0.05 * k, 0.0, 0.0, 0.5 if k else 0.0, 0.2 if k else 0.0))
    bag.write("/gps", t, nav_sat_fix(t, 45.0 + 1e-6 * k, 7.0, 100.0, 0.04, -1 if k == 3 else 0))
t = T0 + 1000000000
bag.write("/aruco", t, {"header": header(t, "camera"), "marker_ids": [3, 9],
    "poses": [pose(1.0, 0.5, 0.25), pose(0.0, 2.0, 0.0)]})
bag.write("/range/post", t, range_(t, 2.5))
bag.write_mcap(path, compression="")
)");
  const LogRecording read = read_log_recording(log, scratch.write("map.toml", R"(
[robot]
wheelbase = 0.4
[odometry]
twist = "/odom"
[fixes]
topic = "/gps"
[[sightings]]
topic = "/aruco"
each = "poses"
landmark = "../marker_ids[#]"
position = "."
prefix = "m"
[[sightings]]
topic = "/range/post"
name = "post"
range = "range"
)"));
  const Recording& recording = read.recording;
  ASSERT_EQ(recording.drive.rows(), 20U);
  for (std::size_t k = 0; k < 20; ++k) {
    EXPECT_NEAR(recording.drive.left[k], (0.5 - 0.2 * 0.2) * 0.1, 1e-12);
    EXPECT_NEAR(recording.drive.right[k], (0.5 + 0.2 * 0.2) * 0.1, 1e-12);
  }
  ASSERT_EQ(recording.fixes.size(), 20U) << "one has no fix";
  EXPECT_NEAR(recording.fixes[9].y, 1.111, 2e-3);
  EXPECT_NEAR(recording.fixes[9].x, 0.0, 1e-9);
  EXPECT_NEAR(recording.fixes[9].sd, 0.2, 1e-12);
  ASSERT_EQ(recording.sightings.size(), 3U);
  // The camera looks to the left from 0.2 m ahead: (1, 0.5) of it is (0.2 - 0.5, 1) of the robot.
  const Sighting& first = recording.sightings[0];
  EXPECT_EQ(first.landmark, "m3");
  EXPECT_NEAR(first.range, std::hypot(0.3, 1.0), 1e-12);
  EXPECT_NEAR(first.bearing, std::atan2(1.0, -0.3), 1e-12);
  EXPECT_NEAR(first.yaw, 0.5 * std::numbers::pi + 0.25, 1e-12);
  EXPECT_EQ(recording.sightings[1].landmark, "m9");
  EXPECT_EQ(recording.sightings[2].landmark, "post");
  EXPECT_EQ(recording.sightings[2].range, 2.5);
  EXPECT_TRUE(std::isnan(recording.sightings[2].bearing));
  // Markers are seen from the base, nothing says where the antenna sits.
  EXPECT_EQ(read.model.robot.mounted, Mountings());
}

/// The first map of names that nobody should choose is a map still.
TEST(LogInspection, AFirstMapIsValidWhateverTheNames) {
  const ScratchFolder scratch;
  const auto log = scratch.write("odd.csv",
                                 "\"time \"\"s\"\"\",left\\enc,right \u00fcnc,tag='x',battery\n"
                                 "0,0,0,A,12\n1,100,100,B,12.5\n2,220,210,,12\n3,300,320,A,11\n");
  const LogInspection inspection = inspect_log(log);
  const LogRecording read = read_log_recording(log, scratch.write("map.toml", inspection.map));
  EXPECT_EQ(read.recording.drive.rows(), 3U) << inspection.map;
  EXPECT_EQ(read.recording.sightings.size(), 3U);
}

TEST(LogInspection, CountsRangesAndChangesAreThoseOfTheColumns) {
  const ScratchFolder scratch;
  const LogInspection inspection = inspect_log(scratch.write("a.csv", kTable));
  ASSERT_EQ(inspection.topics.size(), 1U);
  const LogTopicFacts& table = inspection.topics.front();
  EXPECT_EQ(table.messages, 5U);
  const auto field = [&](const std::string& path) {
    for (const LogFieldFacts& one : table.fields) {
      if (one.path == path) return one;
    }
    ADD_FAILURE() << path;
    return LogFieldFacts();
  };
  EXPECT_EQ(field("Heading (deg)").least, -170.0);
  EXPECT_EQ(field("Heading (deg)").largest, 170.0);
  EXPECT_EQ(field("Load").different, 1U);
  EXPECT_EQ(field("Right (mm)").last, 58.0);
  EXPECT_NE(inspection.map.find("kind = \"cumulative\""), std::string::npos);
}

struct Header {
  const char* table;
  std::vector<const char*> parts;  ///< of the map
};

TEST(LogInspection, GuessesByNamesThatTeamsChoose) {
  const Header headers[] = {
      {"timestamp,enc_left,enc_right,gyro_z,tag_id,tag_range\n",
       {"field = \"timestamp\"", "[wheels.left]\nfield = \"enc_left\"",
        "[wheels.right]\nfield = \"enc_right\"", "[yaw_rate]\nfield = \"gyro_z\"",
        "landmark = \"tag_id\"", "range = \"tag_range\""}},
      {"t_ms,leftTicks,rightTicks,headingDeg,batteryVoltage,landmark\n",
       {"unit = \"ms\"", "field = \"leftTicks\"", "field = \"rightTicks\"", "unit = \"tick\"",
        "[heading]\nfield = \"headingDeg\"", "landmark = \"landmark\"", "batteryVoltage"}},
      {"Time (s),Left Wheel Velocity (m/s),Right Wheel Velocity (m/s),Marker\n",
       {"unit = \"m/s\"", "field = \"Left Wheel Velocity (m/s)\"", "landmark = \"Marker\""}},
      {"time,left_distance_mm,right_distance_mm,true_x,true_y,true_theta\n",
       {"unit = \"mm\"", "[truth]", "x = \"true_x\"", "heading = \"true_theta\""}},
      {"time_us,odo_left_m,odo_right_m,lat,lon\n",
       {"unit = \"us\"", "unit = \"m\"", "[fixes]", "latitude = \"lat\"", "longitude = \"lon\""}},
  };
  for (const Header& one : headers) {
    const ScratchFolder scratch;
    const std::string head = one.table;
    std::string table = head;
    const auto columns = static_cast<int>(std::count(head.begin(), head.end(), ',')) + 1;
    for (int row = 0; row < 200; ++row) {
      table += std::to_string(20 * row);
      for (int k = 1; k < columns; ++k) {
        table += "," + std::to_string(k < 3 ? 100 * row + k : (row * (k + 3)) % 11);
      }
      table += "\n";
    }
    const LogInspection inspection = inspect_log(scratch.write("a.csv", table));
    for (const char* part : one.parts) {
      EXPECT_NE(inspection.map.find(part), std::string::npos) << part << "\n" << inspection.map;
    }
  }
}

TEST(LogFiles, AreToldByWhatIsInThem) {
  const ScratchFolder scratch;
  EXPECT_TRUE(is_log(scratch.write("a.csv", "a,b\n1,2\n")));
  EXPECT_TRUE(is_log(scratch.write("b.wpilog", std::string("WPILOG\0\1\0\0\0\0", 12))));
  EXPECT_FALSE(is_log(scratch.write("c.graphml", "<graphml/>")));
}

}  // namespace
}  // namespace trussmap::log_recording_test
