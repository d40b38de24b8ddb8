// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Colour on a terminal: the verdict's word in its colour, headings of tables dim. Plain text
// anywhere else (a file, a pipe, NO_COLOR, TERM=dumb).
#pragma once

#include "trussmap/table.hpp"

#include <cstdio>
#include <string>
#include <string_view>

namespace trussmap::app {

/// Whether lines can be written over: a terminal that is not dumb.
[[nodiscard]] bool can_rewrite_lines(std::FILE* file);
/// The same, and colour is not unwanted (NO_COLOR, https://no-color.org).
[[nodiscard]] bool is_coloured(std::FILE* file);

enum class Mood { good, doubt, bad };

/// A sentence that begins with its verdict, "misfit: ...": the word up to the colon in colour and
/// bold; all of it where there is no colon.
[[nodiscard]] std::string verdict_text(Mood mood, std::string_view sentence,
                                       bool coloured = is_coloured(stdout));

/// format_table, its heading dim.
[[nodiscard]] std::string table_text(const TextTable& table, bool coloured = is_coloured(stdout));

/// "warning: ..." and an end of line.
[[nodiscard]] std::string warning_text(std::string_view warning,
                                       bool coloured = is_coloured(stdout));

}  // namespace trussmap::app
