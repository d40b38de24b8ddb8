// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One line of a pose graph's file: words and numbers, with faults that name the line.
#pragma once

#include "trussmap/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace trussmap::io {

/// One line, taken apart from the left.
class GraphLine {
 public:
  GraphLine(std::string_view text, std::size_t number, const std::string& file)
      : rest_(text.substr(0, text.find('#'))), number_(number), file_(file) {}

  /// The next word, empty at the end of the line.
  std::string_view word() {
    const std::size_t begin = rest_.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) {
      rest_ = {};
      return rest_;
    }
    const std::size_t end = std::min(rest_.find_first_of(kBlank, begin), rest_.size());
    const std::string_view found = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return found;
  }

  double number(std::string_view meaning) {
    const std::string_view found = word();
    double value = 0.0;
    // In whatever unit: sums of squares of larger ones, by information as large, overflow.
    constexpr double kLargest = 1e30;
    if (!parse(found, value) || !std::isfinite(value)) complain(found, meaning, "a number");
    if (std::abs(value) > kLargest) complain(found, meaning, "a number of at most 1e30 in size");
    return value;
  }

  std::int64_t id(std::string_view meaning) {
    const std::string_view found = word();
    std::int64_t value = 0;
    if (!parse(found, value)) complain(found, meaning, "a whole number");
    // Two of them can be added.
    constexpr std::int64_t kLargest = std::int64_t{1} << 60;
    if (value > kLargest || value < -kLargest) {
      complain(found, meaning, "a whole number below 2^60 in size");
    }
    return value;
  }

  void finish() {
    const std::string_view found = word();
    if (!found.empty()) fail(fmt::format("\"{}\" is too much, the line should end here", found));
  }

  [[noreturn]] void fail(std::string what) const {
    std::replace(what.begin(), what.end(), '\0', ' ');  // from the file: the message would end
    throw InputError(file_, number_, what);
  }
  [[nodiscard]] std::size_t line_number() const { return number_; }

 private:
  static constexpr std::string_view kBlank = " \t\r\v\f";

  template <typename Number>
  static bool parse(std::string_view text, Number& value) {
    if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
  }

  [[noreturn]] void complain(std::string_view found, std::string_view meaning,
                             std::string_view expected) const {
    if (found.empty()) fail(fmt::format("the line ends before {}, expected {}", meaning, expected));
    fail(fmt::format("{} is \"{}\", expected {}", meaning, found, expected));
  }

  std::string_view rest_;
  std::size_t number_;
  const std::string& file_;
};

}  // namespace trussmap::io
