// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A bag of ROS 1: a line, then records, numbers little-endian.
//
//   "#ROSBAG V2.0" LF
//   length u32, fields of the header (length u32, NAME=VALUE); length u32, data
//
//   op 03 bag header   index_pos u64, conn_count u32, chunk_count u32; padded by its data
//   op 05 chunk        compression (none, bz2, lz4), size u32 of its records; the records, which
//   are
//                      connections and messages
//   op 07 connection   conn u32, topic; data: fields type, md5sum, message_definition
//   op 02 message      conn u32, time u64 (s, ns: u32 each); data: the message
//   op 04 index, 06 chunk info    passed over: what they say is in the chunks
//
// After the chunks, at index_pos, stand all connections again and a chunk info for each chunk. A
// bag that was not closed has index_pos 0; the chunk that was being written has size 0, and its
// records follow it, unless they are compressed. Other records are passed over.
//
// Source: ROS wiki, "Bags/Format/2.0".
#include "logs/ros1_bag.hpp"

#include "logs/byte_reader.hpp"
#include "logs/decompress.hpp"
#include "logs/sequential_file.hpp"

#include <fstream>
#include <map>
#include <optional>
#include <system_error>

namespace trussmap::logs {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kRos1Name = "#ROSBAG V";
constexpr std::string_view kRos1Line = "#ROSBAG V2.0\n";
constexpr std::uint64_t kNsOfSecond = 1000000000;
constexpr std::size_t kLargestRos1Header = std::size_t{1} << 20U;  // bytes
constexpr std::size_t kMostDescribed = std::size_t{32} << 20U;     // bytes, of all connections

enum Ros1Op : std::uint8_t {
  kRos1Message = 0x02,
  kRos1BagHeader = 0x03,
  kRos1Chunk = 0x05,
  kRos1ChunkInfo = 0x06,
  kRos1Connection = 0x07
};

/// Fields NAME=VALUE of a header, or of a connection's data. There are few: they are looked for,
/// not kept.
class Ros1Fields {
 public:
  Ros1Fields(std::string_view bytes, const std::string& file, std::uint64_t at, bool decompressed)
      : reader_(bytes, file, at, decompressed) {}

  [[nodiscard]] std::string_view text(std::string_view name) const {
    ByteReader reader = reader_;
    while (!reader.done()) {
      const std::string_view field = reader.take(reader.number<std::uint32_t>());
      const std::size_t end = field.find('=');
      if (end == std::string_view::npos) reader.fail("a field without =, expected NAME=VALUE");
      if (field.substr(0, end) == name) return field.substr(end + 1);
    }
    reader_.fail("a record without " + std::string(name) + ", expected one with it");
  }

  template <typename T>
  [[nodiscard]] T number(const std::string& name) const {
    const std::string_view bytes = text(name);
    if (bytes.size() != sizeof(T)) {
      reader_.fail(name + " has " + std::to_string(bytes.size()) + " bytes, expected " +
                   std::to_string(sizeof(T)));
    }
    const std::string nothing;
    return ByteReader(bytes, nothing, 0).number<T>();
  }

 private:
  ByteReader reader_;
};

std::string ros1_kind(std::uint8_t op) {
  switch (op) {
    case kRos1Message:
      return "message";
    case kRos1BagHeader:
      return "bag header";
    case kRos1Chunk:
      return "chunk";
    case kRos1Connection:
      return "connection";
    default:
      return "record";
  }
}

class Ros1Reader {
 public:
  Ros1Reader(const fs::path& file, const std::string& shown, BagTopics& topics)
      : file_(file, shown), topics_(&topics) {
    file_.without_checksum();
  }

  std::string read() {
    const std::string_view line = file_.read(kRos1Line.size());
    if (line != kRos1Line) {
      fail_at(file_.name(), 0,
              line.starts_with(kRos1Name)
                  ? "is a bag of ROS 1 of another version, expected #ROSBAG V2.0"
                  : "does not begin as a bag of ROS 1 does, expected #ROSBAG V2.0");
    }
    std::string cut_off;
    bool more = true;
    while (more && cut_off.empty()) more = read_record(cut_off);
    if (!cut_off.empty() || at_its_end()) return cut_off;
    return at_byte(file_.at()) + "all messages are read, but its end is missing";
  }

 private:
  static std::string at_byte(std::uint64_t at) { return "at byte " + std::to_string(at) + ": "; }

