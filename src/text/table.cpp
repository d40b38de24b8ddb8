// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/table.hpp"

#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap {
namespace {

/// Characters, not bytes.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

std::string padded(const std::string& text, std::size_t to, Align align) {
  const std::string space(to - std::min(to, width(text)), ' ');
  return align == Align::right ? space + text : text + space;
}

std::string without_trailing_space(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

}  // namespace

std::string format_table(const TextTable& table) {
  std::vector<std::vector<std::string>> rows = table.rows;
  for (auto& row : rows) {
    for (std::string& cell : row) cell = text::without_sign_of_nothing(shortened_words(cell));
  }
  std::vector<std::size_t> widths(table.columns.size(), 0);
  for (const auto& row : rows) {
    for (std::size_t k = 0; k < std::min(row.size(), widths.size()); ++k) {
      widths[k] = std::max(widths[k], width(row[k]));
    }
  }
  const std::string indent(static_cast<std::size_t>(std::max(table.indent, 0)), ' ');
  std::string text;
  for (std::size_t number = 0; number < rows.size(); ++number) {
    const auto& row = rows[number];
    std::string line = indent;
    for (std::size_t k = 0; k < std::min(row.size(), widths.size()); ++k) {
      line += (k == 0 ? "" : "  ") + padded(row[k], widths[k], table.columns[k]);
    }
    text += without_trailing_space(line) + "\n";
    if (number != 0 || !table.has_heading) continue;
    line = indent;
    for (std::size_t k = 0; k < widths.size(); ++k) {
      line += (k == 0 ? "" : "  ") + std::string(widths[k], '-');
    }
    text += line + "\n";
  }
  return text;
}

std::string shortened(const std::string& text, std::size_t most) {
  if (width(text) <= most) return text;
  std::string kept;
  std::size_t characters = 0;
  for (const char c : text) {
    const bool begins = (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    if (begins && characters + 3 == std::max<std::size_t>(most, 3)) break;
    characters += begins ? 1 : 0;
    kept += c;
  }
  return kept + "...";
}

QuantityText quantity_text(double value, double standard_error) {
  if (!std::isfinite(value)) return {"-", ""};
  if (!(standard_error > 0.0) || !std::isfinite(standard_error)) {
    return {fmt::format("{:.6g}", value), ""};
  }
  // Rounded to two digits first: 0.0996 counts as 0.10.
  const double rounded = std::stod(fmt::format("{:.1e}", standard_error));
  const int decimals = 1 - static_cast<int>(std::floor(std::log10(rounded) + 1e-9));
  constexpr int kMostDecimals = 9;
  if (decimals > kMostDecimals) {
    return {fmt::format("{:.6g}", value), fmt::format("{:.1e}", standard_error)};
  }
  const int shown = std::max(decimals, 0);
  return {text::without_sign_of_nothing(fmt::format("{:.{}f}", value, shown)),
          fmt::format("{:.{}f}", standard_error, shown)};
}

std::string probability_text(double p) {
  if (!std::isfinite(p)) return "-";
  if (p >= 0.01) return fmt::format("{:.2f}", p);
  return p > 0.0 ? fmt::format("{:.1g}", p) : "< 1e-300";
}

}  // namespace trussmap
