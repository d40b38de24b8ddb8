// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Data elements of a MATLAB file of level 5 (MathWorks, "MAT-File Format", R2017a): what variables
// and their parts are made of.
//
//   header     128 bytes, of which "IM" at 126 says little-endian
//   element    type, size, data; after it up to 8 bytes are filled up
//   variable   an element of type kMatMatrix, whose data are elements: flags, dimensions, name,
//   values
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::io {

inline constexpr std::size_t kMatHeader = 128;
inline constexpr std::uint32_t kMatInt8 = 1;
inline constexpr std::uint32_t kMatInt32 = 5;
inline constexpr std::uint32_t kMatUint32 = 6;
inline constexpr std::uint32_t kMatMatrix = 14;
inline constexpr std::uint32_t kMatCompressed = 15;
inline constexpr std::uint32_t kMatComplex = 0x800;  ///< of a variable's flags

static_assert(std::endian::native == std::endian::little, "numbers are taken as they lie");

template <typename T>
[[nodiscard]] T mat_number(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Values of an element: numbers that are whole are often kept in fewer bytes. None of other types.
[[nodiscard]] std::optional<std::vector<double>> mat_numbers(std::uint32_t type,
                                                             std::string_view bytes);

struct MatElement {
  std::uint32_t type = 0;
  std::string_view data;
  std::size_t begin = 0;  ///< of the data, in the file
};

/// One element after the other; of compressed ones bytes count from where they begin.
class MatElements {
 public:
  MatElements(std::string_view bytes, std::size_t begin, const std::string& file)
      : bytes_(bytes), begin_(begin), file_(file) {}

  [[nodiscard]] bool ends() const { return at_ >= bytes_.size(); }
  /// Throws InputError where the bytes end before it does.
  MatElement next();
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string_view bytes_;
  std::size_t begin_;
  const std::string& file_;
  std::size_t at_ = 0;
};

/// A variable or a field, before its values.
struct MatHead {
  std::uint32_t type = 0;  ///< MATLAB's class; above 15: an object, of which nothing else is known
  bool complex = false;
  std::vector<std::int32_t> dimensions;
  std::string name;

  [[nodiscard]] bool is_numeric() const { return type >= 6 && type <= 15; }
  [[nodiscard]] bool is_whole() const { return type >= 8; }
  [[nodiscard]] bool is_structure() const { return type == 2; }
  /// Of a matrix; 0 of what has more dimensions.
  [[nodiscard]] std::size_t rows() const { return size(0); }
  [[nodiscard]] std::size_t across() const { return size(1); }
  [[nodiscard]] std::size_t elements() const { return rows() * across(); }

 private:
  [[nodiscard]] std::size_t size(std::size_t dimension) const {
    return dimensions.size() == 2 ? static_cast<std::size_t>(dimensions[dimension]) : 0;
  }
};

/// Flags, dimensions (two to 32) and name of a variable's elements; throws InputError without them.
/// Fields have empty names.
[[nodiscard]] MatHead mat_head(MatElements& parts);

/// Throws InputError, saying what it is instead, where these are not a file's first bytes.
void require_mat_header(std::string_view bytes, const std::string& file);

}  // namespace trussmap::io
