// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// MCAP: records one after the other, numbers little-endian, texts with their length (uint32).
//
//   89 'M' 'C' 'A' 'P' '0' CR LF    first and last bytes of a file
//   type, uint8; length, uint64; content
//
//   01 header       profile, library
//   03 schema       id u16, name, encoding, data (u32 length)
//   04 channel      id u16, schema id u16, topic, encoding of messages, more
//   05 message      channel id u16, sequence u32, log time u64, publish time u64, data
//   06 chunk        first and last time u64, size u64 and CRC-32 u32 of its records, compression,
//                   records (u64 length), which are schemas, channels and messages
//   0f end of data  CRC-32 u32 of the file so far, 0 where it was not made; then a summary, and a
//                   footer (02)
//
// The file is read in this order, and neither its indices nor its summary are: what they say is in
// the data already, and less of a file that was cut off. Other types of records are passed over.
//
// Source: the MCAP format specification, https://mcap.dev/spec.
#include "logs/mcap.hpp"

#include "logs/byte_reader.hpp"
#include "logs/mcap_channels.hpp"
#include "logs/mcap_records.hpp"
#include "logs/sequential_file.hpp"
#include "trussmap/error.hpp"

#include <array>
#include <fstream>
#include <optional>

namespace trussmap::logs {
namespace {

namespace fs = std::filesystem;
using namespace mcap;

constexpr std::size_t kNamed = 5;         // bytes of it that say that it is MCAP
constexpr std::size_t kRecordHeader = 9;  // bytes
constexpr std::size_t kDataEndSize = kRecordHeader + 4;

std::string kind_of(std::uint8_t type) {
  switch (type) {
    case kHeader:
      return "header";
    case kSchema:
      return "schema";
    case kChannel:
      return "channel";
    case kMessage:
      return "message";
    case kChunk:
      return "chunk";
    default:
      return "record";
  }
}

void check_magic(SequentialFile& file) {
  const std::string_view magic = file.read(kMagic.size());
  if (magic.empty()) fail_at(file.name(), 0, "the file is empty, expected an MCAP file");
  if (magic.substr(0, kNamed) != kMagic.substr(0, kNamed)) {
    fail_at(file.name(), 0, "does not begin as an MCAP file does");
  }
  if (magic == kMagic) return;
  fail_at(file.name(), kNamed,
          magic.size() < kMagic.size() ? "ends in the first 8 bytes, expected an MCAP file"
                                       : "is MCAP of another version, expected version 0");
}

/// What the end of a file says of it.
struct McapEnd {
  bool whole = false;                           // the file ends as it should
  std::optional<std::uint64_t> unchecked = {};  // where data without a checksum end
};

/// Few files state a checksum of their data, and making one takes as long as the rest. A pipe shows
/// nothing of its end.
McapEnd end_of(const SequentialFile& file) {
  McapEnd found;
  constexpr std::uint64_t kFooterSize = kRecordHeader + 20;  // bytes
  const std::uint64_t size = file.size().value_or(0);
  const std::uint64_t end = kFooterSize + kMagic.size();
  if (size < kMagic.size() + end) return found;
  const std::string footer = file.look(size - end, static_cast<std::size_t>(end));
  if (!footer.ends_with(kMagic)) return found;
  found.whole = true;
  if (static_cast<std::uint8_t>(footer[0]) != kFooter) return found;
  ByteReader reader(footer, file.name(), size - end);
  reader.skip(kRecordHeader);
  const auto summary = reader.number<std::uint64_t>();
  const std::uint64_t data_end = (summary == 0 ? size - end : summary) - kDataEndSize;
  if (data_end >= size) return found;
  const std::string stated = file.look(data_end, kDataEndSize);
  const std::string none = static_cast<char>(kDataEnd) + std::string("\4") + std::string(11, '\0');
  if (stated != none) return found;
  found.unchecked = data_end;
  return found;
}

/// The records of a chunk: where they lie in the file, or what they are decompressed from does.
struct ChunkRecords {
  std::string_view bytes;
  std::uint64_t at = 0;
  bool decompressed = false;
};

ChunkRecords records_of_chunk(ByteReader& reader, const std::string& file,
                              Decompressor& decompressor) {
  const std::uint64_t begin = reader.offset();
  reader.skip(2 * sizeof(std::uint64_t));  // times
  const auto size = reader.number<std::uint64_t>();
  const auto crc = reader.number<std::uint32_t>();
  const std::string_view compression = mcap_text(reader);
  const auto compressed = reader.number<std::uint64_t>();
  const std::uint64_t records_at = reader.offset();
  std::string_view records = reader.take(compressed);
  if (size > kLargestChunk) {
    fail_at(file, begin,
            "a chunk of " + std::to_string(size) + " bytes, expected " +
                std::to_string(kLargestChunk) + " at most");
  }
  const bool plain = compression.empty() || compression == "none";
  try {
    if (compression == "lz4") {
      records = decompressor.lz4(records, size);
    } else if (compression == "zstd") {
      records = decompressor.zstd(records, size);
    } else if (!plain) {
      fail_at(file, begin,
              "a chunk is compressed by \"" + std::string(compression.substr(0, 40)) +
                  "\", expected lz4, zstd or nothing");
    } else if (records.size() != size) {
      throw DecompressError("its records have " + std::to_string(records.size()) +
                            " bytes, expected " + std::to_string(size));
    }
  } catch (const DecompressError& error) {
    fail_at(file, begin, std::string("a chunk is damaged: ") + error.what());
  }
  if (const std::uint32_t found = crc == 0 ? 0 : crc32(records); found != crc) {
    fail_at(file, begin,
            "a chunk is damaged: its checksum (CRC-32) is " + std::to_string(found) +
                ", expected " + std::to_string(crc));
  }
  return {records, plain ? records_at : begin, !plain};
}

class McapReader {
 public:
  McapReader(const fs::path& file, const std::string& shown, BagTopics& topics)
      : file_(file, shown), topics_(&topics), channels_(topics) {}

