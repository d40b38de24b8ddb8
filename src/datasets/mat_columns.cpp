// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "datasets/mat_columns.hpp"

#include "text/plain_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

namespace trussmap {
namespace {

constexpr std::size_t kHeader = 128;
constexpr std::uint32_t kInt8 = 1;
constexpr std::uint32_t kInt32 = 5;
constexpr std::uint32_t kUint32 = 6;
constexpr std::uint32_t kMatrix = 14;
constexpr std::uint32_t kComplex = 0x800;

static_assert(std::endian::native == std::endian::little, "numbers are taken as they lie");

template <typename T>
T number_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

template <typename T>
std::vector<double> numbers_of(std::string_view bytes) {
  std::vector<double> numbers;
  numbers.reserve(bytes.size() / sizeof(T));
  for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
    numbers.push_back(static_cast<double>(number_at<T>(bytes, at)));
  }
  return numbers;
}

/// Numbers that are whole are often kept in fewer bytes. None of other types.
std::optional<std::vector<double>> numbers_of(std::uint32_t type, std::string_view bytes) {
  switch (type) {
    case 1:
      return numbers_of<std::int8_t>(bytes);
    case 2:
      return numbers_of<std::uint8_t>(bytes);
    case 3:
      return numbers_of<std::int16_t>(bytes);
    case 4:
      return numbers_of<std::uint16_t>(bytes);
    case 5:
      return numbers_of<std::int32_t>(bytes);
    case 6:
      return numbers_of<std::uint32_t>(bytes);
    case 7:
      return numbers_of<float>(bytes);
    case 9:
      return numbers_of<double>(bytes);
    default:
      return std::nullopt;
  }
}

struct Element {
  std::uint32_t type = 0;
  std::string_view data;
  std::size_t begin = 0;  ///< of the data, in the file
};

/// One data element after the other.
class Elements {
 public:
  Elements(std::string_view bytes, std::size_t begin, const std::string& file)
      : bytes_(bytes), begin_(begin), file_(file) {}

  [[nodiscard]] bool ends() const { return at_ >= bytes_.size(); }

  Element next() {
    if (bytes_.size() - at_ < 8) fail("ends inside an element");
    Element element{number_at<std::uint32_t>(bytes_, at_), {}, begin_ + at_ + 8};
    std::size_t size = number_at<std::uint32_t>(bytes_, at_ + 4);
    std::size_t data = at_ + 8;
    std::size_t whole = size + (8 - size % 8) % 8;
    if (element.type > 0xffff) {  // a small one: four bytes of data at most, in its own tag
      size = element.type >> 16U;
      element.type &= 0xffffU;
      data = at_ + 4;
      element.begin -= 4;
      whole = 0;
      if (size > 4) fail("has a small element of more than 4 bytes");
    }
    const std::size_t left = bytes_.size() - data;
    if (size > left) fail("ends inside an element");
    element.data = bytes_.substr(data, size);
    at_ = whole == 0 ? at_ + 8 : data + std::min(whole, left);
    return element;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(
        file_, 0,
        what + " at byte " + std::to_string(begin_ + at_) + ", expected a MATLAB file of level 5");
  }

 private:
  std::string_view bytes_;
  std::size_t begin_;
  const std::string& file_;
  std::size_t at_ = 0;
};

void read_matrix(const Element& matrix, const std::string& file,
                 std::map<std::string, std::vector<double>>& columns) {
  Elements parts(matrix.data, matrix.begin, file);
  const Element flags = parts.next();
  if (flags.type != kUint32 || flags.data.size() != 8) parts.fail("has no array flags");
  const Element dimensions = parts.next();
  if (dimensions.type != kInt32 || dimensions.data.size() != 8) {
    parts.fail("has an array that is no matrix");
  }
  const auto rows = number_at<std::int32_t>(dimensions.data, 0);
  const auto across = number_at<std::int32_t>(dimensions.data, 4);
  const Element name = parts.next();
  if (name.type != kInt8 || name.data.empty() || !is_plain_text(name.data)) {
    parts.fail("has an array without a name");
  }
  const Element values = parts.next();
  const bool real = (number_at<std::uint32_t>(flags.data, 0) & kComplex) == 0;
  std::optional<std::vector<double>> numbers = numbers_of(values.type, values.data);
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
  if (bytes.size() < kHeader || std::string_view(bytes).substr(126, 2) != "IM") {
    throw InputError(name, 0, "is no MATLAB file of level 5, little-endian, expected one");
  }
  std::map<std::string, std::vector<double>> columns;
  Elements elements(std::string_view(bytes).substr(kHeader), kHeader, name);
  while (!elements.ends()) {
    const Element element = elements.next();
    if (element.type != kMatrix) elements.fail("has an element that is no plain matrix");
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
