// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Tables of bare numbers, as data sets come.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

namespace trussmap::datasets {

inline constexpr std::string_view kWhiteSpace = " \t\r";
inline constexpr std::string_view kCommas = ", \t\r";

struct NumberRow {
  std::vector<double> values;
  std::size_t line = 0;  ///< of the file, from 1

  double operator[](std::size_t column) const { return values[column]; }
};

/// Rows of `columns` finite numbers between `separators`; blank lines and what begins with # are
/// skipped. Decompresses .xz. Throws InputError with line, also where there is no row.
[[nodiscard]] std::vector<NumberRow> read_number_rows(const std::filesystem::path& file,
                                                      std::size_t columns,
                                                      std::string_view separators);

/// The file, plain or with .xz appended; empty if there is neither.
[[nodiscard]] std::filesystem::path plain_or_xz(const std::filesystem::path& path);

/// The same; throws InputError where neither is there.
[[nodiscard]] std::filesystem::path require_plain_or_xz(const std::filesystem::path& path);

/// The file of a data set whose names begin alike.
[[nodiscard]] std::filesystem::path beside(const std::filesystem::path& prefix, const char* ending);

/// A time counted from an epoch, s: to microseconds, which is more than such files have.
[[nodiscard]] double since(double epoch, double time);

}  // namespace trussmap::datasets
