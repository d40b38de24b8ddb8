// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/csv.hpp"

#include "geometry/index.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/recording.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <unordered_set>

namespace trussmap::io {

CsvReader::CsvReader(std::string_view text, std::string file, CsvForm form)
    : text_(text), file_(std::move(file)), form_(form) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text_.substr(0, kByteOrderMark.size()) == kByteOrderMark) at_ = kByteOrderMark.size();
  if (const std::size_t bad = invalid_utf8(text_); bad != std::string_view::npos) {
    const auto line = std::count(text_.begin(), text_.begin() + static_cast<long>(bad), '\n');
    throw InputError(file_, static_cast<std::size_t>(line) + 1,
                     "a byte that is no UTF-8 text, expected UTF-8");
  }
  if (form_ == CsvForm::by_hand) separator_ = separator_of_header();
  if (!read_record()) {
    throw InputError(file_, 1, "the file is empty, expected a header row");
  }
  std::unordered_set<std::string_view> seen;
  for (const std::string_view name : record_.fields()) {
    if (!seen.insert(name).second) {
      fail("column " + shown_field(name) + " stands twice in the header, expected each name once");
    }
    columns_.emplace_back(name);
  }
}

int CsvReader::find(std::string_view column) const {
  const auto place = std::find(columns_.begin(), columns_.end(), column);
  return place == columns_.end() ? -1 : static_cast<int>(place - columns_.begin());
}

int CsvReader::require(std::string_view column) const {
  const int place = find(column);
  if (place < 0) {
    std::string found;
    for (const std::string& name : columns_) {
      found += (found.empty() ? "" : ",") + name;
      const std::size_t first = name.find_first_not_of(' ');
      if (first == std::string::npos) continue;
      if (name.substr(first, name.find_last_not_of(' ') - first + 1) == column) {
        fail("column \"" + name + "\" has a blank, expected \"" + std::string(column) +
             "\" (blanks beside a comma are part of the field)");
      }
    }
    fail("column \"" + std::string(column) + "\" is missing, found \"" + found + "\"");
  }
  return place;
}

char CsvReader::separator_of_header() const {
  std::size_t at = at_;
  for (;;) {  // over what read_record skips
    const std::size_t end = std::min(text_.find('\n', at), text_.size());
    const std::string_view line = text_.substr(at, end - at);
    if (!line.empty() && line != "\r" && line.front() != '#') {
      if (line.find(',') != std::string_view::npos) return ',';
      if (line.find(';') != std::string_view::npos) return ';';
      return line.find('\t') != std::string_view::npos ? '\t' : ',';
    }
    if (end == text_.size()) return ',';
    at = end + 1;
  }
}

bool CsvReader::is_blank() const {
  const std::vector<std::string_view>& fields = record_.fields();
  return std::all_of(fields.begin(), fields.end(),
                     [](std::string_view field) { return field.empty(); });
}

bool CsvReader::next() {
  do {
    if (!read_record()) return false;
  } while (form_ == CsvForm::by_hand && is_blank());
  if (record_.fields().size() == columns_.size()) return true;
  const bool at_end = at_ >= text_.size();
  const bool line_open = text_.back() != '\n';
  if (at_end && line_open && record_.fields().size() < columns_.size()) {
    fail("the file is cut off in the middle of a row, expected " + std::to_string(columns_.size()) +
         " fields");
  }
  fail(std::to_string(record_.fields().size()) +
       (record_.fields().size() == 1 ? " field" : " fields") + ", expected " +
       std::to_string(columns_.size()) + " as in the header" +
       (form_ == CsvForm::by_hand && separator_ == ',' && record_.fields().size() > columns_.size()
            ? " (decimal commas? part the fields by semicolons, or quote the numbers)"
            : ""));
}

bool CsvReader::read_record() {
  while (at_ < text_.size()) {  // over blank lines and comments
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const char first = text_[at_];
    if (first != '#' && first != '\n' && !(first == '\r' && at_ + 1 == end)) break;
    at_ = std::min(end + 1, text_.size());
    ++next_line_;
  }
  if (at_ >= text_.size()) return false;
  line_ = next_line_;
  at_ = record_.read(text_, at_, separator_, separator_ != ',');
  next_line_ += record_.line_ends();
  if (record_.wrong() != nullptr) fail(record_.wrong());
  return true;
}

std::string_view CsvReader::field(int column) const {
  return record_.fields()[idx(column)];
}

double CsvReader::number(int column) const {
  std::string_view text = field(column);
  const std::string& name = columns_[idx(column)];
  if (text.empty()) fail("column " + name + " is empty, expected a number");
  std::string pointed;
  if (form_ == CsvForm::by_hand && std::count(text.begin(), text.end(), ',') == 1 &&
      text.find('.') == std::string_view::npos) {
    pointed = text;
    pointed[pointed.find(',')] = '.';
    text = pointed;
  }
  double value = 0.0;
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  const char* first = text.data() + (plus ? 1 : 0);
  const char* last = text.data() + text.size();
  const auto [end, status] = std::from_chars(first, last, value);
  if (status == std::errc::result_out_of_range) {
    fail("column " + name + " is " + shown_field(field(column)) +
         ", expected a number within double's range");
  }
  if (status != std::errc() || end != last) {
    fail("column " + name + " is " + shown_field(field(column)) + ", expected a number");
  }
  if (!std::isfinite(value)) {
    fail("column " + name + " is " + shown_field(field(column)) + ", expected a finite number");
  }
  return value;
}

double CsvReader::number(int column, double largest) const {
  const double value = number(column);
  if (std::abs(value) > largest) {
    fail("column " + columns_[idx(column)] + " is " + shown_field(field(column)) +
         ", expected a number of at most " + csv_number(largest) + " in size");
  }
  return value;
}

double CsvReader::number_or_absent(int column, double largest) const {
  return field(column).empty() ? kAbsent : number(column, largest);
}

void CsvReader::fail(const std::string& what) const {
  std::string text = what;  // with names from the file: a byte 0 would end the message
  std::replace(text.begin(), text.end(), '\0', ' ');
  throw InputError(file_, line_, text);
}

std::string csv_field(std::string_view text) {
  const bool plain = text.find_first_of(",\"\r\n") == std::string_view::npos &&
                     (text.empty() || text.front() != '#');
  if (plain) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string csv_number(double value) {
  return std::isnan(value) ? "" : text::shortest_text(value);
}

}  // namespace trussmap::io
