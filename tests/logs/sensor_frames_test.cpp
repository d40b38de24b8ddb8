// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/log_messages.hpp"
#include "scratch_folder.hpp"
#include "trussmap/log_files.hpp"

#include <numbers>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::sensor_frames_test {
namespace {

using testing::ScratchFolder;
using testing::written_by;

/// Antenna and laser sit where /tf_static says, the laser over a bracket that is turned; what the
/// map states stays.
TEST(LogRecording, PlacesOfSensorsComeFromTheFrames) {
  const ScratchFolder scratch;
  const auto log = written_by(scratch, R"(
import math
from bag_writer import BagWriter
from messages import *
bag = BagWriter()
bag.topic("/odom", "nav_msgs/msg/Odometry")
bag.topic("/gps", "sensor_msgs/msg/NavSatFix")
bag.topic("/range/post", "sensor_msgs/msg/Range")
bag.topic("/tf", "tf2_msgs/msg/TFMessage")
bag.topic("/tf_static", "tf2_msgs/msg/TFMessage")
T0 = 1700000000 * 10**9
bag.write("/tf_static", T0, tf(transform(T0, "base_link", "bracket", 1.0, 0.5, math.pi / 2),
    transform(T0, "bracket", "laser", 0.2, 0.0, -math.pi / 4),
    transform(T0, "base_link", "gps", -0.3, 0.1, 1.0),
    transform(T0, "base_link", "prism", 0.1, 0.2, 0.3)))
for k in range(21):
    t = T0 + k * 100000000
    bag.write("/odom", t, odometry(t, 0.05 * k, 0.0, 0.0, 0.5 if k else 0.0, 0.0))
    bag.write("/tf", t, tf(transform(t, "map", "base_link", 0.05 * k, 0.0, 0.0)))
    fix = nav_sat_fix(t, 45.0 + 1e-6 * k, 7.0, 100.0, 0.04, 0)
    fix["header"] = header(t, "gps")
    bag.write("/gps", t, fix)
    seen = range_(t, 2.5)
    seen["header"] = header(t, "laser")
    bag.write("/range/post", t, seen)
bag.write_mcap(path, compression="")
)");
  const std::string map = R"(
[odometry]
twist = "/odom"
[fixes]
topic = "/gps"
[truth]
pose = "/tf:map.prism"
[[sightings]]
topic = "/range/post"
name = "post"
range = "range"
[robot]
wheelbase = 0.4
)";
  const Mountings found =
      read_log_recording(log, scratch.write("map.toml", map)).model.robot.mounted;
  const auto expect_at = [](const std::optional<Mounting>& at, double x, double y, double yaw) {
    ASSERT_TRUE(at.has_value());
    EXPECT_NEAR(at->x, x, 1e-12);
    EXPECT_NEAR(at->y, y, 1e-12);
    EXPECT_NEAR(at->yaw, yaw, 1e-12);
  };
  expect_at(found.antenna, -0.3, 0.1, 0.0);
  expect_at(found.sensor, 1.0, 0.7, 0.25 * std::numbers::pi);
  expect_at(found.tracked, 0.1, 0.2, 0.3);
  EXPECT_FALSE(found.scanner.has_value());
  const Mountings stated =
      read_log_recording(log, scratch.write("map.toml", map + "[robot.antenna]\nx = 2\n"))
          .model.robot.mounted;
  expect_at(stated.antenna, 2.0, 0.0, 0.0);
}

}  // namespace
}  // namespace trussmap::sensor_frames_test
