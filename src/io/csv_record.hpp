// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One record of a table, split into fields as RFC 4180 has it: a field may be quoted ("" is a quote
// within, line ends and separators are text within). Records end in LF or CR LF.
//
//   separator   ','  ';'  tab   one between two fields
//               ' '             any blanks and tabs between two fields, and beside the outer ones
//   loose                       blanks beside a separator are no part of the field
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::io {

class CsvRecord {
 public:
  /// Reads the record that begins at `at`, and returns where the next one does. The text must
  /// outlive the fields.
  std::size_t read(std::string_view text, std::size_t at, char separator = ',', bool loose = false);

  [[nodiscard]] const std::vector<std::string_view>& fields() const { return fields_; }
  /// Line ends that the record has, its own among them.
  [[nodiscard]] std::size_t line_ends() const { return line_ends_; }
  /// What is wrong with the record, which is then read in part; nullptr: nothing.
  [[nodiscard]] const char* wrong() const { return wrong_; }

 private:
  bool read_field();
  bool read_quoted();
  void skip_blanks();
  [[nodiscard]] bool blank(std::size_t at) const;
  [[nodiscard]] bool ends_record(std::size_t at) const;
  [[nodiscard]] bool ends_field(std::size_t at) const;

  std::string_view text_;
  std::size_t at_ = 0;
  char separator_ = ',';
  bool loose_ = false;
  std::size_t line_ends_ = 0;
  const char* wrong_ = nullptr;
  std::vector<std::string_view> fields_;
  std::deque<std::string> unquoted_;  // fields whose text differs from the file's bytes
  std::size_t used_unquoted_ = 0;
};

/// Place of the first byte that is not part of valid UTF-8, or npos.
[[nodiscard]] std::size_t invalid_utf8(std::string_view text);

/// A field for a message: in quotes, on one line, its first 40 bytes.
[[nodiscard]] std::string shown_field(std::string_view field);

}  // namespace trussmap::io
