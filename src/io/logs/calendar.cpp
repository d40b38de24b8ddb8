// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/logs/calendar.hpp"

#include <chrono>
#include <regex>

namespace trussmap {

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

}  // namespace trussmap
