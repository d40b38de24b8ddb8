// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/calendar.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <regex>

namespace trussmap::logs {

std::optional<std::int64_t> calendar_time(const std::string& text) {
  static const std::regex kTime(
      R"(^\s*(\d{4})[-/](\d{2})[-/](\d{2})[T ](\d{2}):(\d{2}):(\d{2})(?:[.,](\d{1,9}))?)"
      R"(\s*(Z|[+-]\d{2}:?\d{2})?\s*$)");
  std::smatch found;
  constexpr std::size_t kLongest = 64;
  if (text.size() > kLongest || !std::regex_match(text, found, kTime)) return std::nullopt;
  const auto number = [&](std::size_t k) { return std::stoi(found[k].str()); };
  const std::chrono::year_month_day date{std::chrono::year(number(1)),
                                         std::chrono::month(static_cast<unsigned>(number(2))),
                                         std::chrono::day(static_cast<unsigned>(number(3)))};
  constexpr int kHours = 24;
  constexpr int kSixty = 60;
  constexpr int kFirstYear = 1900;  // ns since 1970 must fit in 64 bits
  constexpr int kLastYear = 2200;
  if (number(1) < kFirstYear || number(1) > kLastYear) return std::nullopt;
  if (!date.ok() || number(4) >= kHours || number(5) >= kSixty || number(6) > kSixty) {
    return std::nullopt;
  }
  std::int64_t seconds = std::chrono::sys_days(date).time_since_epoch().count();
  seconds = ((seconds * kHours + number(4)) * kSixty + number(5)) * kSixty + number(6);
  std::string fraction = found[7].str();
  fraction.resize(9, '0');
  if (const std::string zone = found[8].str(); zone.size() > 1) {
    const int minutes =
        std::stoi(zone.substr(1, 2)) * kSixty + std::stoi(zone.substr(zone.size() - 2));
    seconds -= (zone.front() == '-' ? -1 : 1) * std::int64_t{minutes} * kSixty;
  }
  return seconds * kNanosecondsPerSecond + std::stoll(fraction);
}

std::optional<std::int64_t> decimal_time(std::string_view text, std::int64_t unit) {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  const std::size_t mantissa = std::min(text.find_first_of("eE"), text.size());
  std::string digits(text.substr(0, mantissa));
  const std::size_t mark = std::min(digits.find_first_of(".,"), digits.size());
  auto whole = static_cast<std::ptrdiff_t>(mark);  // digits before the point
  if (mark < digits.size()) digits.erase(mark, 1);
  if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos) {
    return std::nullopt;
  }
  if (mantissa < text.size()) {
    std::string_view power = text.substr(mantissa + 1);
    if (power.starts_with('+')) power.remove_prefix(1);
    int exponent = 0;
    const auto read = std::from_chars(power.data(), power.data() + power.size(), exponent);
    constexpr int kMost = 40;
    if (read.ec != std::errc() || read.ptr != power.data() + power.size() ||
        std::abs(exponent) > kMost) {
      return std::nullopt;
    }
    whole += exponent;
  }
  if (whole < 0) digits.insert(0, static_cast<std::size_t>(-whole), '0');
  whole = std::max<std::ptrdiff_t>(whole, 0);
  const auto places = static_cast<std::size_t>(whole);
  if (digits.size() < places) digits.resize(places, '0');
  std::int64_t integer = 0;
  constexpr std::int64_t kLargest = 4000000000000000000;  // ns
  for (std::size_t k = 0; k < places; ++k) {
    constexpr std::int64_t kTen = 10;
    if (integer > kLargest / unit / kTen) return std::nullopt;
    integer = kTen * integer + (digits[k] - '0');
  }
  const std::string below = "0." + digits.substr(places) + "0";
  double fraction = 0.0;
  std::from_chars(below.data(), below.data() + below.size(), fraction);
  const std::int64_t t = integer * unit + std::llround(fraction * static_cast<double>(unit));
  if (t > kLargest) return std::nullopt;
  return negative ? -t : t;
}

}  // namespace trussmap::logs
