// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/steering.hpp"

#include "drive/body_motion.hpp"
#include "drive/steered_motion.hpp"
#include "effects/corrected_recording.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace trussmap {
namespace {

/// Per row, what is added to the angle; `names` of the effects.
std::vector<double> added_angles(const MotionRows& drive, const std::vector<Effect>& effects,
                                 const RowVariables& variables, int session, std::string& names) {
  const std::vector<double>& angle = drive.wheels[1].reading;
  std::vector<double> more(drive.rows(), 0.0);
  for (const Effect& effect : effects) {
    if (!is_steering(effect.channel)) continue;
    names += (names.empty() ? "effect \"" : "\", \"") + effect.name;
    try {
      const std::vector<double> g = gains_of(effect, variables, session, drive.rows());
      for (std::size_t row = 0; row < more.size(); ++row) {
        more[row] += effect.channel == Channel::steer ? g[row] : g[row] * angle[row];
      }
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("effect \"" + effect.name + "\": " + error.what());
    }
  }
  return more;
}

}  // namespace

bool is_steering(Channel channel) {
  return channel == Channel::steer || channel == Channel::steer_gain;
}

bool steers(const std::vector<Effect>& effects) {
  return std::any_of(effects.begin(), effects.end(),
                     [](const Effect& one) { return is_steering(one.channel); });
}

MotionRows steered(MotionRows drive, const Robot& robot, const std::vector<Effect>& effects,
                   const RowVariables& variables, int session) {
  if (!steers(effects) || drive.wheels.size() != 2 || !drive.wheels[1].steers) return drive;
  if (!drive.gyro.empty() || !drive.steered.empty()) {
    throw std::logic_error("steering is taken in once, and before the gyro");
  }
  std::string names;
  const std::vector<double> more = added_angles(drive, effects, variables, session, names);
  drive.steered.reserve(drive.rows());
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double travel = drive.wheels[0].reading[row];
    const double angle = drive.wheels[1].reading[row];
    const SteeredMotion after = steered_motion(robot, travel, angle + more[row]);
    if (!after.possible) {
      throw std::invalid_argument(joined(
          names, "\": leaves the measured wheel no way ahead at t = ", short_text(drive.t[row]),
          " s, with a steering angle of ", short_text(angle + more[row]), " rad"));
    }
    // What replicas and noise made of the row stays.
    const Eigen::Vector3d added = after.motion - steered_motion(robot, travel, angle).motion;
    add_travel(drive, row, wheel_travel({added[0], 0.0, added[2]}, robot));
    drive.steered.push_back({added[0], added[2]});
    for (std::size_t k = 0; k < 2; ++k) {
      const Eigen::Vector3d& by = after.by_reading[k];
      drive.wheels[k].by_reading[row] = {by[0], by[1], by[2]};
    }
  }
  return drive;
}

}  // namespace trussmap
