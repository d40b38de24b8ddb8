// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Turns of the gyro against the wheels', in stretches in which these have turned by a third of a
// radian.
#include "check/findings.hpp"
#include "geometry/units.hpp"
#include "text/number_text.hpp"

#include <cmath>

namespace trussmap::check {
namespace {

constexpr double kGyroStretch = 0.3;  // rad, by the wheels
constexpr int kFewestStretches = 12;  // stretches
constexpr double kClearGyro = 0.8;    // correlation
constexpr double kFar = 3.0;          // factor beside degrees per radian

}  // namespace

TurnAgreement check_gyro(Checked& checked) {
  const MotionRows& drive = checked.recording.drive;
  TurnAgreement result;
  if (!drive.has_gyro() || checked.wrong.contains("left")) return result;
  double ww = 0.0;
  double wg = 0.0;
  double gg = 0.0;
  double wheels = 0.0;
  double gyro = 0.0;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    if (std::isnan(drive.yaw_rate[row])) continue;
    wheels += drive.turn[row];
    gyro += drive.yaw_rate[row] * drive.duration(row);
    if (std::abs(wheels) < kGyroStretch) continue;
    ww += wheels * wheels;
    wg += wheels * gyro;
    gg += gyro * gyro;
    ++result.turns;
    wheels = gyro = 0.0;
  }
  if (result.turns < kFewestStretches || !(gg > 0.0)) return result;
  result.correlation = wg / std::sqrt(ww * gg);
  result.slope = wg / ww;
  if (std::abs(result.correlation) < kClearGyro) return result;
  result.sign = result.correlation > 0.0 ? 1 : -1;
  const double times = std::sqrt(gg / ww);
  if (checked.wheelbase_known && std::abs(std::log(times / geometry::kDegrees)) < std::log(kFar)) {
    checked.add("drive.csv", "yaw_rate", "angle unit",
                text::joined("the gyro turns ", figure(times), " times as far as the wheels"),
                "convert the yaw rates to rad/s");
  }
  return result;
}

}  // namespace trussmap::check
