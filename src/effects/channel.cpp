// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/channel.hpp"

#include "effects/channel_record.hpp"

#include <stdexcept>

namespace trussmap {

const std::vector<ChannelFacts>& channels() {
  static const std::vector<ChannelFacts> all = [] {
    std::vector<ChannelFacts> facts;
    for (const effects::ChannelRecord& one : effects::channel_records()) facts.push_back(one.facts);
    return facts;
  }();
  return all;
}

std::optional<std::size_t> wheel_of(Channel channel) {
  if (channel < Channel::wheel1 || channel > Channel::wheel6) return std::nullopt;
  return static_cast<std::size_t>(channel) - static_cast<std::size_t>(Channel::wheel1);
}

const ChannelFacts& facts_of(Channel channel) {
  return effects::record_of(channel).facts;
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
