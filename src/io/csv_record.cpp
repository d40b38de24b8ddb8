// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/csv_record.hpp"

namespace trussmap::io {

std::size_t CsvRecord::read(std::string_view text, std::size_t at, char separator, bool loose) {
  text_ = text;
  at_ = at;
  separator_ = separator;
  loose_ = loose || separator == ' ';
  line_ends_ = 0;
  wrong_ = nullptr;
  fields_.clear();
  used_unquoted_ = 0;
  while (read_field()) {
  }
  return at_;
}

bool CsvRecord::blank(std::size_t at) const {
  return at < text_.size() && (text_[at] == ' ' || (text_[at] == '\t' && separator_ != '\t'));
}

bool CsvRecord::ends_record(std::size_t at) const {
  return at >= text_.size() || text_[at] == '\n' ||
         (text_[at] == '\r' && (at + 1 >= text_.size() || text_[at + 1] == '\n'));
}

bool CsvRecord::ends_field(std::size_t at) const {
  return ends_record(at) || text_[at] == separator_ || (separator_ == ' ' && text_[at] == '\t');
}

void CsvRecord::skip_blanks() {
  while (loose_ && blank(at_)) ++at_;
}

/// Whether another one follows.
bool CsvRecord::read_field() {
  skip_blanks();
  if (at_ < text_.size() && text_[at_] == '"') {
    if (!read_quoted()) return false;
    const std::size_t behind = at_;
    skip_blanks();
    if (!ends_field(at_) && !(separator_ == ' ' && at_ > behind)) {
      wrong_ = separator_ == ','
                   ? "text after a closing quote, expected a comma or the line's end"
                   : "text after a closing quote, expected a separator or the line's end";
      return false;
    }
  } else {
    std::size_t end = at_;
    for (; !ends_field(end); ++end) {
      if (text_[end] == '"') {
        wrong_ = "a quote within an unquoted field, expected \"...\" around it";
        return false;
      }
    }
    std::string_view field = text_.substr(at_, end - at_);
    at_ = end;
    if (loose_) field = field.substr(0, field.find_last_not_of(" \t") + 1);
    fields_.push_back(field);
    skip_blanks();
  }
  if (!ends_record(at_)) {
    if (separator_ != ' ') ++at_;
    return true;
  }
  if (at_ < text_.size() && text_[at_] == '\r') ++at_;
  if (at_ < text_.size()) {
    ++at_;
    ++line_ends_;
  }
  return false;
}

bool CsvRecord::read_quoted() {
  if (used_unquoted_ == unquoted_.size()) unquoted_.emplace_back();
  std::string& value = unquoted_[used_unquoted_++];
  value.clear();
  std::size_t k = at_ + 1;
  for (;; ++k) {
    if (k >= text_.size()) {
      wrong_ = "a quoted field is not closed, expected a second \"";
      return false;
    }
    if (text_[k] == '\n') ++line_ends_;
    if (text_[k] != '"') {
      value += text_[k];
    } else if (k + 1 < text_.size() && text_[k + 1] == '"') {
      value += text_[k++];
    } else {
      break;
    }
  }
  at_ = k + 1;
  fields_.emplace_back(value);
  return true;
}

std::size_t invalid_utf8(std::string_view text) {
  for (std::size_t k = 0; k < text.size();) {
    const auto byte = static_cast<unsigned char>(text[k]);
    if (byte < 0x80U) {
      ++k;
      continue;
    }
    const std::size_t length = byte >= 0xF0U ? 4 : byte >= 0xE0U ? 3 : 2;
    if (byte < 0xC2U || byte > 0xF4U || k + length > text.size()) return k;
    const auto second = static_cast<unsigned char>(text[k + 1]);
    const bool overlong = (byte == 0xE0U && second < 0xA0U) || (byte == 0xF0U && second < 0x90U);
    const bool beyond = (byte == 0xEDU && second > 0x9FU) || (byte == 0xF4U && second > 0x8FU);
    if (overlong || beyond) return k;
    for (std::size_t n = 1; n < length; ++n) {
      if ((static_cast<unsigned char>(text[k + n]) & 0xC0U) != 0x80U) return k;
    }
    k += length;
  }
  return std::string_view::npos;
}

std::string shown_field(std::string_view field) {
  constexpr std::size_t kLongest = 40;
  std::string text(field.substr(0, kLongest));
  for (char& c : text) c = static_cast<unsigned char>(c) < 0x20U ? ' ' : c;
  return "\"" + text + (field.size() > kLongest ? "...\"" : "\"");
}

}  // namespace trussmap::io
