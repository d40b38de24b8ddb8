// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// WPILib's data logs (FRC robots; DataLogManager, AdvantageKit).
//
//   file      "WPILOG", u16 version 0x0100, u32 length, text; records to the end
//   record    u8 lengths, entry 1-4 bytes, size 1-4, time 1-8 (µs), payload
//             lengths: bits 0-1 of the entry, 2-3 of the size, 4-6 of the time, each less 1
//   entry 0   a control record: u8 kind, u32 entry, then
//             0 start   name, type, metadata, each as u32 length and text
//             1 finish  nothing: the number may be used again
//             Data of an entry that is not started are passed over, and counted.
//             2 set metadata, as u32 length and text
//
// Little endian. A topic is an entry's name and type. Structs are decoded by the schemas that the
// log holds (wpilog_struct.hpp), wherever in it they stand.
//
// Source: WPILib Data Log File Format Specification 1.0 (allwpilib, wpiutil/doc/datalog.adoc).
#include "logs/byte_reader.hpp"
#include "logs/file_window.hpp"
#include "logs/message_log.hpp"
#include "logs/wpilog_type.hpp"

#include <algorithm>
#include <deque>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

namespace trussmap::logs {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kWpilogMagic = "WPILOG";
constexpr std::size_t kMostEntries = 100000;

struct LogEntry {
  LogTopic topic;
  WpilogType type;
  std::size_t number = 0;
  bool asked = false;
  bool wanted = false;
  std::size_t schemas = 0;  // of which the struct was found
};

class Wpilog {
 public:
  Wpilog(const fs::path& file, const LogVisit& visit, bool schemas_alone = false)
      : file_(file),
        name_(file.string()),
        visit_(&visit),
        schemas_alone_(schemas_alone),
        window_(file) {}

  LogEnd read() {
    if (read_header()) {
      while (read_record()) {
      }
    }
    LogEnd end;
    for (LogEntry& one : topics_) {
      if (one.type.content != WpilogContent::schema) end.topics.push_back(std::move(one.topic));
    }
    end.cut_off = cut_off_;
    if (unstarted_ > 0) {
      end.passed_over.push_back(
          {unstarted_, "records of entries that were not started, or had been finished"});
    }
    return end;
  }

 private:
  [[nodiscard]] bool cut(const std::string& what) {
    cut_off_ = "at byte " + std::to_string(window_.offset()) + ": ends " + what;
    return false;
  }

  bool read_header() {
    constexpr std::size_t kHeader = 12;
    const std::string_view bytes = window_.peek(kHeader).substr(0, kHeader);
    if (!bytes.starts_with(kWpilogMagic)) {
      fail_at(name_, 0, "is no WPILib data log, expected \"WPILOG\"");
    }
    if (bytes.size() < kHeader) return cut("in the middle of the header");
    ByteReader reader(bytes, name_, 0);
    reader.skip(kWpilogMagic.size());
    const auto version = reader.number<std::uint16_t>();
    if (version >> 8U != 1) {
      fail_at(name_, kWpilogMagic.size(),
              "version " + std::to_string(version >> 8U) + "." + std::to_string(version & 0xFFU) +
                  " of the format, expected 1.0");
    }
    const std::uint64_t length = kHeader + std::uint64_t{reader.number<std::uint32_t>()};
    if (window_.skip(length) < length) return cut("in the middle of the header");
    return true;
  }

