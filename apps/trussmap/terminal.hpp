// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Colour on a terminal: the verdict's word in its colour, headings of tables dim. Plain text
// anywhere else (a file, a pipe, NO_COLOR, TERM=dumb).
#pragma once

#include "trussmap/texts.hpp"

#include <cstdio>
#include <string>
#include <string_view>

namespace trussmap::app {

/// Whether lines can be written over: a terminal that is not dumb.
[[nodiscard]] bool can_rewrite_lines(std::FILE* file);
/// The same, and colour is not unwanted (NO_COLOR, https://no-color.org).
[[nodiscard]] bool is_coloured(std::FILE* file);

/// The style of text that suits it.
[[nodiscard]] TextStyle style_of(std::FILE* file);

// Parts of texts (texts.hpp) for standard output.

[[nodiscard]] std::string verdict_text(Mood mood, std::string_view sentence);
[[nodiscard]] std::string table_text(const TextTable& table);
[[nodiscard]] std::string warning_text(std::string_view warning);

}  // namespace trussmap::app
