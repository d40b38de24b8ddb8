// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "datasets/formats.hpp"
#include "scratch_folder.hpp"
#include "shared_data.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording_files.hpp"

#include <cmath>
#include <cstdint>
#include <map>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace trussmap::encoder_log_test {
using namespace datasets;
namespace {

using testing::ScratchFolder;

const std::string kHeader =
    "#kinematic_model: traction_drive_wheel\n"
    "#parameters: [ Ksteer Ktraction axis_length steer_offset ]\n"
    "#parameter_values: 0.5 0.02 1.4 0.1\n"
    "#joints_max_enc: [ steering traction_wheel ]\n"
    "#joints_max_enc_values: 8192 5000\n"
    "#laser wrt base_link\n"
    "#\ttranslation:\t[ 1.5, 0.5, 0 ],\n"
    "#\trotation:\t [ 0, 0, 0, 1 ]\n";

std::string sample(double t, int steer, std::uint32_t ticks) {
  return fmt::format("time: {} ticks: {} {} model_pose: 0 0 0 tracker_pose: 3 4 {}\n", 1000.0 + t,
                     steer, ticks, M_PI / 2.0);
}

/// Eleven samples, 0.04 s apart: the wheel turns back through the counter's 0.
std::string log_of(int steer) {
  std::string text = kHeader;
  std::uint32_t ticks = 700;
  for (int k = 0; k < 11; ++k) {
    text += sample(0.04 * k, steer, ticks);
    ticks -= 100;
  }
  return text;
}

TEST(EncoderLog, CountsBecomeTravelsAndAngles) {
  const ScratchFolder scratch;
  scratch.write("log.txt", log_of(8192 - 1024));
  ASSERT_TRUE(is_encoder_log(scratch.path() / "log.txt"));
  const Dataset read = read_encoder_log(scratch.path() / "log.txt");
  EXPECT_EQ(read.figure("samples"), 11);
  EXPECT_EQ(read.epoch, 1000.0);
  EXPECT_EQ(read.model.robot.drive, DriveKind::tricycle);
  EXPECT_EQ(read.model.robot.length, 1.4);
  const Drive& drive = read.recording.drive;
  ASSERT_EQ(drive.rows(), 2U);
  for (std::size_t row = 0; row < 2; ++row) {
    EXPECT_NEAR(drive.t[row], 0.2 * static_cast<double>(row + 1), 1e-6);
    EXPECT_NEAR(drive.covariates[0].values[row], -500.0 / 5000.0 * 0.02, 1e-12);
    EXPECT_NEAR(drive.covariates[1].values[row], -0.5 * M_PI / 4.0 + 0.1, 1e-12);
    // The sensor is 1.5 m ahead and 0.5 m to the left of a robot that faces along +y.
    EXPECT_NEAR(read.recording.truth[row].x, 3.5, 1e-12);
    EXPECT_NEAR(read.recording.truth[row].y, 2.5, 1e-12);
  }
}

std::string complaint(const std::string& text) {
  const ScratchFolder scratch;
  scratch.write("log.txt", text);
  try {
    static_cast<void>(read_encoder_log(scratch.path() / "log.txt"));
  } catch (const InputError& error) {
    return std::string(error.what()).substr(scratch.path().string().size() + 1);
  }
  return "none";
}

TEST(EncoderLog, SaysWhatIsWrong) {
  EXPECT_EQ(complaint(kHeader), "log.txt: has fewer than 11 samples, expected a drive");
  EXPECT_EQ(complaint(kHeader + sample(0.0, 1, 1) + sample(0.0, 1, 1)),
            "log.txt:10: time runs backwards, expected samples in order of time");
  EXPECT_EQ(complaint(kHeader + "time: 3 ticks: 1 model_pose: 0 0 0 tracker_pose: 0 0 0\n"),
            "log.txt:9: ticks: has 1 numbers, expected 2");
  EXPECT_EQ(complaint(kHeader + sample(0.0, 9000, 1)),
            "log.txt:9: the steering's count exceeds its turn, expected less than 8192");
  EXPECT_EQ(complaint(kHeader + "time: 3 ticks: 1 -4 model_pose: 0 0 0 tracker_pose: 0 0 0\n"),
            "log.txt:9: a count is no unsigned number of 32 bits, expected one");
  EXPECT_EQ(complaint("#kinematic_model: bicycle\n"),
            "log.txt:1: the kinematic model is another one, expected traction_drive_wheel");
  EXPECT_EQ(
      complaint(sample(0.0, 1, 1)),
      "log.txt:1: a sample before #parameter_values and #joints_max_enc_values, expected these");
}

/// Against least squares of another program on the same log (motions over 25 samples, all equally
/// weighted): gain 5.64 +- 0.10, offset -0.057 +- 0.018 rad, length 1.55 +- 0.05 m, travel
/// 1.011 +- 0.017 of what is stated, sensor at (1.806 +- 0.034, -0.027 +- 0.030) m.
TEST(EncoderLogData, TheGuessesOffByFactorsAreCalibrated) {
  const std::string below = "data/tricycle-calibration/dataset.txt.xz";
  TRUSSMAP_NEEDS_SHARED(below);
  const Dataset read = read_encoder_log(testing::shared(below));
  const DrivenRecording recording = with_wheels(read.recording, read.model.robot);
  const WheelCalibration found = calibrate_wheels({recording}, read.model);
  EXPECT_TRUE(found.settled);
  std::map<Channel, double> g;
  for (const DriveConstant& one : found.constants) g[one.channel] = one.g.value;
  EXPECT_NEAR(1.0 + g[Channel::steer_gain], 5.64, 0.2);
  EXPECT_NEAR(g[Channel::steer], -0.057, 0.036);
  EXPECT_NEAR(1.4 / (1.0 + g[Channel::turn]), 1.55, 0.1);
  EXPECT_NEAR(1.0 + g[Channel::wheels], 1.011, 0.034);
  EXPECT_NEAR(1.5 + found.truth.ahead, 1.806, 0.068);
  EXPECT_NEAR(found.truth.left, -0.027, 0.06);
}

}  // namespace
}  // namespace trussmap::encoder_log_test
