// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/mcap_write.hpp"

#include "logs/little_endian.hpp"
#include "logs/mcap_records.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <zstd.h>

#include <lzma.h>

namespace trussmap::logs {
namespace {

using namespace mcap;

constexpr int kLevel = 3;  // zstd's default: what recorders take

/// With its length before it, of 4 bytes: strings, maps, arrays.
void put_counted(std::string& out, std::string_view bytes) {
  put_little(out, static_cast<std::uint32_t>(bytes.size()));
  out += bytes;
}

void put_record(std::string& out, Opcode opcode, std::string_view content) {
  put_little(out, static_cast<std::uint8_t>(opcode));
  put_little(out, static_cast<std::uint64_t>(content.size()));
  out += content;
}

/// The polynomial of IEEE 802.3, as zlib's and the specification's.
std::uint32_t crc(std::string_view bytes, std::size_t from = 0) {
  const std::string_view part = bytes.substr(from);
  return lzma_crc32(reinterpret_cast<const std::uint8_t*>(part.data()), part.size(), 0);
}

std::string compressed(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), kLevel);
  if (ZSTD_isError(size) != 0U) throw std::runtime_error("zstd cannot compress a chunk");
  packed.resize(size);
  return packed;
}

}  // namespace

void McapWriter::Times::take(std::uint64_t time) {
  first = any ? std::min(first, time) : time;
  last = any ? std::max(last, time) : time;
  any = true;
}

McapWriter::McapWriter() : file_(kMagic) {
  std::string header;
  put_counted(header, "ros2");
  put_counted(header, "trussmap");
  put_record(file_, kHeader, header);
}

std::uint16_t McapWriter::add_channel(const std::string& topic, const std::string& type,
                                      const std::string& definition) {
  auto schema = std::find_if(schemas_.begin(), schemas_.end(),
                             [&](const Schema& one) { return one.type == type; });
  if (schema == schemas_.end()) {
    std::string content;
    put_little(content, static_cast<std::uint16_t>(schemas_.size() + 1));
    put_counted(content, type);
    put_counted(content, "ros2msg");
    put_counted(content, definition);
    std::string record;
    put_record(record, kSchema, content);
    schema = schemas_.insert(schema, {type, std::move(record)});
  }
  const auto number = static_cast<std::uint16_t>(channels_.size());
  const std::size_t of_type = static_cast<std::size_t>(schema - schemas_.begin());
  std::string content;
  put_little(content, number);
  put_little(content, static_cast<std::uint16_t>(of_type + 1));
  put_counted(content, topic);
  put_counted(content, "cdr");
  std::string metadata;
  // Recorders state how each publisher's queue was set here; empty: the player's defaults.
  put_counted(metadata, "offered_qos_profiles");
  put_counted(metadata, "");
  put_counted(content, metadata);
  std::string record;
  put_record(record, kChannel, content);
  channels_.push_back({std::move(record), of_type});
  return number;
}

void McapWriter::add(std::uint16_t channel, std::uint64_t time, std::string_view data) {
  Channel& on = channels_[channel];
  if (Schema& schema = schemas_[on.schema]; !schema.written) {
    chunk_ += schema.record;
    schema.written = true;
  }
  if (!on.written) {
    chunk_ += on.record;
    on.written = true;
  }
  std::string& index = chunk_index_[channel];
  put_little(index, time);
  put_little(index, static_cast<std::uint64_t>(chunk_.size()));
  std::string content;
  put_little(content, channel);
  put_little(content, static_cast<std::uint32_t>(on.messages));
  put_little(content, time);  // recorded
  put_little(content, time);  // published
  content += data;
  put_record(chunk_, kMessage, content);
  chunk_times_.take(time);
  times_.take(time);
  ++on.messages;
  if (chunk_.size() >= kChunkBytes) close_chunk();
}

