// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The channels of an MCAP file, by its records of schemas and channels.
#pragma once

#include "logs/bag_topics.hpp"
#include "logs/byte_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace trussmap::logs {

/// A text with its length before it.
[[nodiscard]] std::string_view mcap_text(ByteReader& reader);

/// Calls throw InputError. A record's `content` is what `reader` stands at the begin of.
class McapChannels {
 public:
  explicit McapChannels(BagTopics& topics) : topics_(&topics) {}

  void take_schema(std::string_view content, ByteReader& reader);
  void take_channel(std::string_view content, ByteReader& reader);

  /// Its number among the topics' channels; none: no record has described it.
  [[nodiscard]] std::optional<std::size_t> number_of(std::uint16_t id) const;

 private:
  struct Schema {
    std::string name;
    std::string encoding;
    std::string definition;  ///< of ros2msg and ros1msg alone
    bool kept = true;        ///< false: the definition is too large
    std::uint32_t crc = 0;   ///< of the record
  };
  struct Channel {
    std::size_t number = 0;
    std::uint32_t crc = 0;  ///< of the record
  };

  void keep(std::size_t bytes, const ByteReader& reader);

  BagTopics* topics_;
  std::size_t kept_ = 0;  ///< bytes of names and definitions
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
};

}  // namespace trussmap::logs
