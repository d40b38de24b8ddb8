// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/table_records.hpp"

#include "io/csv_record.hpp"
#include "trussmap/error.hpp"

#include <algorithm>

namespace trussmap::logs {
namespace {

constexpr std::size_t kLongest = std::size_t{1} << 20U;  // bytes of a record

}  // namespace

TableRecords::TableRecords(const std::filesystem::path& file)
    : name_(file.string()), window_(file) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (window_.peek(kByteOrderMark.size()).starts_with(kByteOrderMark)) {
    window_.skip(kByteOrderMark.size());
  }
}

/// Up to the line end, over those within quotes if so wished.
std::string_view TableRecords::line_or_record(bool quotes, bool& ended) {
  bool open = false;
  std::size_t at = 0;
  for (std::string_view text = window_.peek(1);;) {
    for (; at < text.size(); ++at) {
      if (text[at] == '"' && quotes) open = !open;
      if (text[at] == '\n' && !open) {
        ended = true;
        return text.substr(0, at + 1);
      }
    }
    if (at > kLongest) {
      throw InputError(name_, next_line_,
                       open ? "a quoted field is not closed, expected a second \""
                            : "a line of more than 1 MiB, expected the rows of a table");
    }
    const std::string_view longer = window_.peek(text.size() + 1);
    if (longer.size() == text.size()) {
      ended = false;
      return text;
    }
    text = longer;
  }
}

bool TableRecords::next() {
  comment_.clear();
  while (true) {
    window_.skip(taken_);
    taken_ = 0;
    const std::string_view first = window_.peek(1);
    if (first.empty() || !cut_off_.empty()) return false;
    const bool comment = first[0] == '#' || first[0] == '%';
    record_.text = line_or_record(!comment, record_.ended);
    record_.byte = window_.offset();
    record_.line = next_line_;
    taken_ = record_.text.size();
    next_line_ +=
        static_cast<std::size_t>(std::count(record_.text.begin(), record_.text.end(), '\n'));
    if (comment) {
      comment_ = record_.text.substr(1);
    } else if (record_.text.find_first_not_of(" \t\r\n") != std::string_view::npos) {
      check();
      return cut_off_.empty();
    }
  }
}

void TableRecords::check() {
  if (const std::size_t zero = record_.text.find('\0'); zero != std::string_view::npos) {
    if (record_.ended || record_.text.find_first_not_of('\0', zero) != std::string_view::npos) {
      throw InputError(name_, record_.line, "a byte 0, expected text");
    }
    cut_off_ = "at byte " + std::to_string(record_.byte + zero) + ": ends with bytes 0";
  }
  if (const std::size_t bad = io::invalid_utf8(record_.text); bad != std::string_view::npos) {
    constexpr std::size_t kLongestCharacter = 4;
    if (!record_.ended && bad + kLongestCharacter > record_.text.size()) {
      cut_off_ = "at byte " + std::to_string(record_.byte + bad) + ": ends within a character";
      return;
    }
    throw InputError(name_, record_.line, "a byte that is no UTF-8 text, expected UTF-8");
  }
}

}  // namespace trussmap::logs
