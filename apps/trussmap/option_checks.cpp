// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "option_checks.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

namespace trussmap::app {
namespace {

/// The number that the whole text is.
template <typename Number>
std::optional<Number> number_of(std::string_view text) {
  Number value{};
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc{} || read.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

constexpr std::uint64_t kMostEta = 1'000'000'000;

// In any unit: squares of other numbers, and what is divided by them, have no bounds.
constexpr double kSmallest = 1e-15;
constexpr double kLargest = 1e15;

// m, of a robot.
constexpr double kShortest = 1e-4;
constexpr double kLongest = 1e4;

bool is_whole_number(const std::string& text, std::uint64_t least) {
  const std::optional<std::uint64_t> value = number_of<std::uint64_t>(text);
  return value && *value >= least;
}

std::optional<StretchOfTime> stretch_in(const std::string& text) {
  std::vector<std::string> parts{""};
  for (const char one : text) {
    if (one == ':') {
      parts.emplace_back();
    } else {
      parts.back() += one;
    }
  }
  StretchOfTime result;
  if (parts.size() == 3) {
    if (!is_whole_number(parts.front(), 1)) return std::nullopt;
    result.recording = std::stoul(parts.front()) - 1;
    parts.erase(parts.begin());
  }
  if (parts.size() != 2) return std::nullopt;
  const std::optional<double> from = finite_number(parts[0]);
  const std::optional<double> to = finite_number(parts[1]);
  if (!from || !to || !(*from < *to)) return std::nullopt;
  result.time = {*from, *to};
  return result;
}

}  // namespace

std::optional<double> finite_number(std::string_view text) {
  const std::optional<double> value = number_of<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

Check stretch_of_time() {
  return {[](const std::string& text) {
            return stretch_in(text) ? ""
                                    : "'" + text +
                                          "' is no stretch of time, expected FROM:TO or N:FROM:TO "
                                          "in seconds, FROM below TO, N a recording's number";
          },
          ""};
}

StretchOfTime parse_stretch(const std::string& text) {
  return stretch_in(text).value();
}

Check above_zero() {
  return {[](const std::string& text) -> std::string {
            const std::optional<double> value = finite_number(text);
            if (!value || !(*value > 0.0)) return "'" + text + "' is not a number above 0";
            return *value >= kSmallest && *value <= kLargest
                       ? ""
                       : "'" + text + "' is not a number from 1e-15 to 1e15";
          },
          ""};
}

Check length_of_robot() {
  return {[](const std::string& text) -> std::string {
            const std::optional<double> value = finite_number(text);
            if (!value || !(*value > 0.0)) return "'" + text + "' is not a number above 0";
            return *value >= kShortest && *value <= kLongest
                       ? ""
                       : "'" + text + "' is not a length from 0.0001 to 10000 m";
          },
          ""};
}

Check zero_or_more() {
  return {[](const std::string& text) -> std::string {
            const std::optional<double> value = finite_number(text);
            if (!value || !(*value >= 0.0)) return "'" + text + "' is not a number of 0 or more";
            return *value <= kLargest ? "" : "'" + text + "' is not a number of at most 1e15";
          },
          ""};
}

Check length_to_place() {
  return {[](const std::string& text) -> std::string {
            const std::optional<double> value = finite_number(text);
            return value && std::abs(*value) <= kLongest
                       ? ""
                       : "'" + text + "' is not a number from -10000 to 10000";
          },
          ""};
}

Check whole_number(std::uint64_t least) {
  return {[least](const std::string& text) {
            return is_whole_number(text, least) ? ""
                                                : "'" + text + "' is not a whole number of " +
                                                      std::to_string(least) + " or more";
          },
          ""};
}

Check eta_text() {
  return {[](const std::string& text) {
            return text == "all" || text == "auto" || text == "estimated" ||
                           (is_whole_number(text, 2) && !is_whole_number(text, kMostEta + 1))
                       ? ""
                       : "'" + text + "' is no whole number from 2 to 10^9, all, estimated or auto";
          },
          ""};
}

}  // namespace trussmap::app
