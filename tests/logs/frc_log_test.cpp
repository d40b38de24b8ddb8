// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Logs of FRC robots: of one whose four modules steer, by its chassis or by them, and of one with
// two wheels. The drive is integrated in Python, in steps of 1 ms.
#include "logs/log_messages.hpp"
#include "scratch_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/log_files.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::frc_log_test {
namespace {

using testing::ScratchFolder;
using testing::written_by;

/// CHASSIS, MODULES, TANK: what is in it; SIDE: m/s to the left at most.
constexpr const char* kRobot = R"py(
import math
from wpilog_writer import *
PLACES = [(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)]
with WpiLog(path) as log:
    log.wpilib_schemas(*WPILIB)
    start = lambda name, kind: log.start(name, kind)
    steer = [start(f"/Drive/{n}/SteerEncoder", "double") for n in ("LeftFront", "RightFront")]
    if CHASSIS:
        asked = start("/RealOutputs/Chassis/Setpoints", "struct:ChassisSpeeds")
        chassis = start("/RealOutputs/Chassis/Measured", "struct:ChassisSpeeds")
    if MODULES:
        wanted = start("/RealOutputs/SwerveStates/Setpoints", "struct:SwerveModuleState[]")
        states = start("/RealOutputs/SwerveStates/Measured", "struct:SwerveModuleState[]")
    if TANK:
        wheels = [start(f"/Drive/{n}PositionMeters", "double") for n in ("Left", "Right")]
    fix = start("/Vision/Pose", "struct:Pose2d")
    x = y = heading = left = right = 0.0
    for k in range(1500):
        t = 1000000 + 20000 * k
        vx, vy, omega = 1 + 0.5 * math.sin(k / 60), SIDE * math.sin(k / 45), 0.8 * math.sin(k / 70)
        if CHASSIS:
            log.write(asked, t, dict(vx=9.0 + math.sin(k), vy=0.0, omega=math.sin(k)))
            log.write(chassis, t, dict(vx=vx, vy=vy, omega=omega))
        if MODULES:
            each = []
            for px, py in PLACES:
                mx, my = vx - omega * py, vy + omega * px
                each.append(dict(speed=-math.hypot(mx, my), angle={"value": math.atan2(-my, -mx)}))
            log.write(states, t, each)
            log.write(wanted, t, [dict(speed=k, angle={"value": 0.0})] * 4)
        if TANK:
            log.write(wheels[0], t, left)
            log.write(wheels[1], t, right)
        for n, one in enumerate(steer):
            log.write(one, t, 0.01 * k + 0.5 * math.sin(k / 50 + n))
        if k % 50 == 0:
            log.write(fix, t, {"translation": {"x": x, "y": y}, "rotation": {"value": heading}})
        # The motion that holds until the next message is the next one's: of the one before.
        vx, vy = 1 + 0.5 * math.sin((k + 1) / 60), SIDE * math.sin((k + 1) / 45)
        omega = 0.8 * math.sin((k + 1) / 70)
        for _ in range(20):
            heading += 0.0005 * omega
            x += 0.001 * (vx * math.cos(heading) - vy * math.sin(heading))
            y += 0.001 * (vx * math.sin(heading) + vy * math.cos(heading))
            heading += 0.0005 * omega
        left += 0.02 * (vx - 0.3 * omega)
        right += 0.02 * (vx + 0.3 * omega)
)py";

struct Converted {
  std::string map;
  LogRecording log;
};

Converted converted(const std::string& constants, const std::string& from = "",
                    const std::string& to = "") {
  const ScratchFolder scratch;
  const auto log = written_by(scratch, constants + "\n" + kRobot);
  Converted result;
  result.map = inspect_log(log).map;
  std::string mended = result.map;
  if (const std::size_t at = mended.find(from); !from.empty() && at != std::string::npos) {
    mended.replace(at, from.size(), to);
  }
  mended += "\n[truth]\npose = \"/Vision/Pose\"\n";
  result.log = read_log_recording(log, scratch.write("map.toml", mended));
  return result;
}

