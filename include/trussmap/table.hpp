// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// Tables for people: aligned columns of text, and numbers with as many digits as they deserve.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trussmap {

enum class Align { left, right };

struct TextTable {
  std::vector<Align> columns;
  std::vector<std::vector<std::string>> rows;  ///< the first is the heading where has_heading
  bool has_heading = false;                    ///< ruled off from the rest
  int indent = 2;                              ///< spaces before each line
};

/// One line per row, columns two spaces apart, nothing trailing. UTF-8: widths are counted in
/// characters, after shortened_words(). A row may have fewer cells than there are columns.
[[nodiscard]] std::string format_table(const TextTable& table);

/// No more characters than `width`: a longer text ends in "...".
[[nodiscard]] std::string shortened(const std::string& text, std::size_t width);

/// A message with its long words, and long texts in "...", shortened in the middle, and each of its
/// lines to a length that can be read: who writes a name of 10 000 letters gets its ends shown.
[[nodiscard]] std::string shortened_words(std::string_view message);

/// A value and its standard error to the same decimal, that of the error's second digit:
/// "0.3362" and "0.0015". Without an error (0 or not finite) the value has six digits and the
/// error is empty.
struct QuantityText {
  std::string value;
  std::string error;
};

[[nodiscard]] QuantityText quantity_text(double value, double standard_error);

/// A probability: "0.31", "0.004", "3e-9", and "-" for NaN.
[[nodiscard]] std::string probability_text(double p);

/// Text that came from a file, for a reader's eye: nothing in it may command a terminal, turn the
/// direction of what follows, or (unless `lines`) break the line. Control characters, marks and
/// overrides of direction, separators of lines, and bytes that are no UTF-8 become \xHH or
/// \u{HHHH}.
[[nodiscard]] std::string escaped_controls(std::string_view text, bool lines = false);

}  // namespace trussmap
