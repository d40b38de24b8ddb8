// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/sought_constants.hpp"

#include "effects/channel_physics.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::calibration {
namespace {

constexpr double kUseless = 0.1;  // a standard error of a ratio that is no calibration

constexpr double kUselessDrift = 0.01;  // rad/s

/// The same of a steering's gain. Small angles tell it from the wheelbase so badly that both get
/// worse.
constexpr double kUselessGain = 0.03;

double joined_factors(double g, double more) {
  return (1.0 + g) * (1.0 + more) - 1.0;
}

SoughtConstant turn_constant() {
  constexpr const char* kMissing = "the robot hardly turns; drive turns, both ways";
  return {.name = "wheelbase",
          .channel = Channel::turn,
          .symbol = "E_b (wheelbase / nominal)",
          .missing = kMissing,
          .missing_without_distance = kMissing,
          .ratio = [](double g) { return 1.0 / (1.0 + g); },
          .joined = joined_factors};
}

/// Of a robot that says how far it has turned: what it says has a factor, and a bias.
SoughtConstant told_turn_constant() {
  SoughtConstant result = turn_constant();
  result.symbol = "the scale of its turns";
  result.ratio = [](double g) { return 1.0 + g; };
  return result;
}

SoughtConstant drift_constant() {
  constexpr const char* kMissing = "the drive is too short to show it";
  return {.name = "heading drift",
          .channel = Channel::drift,
          .symbol = "the bias of its turn rate",
          .missing = kMissing,
          .missing_without_distance = kMissing,
          .ratio = [](double) { return 1.0; }};
}

SoughtConstant scale_constant() {
  return {.name = "wheel scale",
          .channel = Channel::wheels,
          .symbol = "E_s (true / measured travel)",
          .missing =
              "the robot hardly gets anywhere, and turns on the spot cannot tell larger "
              "wheels from a smaller wheelbase; drive straight lines",
          .joined = joined_factors};
}

/// Of such a robot the scale of its way alone.
SoughtConstant travel_constant() {
  SoughtConstant result = scale_constant();
  result.name = "travel scale";
  result.channel = Channel::travel;
  result.missing = "the robot hardly gets anywhere; drive straight lines";
  return result;
}

SoughtConstant diameters_constant() {
  constexpr const char* kMissing =
      "the drive is too short to show one wheel larger than the other; drive straight lines of "
      "several metres";
  return {.name = "wheel diameter ratio",
          .channel = Channel::difference,
          .symbol = "E_d (right wheel / left wheel)",
          .missing = kMissing,
          .missing_without_distance = kMissing,
          .ratio = [](double g) { return (1.0 + 0.5 * g) / (1.0 - 0.5 * g); },
          // (1 - g/2), (1 + g/2) multiply to another ratio, and a scale of second order.
          .joined = [](double g, double more) { return (g + more) / (1.0 + 0.25 * g * more); }};
}

SoughtConstant steering_offset_constant() {
  constexpr const char* kMissing =
      "the drive is too short to show where straight ahead is; drive straight lines of several "
      "metres";
  return {.name = "steering offset",
          .channel = Channel::steer,
          .symbol = "the steering's offset",
          .missing = kMissing,
          .missing_without_distance = kMissing,
          .ratio = [](double g) { return std::cos(g); }};
}

SoughtConstant steering_gain_constant() {
  constexpr const char* kMissing =
      "the steering angles are too small, or too much alike, to tell it from the wheelbase; steer "
      "far, and little, both ways";
  return {.name = "steering gain",
          .channel = Channel::steer_gain,
          .symbol = "the steering's gain",
          .missing = kMissing,
          .missing_without_distance = kMissing};
}

/// Of wheels that are not those that the model says; none is a factor.
SoughtConstant place_constant(const char* name, Channel channel, const char* symbol) {
  constexpr const char* kMissing =
      "the robot bends too little, or to one side alone; drive sharp bends, both ways";
  return {.name = name,
          .channel = channel,
          .symbol = symbol,
          .missing = kMissing,
          .missing_without_distance = kMissing,
          .seldom = true,
          .ratio = [](double) { return 1.0; }};
}

SoughtConstant measured_place_constant() {
  return place_constant("travel read beside the middle", Channel::wheel_left,
                        "the measured wheel's place to the left");
}

SoughtConstant steered_place_constant() {
  return place_constant("angle read beside the middle", Channel::steer_left,
                        "the steered wheel's place to the left");
}

SoughtConstant other_axle_constant() {
  return place_constant("travel read at the other axle", Channel::other_axle,
                        "the other axle's share of the travel");
}

}  // namespace

bool turns_alone(const Robot& robot, std::size_t column) {
  const auto at = static_cast<Eigen::Index>(column);
  return robot.matrix(0, at) == 0.0 && robot.matrix(1, at) == 0.0 && robot.matrix(2, at) != 0.0;
}

bool says_its_turns(const Robot& robot) {
  if (robot.drive == DriveKind::unicycle) return robot.columns.size() > 1;
  if (robot.drive != DriveKind::wheels) return false;
  int turning = 0;
  int alone = 0;
  for (std::size_t k = 0; k < robot.columns.size(); ++k) {
    turning += robot.matrix(2, static_cast<Eigen::Index>(k)) != 0.0 ? 1 : 0;
    alone += turns_alone(robot, k) ? 1 : 0;
  }
  return turning == 1 && alone == 1;
}

