// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Values of an enumeration by the names that files and reports have for them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace trussmap::text {

template <typename Value, std::size_t Count>
using NamedValues = std::array<std::pair<Value, std::string_view>, Count>;

/// Of a value that has one.
template <typename Value, std::size_t Count>
[[nodiscard]] std::string_view name_in(const NamedValues<Value, Count>& names, Value value) {
  return std::find_if(names.begin(), names.end(),
                      [value](const auto& one) { return one.first == value; })
      ->second;
}

/// Throws std::invalid_argument, listing all names, where no such `kind` of thing has this one.
template <typename Value, std::size_t Count>
[[nodiscard]] Value value_named(const NamedValues<Value, Count>& names, const std::string& kind,
                                std::string_view name) {
  std::string all;
  for (const auto& [value, own] : names) {
    if (own == name) return value;
    all += (all.empty() ? "" : ", ") + std::string(own);
  }
  throw std::invalid_argument(kind + " \"" + std::string(name) + "\" is unknown, expected one of " +
                              all);
}

}  // namespace trussmap::text
