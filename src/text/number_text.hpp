// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Numbers as text, sentences with numbers in them, and numbers of few digits.
#pragma once

#include <locale>
#include <sstream>
#include <string>

namespace trussmap::text {

/// The shortest text that reads back to the same bits: "0.1", "1e-07".
[[nodiscard]] std::string shortest_text(double value);

/// So many significant digits at most, as printf's %g.
[[nodiscard]] std::string short_text(double value, int digits = 6);

/// So many digits behind the point, as printf's %f.
[[nodiscard]] std::string fixed_text(double value, int decimals);

/// The same with its sign, "+1.20"; what rounds to nothing has none: "0.00".
[[nodiscard]] std::string signed_fixed_text(double value, int decimals);

/// A number's text, without the sign where all digits are 0.
[[nodiscard]] std::string without_sign_of_nothing(std::string text);

/// How many times as large: with one decimal, or as many as show that it is not 1.
[[nodiscard]] std::string times_text(double ratio);

/// The parts, one behind the other: texts and whole numbers.
template <typename... Parts>
[[nodiscard]] std::string joined(const Parts&... parts) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  (stream << ... << parts);
  return stream.str();
}

/// The nearest multiple of a power of ten between 1e-5 and 1e-4 of `scale`: a number that a search
/// cannot tell from `value`, with a short text. `scale` above 0.
[[nodiscard]] double rounded_within(double value, double scale);

}  // namespace trussmap::text