/// The columns of the body, row by row along arcs of our own making, end at the truth's last pose.
void expect_it_ends_there(const Recording& recording) {
  double x = 0.0, y = 0.0, heading = 0.0;
  const Drive& drive = recording.drive;
  ASSERT_EQ(drive.covariates.size(), 3U);
  EXPECT_EQ(drive.covariates[0].name, "ahead");
  EXPECT_EQ(drive.covariates[1].name, "left");
  EXPECT_EQ(drive.covariates[2].name, "turn");
  std::size_t next = 1;  // of the truth, whose first is where the drive begins
  for (std::size_t k = 0; k < drive.rows() && next < recording.truth.size(); ++k) {
    const double ahead = drive.covariates[0].values[k];
    const double left = drive.covariates[1].values[k];
    const double turn = drive.covariates[2].values[k];
    const double middle = heading + 0.5 * turn;
    x += ahead * std::cos(middle) - left * std::sin(middle);
    y += ahead * std::sin(middle) + left * std::cos(middle);
    heading += turn;
    if (drive.t[k] < recording.truth[next].t - 1e-6) continue;
    EXPECT_NEAR(drive.t[k], recording.truth[next].t, 1e-6);
    EXPECT_NEAR(x, recording.truth[next].x, 2e-3) << next;
    EXPECT_NEAR(y, recording.truth[next].y, 2e-3) << next;
    ++next;
  }
  EXPECT_EQ(next, recording.truth.size());
  EXPECT_EQ(next, 30U);
}

TEST(FrcLog, AChassisThatGoesSidewaysIsTakenBeforeEncodersThatSteer) {
  const Converted all = converted("CHASSIS, MODULES, TANK, SIDE = 1, 1, 0, 0.7");
  EXPECT_NE(all.map.find("[odometry]   # the speed of the chassis, held since the message before\n"
                         "twist = \"/RealOutputs/Chassis/Measured\"\n"),
            std::string::npos)
      << all.map;
  EXPECT_NE(all.map.find("drive = \"wheels\""), std::string::npos) << all.map;
  EXPECT_EQ(all.map.find("SteerEncoder"), std::string::npos) << all.map;
  EXPECT_EQ(all.map.find("STATE IT"), std::string::npos) << all.map;
  expect_it_ends_there(all.log.recording);
}

TEST(FrcLog, ModulesAloneGiveTheBodysMotion) {
  const Converted all =
      converted("CHASSIS, MODULES, TANK, SIDE = 0, 1, 0, 0.7",
                "places = [[0.3, 0.3], [0.3, -0.3], [-0.3, 0.3], [-0.3, -0.3]]",
                "places = [[0.3, 0.25], [0.3, -0.25], [-0.3, 0.25], [-0.3, -0.25]]");
  EXPECT_NE(all.map.find("modules = \"/RealOutputs/SwerveStates/Measured\"\n"
                         "places = [[0.3, 0.3], [0.3, -0.3], [-0.3, 0.3], [-0.3, -0.3]]   # m, of "
                         "each module: ahead, to the left; STATE IT"),
            std::string::npos)
      << all.map;
  EXPECT_EQ(all.map.find("SteerEncoder"), std::string::npos) << all.map;
  expect_it_ends_there(all.log.recording);
}

/// Wheels before what is made of them.
TEST(FrcLog, OfTwoWheelsThatDoNotSteerTheEncodersAreTaken) {
  const Converted all = converted("CHASSIS, MODULES, TANK, SIDE = 1, 0, 1, 0");
  EXPECT_NE(all.map.find("field = \"/Drive/LeftPositionMeters\""), std::string::npos) << all.map;
  EXPECT_EQ(all.map.find("drive = \"wheels\""), std::string::npos) << all.map;
  EXPECT_EQ(all.map.find("[odometry]"), std::string::npos) << all.map;
  EXPECT_EQ(all.map.find("omega"), std::string::npos) << all.map;  // made of the wheels, no gyro
  const Converted chassis =
      converted("CHASSIS, MODULES, TANK, SIDE = 1, 0, 0, 0", "wheelbase = 0.34", "wheelbase = 0.6");
  EXPECT_NE(chassis.map.find("twist = \"/RealOutputs/Chassis/Measured\""), std::string::npos)
      << chassis.map;
  const Drive& wheels = all.log.recording.drive;
  const Drive& body = chassis.log.recording.drive;
  ASSERT_EQ(wheels.rows(), body.rows());
  for (std::size_t k = 0; k < wheels.rows(); ++k) {
    EXPECT_NEAR(wheels.left[k], body.left[k], 1e-9) << k;
    EXPECT_NEAR(wheels.right[k], body.right[k], 1e-9) << k;
  }
}

