// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/rosbag2_sqlite.hpp"

#include "logs/byte_reader.hpp"
#include "trussmap/error.hpp"

#include <array>
#include <cstdint>
#include <fstream>
#include <map>
#include <sqlite3.h>
#include <system_error>

namespace trussmap::logs {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestStored = std::size_t{1} << 20U;     // bytes
constexpr std::size_t kMostStoredBytes = std::size_t{32} << 20U;  // all together
constexpr std::size_t kMostBagTopics = 65536;
constexpr int kMostPages = -16 * 1024;  // KiB of memory for pages of the file

/// As a URI, in which a few characters have a meaning.
std::string uri_of(const fs::path& file) {
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string uri = "file:";
  for (const char c : fs::absolute(file).string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '%' || c == '?' || c == '#') {
      uri += '%';
      uri += kHex[byte >> 4U];
      uri += kHex[byte & 0xFU];
    } else {
      uri += c;
    }
  }
  return uri + "?mode=ro&immutable=1";
}

/// SQLite takes what a last page lacks for zeros.
void check_pages(const fs::path& file, const std::string& shown) {
  constexpr std::size_t kHeader = 18;  // bytes: a name, and the size of pages, big-endian
  const std::uintmax_t size = fs::file_size(file);
  if (size == 0) throw InputError(shown, 0, "is empty, expected the SQLite file of a rosbag2");
  std::ifstream stream(file, std::ios::binary);
  std::array<unsigned char, kHeader> header{};
  stream.read(reinterpret_cast<char*>(header.data()), header.size());
  std::uintmax_t page = header[16] * 256U + header[17];
  if (page == 1) page = 65536;
  if (page == 0 || size % page == 0) return;
  fail_at(shown, size,
          "the database is cut off, in the middle of a page of " + std::to_string(page) +
              " bytes, expected it whole (copy it again, or sqlite3 FILE .recover)");
}