  std::string read() {
    check_magic(file_);
    end_ = end_of(file_);
    if (end_.unchecked) file_.without_checksum();
    std::string cut_off;
    while (!at_end_ && cut_off.empty()) cut_off = read_record();
    if (!cut_off.empty() || end_.whole) return cut_off;
    return "at byte " + std::to_string(file_.at()) +
           ": all messages are read, but its end is missing";
  }

 private:
  /// Where the file is cut off.
  std::string read_record() {
    const std::uint64_t begin = file_.at();
    const std::string_view header = file_.read(kRecordHeader);
    const std::string at = "at byte " + std::to_string(begin) + ": ";
    if (header.empty()) return at + "ends before the record that ends its data";
    ByteReader reader(header, file_.name(), begin);
    const auto type = reader.number<std::uint8_t>();
    if (type == 0) {
      const bool zeros = header.find_first_not_of('\0') == std::string_view::npos;
      if (zeros && file_.zeros_to_end()) return at + "has nothing but zeros from here on";
      fail_at(file_.name(), begin, "a record of type 0, expected 1 to 255");
    }
    if (header.size() < kRecordHeader) return at + "ends in the middle of a record";
    const auto length = reader.number<std::uint64_t>();
    if (first_ && type != kHeader) {
      fail_at(file_.name(), begin,
              "a record of type " + std::to_string(type) + ", expected the header (type 1)");
    }
    first_ = false;
    const bool read_whole = type == kSchema || type == kChannel || type == kMessage ||
                            type == kChunk || type == kDataEnd;
    if (read_whole && length > kLargestChunk) return beyond(begin, type, length);
    const std::uint32_t crc = file_.crc_before();
    const std::string_view content = read_whole ? file_.read(length) : std::string_view();
    if ((read_whole ? content.size() : file_.skip(length)) < length) {
      return beyond(begin, type, length);
    }
    take(type, content, begin + kRecordHeader, crc);
    return {};
  }

