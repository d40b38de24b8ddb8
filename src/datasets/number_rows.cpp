// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "datasets/number_rows.hpp"

#include "files/present.hpp"
#include "io/csv_record.hpp"
#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

namespace trussmap::datasets {

std::vector<NumberRow> read_number_rows(const std::filesystem::path& file, std::size_t columns,
                                        std::string_view separators) {
  const std::string text = read_file(file);
  std::vector<NumberRow> rows;
  std::size_t line = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view content = std::string_view(text).substr(at, end - at);
    at = end + 1;
    ++line;
    NumberRow row{{}, line};
    for (std::size_t k = content.find_first_not_of(separators);
         k != std::string_view::npos && content[k] != '#';) {
      const std::size_t stop = std::min(content.find_first_of(separators, k), content.size());
      const std::string_view word = content.substr(k, stop - k);
      double value = 0.0;
      const auto [rest, status] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (status != std::errc() || rest != word.data() + word.size() || !std::isfinite(value)) {
        throw InputError(file.string(), line, io::shown_field(word) + ", expected a finite number");
      }
      row.values.push_back(value);
      k = content.find_first_not_of(separators, stop);
    }
    if (row.values.empty()) continue;
    if (row.values.size() != columns) {
      throw InputError(
          file.string(), line,
          std::to_string(row.values.size()) + " numbers, expected " + std::to_string(columns));
    }
    rows.push_back(std::move(row));
  }
  if (rows.empty()) throw InputError(file.string(), 0, "no rows, expected some");
  return rows;
}

std::filesystem::path plain_or_xz(const std::filesystem::path& path) {
  if (files::is_present(path)) return path;
  std::filesystem::path compressed = path;
  compressed += ".xz";
  if (files::is_present(compressed)) return compressed;
  return {};
}

std::filesystem::path require_plain_or_xz(const std::filesystem::path& path) {
  std::filesystem::path file = plain_or_xz(path);
  if (file.empty()) throw InputError(path.string(), 0, "is missing, plain or as .xz");
  return file;
}

std::filesystem::path beside(const std::filesystem::path& prefix, const char* ending) {
  std::filesystem::path path = prefix;
  path += ending;
  return path;
}

double since(double epoch, double time) {
  return std::round((time - epoch) * 1e6) / 1e6;
}

}  // namespace trussmap::datasets
