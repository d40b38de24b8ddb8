// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/texts.hpp"

#include <fmt/color.h>
#include <fmt/format.h>

namespace trussmap {
namespace {

fmt::text_style colour_of(Mood mood) {
  const fmt::terminal_color colour = mood == Mood::good    ? fmt::terminal_color::green
                                     : mood == Mood::doubt ? fmt::terminal_color::yellow
                                                           : fmt::terminal_color::red;
  return fmt::emphasis::bold | fmt::fg(colour);
}

}  // namespace

std::string verdict_text(Mood mood, std::string_view said, TextStyle style) {
  std::string sentence = shortened_words(said);
  if (style == TextStyle::plain) return sentence;
  const std::size_t word = sentence.find(':');
  const std::string rest = word == std::string::npos ? "" : sentence.substr(word);
  return fmt::format("{}{}", fmt::styled(sentence.substr(0, word), colour_of(mood)), rest);
}

std::string table_text(const TextTable& table, TextStyle style) {
  std::string text = format_table(table);
  if (style == TextStyle::plain || !table.has_heading) return text;
  const std::size_t end = text.find('\n');
  return fmt::format("{}{}",
                     fmt::styled(text.substr(0, end), fmt::text_style(fmt::emphasis::faint)),
                     text.substr(end));
}

std::string warning_text(std::string_view warning, TextStyle style) {
  return verdict_text(Mood::doubt, fmt::format("warning: {}\n", warning), style);
}

std::string warnings_text(const std::vector<std::string>& warnings, TextStyle style) {
  std::string text = warnings.empty() ? "" : "\n";
  for (const std::string& warning : warnings) text += warning_text(warning, style);
  return text;
}

std::string notes_text(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += fmt::format("note: {}\n", shortened_words(note));
  return text;
}

}  // namespace trussmap