  bool read_record() {
    constexpr std::size_t kLongestHead = 17;
    const std::string_view head = window_.peek(kLongestHead).substr(0, kLongestHead);
    if (head.empty()) return false;
    const auto lengths = static_cast<unsigned char>(head[0]);
    const std::size_t entry_length = (lengths & 3U) + 1U;
    const std::size_t size_length = (lengths >> 2U & 3U) + 1U;
    const std::size_t time_length = (lengths >> 4U & 7U) + 1U;
    if ((lengths & 0x80U) != 0) {
      fail_at(name_, window_.offset(), "is no record, expected a first byte below 128");
    }
    const std::size_t length = 1 + entry_length + size_length + time_length;
    if (head.size() < length) return cut("in the middle of a record");
    const auto number = [&head](std::size_t at, std::size_t size) {
      std::uint64_t value = 0;
      while (size-- > 0) value = value << 8U | static_cast<unsigned char>(head[at + size]);
      return value;
    };
    const auto entry = static_cast<std::uint32_t>(number(1, entry_length));
    const std::uint64_t size = number(1 + entry_length, size_length);
    const std::uint64_t time = number(1 + entry_length + size_length, time_length);
    if (entry == 0 && size == 0) return read_zeros();
    if (size > kLargestChunk) {
      fail_at(name_, window_.offset(),
              "a record of " + std::to_string(size) + " bytes, expected at most 256 MiB");
    }
    LogEntry* const topic = entry == 0 ? nullptr : topic_by(entry);
    if (topic == nullptr ? entry != 0 : !needed(*topic)) {
      const std::uint64_t begin = window_.offset();
      if (window_.skip(length + size) == length + size) {
        ++(topic != nullptr ? topic->topic.messages : unstarted_);
        return true;
      }
      cut_off_ = "at byte " + std::to_string(begin) + ": ends in the middle of a record";
      return false;
    }
    const auto whole = static_cast<std::size_t>(length + size);
    const std::string_view record = window_.peek(whole).substr(0, whole);
    if (record.size() < whole) return cut("in the middle of a record");
    ByteReader payload(record.substr(length), name_, window_.offset() + length);
    if (topic == nullptr) {
      read_control(payload);
    } else {
      read_message(*topic, payload, time);
    }
    window_.skip(whole);
    return true;
  }

  /// An empty control record is none; a file that lost power may end with bytes 0.
  bool read_zeros() {
    const std::uint64_t begin = window_.offset();
    while (true) {
      const std::string_view bytes = window_.peek(1);
      if (bytes.find_first_not_of('\0') != std::string_view::npos) {
        fail_at(name_, begin, "a control record without content");
      }
      if (bytes.empty()) break;
      window_.skip(bytes.size());
    }
    cut_off_ = "at byte " + std::to_string(begin) + ": ends with bytes 0";
    return false;
  }

  /// None of an entry that has not been started, as where a log's beginning is lost, or that has
  /// been finished.
  LogEntry* topic_by(std::uint32_t entry) {
    const auto place = entries_.find(entry);
    return place == entries_.end() ? nullptr : place->second;
  }

  static std::string text(ByteReader& reader) {
    return std::string(reader.take(reader.number<std::uint32_t>()));
  }

  void read_control(ByteReader& reader) {
    const auto kind = reader.number<std::uint8_t>();
    if (kind > 2) {
      reader.fail("a control record of kind " + std::to_string(kind) + ", expected 0, 1 or 2");
    }
    const auto entry = reader.number<std::uint32_t>();
    if (kind == 0) {
      const std::string name = text(reader);
      const std::string type = text(reader);
      static_cast<void>(text(reader));
      if (entry == 0) reader.fail("entry 0 is started, expected another");
      entries_[entry] = started(name, type, reader);
    } else if (kind == 1) {
      entries_[entry] = nullptr;
    } else {
      static_cast<void>(text(reader));
    }
    if (!reader.done()) {
      reader.fail("a control record with " + std::to_string(reader.left()) + " bytes too many");
    }
  }

  LogEntry* started(const std::string& name, const std::string& type, const ByteReader& reader) {
    const auto [place, fresh] = by_name_.try_emplace({name, type}, topics_.size());
    if (!fresh) return &topics_[place->second];
    if (topics_.size() == kMostEntries) {
      reader.fail("more than " + std::to_string(kMostEntries) + " topics");
    }
    WpilogType content = wpilog_type(name, type);
    topics_.push_back({{name, type, "wpilog", content.unread}, content});
    if (topics_.back().type.content != WpilogContent::schema)
      topics_.back().number = shown_topics_++;
    return &topics_.back();
  }

