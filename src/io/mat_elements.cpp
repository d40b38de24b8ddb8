// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/mat_elements.hpp"

#include "text/plain_text.hpp"
#include "trussmap/error.hpp"

#include <algorithm>

namespace trussmap::io {
namespace {

template <typename T>
std::vector<double> numbers_of(std::string_view bytes) {
  std::vector<double> numbers;
  numbers.reserve(bytes.size() / sizeof(T));
  for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
    numbers.push_back(static_cast<double>(mat_number<T>(bytes, at)));
  }
  return numbers;
}

}  // namespace

std::optional<std::vector<double>> mat_numbers(std::uint32_t type, std::string_view bytes) {
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
    case 12:
      return numbers_of<std::int64_t>(bytes);
    case 13:
      return numbers_of<std::uint64_t>(bytes);
    default:
      return std::nullopt;
  }
}

MatElement MatElements::next() {
  if (bytes_.size() - at_ < 8) fail("ends inside an element");
  MatElement element{mat_number<std::uint32_t>(bytes_, at_), {}, begin_ + at_ + 8};
  std::size_t size = mat_number<std::uint32_t>(bytes_, at_ + 4);
  std::size_t data = at_ + 8;
  std::size_t whole = size;
  if (element.type != kMatCompressed) whole += (8 - size % 8) % 8;
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

void MatElements::fail(const std::string& what) const {
  throw InputError(
      file_, 0,
      what + " at byte " + std::to_string(begin_ + at_) + ", expected a MATLAB file of level 5");
}

MatHead mat_head(MatElements& parts) {
  constexpr std::size_t kMostDimensions = 32;
  MatHead head;
  const MatElement flags = parts.next();
  if (flags.type != kMatUint32 || flags.data.size() != 8) parts.fail("has no array flags");
  const auto bits = mat_number<std::uint32_t>(flags.data, 0);
  head.type = bits & 0xffU;
  head.complex = (bits & kMatComplex) != 0;
  if (head.type > 15) return head;  // an object: made otherwise
  const MatElement dimensions = parts.next();
  const std::size_t count = dimensions.data.size() / 4;
  if (dimensions.type != kMatInt32 || count < 2 || count > kMostDimensions) {
    parts.fail("has an array without dimensions");
  }
  for (std::size_t k = 0; k < count; ++k) {
    head.dimensions.push_back(mat_number<std::int32_t>(dimensions.data, 4 * k));
    if (head.dimensions.back() < 0) parts.fail("has an array with a negative size");
  }
  const MatElement name = parts.next();
  if (name.type != kMatInt8 || !text::is_plain_text(name.data))
    parts.fail("has an array without a name");
  head.name = name.data;
  return head;
}

void require_mat_header(std::string_view bytes, const std::string& file) {
  constexpr std::string_view kHdf = "\x89HDF";
  constexpr std::size_t kBehindText = 512;  // MATLAB's own text stands before what is HDF5
  if (bytes.starts_with(kHdf) ||
      (bytes.size() > kBehindText && bytes.substr(kBehindText).starts_with(kHdf))) {
    throw InputError(file, 0,
                     "is a MATLAB file of version 7.3 (HDF5), expected level 5: save it with "
                     "save(..., '-v7')");
  }
  if (bytes.size() < kMatHeader || bytes.substr(126, 2) != "IM") {
    throw InputError(file, 0, "is no MATLAB file of level 5, little-endian, expected one");
  }
}

}  // namespace trussmap::io