  [[nodiscard]] bool at_its_end() const {
    return index_at_ != 0 && file_.at() >= index_at_ && chunk_infos_ >= chunks_;
  }
  /// The file goes as far as its index: what is beyond its end is no cut, but damage.
  [[nodiscard]] bool has_index() const {
    return index_at_ != 0 && file_.size() && index_at_ < *file_.size();
  }

  /// False at the end of the file; `cut_off` where that is too soon.
  bool read_record(std::string& cut_off) {
    const std::uint64_t begin = file_.at();
    const std::string_view first = file_.read(sizeof(std::uint32_t));
    if (first.empty()) {
      if (first_) fail_at(file_.name(), begin, "ends here, expected the header of the bag");
      return false;
    }
    if (first.size() < sizeof(std::uint32_t)) {
      cut_off = at_byte(begin) + "ends in the middle of a record";
      return true;
    }
    const auto length = ByteReader(first, file_.name(), begin).number<std::uint32_t>();
    if (length == 0 && file_.zeros_to_end()) {
      cut_off = at_byte(begin) + "has nothing but zeros from here on";
      return true;
    }
    if (length == 0 || length > kLargestRos1Header) {
      fail_at(file_.name(), begin,
              "a record whose header has " + std::to_string(length) + " bytes, expected 1 to " +
                  std::to_string(kLargestRos1Header));
    }
    header_ = file_.read(length);
    const std::string size(file_.read(header_.size() < length ? 0 : sizeof(std::uint32_t)));
    if (size.size() < sizeof(std::uint32_t)) {
      cut_off = beyond(begin, "record");
      return true;
    }
    const Ros1Fields fields(header_, file_.name(), begin + sizeof(std::uint32_t), false);
    const auto data = ByteReader(size, file_.name(), begin).number<std::uint32_t>();
    cut_off = take(fields, begin, data);
    return true;
  }

  std::string beyond(std::uint64_t begin, const std::string& kind) const {
    if (has_index()) {
      fail_at(file_.name(), begin, "a " + kind + " that ends beyond the file, expected within it");
    }
    return at_byte(begin) + "ends in the middle of a " + kind;
  }

  /// A record of the file, `size` bytes of whose data are still to be read.
  std::string take(const Ros1Fields& fields, std::uint64_t begin, std::uint32_t size) {
    const auto op = fields.number<std::uint8_t>("op");
    if (first_ && op != kRos1BagHeader) {
      fail_at(file_.name(), begin,
              "a record of op " + std::to_string(op) + ", expected the header of the bag (op 3)");
    }
    first_ = false;
    const bool wanted = op == kRos1Message || op == kRos1Chunk || op == kRos1Connection;
    if (wanted && size > kLargestChunk) {
      if (file_.skip(size) < size) return beyond(begin, ros1_kind(op));
      fail_at(file_.name(), begin,
              "a " + ros1_kind(op) + " of " + std::to_string(size) + " bytes, expected " +
                  std::to_string(kLargestChunk) + " at most");
    }
    const std::uint64_t data_at = file_.at();
    const std::string_view data = wanted ? file_.read(size) : std::string_view();
    if ((wanted ? data.size() : file_.skip(size)) < size) return beyond(begin, ros1_kind(op));
    if (op == kRos1BagHeader) {
      index_at_ = fields.number<std::uint64_t>("index_pos");
      chunks_ = fields.number<std::uint32_t>("chunk_count");
    } else if (op == kRos1ChunkInfo) {
      ++chunk_infos_;
    } else if (op == kRos1Chunk) {
      return take_chunk(fields, data, begin, data_at);
    } else if (wanted) {
      take_plain(op, fields, data, begin, data_at, false);
    }
    return {};
  }

  std::string take_chunk(const Ros1Fields& fields, std::string_view data, std::uint64_t begin,
                         std::uint64_t data_at) {
    const std::string compression(fields.text("compression"));
    const auto size = fields.number<std::uint32_t>("size");
    const bool plain = compression == "none";
    if (data.empty() && index_at_ == 0) {  // was being written: plain records follow
      return plain ? std::string() : beyond(begin, "chunk");
    }
    if (size > kLargestChunk) {
      fail_at(file_.name(), begin,
              "a chunk of " + std::to_string(size) + " bytes, expected " +
                  std::to_string(kLargestChunk) + " at most");
    }
    try {
      if (compression == "bz2") {
        data = decompressor_.bzip2(data, size);
      } else if (compression == "lz4") {
        data = decompressor_.lz4(data, size);
      } else if (!plain) {
        fail_at(file_.name(), begin,
                "a chunk is compressed by \"" + compression.substr(0, 40) +
                    "\", expected none, bz2 or lz4");
      } else if (data.size() != size) {
        throw DecompressError("its records have " + std::to_string(data.size()) +
                              " bytes, expected " + std::to_string(size));
      }
    } catch (const DecompressError& error) {
      fail_at(file_.name(), begin, std::string("a chunk is damaged: ") + error.what());
    }
    take_records(data, plain ? data_at : begin, !plain);
    return {};
  }

