// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Logs of Road Runner 1.0 (FTC robots; FlightRecorder).
//
//   file      "RR", i16 version 0 or 1; entries to the end
//   channel   i32 0, name, schema: the first one has number 0
//   message   i32 1, i32 number of the channel, value
//
//   schema                       value                       in the tree
//   i32 0 struct, i32 count,     the members                 group
//     (name, schema) each
//   i32 1 int, 2 long            4, 8 bytes                  integer
//   i32 3 double                 8                           number
//   i32 4 string                 i32 length, UTF-8           text
//   i32 5 boolean                1                           integer 0 or 1
//   i32 6 enum, i32 count, names i32 of the constant         text, its name
//   i32 7 array, schema          i32 count, elements         list
//
// Big endian; a name is i32 length and UTF-8. Version 0 has four bytes 0 behind a channel for each
// array in its schema. A message has no time but in its fields ("timestamp", ns).
//
// Source: acmerobotics/road-runner-ftc, LogFile.kt.
#include "logs/byte_reader.hpp"
#include "logs/file_window.hpp"
#include "logs/message_log.hpp"

#include <algorithm>
#include <deque>
#include <utility>

namespace trussmap::logs {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kRoadRunnerMagic = "RR";
constexpr std::size_t kMostRoadRunnerTopics = 100000;
constexpr std::size_t kMostSchemaFields = std::size_t{1} << 20U;  // of a message, or of a schema
constexpr int kDeepestSchema = 32;

enum class Kind : std::int32_t { group, whole, long_whole, real, text, boolean, constant, list };

struct Schema {
  Kind kind = Kind::group;
  std::string name;                    // within a struct
  std::vector<Schema> parts;           // members; the element of an array
  std::vector<std::string> constants;  // of an enum
};

struct Topic {
  LogTopic topic;
  Schema schema;
  bool asked = false;
  bool wanted = false;
};

/// The entry goes on beyond what is in memory.
struct NeedsMore {};

/// Bytes of one entry, as far as they are in memory.
class Entry {
 public:
  Entry(std::string_view bytes, const std::string& file, std::uint64_t begin)
      : reader_(bytes, file, begin) {
    reader_.big_endian(true);
  }

  [[nodiscard]] std::size_t at() const { return reader_.at(); }
  [[noreturn]] void fail(const std::string& what) const { reader_.fail(what); }

  std::string_view take(std::size_t count) {
    if (count > reader_.left()) throw NeedsMore();
    return reader_.take(count);
  }

  template <typename T>
  T number() {
    if (sizeof(T) > reader_.left()) throw NeedsMore();
    return reader_.number<T>();
  }

  std::size_t count(const char* of) {
    const auto found = number<std::int32_t>();
    if (found < 0 || static_cast<std::uint64_t>(found) > kLargestChunk) {
      fail(std::to_string(found) + " " + of + ", expected 0 to 256 million");
    }
    return static_cast<std::size_t>(found);
  }

  std::string_view text() { return take(count("bytes of text")); }

 private:
  ByteReader reader_;
};

class RoadRunnerLog {
 public:
  RoadRunnerLog(const fs::path& file, const LogVisit& visit)
      : name_(file.string()), visit_(&visit), window_(file) {}

  LogEnd read() {
    if (read_header()) {
      while (read_entry()) {
      }
    }
    LogEnd end;
    for (Topic& one : topics_) end.topics.push_back(std::move(one.topic));
    end.cut_off = cut_off_;
    return end;
  }

 private:
  bool cut(const std::string& what) {
    cut_off_ = "at byte " + std::to_string(window_.offset()) + ": ends " + what;
    return false;
  }

  bool read_header() {
    constexpr std::size_t kHeader = 4;
    const std::string_view bytes = window_.peek(kHeader).substr(0, kHeader);
    if (!bytes.starts_with(kRoadRunnerMagic))
      fail_at(name_, 0, "is no Road Runner log, expected \"RR\"");
    if (bytes.size() < kHeader) return cut("in the middle of the header");
    Entry header(bytes, name_, 0);
    header.take(kRoadRunnerMagic.size());
    version_ = header.number<std::int16_t>();
    if (version_ != 0 && version_ != 1) {
      fail_at(name_, kRoadRunnerMagic.size(),
              "version " + std::to_string(version_) + " of the format, expected 0 or 1");
    }
    window_.skip(kHeader);
    return true;
  }

