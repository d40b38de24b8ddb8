// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a table looks like, found from its first rows.
//
//   separator   ',' ';' tab, or ' ' for any blanks: the one by which the rows have equally many
//               fields, and the most numbers in them; or as a first line "sep=;" says
//   columns     by the first row; by a comment right before it (rostopic's "%time,x"; numpy's "# t
//               x") where the first row is of numbers; by the standard message that the rows are
//               (echoed_message.hpp); else "column 1", "column 2", ...
//   units       a second row without a number ("[s],[mm]"), before one with: "name [s]"
//
// A first row that holds numbers alone is no header, nor one whose numbers and texts stand where
// those of the second do ("1.0,red,3").
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::logs {

enum class CellKind { absent, number, text };

struct TableLayout {
  char separator = ',';
  std::vector<std::string> columns;  ///< each name once: "x", "x (2)"
  std::size_t first_row = 0;         ///< of the records given: the first that is no header
  bool header = false;
  std::size_t header_record = 0;  ///< where one is, or could be
  const char* wrong = nullptr;    ///< with that record
  /// The header ends with a separator: a row may do without its last, empty field.
  bool open_header = false;
};

/// `comment`: what stands right before the first record, if anything. Precondition: some records.
[[nodiscard]] TableLayout table_layout(const std::vector<std::string>& records,
                                       std::string_view comment);

/// A number in a table. `mark` is '.' or ',', or 0 where the first number that has one decides;
/// what is infinite, "nan", "none", "null" or "n/a" is absent.
class CellReader {
 public:
  explicit CellReader(char mark) : mark_(mark) {}

  [[nodiscard]] CellKind read(std::string_view cell);
  [[nodiscard]] double number() const { return number_; }
  /// Whether it is whole and within 64 bits; true and false are 1 and 0.
  [[nodiscard]] bool whole() const { return whole_; }
  [[nodiscard]] std::int64_t integer() const { return integer_; }

 private:
  char mark_;
  double number_ = 0.0;
  bool whole_ = false;
  std::int64_t integer_ = 0;
};

/// Of the tables whose fields lie between such separators.
[[nodiscard]] constexpr char decimal_mark(char separator) {
  return separator == ';' ? '\0' : '.';
}

}  // namespace trussmap::logs
