// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A table of map.toml, key by key: each is asked for, and what was not asked for is an error.
#pragma once

#include "io/toml_parser.hpp"
#include "trussmap/error.hpp"
#include "trussmap/planar.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace trussmap::logs {

class TomlFields {
 public:
  /// `where`: "[wheels.left]", for messages.
  TomlFields(const toml::table& table, std::string file, std::string where)
      : table_(&table), file_(std::move(file)), where_(std::move(where)) {}

  [[nodiscard]] std::size_t line() const { return table_->source().begin.line; }
  [[nodiscard]] const std::string& file() const { return file_; }

  [[nodiscard]] const toml::node* find(const char* key) {
    asked_.emplace_back(key);
    return table_->get(key);
  }
  [[nodiscard]] bool has(const char* key) { return find(key) != nullptr; }

  /// `otherwise` where it is absent.
  std::string text(const char* key, const std::string& otherwise = "") {
    const toml::node* node = find(key);
    if (node == nullptr) return otherwise;
    if (!node->is_string()) fail(*node, std::string(key) + " is no text, expected \"...\"");
    return *node->value<std::string>();
  }
  std::string needed_text(const char* key) {
    if (!has(key)) fail(std::string("has no ") + key + ", expected one");
    return text(key);
  }
  double number(const char* key, double otherwise) {
    const toml::node* node = find(key);
    if (node == nullptr) return otherwise;
    const auto value = node->value<double>();
    constexpr double kLargest = 1e15;
    if (!node->is_number() || !value || !(std::abs(*value) <= kLargest)) {
      fail(*node, std::string(key) + " is no number, expected one of at most 1e15 in size");
    }
    return *value;
  }
  double positive(const char* key, double otherwise) {
    const double value = number(key, otherwise);
    if (has(key) && !(value > 0.0)) {
      fail(*table_->get(key), std::string(key) + " is not positive, expected more than 0");
    }
    constexpr double kSmallest = 1e-12;  // in any unit: what is divided by less has no bounds
    if (has(key) && value < kSmallest) {
      fail(*table_->get(key), std::string(key) + " is below 1e-12, expected more");
    }
    return value;
  }
  /// s that are added to times.
  double clock() {
    const double value = number("clock", 0.0);
    constexpr double kLargest = 1e10;  // from a clock since the start to one since 1900
    if (std::abs(value) > kLargest) {
      fail(*table_->get("clock"), "clock is more than 1e10 s, expected less");
    }
    return value;
  }
  bool flag(const char* key, bool otherwise) {
    const toml::node* node = find(key);
    if (node == nullptr) return otherwise;
    if (!node->is_boolean()) fail(*node, std::string(key) + " is neither true nor false");
    return *node->value<bool>();
  }
  /// 1 or -1.
  double sign(const char* key) {
    const double value = number(key, 1.0);
    if (value != 1.0 && value != -1.0) {
      fail(*table_->get(key), std::string(key) + " is neither 1 nor -1, expected one of them");
    }
    return value;
  }
  std::vector<std::string> texts(const char* key) {
    const toml::node* node = find(key);
    std::vector<std::string> found;
    if (node == nullptr) return found;
    if (node->is_string()) return {*node->value<std::string>()};
    const toml::array* list = node->as_array();
    for (std::size_t k = 0; list != nullptr && k < list->size(); ++k) {
      if (!(*list)[k].is_string()) break;
      found.push_back(*(*list)[k].value<std::string>());
    }
    if (list == nullptr || found.size() != list->size()) {
      fail(*node, std::string(key) + " is no list of texts, expected [\"...\", ...]");
    }
    return found;
  }

  /// Pairs of numbers, [[x, y], ...].
  std::vector<Vector2> points(const char* key) {
    const toml::node* node = find(key);
    std::vector<Vector2> found;
    if (node == nullptr) return found;
    const toml::array* list = node->as_array();
    for (std::size_t k = 0; list != nullptr && k < list->size(); ++k) {
      const toml::array* pair = (*list)[k].as_array();
      if (pair == nullptr || pair->size() != 2) break;
      const auto x = (*pair)[0].value<double>();
      const auto y = (*pair)[1].value<double>();
      if (!x || !y || !std::isfinite(*x) || !std::isfinite(*y)) break;
      found.emplace_back(*x, *y);
    }
    if (list == nullptr || found.size() != list->size()) {
      fail(*node, std::string(key) + " is no list of pairs of numbers, expected [[0.3, 0.3], ...]");
    }
    return found;
  }

  /// Throws where the table has further keys.
  void finish() const {
    for (const auto& [key, node] : *table_) {
      if (std::find(asked_.begin(), asked_.end(), key.str()) != asked_.end()) continue;
      std::string expected;
      for (const std::string& one : asked_) {
        if (expected.find(one) == std::string::npos) {
          expected += (expected.empty() ? "" : ", ") + one;
        }
      }
      throw InputError(file_, key.source().begin.line,
                       "key \"" + std::string(key.str()) + "\" in " + where_ +
                           " is unknown, expected one of " + expected);
    }
  }

  [[noreturn]] void fail(const toml::node& node, const std::string& what) const {
    throw InputError(file_, node.source().begin.line, where_ + ": " + what);
  }
  [[noreturn]] void fail(const std::string& what) const {
    std::string unknown;  // so far: a slip of the pen, most likely
    for (const auto& [key, node] : *table_) {
      if (std::find(asked_.begin(), asked_.end(), key.str()) != asked_.end()) continue;
      unknown += (unknown.empty() ? " (there is " : ", ") + std::string(key.str());
    }
    throw InputError(file_, line(), where_ + " " + what + unknown + (unknown.empty() ? "" : ")"));
  }

 private:
  const toml::table* table_;
  std::string file_;
  std::string where_;
  std::vector<std::string> asked_;
};

}  // namespace trussmap::logs
