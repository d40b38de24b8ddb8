// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/source_agreement.hpp"

#include "logs/log_messages.hpp"
#include "scratch_folder.hpp"
#include "trussmap/log_files.hpp"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::source_agreement_test {
using namespace logs;
namespace {

using testing::ScratchFolder;
using Lines = std::vector<std::string>;

constexpr std::int64_t kStep = 50000000;  // ns

/// What an odometry of a drive in curves says wrongly.
struct Fault {
  double ahead = 1.0;  ///< factors of the twist
  double turn = 1.0;
  bool exchanged = false;  ///< x is to the right
  bool of_frame = false;   ///< in the axes of the odometry's frame
  double noise = 0.0;      ///< m/s and rad/s, of each twist
  std::int64_t delay = 0;  ///< messages by which the twist is late
  bool reset = false;      ///< the pose is set anew in the middle
  double heading = 0.7;    ///< rad, of the odometry's frame
};

/// Two minutes at 20 Hz, integrated by 50 steps a message: no formula of the check's.
Lines said_of(const Fault& fault) {
  std::mt19937 draw(20261129);
  std::normal_distribution<double> gauss(0.0, 1.0);
  TwistBesidePose check;
  std::vector<FieldTwist> twists;
  double x = 0.0, y = 0.0, heading = fault.heading;
  for (int k = 0; k < 2400; ++k) {
    const double speed = 0.5 + 0.3 * std::sin(k / 90.0);
    const double turn = 0.6 * std::sin(k / 55.0) + 0.1;
    FieldTwist twist{speed, 0.0, turn};
    if (fault.of_frame) {
      twist = {speed * std::cos(heading), speed * std::sin(heading), turn};
    }
    if (fault.exchanged) twist = {-twist.left, twist.ahead, turn};
    twist.ahead = fault.ahead * twist.ahead + fault.noise * gauss(draw);
    twist.turn = fault.turn * twist.turn + fault.noise * gauss(draw);
    twists.push_back(twist);
    FieldPose pose;
    const double jump = fault.reset && k > 1200 ? 300.0 : 0.0;
    pose.position = {x + jump, y, 0.0};
    pose.rotation = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ());
    const auto late = static_cast<std::size_t>(std::max<std::int64_t>(0, k - fault.delay));
    check.add(k * kStep, twists[late], pose);
    constexpr int kParts = 50;
    for (int part = 0; part < kParts; ++part) {
      heading += turn * 0.05 / kParts;
      x += speed * std::cos(heading) * 0.05 / kParts;
      y += speed * std::sin(heading) * 0.05 / kParts;
    }
  }
  return check.contradictions("/odom");
}

TEST(SourceAgreement, OfAnHonestOdometryNothingIsSaid) {
  EXPECT_EQ(said_of({}), Lines());
  EXPECT_EQ(said_of({.noise = 0.1}), Lines());
  EXPECT_EQ(said_of({.delay = 4}), Lines());
  EXPECT_EQ(said_of({.reset = true}), Lines());
  // Wheels that are a few percent off are effects, to be found by a fit.
  EXPECT_EQ(said_of({.ahead = 1.05, .turn = 0.95}), Lines());
}

TEST(SourceAgreement, AScaleIsNamedWithItsFactor) {
  EXPECT_EQ(said_of({.ahead = 0.001}),
            Lines{"the twist of /odom moves 0.001 times as much as the pose beside it (likeness "
                  "1.00): a unit or a constant is wrong in one of them, expected about 1"});
  const Lines degrees = said_of({.turn = 180.0 / 3.14159265358979});
  ASSERT_EQ(degrees.size(), 1U);
  EXPECT_EQ(degrees[0].substr(0, 70),
            "the twist of /odom turns 57.3 times as much as the pose beside it (lik");
  EXPECT_EQ(said_of({.turn = 0.8}).size(), 1U);
}

TEST(SourceAgreement, ASignIsNamed) {
  EXPECT_EQ(said_of({.turn = -1.0}),
            Lines{"the twist of /odom turns -1 times as much as the pose beside it (likeness "
                  "-1.00): a sign is wrong in one of them, expected about 1"});
  const Lines back = said_of({.ahead = -1.0, .noise = 0.05});
  ASSERT_EQ(back.size(), 1U);
  EXPECT_NE(back[0].find("moves -0.99"), std::string::npos) << back[0];
}

TEST(SourceAgreement, AxesAreNamed) {
  EXPECT_EQ(said_of({.exchanged = true}),
            Lines{"the twist of /odom moves to the left where the pose beside it moves ahead "
                  "(likeness 1.00): its axes x and y are exchanged, expected x ahead"});
  const Lines frame = said_of({.of_frame = true});
  ASSERT_FALSE(frame.empty());
  EXPECT_TRUE(
      frame[0].starts_with("the twist of /odom is in the axes of the odometry's frame, not "
                           "in the robot's: so it misses the pose beside it by "))
      << frame[0];
}

TEST(SourceAgreement, OfWhatHardlyMovesNothingIsSaid) {
  TwistBesidePose check;
  for (int k = 0; k < 1000; ++k) {
    FieldPose pose;
    pose.position = {1e-3 * std::sin(k), 0.0, 0.0};
    check.add(k * kStep, {0.0, 0.0, 0.001}, pose);
  }
  EXPECT_EQ(check.contradictions("/odom"), Lines());
}

