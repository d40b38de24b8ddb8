// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "terminal.hpp"

#include <cstdlib>
#include <unistd.h>

#include <fmt/color.h>
#include <fmt/format.h>

namespace trussmap::app {
namespace {

fmt::text_style style_of(Mood mood) {
  const fmt::terminal_color colour = mood == Mood::good    ? fmt::terminal_color::green
                                     : mood == Mood::doubt ? fmt::terminal_color::yellow
                                                           : fmt::terminal_color::red;
  return fmt::emphasis::bold | fmt::fg(colour);
}

std::string_view variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string_view() : std::string_view(value);
}

}  // namespace

bool can_rewrite_lines(std::FILE* file) {
  return ::isatty(::fileno(file)) == 1 && !variable("TERM").empty() && variable("TERM") != "dumb";
}

bool is_coloured(std::FILE* file) {
  return variable("NO_COLOR").empty() && can_rewrite_lines(file);
}

std::string verdict_text(Mood mood, std::string_view said, bool coloured) {
  std::string sentence = shortened_words(said);
  if (!coloured) return sentence;
  const std::size_t word = sentence.find(':');
  const std::string rest = word == std::string::npos ? "" : sentence.substr(word);
  return fmt::format("{}{}", fmt::styled(sentence.substr(0, word), style_of(mood)), rest);
}

std::string table_text(const TextTable& table, bool coloured) {
  std::string text = format_table(table);
  if (!coloured || !table.has_heading) return text;
  const std::size_t end = text.find('\n');
  return fmt::format("{}{}",
                     fmt::styled(text.substr(0, end), fmt::text_style(fmt::emphasis::faint)),
                     text.substr(end));
}

std::string warning_text(std::string_view warning, bool coloured) {
  return verdict_text(Mood::doubt, fmt::format("warning: {}\n", warning), coloured);
}

}  // namespace trussmap::app