  /// Whether the message is decoded; asks of the topic where that is not known yet.
  bool needed(LogEntry& topic) {
    if (topic.type.content == WpilogContent::schema) return true;
    if (schemas_alone_) return false;
    if (topic.type.content == WpilogContent::structure && topic.schemas != schema_changes_) {
      find_type(topic);
    }
    if (!topic.asked) {
      topic.asked = true;
      topic.wanted = visit_->wanted == nullptr || visit_->wanted(topic.topic);
    }
    return topic.wanted && topic.topic.unread.empty() && visit_->message != nullptr;
  }

  void find_type(LogEntry& topic) {
    StructSchemas::Found found = schemas_.find(topic.type.structure);
    if (!all_schemas_ && (found.type == nullptr || !schemas_.states(topic.type.structure))) {
      look_ahead();
      found = schemas_.find(topic.type.structure);
    }
    topic.type.type = found.type;
    topic.topic.unread = found.problem;
    topic.schemas = schema_changes_;
  }

  /// All schemas of the file, where one is missing that may come later.
  void look_ahead() {
    all_schemas_ = true;
    Wpilog ahead(file_, *visit_, true);
    try {
      static_cast<void>(ahead.read());
    } catch (const InputError&) {
      // Said when it is reached.
    }
    for (const auto& [name, schema] : ahead.first_schemas_) {
      if (!schemas_.states(name)) schemas_.add(name, schema);
    }
    ++schema_changes_;
  }

  void read_message(LogEntry& topic, ByteReader& payload, std::uint64_t time) {
    ++topic.topic.messages;
    if (topic.type.content == WpilogContent::schema) {
      const std::string schema(payload.take(payload.left()));
      if (schemas_alone_) first_schemas_.try_emplace(topic.type.structure, schema);
      if (!schemas_alone_ && schemas_.add(topic.type.structure, schema)) ++schema_changes_;
      return;
    }
    constexpr std::int64_t kNanoseconds = 1000;  // of a microsecond
    constexpr std::int64_t kLatest = std::numeric_limits<std::int64_t>::max() / kNanoseconds;
    const auto microseconds = static_cast<std::int64_t>(time);
    if (microseconds > kLatest || microseconds < -kLatest) {
      fail_at(name_, window_.offset(),
              "a time of " + std::to_string(microseconds) + " µs, expected less than 292 years");
    }
    tree_.clear();
    decode_wpilog(topic.type, payload, visit_->elements, tree_);
    const std::int64_t when = microseconds * kNanoseconds;
    visit_->message({topic.topic, topic.number, true, when, when, tree_.root()});
  }

  fs::path file_;
  std::string name_;
  const LogVisit* visit_;
  bool schemas_alone_;
  FileWindow window_;
  std::string cut_off_;
  std::deque<LogEntry> topics_;  // which entries and messages refer to
  std::size_t shown_topics_ = 0;
  std::uint64_t unstarted_ = 0;  // records of no entry
  std::map<std::pair<std::string, std::string>, std::size_t> by_name_;
  std::unordered_map<std::uint32_t, LogEntry*> entries_;
  StructSchemas schemas_;
  std::map<std::string, std::string> first_schemas_;
  std::size_t schema_changes_ = 1;
  bool all_schemas_ = false;
  FieldTree tree_;
};

}  // namespace

bool is_wpilog(const fs::path& file) {
  if (file.extension() == ".xz") return file.stem().extension() == ".wpilog";
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return false;
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(kWpilogMagic.size(), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes == kWpilogMagic;
}

LogEnd read_wpilog(const fs::path& file, const LogVisit& visit) {
  return Wpilog(file, visit).read();
}

}  // namespace trussmap::logs