/// A twist that is filled in for the way, but not for the turn.
TEST(SourceAgreement, ATurnThatIsMissingIsNamed) {
  const Lines said = said_of({.turn = 0.0});
  ASSERT_EQ(said.size(), 1U);
  EXPECT_TRUE(
      said[0].starts_with("the twist of /odom turns by 0 rad in all, the pose beside it by "))
      << said[0];
}

/// A bag: two wheels' joints and an odometry, whose twist is in deg/s and whose pose is in cm.
constexpr const char* kBag = R"py(
import math
from bag_writer import BagWriter
import messages as ros
bag = BagWriter()
bag.topic("/odom", "nav_msgs/msg/Odometry")
bag.topic("/joint_states", "sensor_msgs/msg/JointState")
bag.topic("/gps", "geometry_msgs/msg/PoseStamped")
x = y = heading = left = right = 0.0
for k in range(1200):
    t = 1_700_000_000_000_000_000 + k * 50_000_000
    turn = math.sin(k / 40)
    bag.write("/odom", t, ros.odometry(t, CM * x, CM * y, heading, 0.5, DEG * turn))
    bag.write("/joint_states", t, ros.joint_state(t, ["l", "r"], [left / 0.05, right / 0.05]))
    bag.write("/gps", t, ros.pose_stamped(t, x, y, heading))
    heading += 0.05 * turn
    x, y = x + 0.025 * math.cos(heading), y + 0.025 * math.sin(heading)
    left, right = left + 0.025 - 0.01 * turn, right + 0.025 + 0.01 * turn
bag.write_mcap(path)
)py";

Lines warnings_of(const std::string& constants, const std::string& map) {
  const ScratchFolder scratch;
  const auto log = testing::written_by(scratch, constants + kBag);
  const std::string head = "[robot]\nwheelbase = 0.4\n[fixes]\ntopic = \"/gps\"\n";
  return read_log_recording(log, scratch.write("map.toml", head + map)).warnings;
}

const std::string kTwist = "[odometry]\ntwist = \"/odom\"\n";
const std::string kPose = "[odometry]\npose = \"/odom\"\n";
const std::string kCompared = "compare = true\n";

std::string wheels(const std::string& radius) {
  return "[wheels]\nunit = \"rad\"\nradius = " + radius +
         "\nleft.field = \"/joint_states/position[l]\"\n"
         "right.field = \"/joint_states/position[r]\"\n";
}

TEST(SourceAgreement, ABagsTwistIsComparedWithItsPose) {
  EXPECT_EQ(warnings_of("CM, DEG = 1, 1", kTwist), Lines());
  EXPECT_EQ(warnings_of("CM, DEG = 1, 1", kPose), Lines());
  for (const std::string& map : {kTwist, kPose}) {
    const Lines both = warnings_of("CM, DEG = 100, 57.2958", map);
    ASSERT_EQ(both.size(), 2U);
    EXPECT_TRUE(both[0].starts_with("the twist of /odom moves 0.01 times as much as the pose"))
        << both[0];
    EXPECT_TRUE(both[1].starts_with("the twist of /odom turns 57.3 times as much as the pose"))
        << both[1];
  }
}

/// Beside [wheels] an [odometry] drives nothing, but is compared.
TEST(SourceAgreement, WheelsAreComparedWithAnOdometry) {
  for (const std::string& odometry : {kTwist, kPose}) {
    EXPECT_EQ(warnings_of("CM, DEG = 1, 1", wheels("0.05") + odometry + kCompared), Lines());
    const Lines radius = warnings_of("CM, DEG = 1, 1", wheels("0.1") + odometry + kCompared);
    ASSERT_EQ(radius.size(), 2U);
    EXPECT_TRUE(radius[0].starts_with("what the wheels say moves 2 times as much as the odometry "))
        << radius[0];
    EXPECT_TRUE(radius[1].starts_with("what the wheels say turns 2 times as much as the odometry "))
        << radius[1];
  }
  const Lines sign =
      warnings_of("CM, DEG = 1, 1", wheels("0.05") + "left.sign = -1\n" + kTwist + kCompared);
  EXPECT_FALSE(sign.empty());
}

/// The recording is that of the wheels, to the last digit.
TEST(SourceAgreement, AnOdometryBesideWheelsChangesNothing) {
  const ScratchFolder scratch;
  const auto log = testing::written_by(scratch, std::string("CM, DEG = 1, 1") + kBag);
  const std::string head = "[robot]\nwheelbase = 0.4\n[fixes]\ntopic = \"/gps\"\n" + wheels("0.05");
  const Drive alone = read_log_recording(log, scratch.write("a.toml", head)).recording.drive;
  const Drive beside =
      read_log_recording(log, scratch.write("b.toml", head + kPose + kCompared)).recording.drive;
  EXPECT_EQ(alone.t, beside.t);
  EXPECT_EQ(alone.left, beside.left);
  EXPECT_EQ(alone.right, beside.right);
}

}  // namespace
}  // namespace trussmap::source_agreement_test
