// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/channel.hpp"

#include <algorithm>
#include <stdexcept>

namespace trussmap {

const std::vector<ChannelFacts>& channels() {
  using enum Channel;
  static const std::vector<ChannelFacts> all{
      {travel, "travel", "", 0.1, "forward travel"},
      {left, "left", "", 0.1, "travel of the left wheel"},
      {right, "right", "", 0.1, "travel of the right wheel"},
      {wheels, "wheels", "", 0.1, "travel of both wheels"},
      {difference, "difference", "", 0.1, "right wheel's travel over left's"},
      {turn, "turn", "", 0.1, "rotation"},
      {drift, "drift", "rad/s", 0.01, "rotation with time"},
      {advance, "advance", "m", 0.02, "travel per event"},
      {rotate, "rotate", "rad", 0.05, "rotation per event"},
      {creep, "creep", "", 0.1, "slip to the left, per travel"},
      {gyro, "gyro", "rad/s", 0.1, "yaw rate that the gyro reads"},
      {gyro_scale, "gyro_scale", "", 0.1, "turn that the gyro reads, in proportion"},
      {lever, "lever", "m", 0.3, "sensor's place ahead of the axle"},
      {lever_left, "lever_left", "m", 0.3, "sensor's place to the axle's left"},
      {compass, "compass", "rad", 0.5, "compass reading"},
      {range, "range", "m", 0.3, "range reading"},
      {range_scale, "range_scale", "", 0.1, "range reading, in proportion"},
      {bearing, "bearing", "rad", 0.5, "bearing reading"},
      {delay, "delay", "s", 0.5, "time stamp of sightings and truth"},
      {truth_heading, "truth_heading", "rad", 0.5, "heading of truth rows"},
      {antenna, "antenna", "m", 0.3, "antenna's place ahead of the axle"},
      {antenna_left, "antenna_left", "m", 0.3, "antenna's place to the axle's left"},
      {fix_delay, "fix_delay", "s", 0.5, "time stamp of fixes"},
      {fix_x, "fix_x", "m", 1.0, "fixes along the map's x axis"},
      {fix_y, "fix_y", "m", 1.0, "fixes along the map's y axis"},
      {sideways, "sideways", "", 0.1, "travel to the left"},
      {wheel1, "wheel1", "", 0.1, "travel of the first wheel"},
      {wheel2, "wheel2", "", 0.1, "travel of the second wheel"},
      {wheel3, "wheel3", "", 0.1, "travel of the third wheel"},
      {wheel4, "wheel4", "", 0.1, "travel of the fourth wheel"},
      {wheel5, "wheel5", "", 0.1, "travel of the fifth wheel"},
      {wheel6, "wheel6", "", 0.1, "travel of the sixth wheel"},
      {steer, "steer", "rad", 0.1, "steering angle"},
      {steer_gain, "steer_gain", "", 0.1, "steering angle, in proportion"},
      {sighting_yaw, "sighting_yaw", "rad", 0.5, "yaw reading of a landmark"}};
  return all;
}

std::optional<std::size_t> wheel_of(Channel channel) {
  if (channel < Channel::wheel1 || channel > Channel::wheel6) return std::nullopt;
  return static_cast<std::size_t>(channel) - static_cast<std::size_t>(Channel::wheel1);
}

const ChannelFacts& facts_of(Channel channel) {
  return *std::find_if(channels().begin(), channels().end(),
                       [channel](const ChannelFacts& one) { return one.channel == channel; });
}

std::string_view name_of(Channel channel) {
  return facts_of(channel).name;
}

std::optional<Channel> parse_channel(std::string_view name) {
  for (const ChannelFacts& one : channels()) {
    if (one.name == name) return one.channel;
  }
  return std::nullopt;
}

Channel channel_named(std::string_view name) {
  if (const std::optional<Channel> channel = parse_channel(name)) return *channel;
  throw std::invalid_argument("channel \"" + std::string(name) + "\" is unknown, expected one of " +
                              channel_names());
}

std::string channel_names() {
  std::string text;
  for (const ChannelFacts& one : channels()) {
    text += (text.empty() ? "" : ", ") + std::string(one.name);
  }
  return text;
}

}  // namespace trussmap
