// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// SQLite, as far as a store needs it: a connection, and statements that are prepared once.
#pragma once

#include "text/table_row.hpp"

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace trussmap::store {

class DatabaseError : public std::runtime_error {
 public:
  /// Says what the code means.
  explicit DatabaseError(int code);
  [[nodiscard]] bool busy() const;
  [[nodiscard]] bool no_database() const;

 private:
  int code_;  ///< SQLite's
};

/// A cell that holds another kind of value than its column: "text in column dx, expected a number".
class DamagedCell : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

class Database;

/// Parameters and columns count from 0. Calls throw DatabaseError.
class Statement final : public text::RowReader, public text::RowWriter {
 public:
  Statement(const Database& database, const std::string& sql);

  using text::RowWriter::bind;
  Statement& bind(int place, double value) override;
  Statement& bind(int place, std::int64_t value) override;
  Statement& bind(int place, int value) { return bind(place, std::int64_t{value}); }
  Statement& bind(int place, const std::string& text) override;

  Statement& bind_bytes(int place, const std::string& bytes);

  /// The next row; false: there is none.
  bool step();

  /// To the end, ready for the next binding; what is not bound anew then is null.
  void run();
  void reset() noexcept;

  /// 0 or nothing where the cell is null; DamagedCell where it is of another kind.
  [[nodiscard]] double real(int column) const override;
  [[nodiscard]] std::int64_t integer(int column) const override;
  [[nodiscard]] std::string text(int column) const override;
  [[nodiscard]] std::string bytes(int column) const;
  [[nodiscard]] bool is_null(int column) const override;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const noexcept;
  };
  static void check(int code);
  void expect(int column, std::initializer_list<int> types, const char* expected) const;

  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

class Database {
 public:
  enum class Access { read, write };

  /// To write, the file is made if it is not there.
  Database(const std::filesystem::path& file, Access access);

  void run(const std::string& sql) const;

  /// The first column of the first row; 0 without one.
  [[nodiscard]] std::int64_t number(const std::string& sql) const;

  /// Becomes a copy of another one.
  void take_over(const Database& other) const;

  [[nodiscard]] bool in_transaction() const;
  [[nodiscard]] sqlite3* handle() const { return database_.get(); }

 private:
  int open(const std::string& file, int flags);

  struct Close {
    void operator()(sqlite3* database) const noexcept;
  };
  std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace trussmap::store
