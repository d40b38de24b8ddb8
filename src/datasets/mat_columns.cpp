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

namespace trussmap {
namespace {

void read_matrix(const MatElement& matrix, const std::string& file,
                 std::map<std::string, std::vector<double>>& columns) {
  MatElements parts(matrix.data, matrix.begin, file);
  const MatElement flags = parts.next();
  if (flags.type != kMatUint32 || flags.data.size() != 8) parts.fail("has no array flags");
  const MatElement dimensions = parts.next();
  if (dimensions.type != kMatInt32 || dimensions.data.size() != 8) {
    parts.fail("has an array that is no matrix");
  }
  const auto rows = mat_number<std::int32_t>(dimensions.data, 0);
  const auto across = mat_number<std::int32_t>(dimensions.data, 4);
  const MatElement name = parts.next();
  if (name.type != kMatInt8 || name.data.empty() || !is_plain_text(name.data)) {
    parts.fail("has an array without a name");
  }
  const MatElement values = parts.next();
  const bool real = (mat_number<std::uint32_t>(flags.data, 0) & kMatComplex) == 0;
  std::optional<std::vector<double>> numbers = mat_numbers(values.type, values.data);
  const bool column =
      (rows == 1 || across == 1) && rows >= 0 && across >= 0 && numbers &&
      static_cast<std::size_t>(rows) * static_cast<std::size_t>(across) == numbers->size();
  if (!real || !column) {
    parts.fail("holds \"" + std::string(name.data) + "\", which is no column of real numbers,");
  }
  columns[std::string(name.data)] = std::move(*numbers);
}

}  // namespace

std::map<std::string, std::vector<double>> read_mat_columns(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  const std::string name = file.string();
  require_mat_header(bytes, name);
  std::map<std::string, std::vector<double>> columns;
  MatElements elements(std::string_view(bytes).substr(kMatHeader), kMatHeader, name);
  while (!elements.ends()) {
    const MatElement element = elements.next();
    if (element.type != kMatMatrix) elements.fail("has an element that is no plain matrix");
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

}  // namespace trussmap
