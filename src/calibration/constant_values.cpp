// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/constant_values.hpp"

#include "calibration/sought_constants.hpp"
#include "effects/channel_physics.hpp"

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace trussmap::calibration {
namespace {

Channel nth_wheel(std::size_t k) {
  return static_cast<Channel>(static_cast<std::size_t>(Channel::wheel1) + k);
}

/// Its own error, beside what all wheels have.
struct OwnGain {
  std::string name;
  std::vector<Channel> of;
  double g = 0.0;
};

std::vector<OwnGain> own_gains(const Robot& robot, const ChannelGains& gains) {
  using enum Channel;
  const auto g = [&gains](Channel channel) { return gain_of(gains, channel); };
  if (robot.drive == DriveKind::differential) {
    return {{"left wheel", {left, difference}, g(left) - 0.5 * g(difference)},
            {"right wheel", {right, difference}, g(right) + 0.5 * g(difference)}};
  }
  if (robot.drive == DriveKind::tricycle || robot.drive == DriveKind::ackermann) {
    return {{"wheel", {}, 0.0}};
  }
  if (robot.drive == DriveKind::unicycle) return {{"travel", {}, 0.0}};
  std::vector<OwnGain> result;
  for (std::size_t k = 0; k < robot.columns.size(); ++k) {
    const Channel channel = nth_wheel(k);
    if (effects::is_of_drive(channel, robot))
      result.push_back({robot.columns[k], {channel}, g(channel)});
  }
  return result;
}

double mean_own(const std::vector<OwnGain>& wheels) {
  if (wheels.empty()) return 0.0;
  double sum = 0.0;
  for (const OwnGain& one : wheels) sum += one.g;
  return sum / static_cast<double>(wheels.size());
}

void add_wheels(const Robot& robot, const ChannelGains& gains, const DriveScales& scales,
                std::vector<ConstantValue>& result) {
  const std::vector<OwnGain> all = own_gains(robot, gains);
  const double mean = mean_own(all);
  for (const OwnGain& one : all) {
    std::vector<Channel> of = one.of;
    of.insert(of.end(), {Channel::wheels, Channel::travel});
    result.push_back({one.name, "times", scales.wheels + scales.length * (one.g - mean),
                      ConstantKind::wheel, std::move(of), "its radius, or travel per tick"});
  }
}

void add_lengths(const Robot& robot, const DriveScales& scales,
                 std::vector<ConstantValue>& result) {
  const std::vector<Channel> turns{Channel::turn, Channel::travel};
  const auto add = [&](const char* name, double length, const char* note) {
    result.push_back({name, "m", scales.length * length, ConstantKind::length, turns, note});
  };
  switch (robot.drive) {
    case DriveKind::differential:
      return add("wheelbase", robot.wheelbase, "");
    case DriveKind::unicycle:
      result.push_back({"turn",
                        "times",
                        scales.wheels / scales.length,
                        ConstantKind::length,
                        {Channel::turn},
                        "what it says of its turns"});
      return;
    case DriveKind::skid_steer:
      return add("wheelbase", robot.wheelbase, "the effective one");
    case DriveKind::tricycle:
    case DriveKind::ackermann:
      return add("length", robot.length, "rear axle to steered wheel");
    case DriveKind::omni3:
      return add("radius", robot.length, "centre to wheel");
    case DriveKind::mecanum:
      add("wheelbase", robot.wheelbase, "with the length: their sum alone shows");
      return add("length", robot.length, "with the wheelbase");
    case DriveKind::wheels: {
      // A column of a robot's own may have the name.
      const bool taken = std::ranges::count(robot.columns, "turn") > 0;
      result.push_back({taken ? "turning" : "turn", "times", 1.0 / scales.length,
                        ConstantKind::length, turns, "the matrix's third row, after the wheels'"});
    }
  }
}

/// What the turn is multiplied by of a robot that says it (says_its_turns).
double turn_factor(const Robot& robot, const ChannelGains& gains, const DriveScales& scales) {
  double factor = scales.wheels / scales.length;
  if (robot.drive != DriveKind::wheels) return factor;
  const std::vector<OwnGain> own = own_gains(robot, gains);
  for (std::size_t k = 0; k < own.size(); ++k) {
    if (turns_alone(robot, k)) factor += own[k].g - mean_own(own);
  }
  return factor;
}

/// What is no matter of wheels.
void add_sensors(const Robot& robot, const ChannelGains& gains, const DriveScales& scales,
                 std::vector<ConstantValue>& result) {
  using enum Channel;
  const auto g = [&gains](Channel channel) { return gain_of(gains, channel); };
  const auto add = [&](const char* name, const char* unit, double value, Channel channel,
                       const char* note) {
    if (!effects::is_of_drive(channel, robot)) return;
    result.push_back({name, unit, value, ConstantKind::other, {channel}, note});
  };
  add("sideways", "times", scales.sideways, sideways, "the way to the side, after the wheels'");
  if (!result.empty() && result.back().name == "sideways") result.back().of.push_back(travel);
  add("steering offset", "rad", g(steer), steer, "add it to the angle, after the gain");
  add("steering gain", "times", 1.0 + g(steer_gain), steer_gain, "the angle");
  add("measured wheel left", "m", scales.length * (robot.wheel_left + g(wheel_left)), wheel_left,
      "of the rear axle's centre: the travel is that of this wheel");
  add("steered wheel left", "m", scales.length * (robot.steer_left + g(steer_left)), steer_left,
      "of the middle: the angle is that of this wheel");
  add("other axle", "times", g(other_axle) / scales.wheels, other_axle,
      robot.drive == DriveKind::tricycle
          ? "1: the travel is the rear axle's (drive ackermann), 0: the steered wheel's"
          : "1: the travel is the steered wheel's (drive tricycle), 0: the rear axle's");
  if (says_its_turns(robot)) {
    add("turn bias", "rad/s", 0.0 - g(drift) / turn_factor(robot, gains, scales), drift,
        "subtract it from the turn rate, before the factor");
  }
  add("gyro scale", "times", 1.0 + g(gyro_scale), gyro_scale, "the rate, after the bias");
  add("gyro bias", "rad/s", g(gyro) / (1.0 + g(gyro_scale)), gyro, "subtract it");
  constexpr const char* kOfAxle = "of the axle's centre";
  const auto [at, receiver, scans] = std::tuple(robot.mounted.sensor.value_or(Mounting()),
                                                robot.mounted.antenna.value_or(Mounting()),
                                                robot.mounted.scanner.value_or(Mounting()));
  add("antenna ahead", "m", receiver.x + g(antenna), antenna, kOfAxle);
  add("antenna left", "m", receiver.y + g(antenna_left), antenna_left, kOfAxle);
  add("fix delay", "s", g(fix_delay), fix_delay, "subtract it from the stamps");
  add("sensor ahead", "m", at.x + g(lever), lever, kOfAxle);
  add("sensor left", "m", at.y + g(lever_left), lever_left, kOfAxle);
  add("scanner ahead", "m", scans.x + g(scanner), scanner, kOfAxle);
  add("scanner left", "m", scans.y + g(scanner_left), scanner_left, kOfAxle);
  add("scanner yaw", "rad", scans.yaw + g(scanner_yaw), scanner_yaw, "to the left of ahead");
  add("sighting delay", "s", g(delay), delay, "subtract it from the stamps");
  add("range offset", "m", g(range), range, "subtract it");
  add("range scale", "times", 1.0 / (1.0 + g(range_scale)), range_scale,
      "the range, after the offset");
  add("bearing offset", "rad", g(bearing), bearing, "subtract it");
  add("yaw offset", "rad", g(sighting_yaw), sighting_yaw, "subtract it");
  add("compass offset", "rad", g(compass), compass, "subtract it");
}

}  // namespace

double gain_of(const ChannelGains& gains, Channel channel) {
  const auto found = gains.find(channel);
  return found == gains.end() ? 0.0 : found->second;
}

DriveScales drive_scales(const Robot& robot, const ChannelGains& gains) {
  const double all = 1.0 + gain_of(gains, Channel::wheels) + mean_own(own_gains(robot, gains));
  const double ahead = all + gain_of(gains, Channel::travel);
  const double turned = all + gain_of(gains, Channel::turn);
  const double aside = all + gain_of(gains, Channel::sideways);
  if (!(ahead > 0.0) || !(turned > 0.0) || !(aside > 0.0)) return {kAbsent, kAbsent, kAbsent};
  return {ahead / turned, ahead, aside / ahead};
}

std::vector<ConstantValue> constant_values(const Robot& robot, const ChannelGains& gains) {
  const DriveScales scales = drive_scales(robot, gains);
  std::vector<ConstantValue> result;
  add_wheels(robot, gains, scales, result);
  add_lengths(robot, scales, result);
  add_sensors(robot, gains, scales, result);
  return result;
}

ChannelGains side_by_side(const Robot& robot, const ChannelGains& in_turn) {
  ChannelGains result = in_turn;
  const double mean = mean_own(own_gains(robot, in_turn));
  const double all = 1.0 + gain_of(in_turn, Channel::wheels) + mean;
  const double turned = 1.0 + gain_of(in_turn, Channel::turn);
  // So that sizes come out as (1 + g_wheels) (1 -+ g/2), or as 1 + g_k, to the last digit.
  for (auto& [channel, g] : result) {
    if (channel == Channel::turn || channel == Channel::sideways) g *= all;
    if (channel == Channel::difference) g *= all * turned;
    if (wheel_of(channel)) g = mean + turned * (g - mean);
  }
  return result;
}

}  // namespace trussmap::calibration
