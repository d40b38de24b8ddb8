// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "terminal.hpp"

#include <cstdlib>
#include <unistd.h>

namespace trussmap::app {
namespace {

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

TextStyle style_of(std::FILE* file) {
  return is_coloured(file) ? TextStyle::coloured : TextStyle::plain;
}

std::string verdict_text(Mood mood, std::string_view sentence) {
  return trussmap::verdict_text(mood, sentence, style_of(stdout));
}

std::string table_text(const TextTable& table) {
  return trussmap::table_text(table, style_of(stdout));
}

std::string warning_text(std::string_view warning) {
  return trussmap::warning_text(warning, style_of(stdout));
}

}  // namespace trussmap::app
