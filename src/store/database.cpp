// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "store/database.hpp"

#include <algorithm>
#include <cctype>
#include <sqlite3.h>
#include <system_error>
#include <unistd.h>

namespace trussmap::store {
namespace {

constexpr int kPatience = 1000;  // ms that another program may take to get out of the way

/// A name with which SQLite asks for no locks.
std::string immutable(const std::filesystem::path& file) {
  std::string uri = "file:";
  for (const char c : file.string()) {
    constexpr const char* kDigits = "0123456789ABCDEF";
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || c == '/' || c == '.' || c == '_' || c == '-') {
      uri += c;
    } else {
      uri += {'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
    }
  }
  return uri + "?immutable=1";
}

/// What SQLite means, in words of this project; its own may be of tables and statements.
std::string said_by_code(int code) {
  switch (code & 0xff) {
    case SQLITE_CANTOPEN:
      return "the file cannot be opened";
    case SQLITE_PERM:
    case SQLITE_AUTH:
    case SQLITE_READONLY:
      return "the file or its folder cannot be written";
    case SQLITE_CORRUPT:
      return "its pages are damaged";
    case SQLITE_FULL:
      return "the disk is full";
    case SQLITE_IOERR:
      return "the disk fails, or is full";
    case SQLITE_NOMEM:
      return "there is not enough memory";
    case SQLITE_TOOBIG:
      return "a cell is too large";
    case SQLITE_CONSTRAINT:
      return "a row breaks the rules of its table";
    case SQLITE_NOTADB:
      return "it is no database";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program holds it";
    case SQLITE_ERROR:
      return "a table or column is not as expected";
    default:
      return "the database fails (" + std::to_string(code) + ")";
  }
}

/// SQLite's kind of a cell, in words.
const char* kind_in_words(int type) {
  switch (type) {
    case SQLITE_INTEGER:
      return "a whole number";
    case SQLITE_FLOAT:
      return "a number that is not whole";
    case SQLITE_TEXT:
      return "text";
    default:
      return "bytes";
  }
}

}  // namespace

DatabaseError::DatabaseError(int code) : std::runtime_error(said_by_code(code)), code_(code) {}

bool DatabaseError::busy() const {
  return (code_ & 0xff) == SQLITE_BUSY || (code_ & 0xff) == SQLITE_LOCKED;
}

bool DatabaseError::no_database() const {
  return (code_ & 0xff) == SQLITE_NOTADB;
}

Statement::Statement(const Database& database, const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v3(database.handle(), sql.c_str(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
  statement_.reset(statement);
  check(code);
}

void Statement::Finalize::operator()(sqlite3_stmt* statement) const noexcept {
  sqlite3_finalize(statement);
}

void Statement::check(int code) {
  if (code == SQLITE_OK || code == SQLITE_ROW || code == SQLITE_DONE) return;
  throw DatabaseError(code);
}

Statement& Statement::bind(int place, double value) {
  check(sqlite3_bind_double(statement_.get(), place + 1, value));
  return *this;
}

Statement& Statement::bind(int place, std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), place + 1, value));
  return *this;
}

Statement& Statement::bind(int place, const std::string& text) {
  check(sqlite3_bind_text64(statement_.get(), place + 1, text.data(), text.size(), SQLITE_TRANSIENT,
                            SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind_bytes(int place, const std::string& bytes) {
  check(sqlite3_bind_blob64(statement_.get(), place + 1, bytes.data(), bytes.size(),
                            SQLITE_TRANSIENT));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) {
    reset();
    throw DatabaseError(code);
  }
  return code == SQLITE_ROW;
}

void Statement::run() {
  while (step()) {
  }
  reset();
}

void Statement::reset() noexcept {
  sqlite3_reset(statement_.get());
  sqlite3_clear_bindings(statement_.get());
}

void Statement::expect(int column, std::initializer_list<int> types, const char* expected) const {
  const int type = sqlite3_column_type(statement_.get(), column);
  if (type == SQLITE_NULL || std::find(types.begin(), types.end(), type) != types.end()) return;
  throw DamagedCell(std::string(kind_in_words(type)) + " in column " +
                    sqlite3_column_name(statement_.get(), column) + ", expected " + expected);
}

double Statement::real(int column) const {
  expect(column, {SQLITE_FLOAT, SQLITE_INTEGER}, "a number");
  return sqlite3_column_double(statement_.get(), column);
}

std::int64_t Statement::integer(int column) const {
  expect(column, {SQLITE_INTEGER}, "a whole number");
  return sqlite3_column_int64(statement_.get(), column);
}

std::string Statement::text(int column) const {
  expect(column, {SQLITE_TEXT}, "text");
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return text == nullptr ? std::string() : std::string(text, static_cast<std::size_t>(size));
}

std::string Statement::bytes(int column) const {
  expect(column, {SQLITE_BLOB}, "bytes");
  const void* bytes = sqlite3_column_blob(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return bytes == nullptr
             ? std::string()
             : std::string(static_cast<const char*>(bytes), static_cast<std::size_t>(size));
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

Database::Database(const std::filesystem::path& file, Access access) {
  // A log in the folder needs a file more to be read; without one nothing changes that is read.
  std::error_code ignored;
  std::filesystem::path log = file;
  log += "-wal";
  const bool no_log =
      !std::filesystem::exists(log, ignored) || std::filesystem::is_empty(log, ignored);
  if (access == Access::read && no_log && ::access(file.parent_path().c_str(), W_OK) != 0) {
    if (const int code = open(immutable(file), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI)) {
      throw DatabaseError(code);
    }
    return;
  }
  // A reader that may write leaves no files of its own behind.
  const int write = SQLITE_OPEN_READWRITE | (access == Access::write ? SQLITE_OPEN_CREATE : 0);
  int code = open(file.string(), write);
  if (code != SQLITE_OK && access == Access::read) code = open(file.string(), SQLITE_OPEN_READONLY);
  if (code != SQLITE_OK) {
    throw DatabaseError(code);
  }
  sqlite3_extended_result_codes(handle(), 1);
  sqlite3_busy_timeout(handle(), kPatience);
  if (access == Access::read) run("PRAGMA query_only = ON");
}

int Database::open(const std::string& file, int flags) {
  sqlite3* database = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &database, flags, nullptr);
  database_.reset(database);
  return code;
}

void Database::Close::operator()(sqlite3* database) const noexcept {
  sqlite3_close_v2(database);
}

void Database::run(const std::string& sql) const {
  const int code = sqlite3_exec(handle(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) throw DatabaseError(code);
}

std::int64_t Database::number(const std::string& sql) const {
  Statement statement(*this, sql);
  return statement.step() ? statement.integer(0) : 0;
}

void Database::take_over(const Database& other) const {
  sqlite3_backup* const backup = sqlite3_backup_init(handle(), "main", other.handle(), "main");
  if (backup == nullptr) throw DatabaseError(sqlite3_errcode(handle()));
  const int code = sqlite3_backup_step(backup, -1);
  sqlite3_backup_finish(backup);
  if (code != SQLITE_DONE) throw DatabaseError(code);
}

bool Database::in_transaction() const {
  return sqlite3_get_autocommit(handle()) == 0;
}

}  // namespace trussmap::store