double SoughtConstant::slope(double g) const {
  constexpr double kStep = 1e-6;
  return (joined(g, kStep) - joined(g, -kStep)) / (2.0 * kStep);
}

std::vector<SoughtConstant> sought_constants(const Robot& robot) {
  switch (robot.drive) {
    case DriveKind::differential:
      return {diameters_constant(), turn_constant(), scale_constant()};
    case DriveKind::unicycle:
      if (!says_its_turns(robot)) return {told_turn_constant(), travel_constant()};
      return {told_turn_constant(), travel_constant(), drift_constant()};
    case DriveKind::tricycle:
      return {steering_offset_constant(), turn_constant(),          scale_constant(),
              steering_gain_constant(),   steered_place_constant(), other_axle_constant()};
    case DriveKind::ackermann:
      return {steering_offset_constant(), turn_constant(),           scale_constant(),
              steering_gain_constant(),   measured_place_constant(), steered_place_constant(),
              other_axle_constant()};
    default:
      break;
  }
  std::vector<SoughtConstant> result;
  for (const ChannelFacts& one : channels()) {
    const std::optional<std::size_t> wheel = wheel_of(one.channel);
    if (!wheel || !effects::is_of_drive(one.channel, robot)) continue;
    if (says_its_turns(robot) && turns_alone(robot, *wheel)) continue;
    const std::string& column = robot.columns[*wheel];
    result.push_back({.name = "radius of " + column,
                      .channel = one.channel,
                      .symbol = "the radius of " + column});
  }
  if (says_its_turns(robot)) {
    result.push_back(told_turn_constant());
    result.push_back(drift_constant());
  } else {
    result.push_back(turn_constant());
  }
  // With these the wheels may roll in other directions than stated, too, to first order: together
  // with the place and the heading of the truth's point all nine numbers from three wheels'
  // travels, or from as many as four can show, to (f, s, a).
  if (robot.drive == DriveKind::omni3 || robot.drive == DriveKind::mecanum) {
    result.push_back({.name = "sideways scale",
                      .channel = Channel::sideways,
                      .symbol = "the scale of what goes sideways",
                      .joined = joined_factors});
  }
  if (robot.drive == DriveKind::omni3) {
    result.push_back({.name = "creep",
                      .channel = Channel::creep,
                      .symbol = "the slip to the left per travel ahead"});
  }
  return result;
}

bool shows_scale(Channel channel) {
  return channel == Channel::wheels || channel == Channel::travel || channel == Channel::wheel1;
}

std::vector<Channel> seldom_constants(const Robot& robot) {
  std::vector<Channel> result;
  for (const SoughtConstant& one : sought_constants(robot)) {
    if (one.seldom) result.push_back(one.channel);
  }
  return result;
}

double useless_sd(const SoughtConstant& one, const Model& model) {
  constexpr double kUselessShare = 0.25;
  if (one.channel == Channel::other_axle) return kUselessShare;
  if (one.seldom) return kUseless * model.robot.length;
  if (one.channel == Channel::drift) return kUselessDrift;
  if (one.channel != Channel::steer_gain) return kUseless;
  for (const Effect& effect : model.effects) {
    if (effect.name == one.name) return kUselessGain * std::abs(1.0 + effect.coefficients[0]);
  }
  return kUselessGain;
}

std::optional<std::size_t> place_of_gain(const Robot& robot) {
  const std::vector<SoughtConstant> constants = sought_constants(robot);
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if (constants[k].channel == Channel::steer_gain) return k;
  }
  return std::nullopt;
}

std::vector<double> in_force(const Model& model) {
  std::vector<double> g;
  for (const SoughtConstant& one : sought_constants(model.robot)) {
    g.push_back(0.0);
    for (const Effect& effect : model.effects) {
      if (effect.name == one.name && !effect.coefficients.empty()) {
        g.back() = effect.coefficients[0];
      }
    }
  }
  return g;
}

Model with_constants(const Model& model, const std::vector<double>& g) {
  const std::vector<SoughtConstant> constants = sought_constants(model.robot);
  Model result = model;
  std::erase_if(result.effects, [&constants](const Effect& effect) {
    return std::any_of(constants.begin(), constants.end(),
                       [&effect](const SoughtConstant& one) { return one.name == effect.name; });
  });
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if (constants[k].seldom && g[k] == 0.0) continue;
    result.effects.push_back({constants[k].name, constants[k].channel, {"1"}, {g[k]}, false});
  }
  return result;
}

double share_before_turning(const std::vector<SoughtConstant>& constants,
                            const std::vector<double>& g, std::size_t which) {
  constexpr double kLeastTurn = 0.1;  // of what is stated: else it turns the wrong way round
  if (constants[which].channel != Channel::difference) return 1.0;
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if (constants[k].channel != Channel::turn) continue;
    return g[k] > kLeastTurn - 1.0 ? 1.0 / (1.0 + g[k]) : 1.0;
  }
  return 1.0;
}

std::vector<double> refined(const std::vector<double>& g, const Wanted& wanted, const Robot& robot,
                            const Eigen::VectorXd& found) {
  const std::vector<SoughtConstant> constants = sought_constants(robot);
  std::vector<double> result = g;
  Eigen::Index at = 0;
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if (!wanted[k]) continue;
    const double more = share_before_turning(constants, g, k) * found[at++];
    result[k] = constants[k].joined(g[k], more);
  }
  return result;
}

}  // namespace trussmap::calibration
