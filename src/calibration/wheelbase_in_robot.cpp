// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A calibrated model for a file: lengths and places of wheels in [robot] (trussmap/calibrate.hpp).
//
// With w a travel, k the curvature by the angle alone, f = w/(1 - y k) and a turn (1 + g) f k are
// those of a robot whose length and whose wheels' places y, z to the left are 1 + g times less.
#include "calibration/constant_values.hpp"
#include "calibration/sought_constants.hpp"
#include "effects/steering.hpp"
#include "trussmap/calibrate.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace trussmap {
using namespace calibration;

namespace {

/// A constant that calibrations find, with a size.
bool is_found(const Effect& effect, const std::vector<SoughtConstant>& sought) {
  return effect.is_constant() && !effect.per_session && !effect.coefficients.empty() &&
         std::ranges::any_of(sought, [&effect](const SoughtConstant& one) {
           return one.name == effect.name && one.channel == effect.channel;
         });
}

/// Places of wheels to the left; whether all that are not in the middle were found: as turning is
/// scaled, so are they.
bool take_sides_in_robot(const std::vector<SoughtConstant>& sought, Model& model) {
  Robot& robot = model.robot;
  bool measured = robot.wheel_left == 0.0;
  bool steered = robot.steer_left == 0.0;
  std::erase_if(model.effects, [&](const Effect& one) {
    if (!effects::is_wheels_place(one.channel) || !is_found(one, sought)) return false;
    const bool travel = one.channel == Channel::wheel_left;
    (travel ? robot.wheel_left : robot.steer_left) += one.coefficients.front();
    (travel ? measured : steered) = true;
    return true;
  });
  return measured && steered;
}

}  // namespace

Model with_wheelbase_in_robot(Model model) {
  Robot& robot = model.robot;
  const std::vector<SoughtConstant> sought = sought_constants(robot);
  const bool sides = take_sides_in_robot(sought, model);
  const bool middle = robot.wheel_left == 0.0 && robot.steer_left == 0.0;
  const bool has_length = robot.drive != DriveKind::wheels && (sides || middle);
  std::vector<Effect*> found;
  ChannelGains in_turn;
  for (Effect& effect : model.effects) {
    if (!is_found(effect, sought)) continue;
    double& g = effect.coefficients.front();
    if (effect.channel == Channel::turn && has_length && 1.0 + g > 0.0 && g != 0.0) {
      robot.wheelbase /= 1.0 + g;
      robot.length /= 1.0 + g;
      robot.wheel_left /= 1.0 + g;
      robot.steer_left /= 1.0 + g;
      robot.wheelbase_stated = true;
      g = 0.0;
    }
    in_turn[effect.channel] = g;
    found.push_back(&effect);
  }
  const ChannelGains gains = side_by_side(robot, in_turn);
  for (Effect* one : found) one->coefficients = {gain_of(gains, one->channel)};
  return model;
}

}  // namespace trussmap