  /// An entry does not say how long it is: it is tried with ever more bytes.
  bool read_entry() {
    std::string_view bytes = window_.peek(1);
    if (bytes.empty()) return false;
    if (ends_with_zeros()) return false;
    for (bytes = window_.peek(1);;) {
      try {
        Entry entry(bytes, name_, window_.offset());
        read_entry(entry);
        window_.skip(entry.at());
        return true;
      } catch (const NeedsMore&) {
      }
      if (bytes.size() > kLargestChunk) {
        fail_at(name_, window_.offset(), "an entry of more than 256 MiB");
      }
      const std::size_t before = bytes.size();
      bytes = window_.peek(2 * before);
      if (bytes.size() == before) return cut("in the middle of an entry");
    }
  }

  /// So many bytes 0 are no entry; a file that lost power may end with them.
  bool ends_with_zeros() {
    constexpr std::size_t kNone = 16;
    constexpr auto kNotZero = [](std::string_view bytes) {
      return bytes.find_first_not_of('\0') != std::string_view::npos;
    };
    std::string_view bytes = window_.peek(kNone);
    if (bytes.size() < kNone || kNotZero(bytes.substr(0, kNone))) return false;
    const std::uint64_t begin = window_.offset();
    for (; !bytes.empty(); bytes = window_.peek(1)) {
      if (kNotZero(bytes)) fail_at(name_, begin, "bytes 0, expected an entry");
      window_.skip(bytes.size());
    }
    cut_off_ = "at byte " + std::to_string(begin) + ": ends with bytes 0";
    return true;
  }

  void read_entry(Entry& entry) {
    const auto kind = entry.number<std::int32_t>();
    if (kind == 0) {
      read_channel(entry);
    } else if (kind == 1) {
      read_message(entry);
    } else {
      fail_at(name_, window_.offset(),
              "an entry of kind " + std::to_string(kind) + ", expected 0 or 1");
    }
  }

  void read_channel(Entry& entry) {
    Topic topic;
    topic.topic.name = entry.text();
    topic.topic.encoding = "road runner";
    std::size_t parts = parts_;
    std::size_t arrays = 0;
    topic.schema = read_schema(entry, 0, parts, arrays);
    topic.topic.type = type_of(topic.schema);
    if (version_ == 0) {
      constexpr std::size_t kPadding = 4;
      const std::string_view padding = entry.take(kPadding * arrays);
      if (padding.find_first_not_of('\0') != std::string_view::npos) {
        entry.fail("no bytes 0 behind a channel with arrays, expected them in version 0");
      }
    }
    if (topics_.size() == kMostRoadRunnerTopics) entry.fail("more than 100000 channels");
    parts_ = parts;
    topics_.push_back(std::move(topic));
  }

  static Schema read_schema(Entry& entry, int depth, std::size_t& parts, std::size_t& arrays) {
    Schema schema;
    const auto kind = entry.number<std::int32_t>();
    if (kind < 0 || kind > static_cast<std::int32_t>(Kind::list)) {
      entry.fail("a schema of kind " + std::to_string(kind) + ", expected 0 to 7");
    }
    schema.kind = static_cast<Kind>(kind);
    if (depth > kDeepestSchema || ++parts > kMostSchemaFields / 4)
      entry.fail("a schema beyond all measure");
    if (schema.kind == Kind::list) {
      ++arrays;
      schema.parts.push_back(read_schema(entry, depth + 1, parts, arrays));
    } else if (schema.kind == Kind::group || schema.kind == Kind::constant) {
      const std::size_t count = entry.count("members");
      if (count == 0) entry.fail("a schema without members, expected some");
      for (std::size_t k = 0; k < count; ++k) {
        std::string name(entry.text());
        if (schema.kind == Kind::constant) {
          if (++parts > kMostSchemaFields / 4) entry.fail("a schema beyond all measure");
          schema.constants.push_back(std::move(name));
          continue;
        }
        schema.parts.push_back(read_schema(entry, depth + 1, parts, arrays));
        schema.parts.back().name = std::move(name);
      }
    }
    return schema;
  }

