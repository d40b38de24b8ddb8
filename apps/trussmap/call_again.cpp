// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "call_again.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace trussmap::app {
namespace {

std::vector<std::string>& remembered() {
  static std::vector<std::string> words;
  return words;
}

}  // namespace

std::string shell_quoted(const std::string& word) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=./,:@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

void remember_call(int argc, char** argv) {
  remembered().assign(argv + std::min(argc, 1), argv + argc);
}

std::string call_with(const std::vector<std::pair<std::string, std::string>>& options) {
  const std::vector<std::string>& words = remembered();
  std::string text = "trussmap";
  for (std::size_t k = 0; k < words.size(); ++k) {
    const auto replaced = std::find_if(options.begin(), options.end(), [&](const auto& one) {
      return words[k] == one.first || words[k].starts_with(one.first + "=");
    });
    if (replaced == options.end()) {
      text += " " + shell_quoted(words[k]);
    } else if (words[k] == replaced->first) {
      ++k;  // its value
    }
  }
  for (const auto& [name, value] : options) text += " " + name + " " + shell_quoted(value);
  return text;
}

std::string call_of(const std::vector<std::string>& words) {
  std::string text = "trussmap";
  for (const std::string& word : words) text += " " + shell_quoted(word);
  return text;
}

std::string next_name(const std::string& name) {
  const std::size_t end = name.find_last_not_of('/');
  const std::string stem = end == std::string::npos ? name : name.substr(0, end + 1);
  const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
  int number = 0;
  const auto [stop, status] =
      std::from_chars(stem.data() + digits, stem.data() + stem.size(), number);
  const bool numbered = digits > 1 && stem[digits - 1] == '-' && digits < stem.size() &&
                        status == std::errc() && number > 0 && number < 1000000;
  return numbered ? stem.substr(0, digits) + std::to_string(number + 1) : stem + "-2";
}

}  // namespace trussmap::app
