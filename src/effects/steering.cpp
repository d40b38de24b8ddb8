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

namespace trussmap::effects {
namespace {

/// Per row; `names` of the effects.
std::vector<drive::SteeringChange> changes_of(const MotionRows& drive,
                                              const std::vector<Effect>& effects,
                                              const RowVariables& variables, int session,
                                              std::string& names) {
  const std::vector<double>& angle = drive.wheels[1].reading;
  std::vector<drive::SteeringChange> more(drive.rows());
  for (const Effect& effect : effects) {
    if (!is_steering(effect.channel)) continue;
    names += (names.empty() ? "effect \"" : "\", \"") + effect.name;
    try {
      const std::vector<double> g = gains_of(effect, variables, session, drive.rows());
      for (std::size_t row = 0; row < more.size(); ++row) {
        add_steering(effect.channel, g[row], angle[row], more[row]);
      }
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("effect \"" + effect.name + "\": " + error.what());
    }
  }
  return more;
}

bool has_steered_wheel(const MotionRows& drive) {
  return drive.wheels.size() == 2 && drive.wheels[1].steers;
}

}  // namespace

bool is_steering(Channel channel) {
  return channel == Channel::steer || channel == Channel::steer_gain || is_wheels_place(channel);
}

bool is_wheels_place(Channel channel) {
  return channel == Channel::wheel_left || channel == Channel::steer_left;
}

bool is_of_steered_drive(Channel channel) {
  return is_steering(channel) || channel == Channel::other_axle;
}

void add_steering(Channel channel, double g, double angle, drive::SteeringChange& change) {
  if (channel == Channel::steer) change.angle += g;
  if (channel == Channel::steer_gain) {
    change.angle += g * angle;
    change.gain += g;
  }
  if (channel == Channel::wheel_left) change.wheel_left += g;
  if (channel == Channel::steer_left) change.steer_left += g;
}

bool steers(const std::vector<Effect>& effects) {
  return std::any_of(effects.begin(), effects.end(),
                     [](const Effect& one) { return is_steering(one.channel); });
}

bool leave_a_way(const std::vector<Effect>& effects, const MotionRows& drive, const Robot& robot,
                 const RowVariables& variables, int session) {
  if (!steers(effects) || !has_steered_wheel(drive)) return true;
  std::string names;
  const std::vector<drive::SteeringChange> more =
      changes_of(drive, effects, variables, session, names);
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double travel = drive.wheels[0].reading[row];
    if (!drive::steered_motion(robot, travel, drive.wheels[1].reading[row], more[row]).possible) {
      return false;
    }
  }
  return true;
}

MotionRows steered(MotionRows drive, const Robot& robot, const std::vector<Effect>& effects,
                   const RowVariables& variables, int session) {
  if (!steers(effects) || !has_steered_wheel(drive)) return drive;
  if (!drive.gyro.empty() || !drive.steered.empty()) {
    throw std::logic_error("steering is taken in once, and before the gyro");
  }
  std::string names;
  const std::vector<drive::SteeringChange> more =
      changes_of(drive, effects, variables, session, names);
  drive.steered.reserve(drive.rows());
  drive.wheels[1].gain.resize(drive.rows());
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double travel = drive.wheels[0].reading[row];
    const double angle = drive.wheels[1].reading[row];
    const drive::SteeredMotion after = drive::steered_motion(robot, travel, angle, more[row]);
    if (!after.possible) {
      throw std::invalid_argument(text::joined(
          names,
          "\": leaves the measured wheel no way ahead at t = ", text::short_text(drive.t[row]),
          " s, with a steering angle of ", text::short_text(angle + more[row].angle),
          " rad, expected coefficients that leave it one"));
    }
    // What replicas and noise made of the row stays.
    const Eigen::Vector3d added = after.motion - drive::steered_motion(robot, travel, angle).motion;
    drive::add_motion(drive, row, {added[0], 0.0, added[2]}, robot);
    drive.steered.push_back({added[0], added[2]});
    drive.wheels[1].gain[row] = 1.0 + more[row].gain;
    for (std::size_t k = 0; k < 2; ++k) {
      const Eigen::Vector3d& by = after.by_reading[k];
      drive.wheels[k].by_reading[row] = {by[0], by[1], by[2]};
    }
  }
  return drive;
}

}  // namespace trussmap::effects