class Database {
 public:
  Database(const fs::path& file, std::string shown) : name_(std::move(shown)) {
    const int status = sqlite3_open_v2(uri_of(file).c_str(), &base_,
                                       SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    if (status != SQLITE_OK) {
      const std::string why = sqlite3_errstr(status);
      sqlite3_close(base_);
      throw InputError(name_, 0, "cannot be opened as a SQLite file (" + why + ")");
    }
    sqlite3_extended_result_codes(base_, 0);
    sqlite3_limit(base_, SQLITE_LIMIT_LENGTH, static_cast<int>(kLargestChunk));
    sqlite3_db_config(base_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(base_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(base_, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    sqlite3_db_config(base_, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  }
  ~Database() { sqlite3_close(base_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  [[nodiscard]] sqlite3* base() const { return base_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(name_, 0, in_a_line(what));
  }
  [[noreturn]] void fail_by_sqlite() const {
    const bool damaged = (sqlite3_errcode(base_) & 0xFF) == SQLITE_CORRUPT;
    fail(std::string("cannot be read as a rosbag2 (") + sqlite3_errmsg(base_) + ")" +
         (damaged ? ", expected a whole database (copy it again, or sqlite3 FILE .recover)" : ""));
  }

 private:
  std::string name_;
  sqlite3* base_ = nullptr;
};

class Statement {
 public:
  Statement(const Database& database, const std::string& sql) : database_(&database) {
    if (sqlite3_prepare_v2(database.base(), sql.c_str(), -1, &statement_, nullptr) != SQLITE_OK) {
      database.fail_by_sqlite();
    }
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  /// On to the next row; false at the end.
  bool next() {
    const int status = sqlite3_step(statement_);
    if (status == SQLITE_ROW) return true;
    if (status == SQLITE_DONE) return false;
    database_->fail_by_sqlite();
  }
  void restart(std::int64_t parameter) {
    sqlite3_reset(statement_);
    sqlite3_bind_int64(statement_, 1, parameter);
  }
  [[nodiscard]] std::int64_t integer(int column) const {
    if (sqlite3_column_type(statement_, column) != SQLITE_INTEGER) {
      database_->fail(std::string("has a row without a number in column ") +
                      sqlite3_column_name(statement_, column) + ", expected a rosbag2");
    }
    return sqlite3_column_int64(statement_, column);
  }
  /// Text or bytes; valid until the next call.
  [[nodiscard]] std::string_view bytes(int column) const {
    const void* found = sqlite3_column_blob(statement_, column);
    const int size = sqlite3_column_bytes(statement_, column);
    if (found == nullptr) {
      if (sqlite3_errcode(database_->base()) == SQLITE_NOMEM) throw std::bad_alloc();
      return {};
    }
    return {static_cast<const char*>(found), static_cast<std::size_t>(size)};
  }

 private:
  const Database* database_;
  sqlite3_stmt* statement_ = nullptr;
};

struct TypeDefinition {
  std::string encoding;
  std::string text;
  bool kept = true;
};

class Rosbag2Reader {
 public:
  Rosbag2Reader(const Database& database, BagTopics& topics)
      : database_(&database), topics_(&topics) {
    Statement(database, "PRAGMA cache_size = " + std::to_string(kMostPages)).next();
    Statement(database, "PRAGMA cell_size_check = ON").next();
  }

  void read() {
    for (const char* const table : {"topics", "messages"}) {
      if (!has_table(table)) {
        database_->fail(std::string("has no table ") + table +
                        ", expected a rosbag2 with topics and messages");
      }
    }
    if (has_table("message_definitions")) read_definitions();
    read_topics();
    read_messages();
  }

 private:
  /// A true one: views and virtual tables could run whatever their author wanted.
  [[nodiscard]] bool has_table(const std::string& name) const {
    return Statement(*database_,
                     "SELECT 1 FROM sqlite_master WHERE type = 'table' AND "
                     "rootpage > 0 AND name = '" +
                         name + "'")
        .next();
  }

  void keep(std::size_t bytes) {
    kept_ += bytes;
    if (kept_ > kMostStoredBytes) {
      database_->fail("the descriptions of topics have more than " +
                      std::to_string(kMostStoredBytes) + " bytes");
    }
  }

  void read_definitions() {
    Statement rows(*database_,
                   "SELECT topic_type, encoding, encoded_message_definition FROM "
                   "message_definitions");
    while (rows.next()) {
      const std::string type(rows.bytes(0));
      TypeDefinition one;
      one.encoding = rows.bytes(1);
      const std::string_view text = rows.bytes(2);
      one.kept = text.size() <= kLongestStored;
      if (one.kept && one.encoding == "ros2msg") one.text = text;
      keep(type.size() + one.encoding.size() + one.text.size());
      definitions_.try_emplace(type, std::move(one));
    }
  }

  void read_topics() {
    Statement rows(*database_, "SELECT id, name, type, serialization_format FROM topics");
    while (rows.next()) {
      const std::int64_t id = rows.integer(0);
      BagChannel channel;
      channel.topic = rows.bytes(1);
      channel.type = rows.bytes(2);
      channel.encoding = rows.bytes(3);
      keep(channel.topic.size() + channel.type.size() + channel.encoding.size());
      if (const auto found = definitions_.find(channel.type); found != definitions_.end()) {
        channel.schema_encoding = found->second.encoding;
        channel.definition = found->second.text;
        channel.definition_known = found->second.kept;
      }
      if (channels_.size() == kMostBagTopics) {
        database_->fail("has more than " + std::to_string(kMostBagTopics) + " topics");
      }
      channels_.emplace(id, topics_->add(channel));
    }
  }

  void read_messages() {
    // The length alone of what nobody wants leaves its pages unread.
    Statement rows(*database_,
                   "SELECT rowid, topic_id, timestamp, length(data) FROM messages ORDER BY rowid");
    Statement data(*database_, "SELECT data FROM messages WHERE rowid = ?");
    while (rows.next()) {
      const std::int64_t row = rows.integer(0);
      const auto channel = channels_.find(rows.integer(1));
      if (channel == channels_.end()) {
        database_->fail("message " + std::to_string(row) + " is of topic " +
                        std::to_string(rows.integer(1)) + ", which it has not");
      }
      const std::int64_t time = rows.integer(2);
      if (!topics_->count(channel->second)) continue;
      data.restart(row);
      if (!data.next()) database_->fail_by_sqlite();
      const auto fail = [this, row](const std::string& what) {
        database_->fail("message " + std::to_string(row) + ": " + what);
      };
      // A time before the epoch is one beyond the latest, too.
      topics_->deliver(channel->second, static_cast<std::uint64_t>(time),
                       static_cast<std::uint64_t>(time), data.bytes(0), fail);
    }
  }

  const Database* database_;
  BagTopics* topics_;
  std::map<std::string, TypeDefinition> definitions_;
  std::map<std::int64_t, std::size_t> channels_;
  std::size_t kept_ = 0;  // bytes of names and definitions
};

}  // namespace

std::string read_rosbag2_sqlite(const fs::path& file, const std::string& shown, BagTopics& topics,
                                const std::function<void()>& opened) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) {
    throw InputError(shown, 0, "cannot be opened, expected a readable file");
  }
  check_pages(file, shown);
  const Database database(file, shown);
  Rosbag2Reader reader(database, topics);
  opened();
  reader.read();
  for (const char* const ending : {"-wal", "-journal"}) {
    const fs::path beside = file.string() + ending;
    if (fs::exists(beside, ignored) && fs::file_size(beside, ignored) > 0) {
      return "what its recorder left in " + beside.filename().string() +
             " is not read; it comes in when sqlite3 opens the bag";
    }
  }
  return {};
}

}  // namespace trussmap::logs