  static std::string type_of(const Schema& schema) {
    switch (schema.kind) {
      case Kind::group:
        return "struct";
      case Kind::whole:
        return "int";
      case Kind::long_whole:
        return "long";
      case Kind::real:
        return "double";
      case Kind::text:
        return "string";
      case Kind::boolean:
        return "boolean";
      case Kind::constant:
        return "enum";
      case Kind::list:
        return type_of(schema.parts[0]) + "[]";
    }
    return {};
  }

  void read_message(Entry& entry) {
    const auto channel = entry.number<std::int32_t>();
    if (channel < 0 || static_cast<std::size_t>(channel) >= topics_.size()) {
      fail_at(name_, window_.offset(),
              "a message of channel " + std::to_string(channel) + ", of which there are " +
                  std::to_string(topics_.size()));
    }
    const auto number = static_cast<std::size_t>(channel);
    Topic& topic = topics_[number];
    tree_.clear();
    read_value(topic.schema, topic.schema.name, entry);
    ++topic.topic.messages;
    if (!topic.asked) {
      topic.asked = true;
      topic.wanted = visit_->wanted == nullptr || visit_->wanted(topic.topic);
    }
    if (topic.wanted && visit_->message) {
      visit_->message({topic.topic, number, false, 0, 0, tree_.root()});
    }
  }

  void read_value(const Schema& schema, std::string_view name, Entry& entry) {
    switch (schema.kind) {
      case Kind::group: {
        const std::size_t group = tree_.open_group(name);
        for (const Schema& one : schema.parts) read_value(one, one.name, entry);
        tree_.close(group);
        break;
      }
      case Kind::whole:
        tree_.add_integer(name, entry.number<std::int32_t>());
        break;
      case Kind::long_whole:
        tree_.add_integer(name, entry.number<std::int64_t>());
        break;
      case Kind::real:
        tree_.add_number(name, entry.number<double>());
        break;
      case Kind::text:
        tree_.add_text(name, entry.text());
        break;
      case Kind::boolean: {
        const auto value = entry.number<std::uint8_t>();
        if (value > 1) entry.fail("a boolean " + std::to_string(value) + ", expected 0 or 1");
        tree_.add_integer(name, value);
        break;
      }
      case Kind::constant: {
        const auto value = entry.number<std::int32_t>();
        if (value < 0 || static_cast<std::size_t>(value) >= schema.constants.size()) {
          entry.fail("constant " + std::to_string(value) + " of an enum, expected 0 to " +
                     std::to_string(schema.constants.size() - 1));
        }
        tree_.add_text(name, schema.constants[static_cast<std::size_t>(value)]);
        break;
      }
      case Kind::list:
        read_list(schema, name, entry);
        break;
    }
    if (tree_.size() > kMostSchemaFields) entry.fail("a message of over a million fields");
  }

  void read_list(const Schema& schema, std::string_view name, Entry& entry) {
    const Schema& element = schema.parts[0];
    const std::size_t count = entry.count("elements");
    const std::size_t list = tree_.open_list(name, count);
    std::size_t size = 0;
    if (element.kind == Kind::whole) size = sizeof(std::int32_t);
    if (element.kind == Kind::long_whole || element.kind == Kind::real) size = sizeof(double);
    if (element.kind == Kind::boolean) size = 1;
    const std::size_t kept = size > 0 ? std::min(count, visit_->elements) : count;
    for (std::size_t k = 0; k < kept; ++k) read_value(element, "", entry);
    entry.take((count - kept) * size);
    tree_.close(list);
  }

  std::string name_;
  const LogVisit* visit_;
  FileWindow window_;
  std::int16_t version_ = 0;
  std::string cut_off_;
  std::deque<Topic> topics_;  // which messages refer to
  std::size_t parts_ = 0;     // of all schemas
  FieldTree tree_;
};

}  // namespace

bool is_roadrunner_log(const fs::path& file) {
  constexpr std::string_view kBegin("RR\0", 3);  // versions are below 256
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return false;
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(kBegin.size(), ' ');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes == kBegin;
}

LogEnd read_roadrunner_log(const fs::path& file, const LogVisit& visit) {
  return RoadRunnerLog(file, visit).read();
}

}  // namespace trussmap::logs