  void take_records(std::string_view records, std::uint64_t at, bool decompressed) {
    ByteReader reader(records, file_.name(), at, decompressed);
    while (!reader.done()) {
      const std::uint64_t begin = reader.offset();
      const auto length = reader.number<std::uint32_t>();
      const std::uint64_t header_at = reader.offset();
      const std::string_view header = reader.take(length);
      const auto size = reader.number<std::uint32_t>();
      const std::uint64_t data_at = reader.offset();
      const std::string_view data = reader.take(size);
      const Ros1Fields fields(header, file_.name(), header_at, decompressed);
      take_plain(fields.number<std::uint8_t>("op"), fields, data, begin, data_at, decompressed);
    }
  }

  /// What stands in a chunk as well as outside of one.
  void take_plain(std::uint8_t op, const Ros1Fields& fields, std::string_view data,
                  std::uint64_t begin, std::uint64_t data_at, bool decompressed) {
    if (op == kRos1Message) take_message(fields, data, begin);
    if (op == kRos1Connection) {
      take_connection(fields, Ros1Fields(data, file_.name(), data_at, decompressed), data.size(),
                      begin);
    }
  }

  void take_connection(const Ros1Fields& header, const Ros1Fields& data, std::size_t bytes,
                       std::uint64_t begin) {
    const auto id = header.number<std::uint32_t>("conn");
    BagChannel channel;
    channel.topic = header.text("topic");
    channel.type = data.text("type");
    channel.encoding = "ros1";
    channel.schema_encoding = "ros1msg";
    channel.definition = data.text("message_definition");
    std::string known = channel.topic + '\0' + channel.type + '\0';
    known += channel.definition;
    const auto [place, is_new] = connections_.try_emplace(id);
    if (!is_new) {
      if (place->second.description == known) return;
      fail_at(file_.name(), begin,
              "connection " + std::to_string(id) + " is described twice, expected the same again");
    }
    described_ += bytes;
    if (described_ > kMostDescribed) {
      fail_at(file_.name(), begin,
              "the descriptions of connections have more than " + std::to_string(kMostDescribed) +
                  " bytes");
    }
    place->second = {topics_->add(channel), std::move(known)};
  }

  void take_message(const Ros1Fields& fields, std::string_view data, std::uint64_t begin) {
    const auto id = fields.number<std::uint32_t>("conn");
    const auto connection = connections_.find(id);
    if (connection == connections_.end()) {
      fail_at(file_.name(), begin,
              "a message of connection " + std::to_string(id) +
                  ", expected one that a record before it describes");
    }
    if (!topics_->count(connection->second.number)) return;
    const auto stamp = fields.number<std::uint64_t>("time");
    const std::uint64_t time = (stamp & 0xFFFFFFFFU) * kNsOfSecond + (stamp >> 32U);
    topics_->deliver(connection->second.number, time, time, data,
                     [&](const std::string& what) { fail_at(file_.name(), begin, what); });
  }

  struct Connection {
    std::size_t number = 0;   // among the topics' channels
    std::string description;  // topic, type, definition
  };

  SequentialFile file_;
  BagTopics* topics_;
  Decompressor decompressor_;
  std::string header_;  // of the record of the file that is being read
  std::map<std::uint32_t, Connection> connections_;
  std::size_t described_ = 0;   // bytes of connections
  std::uint64_t index_at_ = 0;  // 0: the bag was not closed
  std::uint64_t chunks_ = 0;    // as the bag's header says
  std::uint64_t chunk_infos_ = 0;
  bool first_ = true;
};

}  // namespace

bool is_ros1_bag(const fs::path& file) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return false;
  std::ifstream stream(file, std::ios::binary);
  std::string found(kRos1Name.size(), '\0');
  stream.read(found.data(), static_cast<std::streamsize>(found.size()));
  return stream && found == kRos1Name;
}

std::string read_ros1_bag(const fs::path& file, const std::string& shown, BagTopics& topics) {
  return Ros1Reader(file, shown, topics).read();
}

}  // namespace trussmap::logs
