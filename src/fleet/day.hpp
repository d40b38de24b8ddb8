// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cctype>
#include <chrono>
#include <optional>
#include <string>

namespace trussmap::fleet {

/// Days since 1970-01-01 of YYYY-MM-DD; none: it is no date. Of two libraries, hence inline.
[[nodiscard]] inline std::optional<int> day_in(const std::string& date) {
  if (date.size() != 10 || date[4] != '-' || date[7] != '-') return std::nullopt;
  int numbers[3] = {0, 0, 0};
  int part = 0;
  for (const char c : date) {
    if (c == '-') {
      ++part;
      continue;
    }
    if (std::isdigit(static_cast<unsigned char>(c)) == 0 || part > 2) return std::nullopt;
    numbers[part] = 10 * numbers[part] + (c - '0');
  }
  if (part != 2) return std::nullopt;
  const std::chrono::year_month_day day{std::chrono::year{numbers[0]},
                                        std::chrono::month{static_cast<unsigned>(numbers[1])},
                                        std::chrono::day{static_cast<unsigned>(numbers[2])}};
  if (!day.ok()) return std::nullopt;
  return static_cast<int>(std::chrono::sys_days{day}.time_since_epoch().count());
}

}  // namespace trussmap::fleet
