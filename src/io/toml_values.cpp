// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/toml_values.hpp"

#include "io/csv.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace trussmap::io {

void refuse(const toml::source_region& where, const std::string& what) {
  throw TomlFault{where.begin.line, what};
}

const toml::table& toml_table(const toml::node& node, const std::string& name) {
  if (!node.is_table()) refuse(node.source(), name + " is no table, expected [" + name + "]");
  return *node.as_table();
}

const toml::array& toml_list(const toml::node& node, const std::string& name) {
  if (!node.is_array()) refuse(node.source(), name + " is no list, expected [ ... ]");
  return *node.as_array();
}

const toml::array& toml_tables(const toml::node& node, const std::string& name,
                               const std::string& shown) {
  const toml::array* tables = node.as_array();
  if (tables == nullptr || !tables->is_array_of_tables()) {
    refuse(node.source(), name + " is no list of tables, expected " + shown);
  }
  return *tables;
}

std::string toml_words(const toml::node& node, const std::string& name) {
  if (!node.is_string()) refuse(node.source(), name + " is no text, expected \"...\"");
  std::string words = *node.value<std::string>();
  if (words.find('\0') != std::string::npos) {
    refuse(node.source(), name + " holds a byte 0, expected printable text");
  }
  return words;
}

std::string toml_fault(const toml::parse_error& error) {
  constexpr std::string_view kParsing = "Error while parsing ";
  std::string_view what = error.description();
  if (!what.starts_with(kParsing)) return "no TOML: " + std::string(what);
  what.remove_prefix(kParsing.size());
  const std::size_t colon = std::min(what.find(": "), what.size());
  return "no TOML: a " + std::string(what.substr(0, colon)) + " cannot be read" +
         std::string(what.substr(colon));
}

double toml_figure(const toml::node& node, const std::string& name) {
  const auto value = node.value<double>();
  if (!node.is_number() || !value) refuse(node.source(), name + " is no number, expected one");
  if (!std::isfinite(*value)) refuse(node.source(), name + " is not finite, expected a number");
  // Beyond all that robots have, in any unit: squares of larger ones overflow.
  constexpr double kLargest = 1e12;
  if (std::abs(*value) > kLargest) {
    refuse(node.source(), name + " is " + csv_number(*value) + ", expected at most 1e12 in size");
  }
  return *value;
}

double toml_length(const toml::node& node, const std::string& name) {
  const double value = toml_figure(node, name);
  // Of a robot: what is shorter or longer is in another unit, or a slip of the pen.
  constexpr double kShortest = 1e-4;
  constexpr double kLongest = 1e4;
  if (value >= kShortest && value <= kLongest) return value;
  if (value > 0.0) {
    refuse(node.source(),
           name + " is " + csv_number(value) + ", expected a length from 0.0001 to 10000 (m)");
  }
  refuse(node.source(), name + " is " + csv_number(value) + ", expected more than 0 (m)");
}

double toml_spread(const toml::node& node, const std::string& name) {
  const double value = toml_figure(node, name);
  if (value < 0.0) refuse(node.source(), name + " is negative, expected 0 or more");
  constexpr double kSmallest = 1e-12;  // in any unit: weights of smaller ones overflow
  if (value > 0.0 && value < kSmallest) {
    refuse(node.source(), name + " is " + csv_number(value) + ", expected 0, or 1e-12 or more");
  }
  return value;
}

std::string toml_number(double value) {
  return csv_number(value == 0.0 ? 0.0 : value);
}

}  // namespace trussmap::io
