// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "datasets/formats.hpp"
#include "scratch_folder.hpp"
#include "shared_data.hpp"
#include "trussmap/dead_reckoning.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/recording_files.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include <gtest/gtest.h>

namespace trussmap::steered_truck_test {
using namespace datasets;
namespace {

using testing::ScratchFolder;

std::string word(std::uint32_t value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

/// A matrix with one column, as MATLAB 5 writes it.
std::string column(const std::string& name, const std::vector<double>& values,
                   std::uint32_t flags = 6) {
  std::string data(sizeof(double) * values.size(), '\0');
  std::memcpy(data.data(), values.data(), data.size());
  std::string body = word(6) + word(8) + word(flags) + word(0) + word(5) + word(8) +
                     word(static_cast<std::uint32_t>(values.size())) + word(1);
  const auto length = static_cast<std::uint32_t>(name.size());
  body += length <= 4 ? word(1 | (length << 16U)) + name + std::string(4 - length, '\0')
                      : word(1) + word(length) + name + std::string((8 - length % 8) % 8, '\0');
  body += word(9) + word(static_cast<std::uint32_t>(data.size())) + data;
  return word(14) + word(static_cast<std::uint32_t>(body.size())) + body;
}

std::string mat(const std::string& columns) {
  return std::string(124, ' ') + std::string("\0\1IM", 4) + columns;
}

const std::string kFixes = mat(column("timeGps", {30.0, 30.0, 60.0}) +
                               column("Lo_m", {3.0, 4.0, 5.0}) + column("La_m", {1.0, 2.0, 6.0}));

TEST(SteeredTruck, ColumnsBecomeADriveAndFixes) {
  const ScratchFolder scratch;
  scratch.write("a_dr.mat", mat(column("time", {20.0, 45.0, 70.0, 95.0}) +
                                column("speed", {1.0, 2.0, 3.0, 4.0}) +
                                column("steering", {0.1, 0.2, 0.3, 0.4})));
  scratch.write("a_gpsx.mat", kFixes);
  ASSERT_TRUE(is_steered_truck(scratch.path() / "a"));
  const Dataset read = read_steered_truck(scratch.path() / "a");
  const Drive& drive = read.recording.drive;
  ASSERT_EQ(drive.rows(), 3U);
  EXPECT_NEAR(drive.t[0], 0.025, 1e-15);
  EXPECT_NEAR(drive.covariates[0].values[1], 0.05, 1e-15);  // 2 m/s for 25 ms
  EXPECT_EQ(drive.covariates[1].values[1], 0.2);
  ASSERT_EQ(read.recording.fixes.size(), 2U);
  EXPECT_EQ(read.figure("repeated_fixes"), 1);
  EXPECT_NEAR(read.recording.fixes[1].t, 0.040, 1e-15);
  EXPECT_EQ(read.recording.fixes[1].x, 5.0);
  EXPECT_EQ(read.recording.fixes[1].y, 6.0);
}

/// Seven rows of 25 ms: at rest, then ahead with the front wheels turned, at rest, ahead.
std::string moving() {
  return mat(column("time", {0.0, 25.0, 50.0, 75.0, 100.0, 125.0, 150.0, 175.0}) +
             column("speed", {0.0, 4.0, 4.0, 2.0, 0.0, 0.0, 4.0, 9.0}) +
             column("steering", {0.1, 0.1, 0.2, -0.1, 0.1, 0.1, 0.0, 0.0}));
}

/// An edge over the rows [first, end) of `moving`, by the truck's stated axles: 2.83 m apart, the
/// wheel 0.76 m to the left.
std::string edge(int from, int to, std::size_t first, std::size_t end) {
  const double speed[] = {0.0, 4.0, 4.0, 2.0, 0.0, 0.0, 4.0};
  const double steering[] = {0.1, 0.1, 0.2, -0.1, 0.1, 0.1, 0.0};
  double x = 0.0, y = 0.0, heading = 0.0;
  for (std::size_t row = first; row < end; ++row) {
    const double ahead = 0.025 * speed[row] / (1.0 - 0.76 * std::tan(steering[row]) / 2.83);
    x += ahead * std::cos(heading);
    y += ahead * std::sin(heading);
    heading += ahead * std::tan(steering[row]) / 2.83;
  }
  char text[200];
  std::snprintf(text, sizeof text, "ODOMETRY %d %d %.6g %.6g %.6g 100 0 0 500 0 500\n", from, to, x,
                y, heading);
  return text;
}

TEST(SteeredTruck, TreesOfTheGraphStandAtTheTimesOfItsEdges) {
  const ScratchFolder scratch;
  scratch.write("a_dr.mat", moving());
  scratch.write("a_gpsx.mat", kFixes);
  // Pose 1 stands after row 2, pose 3 after row 4; pose 4 is sought beyond a row at rest.
  scratch.write("victoriaPark.txt", edge(0, 1, 0, 2) + edge(1, 3, 2, 4) + edge(3, 4, 6, 7) +
                                        "LANDMARK 3 7 3 4 1.6 0 1.6\nLANDMARK 1 9 5 0 1.6 0 1.6\n");
  const Dataset read = read_steered_truck(scratch.path() / "a");
  EXPECT_EQ(read.figure("graph_poses"), 4);
  const std::vector<Sighting>& seen = read.recording.sightings;
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_EQ(seen[0].landmark, "9");
  EXPECT_NEAR(seen[0].t, 0.050, 1e-12);
  EXPECT_EQ(seen[1].landmark, "7");
  EXPECT_NEAR(seen[1].t, 0.100, 1e-12);
  EXPECT_NEAR(seen[1].range, 5.0, 1e-12);
  EXPECT_NEAR(seen[1].bearing, std::atan2(4.0, 3.0), 1e-12);
}

TEST(SteeredTruck, GraphsOfOtherDrivesAreRefused) {
  const ScratchFolder scratch;
  scratch.write("a_dr.mat", moving());
  scratch.write("a_gpsx.mat", kFixes);
  const auto refusal = [&scratch](const std::string& graph) -> std::string {
    scratch.write("victoriaPark.txt", graph);
    try {
      static_cast<void>(read_steered_truck(scratch.path() / "a"));
    } catch (const InputError& error) {
      return std::string(error.what()).substr(scratch.path().string().size() + 1);
    }
    return "none";
  };
  EXPECT_EQ(refusal("ODOMETRY 0 1 0.11 0 0 1 0 0 1 0 1\nLANDMARK 1 2 3 4 1 0 1\n"),
            "victoriaPark.txt: has an edge from pose 0 to 1 that the drive has not, expected the "
            "graph of this very drive");
  EXPECT_EQ(refusal(edge(0, 1, 0, 2) + edge(2, 3, 2, 4)),
            "victoriaPark.txt: has an edge from pose 2 after one to pose 1, expected the odometry "
            "from pose to pose in order");
  EXPECT_EQ(refusal(edge(0, 1, 0, 2) + "LANDMARK 5 2 3 4 1 0 1\n"),
            "victoriaPark.txt: sees a tree from pose 5, to which no odometry leads, expected poses "
            "of the drive");
  EXPECT_EQ(refusal(edge(0, 1, 0, 2) + "LANDMARK 1 2 three 4 1 0 1\n").substr(0, 18),
            "victoriaPark.txt:2");
}

std::string complaint(const std::string& drive) {
  const ScratchFolder scratch;
  scratch.write("a_dr.mat", drive);
  scratch.write("a_gpsx.mat", kFixes);
  try {
    (void)read_steered_truck(scratch.path() / "a");
  } catch (const InputError& error) {
    return std::string(error.what()).substr(scratch.path().string().size() + 1);
  }
  return "none";
}

TEST(SteeredTruck, SaysWhatIsWrong) {
  const std::string rest = column("speed", {1.0, 2.0, 3.0}) + column("steering", {0.1, 0.2, 0.3});
  EXPECT_EQ(complaint("text"),
            "a_dr.mat: is no MATLAB file of level 5, little-endian, expected one");
  EXPECT_EQ(complaint(mat(column("time", {1.0, 2.0, 3.0}))),
            "a_dr.mat: has no \"speed\", expected it");
  EXPECT_EQ(complaint(mat(column("time", {1.0, 2.0}) + rest)),
            "a_dr.mat: \"speed\" has 3 numbers, expected 2 as the times are");
  EXPECT_EQ(complaint(mat(column("time", {1.0, 2.0, 2.0}) + rest)),
            "a_dr.mat: time runs backwards in row 3, expected rows in order of time");
  EXPECT_EQ(complaint(mat(column("time", {1.0, 2.0, NAN}) + rest)),
            "a_dr.mat: \"time\" holds no number, or one beyond 1e12");
  EXPECT_EQ(complaint(mat(column("time", {1.0, 2.0, 3.0}, 0x806) + rest)),
            "a_dr.mat: holds \"time\", which is no column of real numbers, at byte 208, expected a "
            "MATLAB file of level 5");
  std::string cut = mat(column("time", {1.0, 2.0, 3.0}));
  cut.resize(cut.size() - 5);
  EXPECT_EQ(complaint(cut).substr(0, 32), "a_dr.mat: ends inside an element");
}

/// Every cut of a file, and every byte changed, is read or refused.
TEST(SteeredTruck, NoDamageIsMoreThanAnError) {
  const std::string whole = mat(column("time", {1.0, 2.0, 3.0}) + column("speed", {1.0, 2.0, 3.0}) +
                                column("steering", {0.1, 0.2, 0.3}));
  for (std::size_t at = 0; at < whole.size(); ++at) {
    EXPECT_NE(complaint(whole.substr(0, at)), "none") << at;
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x55);
    static_cast<void>(complaint(changed));
  }
}

/// Victoria Park by odometry and GPS alone: the steering's offset, and an antenna that is near the
/// laser, 3.78 m ahead of the rear axle and 0.5 m to its left.
TEST(SlowSteeredTruck, VictoriaParkFollowsItsGps) {
  TRUSSMAP_NEEDS_SHARED("data/victoria-park/aa3_dr.mat");
  const Dataset read = read_steered_truck(testing::shared("data/victoria-park/aa3"));
  DrivenRecording recording = with_wheels(read.recording, read.model.robot);
  recording.sightings.clear();
  Model model = read.model;
  for (const Channel channel : {Channel::steer, Channel::steer_gain, Channel::wheels,
                                Channel::antenna, Channel::antenna_left}) {
    model.effects.push_back({std::string(name_of(channel)), channel, {"1"}, {}, false});
  }
  FitOptions options;
  options.gate = 8.0;
  const ModelFit fit = fit_model({recording}, model, options);
  const auto found = [&fit](std::size_t k) { return fit.model.effects[k].coefficients[0]; };
  EXPECT_NEAR(found(3), 3.78, 0.3);
  EXPECT_NEAR(found(4), 0.5, 0.3);
  const std::vector<TimedPose> poses = adjusted_poses(fit, 0);
  double sum = 0.0;
  int count = 0;
  std::size_t at = 0;
  for (const Fix& one : recording.fixes) {
    if (one.t < poses.front().t || one.t > poses.back().t) continue;
    while (poses[at].t < one.t) ++at;
    const Pose& pose = poses[at].estimate.pose;
    const Vector2 antenna = pose.position() + rotation(pose.heading) * Vector2(found(3), found(4));
    sum += (antenna - Vector2(one.x, one.y)).squaredNorm();
    ++count;
  }
  EXPECT_LT(std::sqrt(sum / count), 5.0);  // 2.3 m when this was written
}

/// The same constants from trees alone: the truth is what the GPS tells in the test above.
TEST(SlowSteeredTruck, VictoriaParksTreesTellTheSteeringAsItsGpsDoes) {
  TRUSSMAP_NEEDS_SHARED("data/victoria-park/aa3_dr.mat");
  const Dataset read = read_steered_truck(testing::shared("data/victoria-park/aa3"));
  EXPECT_EQ(read.figure("graph_poses"), 6969);
  ASSERT_EQ(read.recording.sightings.size(), 3640U);
  DrivenRecording recording = with_wheels(read.recording, read.model.robot);
  recording.fixes.clear();
  Model model = read.model;
  for (const Channel channel :
       {Channel::steer, Channel::steer_gain, Channel::wheels, Channel::delay}) {
    model.effects.push_back({std::string(name_of(channel)), channel, {"1"}, {}, false});
  }
  FitOptions options;
  options.gate = 16.0;
  const ModelFit fit = fit_model({recording}, model, options);
  const auto found = [&fit](std::size_t k) { return fit.model.effects[k].coefficients[0]; };
  EXPECT_NEAR(found(0), 0.00433, 0.0005);  // by the GPS 0.248 deg
  EXPECT_NEAR(found(1), 0.037, 0.007);     // by the GPS 3.7 %
  EXPECT_LT(fit.left_out.size(), 40U);
}

}  // namespace
}  // namespace trussmap::steered_truck_test
