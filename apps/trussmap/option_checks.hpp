// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Checks of option values that complain in plain words.
#pragma once

#include "trussmap/map_builder.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>

namespace trussmap::app {

/// A number above 0, infinity not included.
inline CLI::Validator above_zero() {
  const auto check = [](const std::string& text) -> std::string {
    double value = 0.0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = read.ec == std::errc{} && read.ptr == text.data() + text.size();
    return whole && std::isfinite(value) && value > 0.0 ? ""
                                                        : "'" + text + "' is not a number above 0";
  };
  return {check, ""};
}

/// A number of 0 or more, infinity not included.
inline CLI::Validator zero_or_more() {
  const auto check = [](const std::string& text) -> std::string {
    double value = 0.0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = read.ec == std::errc{} && read.ptr == text.data() + text.size();
    return whole && std::isfinite(value) && value >= 0.0
               ? ""
               : "'" + text + "' is not a number of 0 or more";
  };
  return {check, ""};
}

/// A whole number from `least` on.
inline CLI::Validator whole_number(std::uint64_t least) {
  const auto check = [least](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = read.ec == std::errc{} && read.ptr == text.data() + text.size();
    return whole && value >= least
               ? ""
               : "'" + text + "' is not a whole number of " + std::to_string(least) + " or more";
  };
  return {check, ""};
}

/// A number of landmarks from 2 on, "all" or "auto".
inline CLI::Validator eta_text() {
  const auto check = [](std::string& text) -> std::string {
    const bool word = text == "all" || text == "auto";
    return word || whole_number(2)(text).empty()
               ? ""
               : "'" + text + "' is no whole number from 2, all or auto";
  };
  return {check, ""};
}

/// What eta_text() let through.
inline Eta parse_eta(const std::string& text) {
  Eta eta;
  if (text == "all") {
    eta.kind = Eta::Kind::all;
  } else if (text == "auto") {
    eta.kind = Eta::Kind::estimated;
  } else {
    eta.count = std::stoi(text);
  }
  return eta;
}

}  // namespace trussmap::app