void McapWriter::close_chunk() {
  if (chunk_.empty()) return;
  const std::string packed = compressed(chunk_);
  const std::size_t begin = file_.size();
  std::string content;
  put_little(content, chunk_times_.first);
  put_little(content, chunk_times_.last);
  put_little(content, static_cast<std::uint64_t>(chunk_.size()));
  put_little(content, crc(chunk_));
  put_counted(content, "zstd");
  put_little(content, static_cast<std::uint64_t>(packed.size()));
  content += packed;
  put_record(file_, kChunk, content);
  const std::size_t end = file_.size();

  std::string offsets;
  for (const auto& [channel, index] : chunk_index_) {
    put_little(offsets, channel);
    put_little(offsets, static_cast<std::uint64_t>(file_.size()));
    std::string entries;
    put_little(entries, channel);
    put_counted(entries, index);
    put_record(file_, kMessageIndex, entries);
  }

  std::string summary;
  put_little(summary, chunk_times_.first);
  put_little(summary, chunk_times_.last);
  put_little(summary, static_cast<std::uint64_t>(begin));
  put_little(summary, static_cast<std::uint64_t>(end - begin));
  put_counted(summary, offsets);
  put_little(summary, static_cast<std::uint64_t>(file_.size() - end));
  put_counted(summary, "zstd");
  put_little(summary, static_cast<std::uint64_t>(packed.size()));
  put_little(summary, static_cast<std::uint64_t>(chunk_.size()));
  chunk_indexes_.push_back(std::move(summary));
  chunk_.clear();
  chunk_index_.clear();
  chunk_times_ = {};
}

std::string McapWriter::statistics() const {
  std::uint64_t messages = 0;
  std::string counts;
  for (std::size_t number = 0; number < channels_.size(); ++number) {
    put_little(counts, static_cast<std::uint16_t>(number));
    put_little(counts, channels_[number].messages);
    messages += channels_[number].messages;
  }
  std::string content;
  put_little(content, messages);
  put_little(content, static_cast<std::uint16_t>(schemas_.size()));
  put_little(content, static_cast<std::uint32_t>(channels_.size()));
  put_little(content, std::uint32_t{0});  // attachments
  put_little(content, std::uint32_t{0});  // metadata
  put_little(content, static_cast<std::uint32_t>(chunk_indexes_.size()));
  put_little(content, times_.first);
  put_little(content, times_.last);
  put_counted(content, counts);
  return content;
}

std::string McapWriter::finish() {
  close_chunk();
  std::string content;
  put_little(content, crc(file_));
  put_record(file_, kDataEnd, content);

  const std::size_t summary = file_.size();
  std::string offsets;
  const auto group = [&](Opcode opcode, const auto& write) {
    const std::size_t begin = file_.size();
    write();
    if (file_.size() == begin) return;
    std::string one;
    put_little(one, static_cast<std::uint8_t>(opcode));
    put_little(one, static_cast<std::uint64_t>(begin));
    put_little(one, static_cast<std::uint64_t>(file_.size() - begin));
    put_record(offsets, kSummaryOffset, one);
  };
  group(kSchema, [&] {
    for (const Schema& one : schemas_) file_ += one.record;
  });
  group(kChannel, [&] {
    for (const Channel& one : channels_) file_ += one.record;
  });
  group(kStatistics, [&] { put_record(file_, kStatistics, statistics()); });
  group(kChunkIndex, [&] {
    for (const std::string& one : chunk_indexes_) put_record(file_, kChunkIndex, one);
  });
  const std::size_t summary_offsets = file_.size();
  file_ += offsets;

  // The checksum covers the footer, too, up to itself: opcode, length and both offsets.
  constexpr std::uint64_t kFooterBytes = 8 + 8 + 4;
  put_little(file_, static_cast<std::uint8_t>(kFooter));
  put_little(file_, kFooterBytes);
  put_little(file_, static_cast<std::uint64_t>(summary));
  put_little(file_, static_cast<std::uint64_t>(summary_offsets));
  put_little(file_, crc(file_, summary));
  file_ += kMagic;
  return std::exchange(*this, McapWriter()).file_;
}

}  // namespace trussmap::logs
