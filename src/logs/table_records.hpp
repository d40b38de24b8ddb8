// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The records of a table in a text file, one after the other, as yet without their fields. A record
// ends with its line, or with the line that closes its last quote. Blank lines and lines that begin
// with # or % are skipped. UTF-8, with or without a byte order mark.
#pragma once

#include "logs/file_window.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace trussmap::logs {

struct TableRecord {
  std::string_view text;  ///< its line end included; valid until the next one is read
  std::size_t line = 0;   ///< where it begins, from 1
  std::uint64_t byte = 0;
  bool ended = true;  ///< false of a last one that has no line end
};

class TableRecords {
 public:
  explicit TableRecords(const std::filesystem::path& file);

  /// False at the file's end. Throws InputError: no UTF-8, a byte 0, a record that is far too long.
  bool next();
  [[nodiscard]] const TableRecord& record() const { return record_; }
  /// The comment right before the record, without its # or %; empty where there is none.
  [[nodiscard]] const std::string& comment() const { return comment_; }
  /// Where the text ends with bytes 0, as after a power cut; empty: it does not.
  [[nodiscard]] const std::string& cut_off() const { return cut_off_; }

 private:
  [[nodiscard]] std::string_view line_or_record(bool quotes, bool& ended);
  void check();

  std::string name_;
  FileWindow window_;
  std::size_t taken_ = 0;  // bytes of the present record
  std::size_t next_line_ = 1;
  TableRecord record_;
  std::string comment_;
  std::string cut_off_;
};

}  // namespace trussmap::logs
