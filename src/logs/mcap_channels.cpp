// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/mcap_channels.hpp"

#include "logs/sequential_file.hpp"

#include <utility>

namespace trussmap::logs {
namespace {

constexpr std::size_t kLargestDefinition = std::size_t{1} << 20U;    // bytes
constexpr std::size_t kLargestDefinitions = std::size_t{32} << 20U;  // all together

std::string differs(const std::string& kind, std::uint16_t id) {
  return kind + " " + std::to_string(id) + " is described twice, expected the same again";
}

}  // namespace

std::string_view mcap_text(ByteReader& reader) {
  return reader.take(reader.number<std::uint32_t>());
}

void McapChannels::take_schema(std::string_view content, ByteReader& reader) {
  const auto id = reader.number<std::uint16_t>();
  if (id == 0) return;
  Schema schema;
  schema.crc = crc32(content);
  if (const auto known = schemas_.find(id); known != schemas_.end()) {
    if (known->second.crc != schema.crc) reader.fail(differs("schema", id));
    return;
  }
  schema.name = mcap_text(reader);
  schema.encoding = mcap_text(reader);
  const std::string_view definition = mcap_text(reader);
  if (schema.encoding == "ros2msg" || schema.encoding == "ros1msg") {
    schema.kept = definition.size() <= kLargestDefinition;
    if (schema.kept) schema.definition = definition;
  }
  keep(schema.name.size() + schema.encoding.size() + schema.definition.size(), reader);
  schemas_.emplace(id, std::move(schema));
}

void McapChannels::take_channel(std::string_view content, ByteReader& reader) {
  const auto id = reader.number<std::uint16_t>();
  const std::uint32_t crc = crc32(content);
  if (const auto known = channels_.find(id); known != channels_.end()) {
    if (known->second.crc != crc) reader.fail(differs("channel", id));
    return;
  }
  const auto schema_id = reader.number<std::uint16_t>();
  BagChannel channel;
  channel.topic = mcap_text(reader);
  channel.encoding = mcap_text(reader);
  keep(channel.topic.size() + channel.encoding.size(), reader);
  if (const auto schema = schemas_.find(schema_id); schema != schemas_.end()) {
    channel.type = schema->second.name;
    channel.schema_encoding = schema->second.encoding;
    channel.definition = schema->second.definition;
    channel.definition_known = schema->second.kept;
  } else if (schema_id != 0) {
    reader.fail("channel " + std::to_string(id) + " has schema " + std::to_string(schema_id) +
                ", expected one that a record before it describes");
  }
  channels_.emplace(id, Channel{topics_->add(channel), crc});
}

void McapChannels::keep(std::size_t bytes, const ByteReader& reader) {
  kept_ += bytes;
  if (kept_ <= kLargestDefinitions) return;
  reader.fail("the descriptions of channels have more than " + std::to_string(kLargestDefinitions) +
              " bytes");
}

std::optional<std::size_t> McapChannels::number_of(std::uint16_t id) const {
  const auto channel = channels_.find(id);
  if (channel == channels_.end()) return std::nullopt;
  return channel->second.number;
}

}  // namespace trussmap::logs