/// The poses that an odometry sums up, of a body that goes sideways.
TEST(FrcLog, PosesGiveTheBodysMotion) {
  const ScratchFolder scratch;
  const auto log =
      written_by(scratch, std::string("CHASSIS, MODULES, TANK, SIDE = 1, 1, 0, 0.7\n") + kRobot);
  const LogRecording read = read_log_recording(
      log, scratch.write("map.toml",
                         "[robot]\ndrive = \"wheels\"\ncolumns = [\"ahead\", \"left\", \"turn\"]\n"
                         "matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n[odometry]\n"
                         "pose = \"/Vision/Pose\"\n[truth]\npose = \"/Vision/Pose\"\n"));
  // Over a second each: along the arc that ends at the next pose.
  double x = 0.0, y = 0.0, heading = 0.0;
  const Drive& drive = read.recording.drive;
  ASSERT_EQ(drive.rows(), 29U);
  for (std::size_t k = 0; k < drive.rows(); ++k) {
    const double turn = drive.covariates[2].values[k];
    constexpr int kParts = 2000;
    for (int part = 0; part < kParts; ++part) {
      const double middle = heading + turn * (part + 0.5) / kParts;
      const double ahead = drive.covariates[0].values[k] / kParts;
      const double left = drive.covariates[1].values[k] / kParts;
      x += ahead * std::cos(middle) - left * std::sin(middle);
      y += ahead * std::sin(middle) + left * std::cos(middle);
    }
    heading += turn;
    EXPECT_NEAR(x, read.recording.truth[k + 1].x, 1e-6);
    EXPECT_NEAR(y, read.recording.truth[k + 1].y, 1e-6);
  }
}

TEST(FrcLog, MistakesInModulesAreNamed) {
  const ScratchFolder scratch;
  const auto log =
      written_by(scratch, std::string("CHASSIS, MODULES, TANK, SIDE = 1, 1, 0, 0.7\n") + kRobot);
  const auto said = [&](const std::string& robot, const std::string& odometry) {
    try {
      static_cast<void>(read_log_recording(
          log,
          scratch.write("map.toml", "[robot]\n" + robot + "[truth]\npose = \"/Vision/Pose\"\n" +
                                        "[odometry]\n" + odometry)));
    } catch (const InputError& error) {
      return std::string(error.what()).substr((scratch.path() / "map.toml").string().size());
    }
    return std::string("none");
  };
  const std::string two = "wheelbase = 0.5\n";
  const std::string modules = "modules = \"/RealOutputs/SwerveStates/Measured\"\n";
  EXPECT_TRUE(said(two, modules).find("has modules without their places") != std::string::npos);
  EXPECT_TRUE(said(two, modules + "places = [[1, 2]]\n").find("of two or more") !=
              std::string::npos);
  EXPECT_TRUE(said(two, modules + "places = [[1, 2], 3]\n").find("is no list of pairs") !=
              std::string::npos);
  EXPECT_TRUE(said(two, modules + "places = [[1, 2], [3, 4]]\n").find("nothing that can be used") !=
              std::string::npos);
  EXPECT_TRUE(
      said("drive = \"omni3\"\nradius = 0.2\n", "twist = \"/RealOutputs/Chassis/Measured\"\n")
          .find("matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]") != std::string::npos);
}

}  // namespace
}  // namespace trussmap::frc_log_test
