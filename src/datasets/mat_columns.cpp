// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "datasets/mat_columns.hpp"

#include "io/mat_elements.hpp"
#include "text/plain_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace trussmap::datasets {
namespace {

void read_matrix(const io::MatElement& matrix, const std::string& file,
                 std::map<std::string, std::vector<double>>& columns) {
  io::MatElements parts(matrix.data, matrix.begin, file);
  const io::MatHead head = io::mat_head(parts);
  if (head.dimensions.size() != 2) parts.fail("has an array that is no matrix");
  if (head.name.empty()) parts.fail("has an array without a name");
  const io::MatElement values = parts.next();
  std::optional<std::vector<double>> numbers = io::mat_numbers(values.type, values.data);
  const bool column =
      (head.rows() == 1 || head.across() == 1) && numbers && head.elements() == numbers->size();
  if (head.complex || !column) {
    parts.fail("holds \"" + head.name + "\", which is no column of real numbers,");
  }
  columns[head.name] = std::move(*numbers);
}

}  // namespace

std::map<std::string, std::vector<double>> read_mat_columns(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  const std::string name = file.string();
  io::require_mat_header(bytes, name);
  std::map<std::string, std::vector<double>> columns;
  io::MatElements elements(std::string_view(bytes).substr(io::kMatHeader), io::kMatHeader, name);
  while (!elements.ends()) {
    const io::MatElement element = elements.next();
    if (element.type != io::kMatMatrix) elements.fail("has an element that is no plain matrix");
    read_matrix(element, name, columns);
  }
  return columns;
}

const std::vector<double>& mat_column(const std::map<std::string, std::vector<double>>& columns,
                                      const std::string& name, const std::filesystem::path& file,
                                      std::size_t rows) {
  constexpr double kMostNumber = 1e12;  // in any unit: beyond all that is meant
  const auto found = columns.find(name);
  if (found == columns.end()) {
    throw InputError(file.string(), 0, "has no \"" + name + "\", expected it");
  }
  const std::vector<double>& values = found->second;
  if (rows > 0 && values.size() != rows) {
    throw InputError(file.string(), 0,
                     "\"" + name + "\" has " + std::to_string(values.size()) +
                         " numbers, expected " + std::to_string(rows) + " as the times are");
  }
  for (const double one : values) {
    if (std::abs(one) <= kMostNumber) continue;
    throw InputError(file.string(), 0, "\"" + name + "\" holds no number, or one beyond 1e12");
  }
  return values;
}

}  // namespace trussmap::datasets
