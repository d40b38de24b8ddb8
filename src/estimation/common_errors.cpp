// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/common_errors.hpp"

#include "effects/simple_shapes.hpp"
#include "geometry/units.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace trussmap::estimation {
namespace {

constexpr double kTurnPerTime = 0.01;  // rad/s: a drift's and a gyro bias's weak prior

/// The heading that a reading shows, with a sin + b cos of hard iron in it.
double heading_under(double reading, double a, double b) {
  constexpr int kRounds = 4;
  double heading = reading;
  for (int round = 0; round < kRounds; ++round) {
    heading = reading - a * std::sin(heading) - b * std::cos(heading);
  }
  return heading;
}

/// One column each for sine and cosine.
std::vector<EffectPattern> hard_iron(const std::vector<DrivenRecording>& recordings, double a,
                                     double b) {
  std::vector<EffectPattern> result(2);
  for (EffectPattern& one : result) one.name = "hard iron";
  for (const DrivenRecording& recording : recordings) {
    const MotionRows& drive = recording.drive;
    std::vector<effects::DrivePattern> sine(drive.rows());
    std::vector<effects::DrivePattern> cosine(drive.rows());
    for (std::size_t row = 0; row < drive.heading.size(); ++row) {
      if (!std::isfinite(drive.heading[row])) continue;
      const double heading = heading_under(drive.heading[row], a, b);
      sine[row].compass = std::sin(heading);
      cosine[row].compass = std::cos(heading);
    }
    result[0].drives.push_back(std::move(sine));
    result[1].drives.push_back(std::move(cosine));
  }
  return result;
}

/// Whether some row lasts so long (its clock was set, or the robot stood for the night) that a turn
/// per time may have gone round in it: its column is no straight line then.
bool may_go_round_in_a_row(const DrivenRecording& recording) {
  const MotionRows& drive = recording.drive;
  const double most = 0.5 * geometry::kFullTurn / kTurnPerTime;
  for (std::size_t row = 1; row < drive.rows(); ++row) {
    if (drive.t[row] - drive.t[row - 1] > most) return true;
  }
  return false;
}

}  // namespace

std::vector<Effect> common_errors(const std::vector<DrivenRecording>& recordings) {
  // The catalogue's names and shapes, written out: who only builds maps does without it.
  std::vector<Effect> result{
      {"wheel diameter ratio", Channel::difference, {effects::constant_shape()}, {0.0}},
      {"wheelbase", Channel::turn, {effects::constant_shape()}, {0.0}}};
  const bool lasting = std::any_of(recordings.begin(), recordings.end(), may_go_round_in_a_row);
  if (!lasting)
    result.push_back({"heading drift", Channel::drift, {effects::constant_shape()}, {0.0}});
  const bool compass =
      std::any_of(recordings.begin(), recordings.end(),
                  [](const DrivenRecording& recording) { return recording.drive.has_compass(); });
  const bool gyro =
      std::any_of(recordings.begin(), recordings.end(),
                  [](const DrivenRecording& recording) { return recording.drive.has_gyro(); });
  if (gyro && !lasting)
    result.push_back({"gyro bias", Channel::gyro, {effects::constant_shape()}, {0.0}});
  if (compass) {
    result.push_back({"hard iron",
                      Channel::compass,
                      {effects::sine_of("heading"), effects::cosine_of("heading")},
                      {0.0, 0.0}});
  }
  return result;
}

double common_error_sd(const Effect& effect) {
  constexpr std::pair<Channel, double> kSds[] = {{Channel::difference, 0.01},
                                                 {Channel::turn, 0.05},
                                                 {Channel::drift, kTurnPerTime},
                                                 {Channel::gyro, kTurnPerTime},
                                                 {Channel::compass, 0.2}};
  for (const auto& [channel, sd] : kSds) {
    if (channel == effect.channel) return sd;
  }
  throw std::invalid_argument(effect.name + " is no common error");
}

EffectParameters common_error_columns(const std::vector<DrivenRecording>& recordings,
                                      const Robot& robot, const Eigen::VectorXd& coefficients) {
  EffectParameters border;
  for (const Effect& effect : common_errors(recordings)) {
    const double sd = common_error_sd(effect);
    if (effect.channel == Channel::compass) {
      const auto at = static_cast<Eigen::Index>(border.size());
      const bool known = coefficients.size() > at + 1;
      for (EffectPattern& one : hard_iron(recordings, known ? coefficients[at] : 0.0,
                                          known ? coefficients[at + 1] : 0.0)) {
        border.push_back(std::move(one));
        border.back().prior_sd = sd;
      }
    } else {
      border.push_back(plain_effect(effect.channel, recordings, robot));
      border.back().prior_sd = sd;
    }
  }
  return border;
}

}  // namespace trussmap::estimation
