// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// RFC 4180 tables, read strictly and fast.
//
// A header row is required; blank lines and lines that begin with # are skipped; a field may be
// quoted ("" is a quote within, line ends and commas are text within). Lines end in LF or CR LF.
// UTF-8, with or without a byte order mark. Every error names the file and the line, from 1.
#pragma once

#include "io/csv_record.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::io {

/// How strictly a table is read.
enum class CsvForm {
  exact,
  /// As people and spreadsheets write it: fields between semicolons or tabs where the header has
  /// these, blanks beside them no part of a field; a comma for a number's point ("0,31" in quotes
  /// where commas part the fields); rows without anything skipped.
  by_hand
};

/// Walks through a table row by row. The text must outlive it.
class CsvReader {
 public:
  /// Reads the header. Throws InputError: an empty file, a name twice, invalid UTF-8.
  CsvReader(std::string_view text, std::string file, CsvForm form = CsvForm::exact);

  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }

  /// Number of the column, or -1.
  [[nodiscard]] int find(std::string_view column) const;

  /// Number of a column that must be there. Throws InputError.
  [[nodiscard]] int require(std::string_view column) const;

  /// On to the next row; false at the end. Throws InputError where a row has not as many fields
  /// as the header, where a quote is not closed, or where the file is cut off mid-row.
  bool next();

  [[nodiscard]] std::size_t line() const { return line_; }

  /// Field of the present row. Valid until next().
  [[nodiscard]] std::string_view field(int column) const;

  /// The field as a finite number. Throws InputError: empty, text, NaN, infinite, out of range.
  [[nodiscard]] double number(int column) const;

  /// The same, and of a size that is `largest` at most.
  [[nodiscard]] double number(int column, double largest) const;

  /// The same, NaN where the field is empty.
  [[nodiscard]] double number_or_absent(int column, double largest) const;

  /// Throws InputError for the present row: `file:line: what`.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  bool read_record();
  [[nodiscard]] char separator_of_header() const;
  [[nodiscard]] bool is_blank() const;

  std::string_view text_;
  std::string file_;
  CsvForm form_ = CsvForm::exact;
  char separator_ = ',';
  std::size_t at_ = 0;
  std::size_t line_ = 0;       // of the present record's start
  std::size_t next_line_ = 1;  // of text_[at_]
  std::vector<std::string> columns_;
  CsvRecord record_;
};

/// A field for a table: quoted where it must be.
[[nodiscard]] std::string csv_field(std::string_view text);

/// Shortest text that reads back to the same number; empty for NaN.
[[nodiscard]] std::string csv_number(double value);

}  // namespace trussmap::io