  /// A length that cannot be: of a file without its end there is more where it was cut off.
  std::string beyond(std::uint64_t begin, std::uint8_t type, std::uint64_t length) {
    const std::string what = "a " + kind_of(type) + " of " + std::to_string(length) + " bytes";
    if (end_.whole) fail_at(file_.name(), begin, what + ", expected to end before the file does");
    if (file_.skip(length) == length) {
      fail_at(file_.name(), begin,
              what + ", expected " + std::to_string(kLargestChunk) + " at most");
    }
    return "at byte " + std::to_string(begin) + ": ends in the middle of a " + kind_of(type);
  }

  void take(std::uint8_t type, std::string_view content, std::uint64_t at, std::uint32_t crc) {
    ByteReader reader(content, file_.name(), at);
    if (type == kChunk) {
      take_chunk(reader);
    } else if (type == kDataEnd) {
      const auto stated = reader.number<std::uint32_t>();
      if (end_.unchecked && *end_.unchecked + kRecordHeader != at) {
        fail_at(file_.name(), at,
                "the data end here, expected at byte " + std::to_string(*end_.unchecked) +
                    " as the footer says");
      }
      if (stated != 0 && stated != crc) {
        fail_at(file_.name(), at,
                "the checksum (CRC-32) of the data is " + std::to_string(crc) + ", expected " +
                    std::to_string(stated));
      }
      at_end_ = true;
    } else if (type == kFooter) {
      at_end_ = true;
    } else {
      take_plain(type, content, reader);
    }
  }

  /// What stands in a chunk as well as outside of one.
  void take_plain(std::uint8_t type, std::string_view content, ByteReader& reader) {
    if (type == kMessage) take_message(reader);
    if (type == kSchema) channels_.take_schema(content, reader);
    if (type == kChannel) channels_.take_channel(content, reader);
  }

  void take_chunk(ByteReader& reader) {
    const ChunkRecords records = records_of_chunk(reader, file_.name(), decompressor_);
    ByteReader inner(records.bytes, file_.name(), records.at, records.decompressed);
    while (!inner.done()) {
      const auto type = inner.number<std::uint8_t>();
      const auto length = inner.number<std::uint64_t>();
      const std::uint64_t at = inner.offset();
      const std::string_view content = inner.take(length);
      if (type == 0 || type == kChunk) {
        inner.fail("a record of type " + std::to_string(type) + " in a chunk");
      }
      ByteReader record(content, file_.name(), at, records.decompressed);
      take_plain(type, content, record);
    }
  }

  void take_message(ByteReader& reader) {
    const std::uint64_t begin = reader.offset();
    const auto id = reader.number<std::uint16_t>();
    reader.skip(sizeof(std::uint32_t));  // sequence
    const auto log_time = reader.number<std::uint64_t>();
    const auto publish_time = reader.number<std::uint64_t>();
    const std::optional<std::size_t> channel = channels_.number_of(id);
    if (!channel) {
      fail_at(file_.name(), begin,
              "a message of channel " + std::to_string(id) +
                  ", expected one that a record before it describes");
    }
    if (!topics_->count(*channel)) return;
    topics_->deliver(*channel, log_time, publish_time, reader.take(reader.left()),
                     [&](const std::string& what) { fail_at(file_.name(), begin, what); });
  }

  SequentialFile file_;
  BagTopics* topics_;
  McapChannels channels_;
  McapEnd end_;
  bool first_ = true;
  bool at_end_ = false;
  Decompressor decompressor_;
};

}  // namespace

bool is_mcap(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored) || fs::is_directory(file, ignored)) return false;
  if (file.extension() == ".mcap") return true;
  std::array<char, kNamed> begin{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(begin.data(), begin.size());
  return stream && std::string_view(begin.data(), begin.size()) == kMagic.substr(0, kNamed);
}

std::string read_mcap_file(const fs::path& file, const std::string& shown, BagTopics& topics) {
  return McapReader(file, shown, topics).read();
}

LogEnd read_mcap(const fs::path& file, const LogVisit& visit) {
  BagTopics topics(visit);
  std::string cut_off = read_mcap_file(file, file.string(), topics);
  return {topics.all(), std::move(cut_off)};
}

}  // namespace trussmap::logs
