// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// Channels: where an effect acts. With g = sum of coefficient x shape, a row's motion becomes
//
//   travel            ds (1 + g)                      left, right, wheels   that wheel's (1 + g)
//   difference        left (1 - g/2), right (1 + g/2) turn                  dtheta (1 + g)
//   drift             dtheta + g dt                   advance, rotate       ds + g; dtheta + g
//   creep             slips to its left by g ds       lever, lever_left     sensor's point on the
//   compass           reading = heading + g                                 robot
//   range, bearing    reading + g                     range_scale           range (1 + g)
//   delay             stamped g late                          truth_heading   truth's heading + g
//   gyro              yaw rate read = rate + g     gyro_scale             gyro's turn (1 + g)
//   antenna, antenna_left   the point of the robot that a fix has
//   scanner, scanner_left, scanner_yaw   where what loops are of sits on the robot, and looks
//   sideways          travel to the left (1 + g)   wheel1 ... wheel6     that wheel's (1 + g)
//   steer             steering angle + g           steer_gain            steering angle (1 + g)
//   wheel_left        the wheel whose travel is read stands g further left than stated
//   steer_left        the wheel whose steering angle is read does
//   other_axle        travel is by a share g that of the steered wheel instead of the rear one, or
//                     the other way round
//   fix_delay         fixes are stamped g late                fix_x, fix_y    fix = position + g
//
// In code a channel is this enumeration; its name stands in files, options and reports alone.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap {

enum class Channel {
  travel,
  left,
  right,
  wheels,
  difference,
  turn,
  drift,
  advance,
  rotate,
  creep,
  gyro,
  gyro_scale,
  lever,
  lever_left,
  compass,
  range,
  range_scale,
  bearing,
  delay,
  truth_heading,
  antenna,
  antenna_left,
  fix_delay,
  fix_x,
  fix_y,
  sideways,
  wheel1,
  wheel2,
  wheel3,
  wheel4,
  wheel5,
  wheel6,
  steer,
  steer_gain,
  sighting_yaw,
  scanner,
  scanner_left,
  scanner_yaw,
  wheel_left,
  steer_left,
  other_axle
};

/// wheel1 is 0, wheel6 is 5; nothing of other channels.
[[nodiscard]] std::optional<std::size_t> wheel_of(Channel channel);

struct ChannelFacts {
  Channel channel;
  std::string_view name;
  std::string_view unit;       ///< of g; "" = none
  double prior_sd;             ///< sd of a weak prior on the largest |g| of a recording, same unit
  std::string_view does_what;  ///< in words
};

/// All of them, in the order above.
[[nodiscard]] const std::vector<ChannelFacts>& channels();
[[nodiscard]] const ChannelFacts& facts_of(Channel channel);
[[nodiscard]] std::string_view name_of(Channel channel);
[[nodiscard]] std::optional<Channel> parse_channel(std::string_view name);

/// The same; throws std::invalid_argument, listing all names, where there is none of this name.
[[nodiscard]] Channel channel_named(std::string_view name);

/// Their names, separated by commas.
[[nodiscard]] std::string channel_names();

}  // namespace trussmap
