// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Writes MCAP: messages over time on channels, in compressed chunks with an index.
//
//   magic
//   Header                         profile "ros2"
//   Chunk, MessageIndex ...        zstd: Schema and Channel before their first Message, Messages
//   DataEnd                        CRC-32 of all before it
//   Schema, Channel, Statistics,   the summary: what there is, and where
//   ChunkIndex, SummaryOffset ...
//   Footer                         where the summary is, CRC-32 of it
//   magic
//
// Times are ns since the Unix epoch. The same calls give the same bytes (with the same zstd).
//
// Source: the MCAP specification (mcap.dev/spec), version 0 of the format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::logs {

/// Beyond this a chunk is closed, bytes before compression.
inline constexpr std::size_t kChunkBytes = std::size_t{1} << 20U;

class McapWriter {
 public:
  McapWriter();

  /// A topic whose messages are CDR of this type; `definition` is the type's message definition
  /// with all that it depends on. Returns the channel. Precondition: at most 65536 of them.
  std::uint16_t add_channel(const std::string& topic, const std::string& type,
                            const std::string& definition);

  /// The next message; in the order of time, so that readers need not sort.
  void add(std::uint16_t channel, std::uint64_t time, std::string_view data);

  [[nodiscard]] std::uint64_t messages(std::uint16_t channel) const {
    return channels_[channel].messages;
  }

  /// Everything written, with its summary. The writer is empty then.
  [[nodiscard]] std::string finish();

 private:
  struct Channel {
    std::string record;      // as it stands in the file
    std::size_t schema = 0;  // in schemas_
    std::uint64_t messages = 0;
    bool written = false;
  };
  struct Schema {
    std::string type;
    std::string record;
    bool written = false;
  };
  struct Times {
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    bool any = false;
    void take(std::uint64_t time);
  };

  void close_chunk();
  [[nodiscard]] std::string statistics() const;

  std::string file_;
  std::string chunk_;
  std::map<std::uint16_t, std::string> chunk_index_;  // of a channel: (time, offset), as bytes
  Times chunk_times_;
  Times times_;
  std::vector<Schema> schemas_;    // the first has id 1
  std::vector<Channel> channels_;  // the first has id 0
  std::vector<std::string> chunk_indexes_;
};

}  // namespace trussmap::logs
