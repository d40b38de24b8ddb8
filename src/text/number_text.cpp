// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "text/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace trussmap::text {

std::string shortest_text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string short_text(double value, int digits) {
  std::array<char, 64> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::general, digits)
                       .ptr;
  return {buffer.data(), end};
}

std::string fixed_text(double value, int decimals) {
  std::array<char, 400> buffer{};  // the largest double has 309 digits before the point
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::fixed, decimals)
                       .ptr;
  return {buffer.data(), end};
}

std::string signed_fixed_text(double value, int decimals) {
  return without_sign_of_nothing((std::signbit(value) ? "" : "+") + fixed_text(value, decimals));
}

std::string without_sign_of_nothing(std::string text) {
  const bool has_sign = !text.empty() && (text.front() == '-' || text.front() == '+');
  if (has_sign && text.find('0') != std::string::npos &&
      text.find_first_not_of("0.", 1) == std::string::npos) {
    text.erase(0, 1);
  }
  return text;
}

std::string times_text(double ratio) {
  constexpr int kMost = 4;
  int decimals = 1;
  while (decimals < kMost && std::abs(ratio - 1.0) < 0.5 * std::pow(10.0, -decimals)) ++decimals;
  return fixed_text(ratio, decimals);
}

double rounded_within(double value, double scale) {
  const int digits = 4 - static_cast<int>(std::floor(std::log10(scale)));
  // A quotient or product of two whole numbers is the double nearest to the decimal number.
  if (digits <= 0) {
    const double unit = std::pow(10.0, -digits);
    return std::round(value / unit) * unit;
  }
  const double parts = std::pow(10.0, digits);
  return std::round(value * parts) / parts;
}

}  // namespace trussmap::text
