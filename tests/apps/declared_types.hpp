// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Types as src/report/page/types.d.ts declares them, and JSON held against them: interfaces of one
// key a line, whose types are names, literals, arrays of these, and unions.
#pragma once

#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace trussmap::testing {

class DeclaredTypes {
 public:
  explicit DeclaredTypes(const std::string& text) {
    static const std::regex kInterface(R"(interface (\w+) \{([^}]*)\})");
    static const std::regex kKey(R"((\w+)(\??): ([^;]+);)");
    static const std::regex kAlias(R"(type (\w+) = ([^;]+);)");
    for (std::sregex_iterator at(text.begin(), text.end(), kInterface), end; at != end; ++at) {
      const std::string body = (*at)[2];
      std::vector<Key>& keys = interfaces_[(*at)[1]];
      for (std::sregex_iterator key(body.begin(), body.end(), kKey); key != end; ++key) {
        keys.push_back({(*key)[1], (*key)[3], (*key)[2] == "?"});
      }
    }
    for (std::sregex_iterator at(text.begin(), text.end(), kAlias), end; at != end; ++at) {
      aliases_[(*at)[1]] = (*at)[2];
    }
  }

  /// Notes every key that is not declared or is missing, and every value of another type.
  void hold(const nlohmann::json& value, const std::string& type, const std::string& where) {
    if (!fits(value, trimmed(type), where)) {
      lapses.push_back(where + " is " + value.dump().substr(0, 60) + ", not " + type);
    }
  }

  /// Keys that are declared of what was seen, and never were there: "Card.cause".
  [[nodiscard]] std::set<std::string> never_sent() const {
    std::set<std::string> keys;
    for (const auto& [name, declared] : interfaces_) {
      if (!met_.contains(name)) keys.insert(name);
      for (const Key& key : declared) {
        if (met_.contains(name) && !sent_.contains(name + "." + key.name)) {
          keys.insert(name + "." + key.name);
        }
      }
    }
    return keys;
  }

  std::vector<std::string> lapses;

 private:
  struct Key {
    std::string name;
    std::string type;
    bool optional = false;
  };

  static std::string trimmed(const std::string& text) {
    const std::size_t from = text.find_first_not_of(" \n");
    const std::size_t to = text.find_last_not_of(" \n");
    return from == std::string::npos ? "" : text.substr(from, to - from + 1);
  }

  /// "(a | b)[] | null" -> "(a | b)[]", "null".
  static std::vector<std::string> alternatives(const std::string& type) {
    std::vector<std::string> parts{""};
    int depth = 0;
    for (const char c : type) {
      depth += c == '(' ? 1 : c == ')' ? -1 : 0;
      if (c == '|' && depth == 0) {
        parts.emplace_back();
      } else {
        parts.back() += c;
      }
    }
    for (std::string& part : parts) part = trimmed(part);
    return parts;
  }

  bool fits(const nlohmann::json& value, const std::string& type, const std::string& where) {
    if (const auto alias = aliases_.find(type); alias != aliases_.end()) {
      return fits(value, trimmed(alias->second), where);
    }
    const std::vector<std::string> parts = alternatives(type);
    if (parts.size() > 1) {
      for (const std::string& part : parts) {
        if (fits(value, part, where)) return true;
      }
      return false;
    }
    if (type.ends_with("[]")) {
      if (!value.is_array()) return false;
      const std::string inner = type.substr(0, type.size() - 2);
      const bool bracketed = inner.starts_with('(');
      for (const nlohmann::json& one : value) {
        hold(one, bracketed ? inner.substr(1, inner.size() - 2) : inner, where + "[]");
      }
      return true;
    }
    if (type == "string") return value.is_string();
    if (type == "number") return value.is_number();
    if (type == "boolean") return value.is_boolean();
    if (type == "null") return value.is_null();
    if (type.starts_with('\'')) return value == type.substr(1, type.size() - 2);
    const auto declared = interfaces_.find(type);
    if (declared == interfaces_.end()) {
      lapses.push_back(where + ": the type " + type + " is not declared");
      return true;
    }
    if (!value.is_object()) return false;
    hold_keys(value, type, declared->second, where);
    return true;
  }

  void hold_keys(const nlohmann::json& value, const std::string& type, const std::vector<Key>& keys,
                 const std::string& where) {
    met_.insert(type);
    std::set<std::string> known;
    for (const Key& key : keys) {
      known.insert(key.name);
      if (!value.contains(key.name)) {
        if (!key.optional) lapses.push_back(where + " lacks " + key.name + " of " + type);
        continue;
      }
      sent_.insert(type + "." + key.name);
      hold(value.at(key.name), key.type, where + "." + key.name);
    }
    for (const auto& [name, ignored] : value.items()) {
      if (!known.contains(name)) lapses.push_back(where + "." + name + " is not in " + type);
    }
  }

  std::map<std::string, std::vector<Key>> interfaces_;
  std::map<std::string, std::string> aliases_;
  std::set<std::string> met_;
  std::set<std::string> sent_;
};

}  // namespace trussmap::testing
